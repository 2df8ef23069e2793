# SPDX-License-Identifier: GPL-3.0-or-later
"""Coincident vertices as one vertex. glTF and other formats split a vertex where faces meet that differ in UV or normal,
so that the surface falls into pieces; welding joins these again."""

import numpy as np

from .components import components

# Odd random numbers that mix the bits of x, y and z.
_MIX = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)


def weld_coincident_vertices(vertices, triangles):
    """old_to_new (V,): the vertex that each vertex counts as, the first of those that are welded. vertices (V,3),
    triangles (T,3) indices into them.

    Two vertices at exactly the same place are welded where edges of theirs coincide, and one of these edges is open: it
    has a single triangle. So what was split along an edge is joined again. A mesh without open edges stays as it is, and
    so do solids that touch, and surfaces that share a single point. Positions are compared exactly: without coincident
    vertices old_to_new is 0, 1, 2..."""
    vertices, triangles = np.asarray(vertices, np.float64), np.asarray(triangles)
    old_to_new = np.arange(len(vertices))
    if not triangles.size or triangles.min() < 0 or triangles.max() >= len(vertices):
        return old_to_new  # what is wrong with the surface, its user says
    used = np.zeros(len(vertices), bool)
    used[triangles] = True
    place, shared = _places(vertices + 0.0, used)  # + 0.0: -0.0 is 0.0
    edges = triangles[shared[triangles].sum(axis=1) >= 2][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    edges = np.sort(edges[shared[edges].all(axis=1)], axis=1)
    edges, count = _distinct(edges, len(vertices))
    # Of each edge the end at the lower place first; without edges that are a point.
    swap = place[edges[:, 0]] > place[edges[:, 1]]
    edges = np.where(swap[:, None], edges[:, ::-1], edges)
    ends = place[edges]
    proper = ends[:, 0] < ends[:, 1]
    edges, is_open = edges[proper], count[proper] == 1
    _, first, group = np.unique(ends[proper] @ [len(vertices), 1], return_index=True, return_inverse=True)
    welds = np.zeros(len(first), bool)
    welds[group[is_open]] = True
    chosen = welds[group]
    pairs = np.stack([edges[chosen], edges[first[group[chosen]]]], axis=2).reshape(-1, 2)
    if not len(pairs):
        return old_to_new
    number = components(len(vertices), pairs)
    return np.unique(number, return_index=True)[1][number]


def weld_surface(vertices, triangles):
    """(old_to_new, triangles (T,3) of the welded vertices)"""
    old_to_new = weld_coincident_vertices(vertices, triangles)
    triangles = np.asarray(triangles)
    return old_to_new, old_to_new[triangles].astype(triangles.dtype) if is_welding(old_to_new) else triangles


def is_welding(old_to_new):
    """Whether any vertices are welded."""
    return bool((old_to_new != np.arange(len(old_to_new))).any())


def _places(vertices, used):
    """((V,) a number of the place of each used vertex, (V,) bool: several are at it). Other vertices have -1."""
    place, shared = np.full(len(vertices), -1), np.zeros(len(vertices), bool)
    with np.errstate(over="ignore"):
        bits = np.ascontiguousarray(vertices).view(np.uint64)
        mixed = ((bits ^ (bits >> np.uint64(32))) * _MIX).sum(axis=1, dtype=np.uint64)
    of_used = np.sort(mixed[used])
    repeated = of_used[1:][of_used[1:] == of_used[:-1]]
    candidates = np.flatnonzero(used & np.isin(mixed, repeated)) if len(repeated) else np.empty(0, int)
    if not len(candidates):
        return place, shared
    order = candidates[np.lexsort(vertices[candidates].T)]
    same = (vertices[order[1:]] == vertices[order[:-1]]).all(axis=1)
    place[order] = np.cumsum(np.append(True, ~same)) - 1
    shared[order[1:][same]] = shared[order[:-1][same]] = True
    return place, shared


def _distinct(edges, count):
    """((E,2) the distinct edges, (E,) how often each is there)"""
    keys, times = np.unique(edges[:, 0].astype(np.int64) * count + edges[:, 1], return_counts=True)
    return np.column_stack(np.divmod(keys, max(count, 1))), times
