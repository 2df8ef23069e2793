# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons with any number of corners: triangulation, and whether they form a closed, manifold, oriented surface."""

from ctypes import c_size_t
from typing import List, NamedTuple, Sequence

import numpy as np
from numpy.typing import ArrayLike

from .library import call_with_outputs, load


class Faults(NamedTuple):
    """What keeps polygons from being a closed, manifold, oriented surface; all 0 for such a surface.

    open_edges : edges that don't have exactly two polygons
    inconsistent_edges : edges that both of their polygons traverse in the same direction
    non_manifold_vertices : vertices without a polygon, or with several fans of polygons; counted only if both edge
        counts are 0
    """

    open_edges: int
    inconsistent_edges: int
    non_manifold_vertices: int


def polygon_faults(corners: ArrayLike, begin: ArrayLike, vertex_count: int) -> Faults:
    """Count what keeps polygons from being a closed, manifold, oriented surface.

    Parameters
    ----------
    corners : (L,) int, the vertices of all polygons, one polygon after the other
    begin : (F,) int, the index into corners of each polygon's first corner
    vertex_count : number of vertices

    Raises
    ------
    PartwheelError : an index is out of range (Status.INDEX)"""
    corners, begin = (np.ascontiguousarray(values, np.int32) for values in (corners, begin))
    arguments = corners, len(corners), begin, len(begin), vertex_count
    return Faults(*call_with_outputs([c_size_t] * 3, load().pw_polygon_faults, *arguments))


def is_fan(points: np.ndarray) -> bool:
    """Whether the fan around the first corner of a polygon covers it without folds. points : (n, 3)"""
    normal = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
    sides = points[1:] - points[0]
    return bool((np.cross(sides[:-1], sides[1:]) @ normal >= 0).all())


def fan_or_ears(points: np.ndarray, indices: Sequence[int]) -> List[List[int]]:
    """The n - 2 triangles of a nearly flat polygon, corners (n, 3) with these indices: the fan around its first corner if
    that covers it, else by triangulate()."""
    if len(indices) == 3 or is_fan(points):
        return [[indices[0], second, third] for second, third in zip(indices[1:], indices[2:])]
    return triangulate(points, indices)


def triangulate(points: np.ndarray, indices: Sequence[int]) -> List[List[int]]:
    """The n - 2 triangles of a nearly flat polygon, corners (n, 3) with these indices, by ear clipping, best-shaped ear
    first. O(n^3). A polygon that crosses itself and has no ear gives a fan."""
    next_points = np.roll(points, -1, axis=0)
    normal = np.cross(points, next_points).sum(axis=0)  # Newell: also right for concave polygons
    ring, triangles = list(range(len(indices))), []
    while len(ring) > 3:
        best, best_quality = 1, 0.0
        for i in range(len(ring)):
            a, b, c = (points[ring[(i + k) % len(ring)]] for k in (-1, 0, 1))
            sides = np.array([b - a, c - b, a - c])
            doubled_area = np.cross(sides[0], sides[1]) @ normal
            quality = doubled_area / (sides * sides).sum()
            if quality <= best_quality:
                continue
            rest = points[[ring[(i + k) % len(ring)] for k in range(2, len(ring) - 1)]]
            inside = [np.cross(side, rest - start) @ normal >= 0 for side, start in zip(sides, (a, b, c))]
            if not np.logical_and.reduce(inside).any():
                best, best_quality = i, quality
        triangles.append([indices[ring[(best + k) % len(ring)]] for k in (-1, 0, 1)])
        del ring[best]
    if len(ring) == 3:
        triangles.append([indices[corner] for corner in ring])
    return triangles
