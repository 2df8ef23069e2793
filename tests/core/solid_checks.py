# SPDX-License-Identifier: GPL-3.0-or-later
"""What must hold of every solid, checked with numpy, scipy and CGAL alone."""

import ctypes
import functools
import os
from pathlib import Path

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

ROOT = Path(__file__).resolve().parents[2]

TOLERANCE = 1e-9


def triangle_areas(vertices, triangles):
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def volume(vertices, triangles, *_):
    """Enclosed volume, about the middle so that a model far from the origin loses no digits."""
    corners = (vertices - vertices.mean(axis=0))[triangles]
    return np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6


def tetrahedra_volume(hierarchy, tets=slice(None)):
    """Sum over tetrahedra, counted anew from their corners."""
    corners = hierarchy.vertices[hierarchy.tetrahedra[tets]]
    sides = corners[:, 1:] - corners[:, :1]
    return np.einsum("ij,ij->i", np.cross(sides[:, 0], sides[:, 1]), sides[:, 2]).sum() / 6


def check_solid(solid):
    """Closed, manifold and consistently wound, with a mesh in which every vertex is used."""
    vertices, triangles = solid.vertices, solid.triangles
    assert np.array_equal(np.unique(triangles), np.arange(len(vertices)))
    # Edge k of a triangle goes from its corner k to the next: each directed edge once, and its opposite once.
    start, end = triangles.ravel().astype(np.int64), np.roll(triangles, -1, axis=1).ravel().astype(np.int64)
    edge, opposite_edge = start * len(vertices) + end, end * len(vertices) + start
    order = np.argsort(edge)
    assert (np.diff(edge[order]) > 0).all(), "an edge is run along twice in the same direction"
    across = order[np.minimum(np.searchsorted(edge[order], opposite_edge), len(edge) - 1)]
    assert np.array_equal(edge[across], opposite_edge), "an edge has a triangle on one side only"
    # One umbrella a vertex: from a corner to the one across the edge that starts there, and so all around.
    corner = np.arange(len(edge))
    opposite_corner = np.roll(corner.reshape(-1, 3), -1, axis=1).ravel()[across]  # the corner that the edge across ends at
    links = coo_matrix((np.ones(len(edge), bool), (corner, opposite_corner)), (len(edge), len(edge)))
    assert connected_components(links, directed=False)[0] == len(vertices)
    assert solid.source_vertices.shape == (len(vertices),) and solid.source_faces.shape == solid.neighbor_tets.shape == (len(triangles),)
    assert not (solid.source_faces[solid.neighbor_tets >= 0] >= 0).any()


@functools.cache
def checks():
    """self_intersections.cpp, which is built beside the library."""
    library = os.environ.get("PARTWHEEL_LIBRARY") or ROOT / "build" / "release" / "libpartwheel.so"
    return ctypes.CDLL(str(Path(library).with_name("libpartwheel_checks.so")))


def crossings(solid):
    """How many pairs of triangles have more in common than corners and edges. Copies of a vertex of the
    hierarchy are one: where a solid only touches itself there, it does not cross itself."""
    _, first, number = np.unique(solid.source_vertices, return_index=True, return_inverse=True)
    return _count(solid.vertices[first], number[solid.triangles])


def count_crossings(vertices, triangles):
    """The same of any mesh. Vertices at one place are one; triangles without area don't count."""
    vertices, number = np.unique(vertices, axis=0, return_inverse=True)
    triangles = number.ravel()[triangles]
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return _count(vertices, triangles[np.linalg.norm(np.cross(b - a, c - a), axis=1) > 0])


def _count(vertices, triangles):
    vertices, triangles = np.ascontiguousarray(vertices), np.ascontiguousarray(triangles, np.int32)
    function = checks().crossings
    function.restype = ctypes.c_size_t
    function.argtypes = [ctypes.c_void_p, ctypes.c_size_t] * 2
    return function(vertices.ctypes.data, len(vertices), triangles.ctypes.data, len(triangles))
