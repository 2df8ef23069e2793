# SPDX-License-Identifier: GPL-3.0-or-later
"""The models of this tier: every mesh of libcgal-demo, Blender's primitives, the Princeton benchmark's tuning half."""

import os
import re
import subprocess
import tarfile
import tempfile
from pathlib import Path

import numpy as np
from conftest import ROOT
from partwheel import meshes

DEMO = ROOT / "build" / "deps" / "meshes"
BENCHMARK = ROOT.parent / "shared" / "psb" / "tune.tar.xz"  # not ours to pass on: tested where it is, else skipped
UNPACKED = ROOT / "build" / "test" / "models"
EVERYTHING = os.environ.get("PARTWHEEL_RELIABILITY") == "all"

# A cloud of points: there is nothing to build.
NO_TRIANGLES = {"b9.ply"}

# The models that have no volume at all: sheets, which are filled as thin solids.
SHEETS = {
    "ALSTOM_TEST4.off": "one bent blade, open all round",
    "degtri_sliding.off": "flat: 8 triangles in a plane",
    "fold.off": "12 triangles of a folded paper",
    "holes.off": "the front of a mask",
    "horizons.off": "a landscape",
    "in.off": "flat: a square",
    "mesh_with_border.off": "a relief",
    "mesh_with_colors.off": "flat: 4 squares",
    "negative.off": "6 triangles of a bent strip",
    "patch-13.off": "a nearly flat patch",
    "patch-21.off": "a nearly flat patch",
    "patch-23.off": "a flat patch",
    "plane.off": "flat: a grid",
    "poly2x^2+y^2-0.062500.off": "a bowl with four high points",
    "quad.off": "flat: a square",
    "quads_to_stitch.off": "flat: 8 squares",
    "triangle.off": "flat: a triangle",
    "triangular_hole.off": "flat: a triangle with a hole",
    "plane.npz": "Blender's plane", "plane_triangles.npz": "Blender's plane",
    "circle.npz": "Blender's circle", "circle_triangles.npz": "Blender's circle",
    "grid.npz": "Blender's grid", "grid_triangles.npz": "Blender's grid",
}


def demo():
    return sorted(path.name for path in DEMO.iterdir())


def primitives():
    """The names of Blender's primitives; made by the distribution's Blender when they are not there yet."""
    directory = UNPACKED / "primitives"
    if not directory.exists():
        UNPACKED.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=UNPACKED) as folder:
            clean = {"PATH": os.environ["PATH"], "HOME": folder, "LANG": "C.UTF-8"}
            subprocess.run(["blender", "-b", "-noaudio", "--factory-startup", "--python-exit-code", "9", "--python",
                            Path(__file__).with_name("primitives.py"), "--", folder], env=clean, check=True,
                           stdout=subprocess.DEVNULL, timeout=1800)
            directory.mkdir()
            for path in Path(folder).glob("*.npz"):
                path.rename(directory / path.name)
    return sorted(path.name for path in directory.iterdir())


def benchmark():
    """The benchmark's models: all if everything is asked for, else one of each category; none where it is absent."""
    if not BENCHMARK.exists():
        return []
    with tarfile.open(BENCHMARK) as archive:
        names = [name for name in archive.getnames() if re.fullmatch(r"psb/off/\d+\.off", name)]
        if not EVERYTHING:
            names = list({(int(Path(name).stem) - 1) // 20: name for name in sorted(names)}.values())
        missing = [name for name in names if not (UNPACKED / name).exists()]
        for name in missing:
            archive.extract(name, UNPACKED)
    return sorted(Path(name).name for name in names)


def read(name):
    """vertices, triangles, faces, face_count. Raises meshes.MeshFileError."""
    if name.endswith(".npz"):
        with np.load(UNPACKED / "primitives" / name) as arrays:
            return arrays["vertices"], arrays["triangles"], arrays["faces"], int(arrays["face_count"])
    places = (directory / name for directory in (DEMO, UNPACKED / "psb" / "off"))
    return meshes.read(next(path for path in places if path.exists()))[:4]
