# SPDX-License-Identifier: GPL-3.0-or-later
"""How often a click selects the same part of a coarser copy (overlap of at least 0.9), and what building that costs: on
models of 40,000 to 52,000 faces.

usage: build/venv/core/bin/python tests/quality/coarse.py
"""

import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "bench"), str(ROOT / "tests" / "gui")]

import generated  # noqa: E402
import pyfqmr  # noqa: E402
from model import read_off  # noqa: E402
from partwheel import Hierarchy  # noqa: E402
from scipy.spatial import cKDTree  # noqa: E402

CLICKS, SAME = 200, 0.9
COARSER = 2, 4  # times


def build(vertices, triangles):
    """(Hierarchy, processor seconds)"""
    start = time.process_time()
    return Hierarchy.build(vertices, triangles), time.process_time() - start


def part(hierarchy, face, face_count):
    """(F,) which faces a click selects."""
    stops, start = hierarchy.wheel(face)
    return np.isin(np.arange(face_count), hierarchy.faces(stops[start]))


def main():
    models = {**generated.MODELS, "armadillo": lambda: read_off(ROOT / "build" / "deps" / "meshes" / "armadillo.off")}
    for name, create in models.items():
        vertices, triangles = create()
        vertices = vertices.astype(np.float32).astype(float)
        a, b, c = (vertices[triangles[:, k]] for k in range(3))
        area, (exact, seconds) = np.linalg.norm(np.cross(b - a, c - a), axis=1), build(vertices, triangles)
        print(f"{name}: {len(triangles):,} faces {seconds:.2f} s", end="")
        clicked = np.random.default_rng(1).choice(len(area), CLICKS, p=area / area.sum())
        for times in COARSER:
            mesh = pyfqmr.Simplify()
            mesh.setMesh(vertices, triangles)
            mesh.simplify_mesh(target_count=len(triangles) // times, verbose=False)
            corners, faces = mesh.getMesh()[:2]
            coarse, seconds = build(corners, faces.astype(np.int32))
            nearest = cKDTree(corners[faces].mean(axis=1)).query(vertices[triangles].mean(axis=1))[1]
            n_same = 0
            for face in clicked:
                one, other = part(exact, face, len(area)), part(coarse, nearest[face], len(faces))[nearest]
                n_same += area[one & other].sum() >= SAME * area[one | other].sum()
            print(f"; {len(faces):,} faces {seconds:.2f} s, the same part {n_same / CLICKS:.2f}", end="")
        print(flush=True)


main()
