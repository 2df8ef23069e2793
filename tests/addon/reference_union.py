# SPDX-License-Identifier: GPL-3.0-or-later
"""Volumes by manifold3d, a library of its own: of two closed meshes, their intersection and their union.

    build/venv/core/bin/python tests/addon/reference_union.py PAIRS.npz RESULT.npz

PAIRS.npz: count, and for each i the arrays va{i}, ta{i}, vb{i}, tb{i}: vertices and triangles. RESULT.npz: volumes
(count, 4).
"""

import sys

import numpy as np
from manifold3d import Manifold, Mesh64


def solid(vertices, triangles):
    manifold = Manifold(Mesh64(vertices.astype(np.float64), triangles.astype(np.uint64)))
    if manifold.is_empty():
        raise ValueError(f"not a solid: {manifold.status()}")
    return manifold


pairs = np.load(sys.argv[1])
rows = []
for i in range(int(pairs["count"])):
    a, b = (solid(pairs[f"v{name}{i}"], pairs[f"t{name}{i}"]) for name in "ab")
    rows.append([a.volume(), b.volume(), (a ^ b).volume(), (a + b).volume()])
np.savez(sys.argv[2], volumes=np.array(rows))
