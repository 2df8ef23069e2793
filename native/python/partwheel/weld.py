# SPDX-License-Identifier: GPL-3.0-or-later
"""Welds coincident vertices. glTF and other formats split vertices between faces with different UVs or normals, so the
surface falls into pieces. Welding joins them again."""

from typing import Tuple

import numpy as np
from numpy.typing import ArrayLike

from .components import components, to_mask, triangle_components
from .triangles import side_ends

# Odd random multipliers for hashing x, y and z.
_MIX = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)


def weld_coincident_vertices(vertices: ArrayLike, triangles: ArrayLike, sheets: bool = False) -> np.ndarray:
    """old_to_new (V,), the first of the vertices that are welded with each vertex; 0, 1, 2, ... if none are.

    Two vertices with identical coordinates are welded if edges of theirs coincide and one of these edges is open, that is,
    has a single triangle. This joins what was split along an edge. Meshes without open edges, solids that touch, and surfaces
    that share a single point don't change.

    sheets : also weld the two sides of a double-sided sheet, which then move together: coincident edges that are connected to
        a welded one, or that form a whole surface, unlike the edges at which solids touch"""
    vertices, triangles = np.asarray(vertices, np.float64), np.asarray(triangles)
    old_to_new = np.arange(len(vertices))
    if not triangles.size or triangles.min() < 0 or triangles.max() >= len(vertices):
        return old_to_new  # the function that uses the surface reports the error
    place, is_shared = _places(vertices + 0.0, to_mask(len(vertices), triangles))  # + 0.0 turns -0.0 into 0.0
    edges = side_ends(triangles[is_shared[triangles].sum(axis=1) >= 2])
    edges, count = _distinct(edges[is_shared[edges].all(axis=1)], len(vertices))
    # Orient each edge from the lower to the higher place; drop edges of length 0.
    swap = place[edges[:, 0]] > place[edges[:, 1]]
    edges = np.where(swap[:, None], edges[:, ::-1], edges)
    ends = place[edges]
    has_length = ends[:, 0] < ends[:, 1]
    edges, is_open = edges[has_length], count[has_length] == 1
    _, first, group = np.unique(ends[has_length] @ [len(vertices), 1], return_index=True, return_inverse=True)
    is_welded = to_mask(len(first), group[is_open])[group]
    if sheets:
        is_welded |= _find_sheets(place, triangles, ends[has_length], np.bincount(group)[group] > 1, is_welded)
    pairs = np.stack([edges[is_welded], edges[first[group[is_welded]]]], axis=2).reshape(-1, 2)
    if not len(pairs):
        return old_to_new
    component = components(len(vertices), pairs)
    return np.unique(component, return_index=True)[1][component]


def weld_surface(vertices: ArrayLike, triangles: ArrayLike, sheets: bool = False) -> Tuple[np.ndarray, np.ndarray]:
    """(old_to_new (V,), see weld_coincident_vertices(); triangles (T, 3) of the welded vertices)"""
    old_to_new = weld_coincident_vertices(vertices, triangles, sheets)
    triangles = np.asarray(triangles)
    return old_to_new, old_to_new[triangles].astype(triangles.dtype) if is_welding(old_to_new) else triangles


def is_welding(old_to_new: np.ndarray) -> bool:
    """Whether any vertices are welded."""
    return bool((old_to_new != np.arange(len(old_to_new))).any())


def loose_parts(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(T,) the connected component of each triangle; coincident open edges connect."""
    return triangle_components(weld_surface(vertices, triangles)[1])


def _places(vertices: np.ndarray, is_used: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """(place (V,): an id of the position of each used vertex that shares it with another one, -1 for the rest;
    is_shared (V,) bool: whether it has an id)"""
    place, is_shared = np.full(len(vertices), -1), np.zeros(len(vertices), bool)
    with np.errstate(over="ignore"):
        bits = np.ascontiguousarray(vertices).view(np.uint64)
        hashes = ((bits ^ (bits >> np.uint64(32))) * _MIX).sum(axis=1, dtype=np.uint64)
    sorted_hashes = np.sort(hashes[is_used])
    repeated = sorted_hashes[1:][sorted_hashes[1:] == sorted_hashes[:-1]]
    candidates = np.flatnonzero(is_used & np.isin(hashes, repeated)) if len(repeated) else np.empty(0, int)
    if not len(candidates):
        return place, is_shared
    order = candidates[np.lexsort(vertices[candidates].T)]
    is_same = (vertices[order[1:]] == vertices[order[:-1]]).all(axis=1)
    place[order] = np.cumsum(np.append(True, ~is_same)) - 1
    is_shared[order[1:][is_same]] = is_shared[order[:-1][is_same]] = True
    return place, is_shared


def _find_sheets(place: np.ndarray, triangles: np.ndarray, ends: np.ndarray, is_double: np.ndarray,
                 is_welded: np.ndarray) -> np.ndarray:
    """(E,) bool: the edges of double-sided sheets. ends (E, 2): places of the edges; is_double (E,) bool: whether
    another edge coincides; is_welded (E,) bool."""
    if not is_double.any():
        return is_double
    component = components(place.max() + 1, ends[is_double])
    corners = np.where(place < 0, -1, component[place])[triangles]
    exits = corners[(corners != corners[:, :1]).any(axis=1)]  # of triangles that lead out of a component
    is_sheet = np.ones(len(component) + 1, bool)
    is_sheet[exits] = False
    is_sheet[component[ends[is_welded, 0]]] = True
    return is_double & is_sheet[component[ends[:, 0]]]


def _distinct(edges: np.ndarray, vertex_count: int) -> Tuple[np.ndarray, np.ndarray]:
    """((E, 2) the distinct edges, (E,) how often each occurs)"""
    keys, times = np.unique(edges[:, 0].astype(np.int64) * vertex_count + edges[:, 1], return_counts=True)
    return np.column_stack(np.divmod(keys, max(vertex_count, 1))), times
