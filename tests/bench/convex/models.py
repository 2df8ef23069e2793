# SPDX-License-Identifier: GPL-3.0-or-later
"""The models that convex parts are measured on."""

import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "reliability")]

import mutations  # noqa: E402  (found only now)

from partwheel import meshes  # noqa: E402

DEMO = ROOT / "build" / "deps" / "meshes"
DEMOS = "armadillo", "camel", "dino", "elephant", "homer", "knot1", "retinal", "turbine"  # closed ones of CGAL's
EACH = 6  # of the benchmark's tuning half, every sixth: 32
BROKEN = {"delete": "holes", "flip": "turned faces", "duplicate": "doubled faces", "tremble": "noise", "dust": "dust",
          "scramble": "wrong corners"}


def read(path):
    """vertices, triangles."""
    mesh = meshes.read(path)
    return mesh.vertices, mesh.triangles


def clean(benchmark):
    """{name: path}; benchmark: the folder of the Princeton benchmark's models, or None."""
    benchmark_paths = sorted(Path(benchmark).glob("*.off"), key=lambda path: int(path.stem))[::EACH] if benchmark else []
    return {path.stem: path for path in [*benchmark_paths, *(DEMO / f"{name}.off" for name in DEMOS)]}


def broken(paths):
    """{name: (path of the whole one, kind, seed)}: two a kind."""
    selected = list(paths.values())[::max(1, len(paths) // (2 * len(BROKEN)))]
    return {f"{path.stem}, {BROKEN[kind]}": (path, kind, seed)
            for seed, (path, kind) in enumerate(zip(selected, [*BROKEN, *BROKEN]))}


def mutated(path, kind, seed):
    """vertices, triangles."""
    return getattr(mutations, kind)(np.random.default_rng(seed), *read(path))
