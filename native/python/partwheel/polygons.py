# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons of any number of corners: as triangles that have an area wherever that can be; whether they are a solid."""

from __future__ import annotations

from ctypes import c_size_t
from typing import TYPE_CHECKING, List, NamedTuple, Sequence

import numpy as np

from .library import load, told

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Faults(NamedTuple):
    """What keeps polygons from being a closed, manifold, oriented surface. open: edges that have not just two polygons;
    against: edges whose two wind against each other; touching: vertices without a polygon, or with several fans of them
    (not counted where there are others)."""

    open: int
    against: int
    touching: int


def polygon_faults(corners: ArrayLike, begin: ArrayLike, vertex_count: int) -> Faults:
    """The Faults of polygons: corners (L,) their vertices, one after the other, begin (F,) the first corner of each.
    Raises PartwheelError (INDEX)."""
    corners, begin = (np.ascontiguousarray(each, np.int32) for each in (corners, begin))
    given = corners, len(corners), begin, len(begin), vertex_count
    return Faults(*told([c_size_t] * 3, load().pw_polygon_faults, *given))


def triangulate(points: np.ndarray, names: Sequence[int]) -> List[List[int]]:
    """Triangles, as triples of names, of a nearly flat polygon, by cutting off its best-shaped ear again and again.
    points (n,3), names (n,). Gives a fan where the polygon crosses itself and has no ear."""
    following = np.roll(points, -1, axis=0)
    normal = np.cross(points, following).sum(axis=0)  # Newell: also right for concave polygons
    ring, triangles = list(range(len(names))), []
    while len(ring) > 3:
        best, best_shape = 1, 0.0
        for i in range(len(ring)):
            a, b, c = (points[ring[(i + k) % len(ring)]] for k in (-1, 0, 1))
            sides = np.array([b - a, c - b, a - c])
            doubled_area = np.cross(sides[0], sides[1]) @ normal
            shape = doubled_area / (sides * sides).sum()
            if shape <= best_shape:
                continue
            others = points[[ring[(i + k) % len(ring)] for k in range(2, len(ring) - 1)]]
            inside = [np.cross(side, others - start) @ normal >= 0 for side, start in zip(sides, (a, b, c))]
            if not np.logical_and.reduce(inside).any():
                best, best_shape = i, shape
        triangles.append([names[ring[(best + k) % len(ring)]] for k in (-1, 0, 1)])
        del ring[best]
    if len(ring) == 3:
        triangles.append([names[corner] for corner in ring])
    return triangles
