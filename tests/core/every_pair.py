# SPDX-License-Identifier: GPL-3.0-or-later
"""every_pair.cpp for numpy: bodies, their facets, and each query against all of them. And places of one model by another."""

import ctypes

import numpy as np
from scipy.spatial import ConvexHull
from solid_checks import checks


def _call(name, *arguments):
    function = getattr(checks(), name)
    inputs = []
    for argument in arguments:
        if isinstance(argument, np.ndarray):
            assert argument.flags.c_contiguous and argument.dtype in (np.float64, np.int32, np.uint8)
            argument = argument.ctypes.data_as(ctypes.c_void_p)
        else:
            argument = ctypes.c_size_t(argument)
        inputs.append(argument)
    function.restype = None
    function(*inputs)


class Everything:
    """Bodies: vertices (V,3), tetrahedra (T,4) and the part of each, facets (F,3) and the part of each."""

    def __init__(self, vertices, tetrahedra, of_tetrahedra, facets, of_facets):
        self.vertices = np.ascontiguousarray(vertices, np.float64)
        self.tetrahedra = np.ascontiguousarray(tetrahedra, np.int32)
        self.facets = np.ascontiguousarray(facets, np.int32)
        self.of_tetrahedra, self.of_facets = np.asarray(of_tetrahedra, np.int32), np.asarray(of_facets, np.int32)

    @classmethod
    def of_tetrahedra(cls, hierarchy):
        tetrahedra = np.asarray(hierarchy.tetrahedra)
        facets = tetrahedra[:, [[1, 2, 3], [2, 0, 3], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
        _, which, count = np.unique(np.sort(facets, axis=1), axis=0, return_inverse=True, return_counts=True)
        outer = np.flatnonzero(count[which.ravel()] == 1)
        return cls(hierarchy.vertices, tetrahedra, np.arange(len(tetrahedra)), facets[outer], outer // 4)

    def locate(self, points):
        parts = np.empty(len(points), np.int32)
        _call("every_holding", self.vertices, len(self.vertices), self.tetrahedra, len(self.tetrahedra),
              np.ascontiguousarray(points), len(points), parts)
        return np.where(parts >= 0, self.of_tetrahedra[parts], -1)

    def holds(self, point, part):
        is_in_part = self.of_tetrahedra == part
        only = Everything(self.vertices, self.tetrahedra[is_in_part], self.of_tetrahedra[is_in_part], self.facets[:0], [])
        return only.locate(np.array([point]))[0] >= 0

    def hits(self, origins, directions):
        """(parts (n,), distances (n,)), -1 and infinity where there is none."""
        corners = np.ascontiguousarray(self.vertices[self.facets])
        facets, distances = np.empty(len(origins), np.int32), np.empty(len(origins))
        _call("every_hit", corners, len(corners), np.ascontiguousarray(origins), np.ascontiguousarray(directions), len(origins),
              facets, distances)
        return np.where(facets >= 0, self.of_facets[facets], -1), distances

    def distances(self, points, part=None):
        """(n,) from the facets, or those of one part."""
        facets = self.facets if part is None else self.facets[self.of_facets == part]
        corners, distances = np.ascontiguousarray(self.vertices[facets]), np.empty(len(points))
        _call("every_distance", corners, len(corners), np.ascontiguousarray(points), len(points), distances)
        return distances

    def touch(self, other, matrices):
        """(n,) bool"""
        touch = np.empty(len(matrices), np.uint8)
        solids = [array for body in (self, other) for array in (body.vertices, body.tetrahedra, body.facets)]
        sized = [argument for array in solids for argument in (array, len(array))]
        _call("every_touch", *sized, np.ascontiguousarray(matrices[:, :3]), len(matrices), touch)
        return touch.astype(bool)


def hulls_of(hierarchy, bounds):
    """The convex hulls of a cut's parts, by Qhull; the tetrahedra in them go from a corner to each facet."""
    vertices, tetrahedra, facets, of_tetrahedra, of_facets, count = [], [], [], [], [], 0
    for part, (first, last) in enumerate(zip(bounds, bounds[1:])):
        corners, hull = hierarchy.hull_of_slice(first, last)
        points = hierarchy.vertices[np.unique(hierarchy.tetrahedra[first:last])]
        assert ConvexHull(points).volume > 0 and np.isclose(ConvexHull(corners).volume, ConvexHull(points).volume, rtol=1e-9)
        fan = hull[(hull != 0).all(1)]
        tetrahedra.append(count + np.column_stack([fan, np.zeros(len(fan), int)]))
        facets.append(count + hull)
        of_tetrahedra += [part] * len(fan)
        of_facets += [part] * len(hull)
        vertices.append(corners)
        count += len(corners)
    return Everything(np.vstack(vertices), np.vstack(tetrahedra), of_tetrahedra, np.vstack(facets), of_facets)


def rotations(draw, count):
    """(n,3,3), evenly distributed."""
    turned, upper = np.linalg.qr(draw.normal(size=(count, 3, 3)))
    turned *= np.sign(np.diagonal(upper, axis1=1, axis2=2))[:, None]
    return turned * np.sign(np.linalg.det(turned))[:, None, None]


def placed(draw, first, second, count, rigid=False):
    """(n,3,4): the second's points turned, and moved to where they just about reach the first's; unless rigid, every other one
    scaled, mirrored or sheared, too."""
    middle, other = (points.min(0) / 2 + points.max(0) / 2 for points in (first, second))
    linear = rotations(draw, count)
    if not rigid:
        linear[::2] = draw.normal(size=(len(linear[::2]), 3, 3))
    directions = draw.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    reach = ((first - middle) @ directions.T).max(0)
    moved = np.einsum("nij,vj->nvi", linear, second - other) if count * len(second) < 2e7 else None
    reach = reach + (-np.einsum("nvi,ni->nv", moved, directions)).max(1) if moved is not None else reach * 2
    offsets = middle + directions * (reach * draw.uniform(0, 1.2, count))[:, None] - linear @ other
    return np.concatenate([linear, offsets[:, :, None]], axis=2)
