# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds cases with the library that PARTWHEEL_LIBRARY names; prints {case: what was saved, as a digest} as JSON.

Run as: python digests.py THREADS CASE...
"""

import hashlib
import json
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "native" / "python"))

from partwheel import Hierarchy, Mode, meshes  # noqa: E402  (found only now)

MESHES = ROOT / "build" / "deps" / "meshes"
CASES = {  # name: file, or files of several shells, and options of the build
    **{name: (f"{name}.off", {}) for name in (
        "helmet", "rotor", "pinion", "hand", "handle", "couplingdown", "knot", "elephant", "triceratops", "femur")},
    "rotor with points inside": ("rotor.off", {"quality": 1.4}),
    "hand with points inside": ("hand.off", {"quality": 1.4}),
    "hand in mode paper": ("hand.off", {"mode": Mode.PAPER}),
    "rotor in mode paper": ("rotor.off", {"mode": Mode.PAPER}),
    "head, repaired": ("head.off", {}),
    "elephant with holes, repaired": ("elephant-with-holes.off", {}),
    "cow, from points": ("cow.off", {}),
    "assembly": ("rotor.off hand.off head.off pig.off knot.off", {}),
}


def digest(files, options, threads):
    shells = [meshes.read(MESHES / file) for file in files.split()]
    if len(shells) == 1:
        arrays = shells[0].vertices, shells[0].triangles, shells[0].faces, shells[0].face_count
    else:  # side by side, of one size
        vertices = [mesh.vertices / np.ptp(mesh.vertices) + [0.9 * k, 0, 0] for k, mesh in enumerate(shells)]
        first = np.cumsum([0, *map(len, vertices)])
        arrays = np.concatenate(vertices), np.concatenate([mesh.triangles + first[k] for k, mesh in enumerate(shells)])
    hierarchy = Hierarchy.build(*arrays, threads=threads, **options)
    return hashlib.sha256(hierarchy.save()).hexdigest()


if __name__ == "__main__":
    print(json.dumps({name: digest(*CASES[name], int(sys.argv[1])) for name in sys.argv[2:]}))
