# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes closed surfaces 2-manifold by position, as files without shared vertices need them: parts of a solid that touch in
a vertex or an edge are moved apart, and bodies without volume are removed."""

from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .components import components, to_mask
from .triangles import doubled_area_vectors, triangle_areas

STEP = 2.0 ** -19  # how far coincident vertices are moved apart, by the largest coordinate: 32 units of single precision
MIN_THICKNESS = 1e-6  # a body whose volume is below this fraction of its area ** 1.5 counts as flat

Midpoints = Dict[int, int]  # half-edge -> the vertex in its middle


class SeparatedSurface(NamedTuple):
    """A closed surface without coincident vertices."""

    vertices: np.ndarray  # (n, 3) float64, all distinct in single precision
    triangles: np.ndarray  # (m, 3) int32
    sources: np.ndarray  # (m,) the triangle of the original surface that each one is, or is a part of


def separate(vertices: np.ndarray, triangles: np.ndarray) -> SeparatedSurface:
    """A surface that stays 2-manifold when vertices with equal coordinates in single precision are merged. triangles : (m,
    3), in which each directed edge occurs once, and its opposite once

    Triangles that this merging makes degenerate, pairs of opposite triangles, and bodies without volume are removed. Where
    several sheets meet in a vertex, all but the largest move inward by STEP; where they meet in an edge and at both of its
    ends, they get a vertex in its middle, which moves."""
    points, triangles = np.asarray(vertices, np.float64), np.asarray(triangles, np.int64)  # of a Manifold they are unsigned
    unique, place = np.unique(_to_single(points), axis=0, return_inverse=True)
    sources, is_midpoint = np.arange(len(triangles)), np.zeros(len(points), bool)
    if len(unique) < len(points):
        mates, is_kept = _remove_doubles(place.ravel()[triangles], _mates(triangles, len(points)))
        points, triangles, is_midpoint, sources = _split_vertices(points, triangles, mates, is_kept)
    triangles, sources = _remove_flat_bodies(points, triangles, sources)
    points = _move_apart(points, triangles, is_midpoint)
    used, triangles = np.unique(triangles, return_inverse=True)
    return SeparatedSurface(points[used], triangles.reshape(-1, 3).astype(np.int32), sources)


def _to_single(points: np.ndarray) -> np.ndarray:
    return points.astype(np.float32) + np.float32(0)  # + 0 turns -0.0 into 0.0


def _mates(triangles: np.ndarray, vertex_count: int) -> np.ndarray:
    """(3m,) the opposite of each half-edge. Half-edge 3t + k runs from corner k of triangle t to the next one."""
    start, end = triangles.ravel().astype(np.int64), np.roll(triangles, -1, axis=1).ravel().astype(np.int64)
    edges, opposites = start * vertex_count + end, end * vertex_count + start
    order = np.argsort(edges)
    mates = order[np.minimum(np.searchsorted(edges[order], opposites), len(order) - 1)]
    if (edges[mates] != opposites).any():
        raise ValueError("The surface is not closed.")
    return mates


def _remove_doubles(places: np.ndarray, mates: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """(mates, (m,) bool: which triangles stay). Where triangles are removed, those beside them become adjacent to each other.
    places : (m, 3) the position of each corner"""
    mates, is_kept = mates.copy(), np.ones(len(places), bool)

    def glue(one: int, other: int) -> None:
        """Removes two half-edges that coincide."""
        if mates[one] != other:
            mates[mates[one]], mates[mates[other]] = mates[other], mates[one]

    has_length = places != np.roll(places, -1, axis=1)
    for triangle in np.flatnonzero(~has_length.all(axis=1)):
        is_kept[triangle] = False
        rest = 3 * triangle + np.flatnonzero(has_length[triangle])
        if len(rest):
            glue(*rest)
    # Opposite triangles: the same corners in reverse order. Each is rotated so that its lowest position comes first.
    first = places.argmin(axis=1)
    rotated = np.take_along_axis(places, (first[:, None] + [0, 1, 2]) % 3, axis=1)
    is_reversed = rotated[:, 1] > rotated[:, 2]
    _, group, sizes = np.unique(np.sort(rotated, axis=1), axis=0, return_inverse=True, return_counts=True)
    waiting: Dict[Tuple[int, bool], List[int]] = {}
    for triangle in np.flatnonzero(is_kept & (sizes[group.ravel()] > 1)):
        key = int(group.ravel()[triangle]), bool(is_reversed[triangle])
        opposites = waiting.get((key[0], not key[1]))
        if not opposites:
            waiting.setdefault(key, []).append(int(triangle))
            continue
        other = opposites.pop()
        is_kept[triangle] = is_kept[other] = False
        for k in range(3):
            start = np.flatnonzero(places[other] == places[triangle, (k + 1) % 3])[0]
            glue(3 * triangle + k, 3 * other + start)
    return mates, is_kept


def _split_vertices(points: np.ndarray, triangles: np.ndarray, mates: np.ndarray,
                    is_kept: np.ndarray) -> Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(points, triangles, is_midpoint, sources) with a vertex for each fan of triangles at a point, and with midpoints for
    edges that would have the same two vertices."""
    half_edges = np.flatnonzero(np.repeat(is_kept, 3))
    following = half_edges - half_edges % 3 + (half_edges + 1) % 3
    # Corner k of a triangle is where its half-edge k starts; so does the one after the opposite of half-edge k.
    after_mate = mates - mates % 3 + (mates + 1) % 3
    fans = components(len(mates), np.column_stack([half_edges, after_mate[half_edges]]))
    _, first, corners = np.unique(fans[half_edges], return_index=True, return_inverse=True)
    points = points[triangles.ravel()[half_edges[first]]]
    corner = np.full(len(mates), -1)
    corner[half_edges] = corners.ravel()
    ends = np.sort(np.column_stack([corner[half_edges], corner[following]]), axis=1)
    is_lower = half_edges < mates[half_edges]
    _, distinct = np.unique(ends[is_lower], axis=0, return_index=True)
    doubles = np.delete(half_edges[is_lower], distinct)
    midpoints: Midpoints = {}
    for number, half_edge in enumerate(doubles.tolist()):
        midpoints[half_edge] = midpoints[int(mates[half_edge])] = len(points) + number
    is_midpoint = np.arange(len(points) + len(doubles)) >= len(points)
    points = np.vstack([points, points[np.delete(ends[is_lower], distinct, axis=0)].mean(axis=1)])
    is_split = to_mask(len(triangles), np.array(list(midpoints), int) // 3)
    whole = np.flatnonzero(is_kept & ~is_split)
    result, sources = [corner.reshape(-1, 3)[whole]], [whole]
    for triangle in np.flatnonzero(is_split).tolist():
        mids = [midpoints.get(3 * triangle + k) for k in range(3)]
        pieces = list(_divide(corner[3 * triangle:3 * triangle + 3].tolist(), mids))
        result.append(np.array(pieces))
        sources.append(np.full(len(pieces), triangle))
    return points, np.vstack(result), is_midpoint, np.concatenate(sources)


def _divide(corners: Sequence[int], midpoints: Sequence[Optional[int]]) -> Iterator[Sequence[int]]:
    """The triangles of a triangle some of whose edges (edge k starts at corner k) have midpoints."""
    for k, middle in enumerate(midpoints):
        if middle is not None:
            yield from _divide([middle, corners[(k + 1) % 3], corners[(k + 2) % 3]], [None, midpoints[(k + 1) % 3], None])
            yield from _divide([middle, corners[(k + 2) % 3], corners[k]], [None, midpoints[(k + 2) % 3], None])
            return
    yield corners


def _remove_flat_bodies(points: np.ndarray, triangles: np.ndarray,
                        sources: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The triangles and sources without those of bodies that have no volume."""
    body = components(len(points), np.vstack([triangles[:, :2], triangles[:, 1:]]))[triangles[:, 0]]
    _, first, body = np.unique(body, return_index=True, return_inverse=True)
    corners = points[triangles]
    areas = np.bincount(body.ravel(), triangle_areas(corners))
    local = corners - points[triangles[first, 0]][body.ravel()][:, None]
    volumes = np.bincount(body.ravel(), np.einsum("ij,ij->i", local[:, 0], np.cross(local[:, 1], local[:, 2]))) / 6
    has_volume = abs(volumes) > MIN_THICKNESS * areas ** 1.5
    return triangles[has_volume[body.ravel()]], sources[has_volume[body.ravel()]]


def _move_apart(points: np.ndarray, triangles: np.ndarray, is_midpoint: np.ndarray) -> np.ndarray:
    """The points, of which those at the same position, and midpoints, are moved inward until all are distinct."""
    sizes = np.bincount(triangles.ravel(), minlength=len(points))
    to_move = np.union1d(_coincident(points, sizes, sizes), np.flatnonzero(is_midpoint & (sizes > 0)))
    if not len(to_move):
        return points
    normals = np.zeros(points.shape)
    np.add.at(normals, triangles.ravel(), np.repeat(doubled_area_vectors(points[triangles]), 3, axis=0))
    normals[~normals.any(axis=1)] = 1  # any direction
    directions = normals / np.linalg.norm(normals, axis=1)[:, None]
    step = STEP * abs(points[sizes > 0]).max()
    distances, moved, factors = np.zeros(len(points)), points, np.ones(len(points))
    while len(to_move):
        distances[to_move] += step * factors[to_move]
        factors[to_move] = np.arange(1, len(to_move) + 1)  # if some meet again, let them differ
        moved = points - directions * distances[:, None]
        to_move = _coincident(moved, sizes, distances == 0)
    return moved


def _coincident(points: np.ndarray, sizes: np.ndarray, rank: np.ndarray) -> np.ndarray:
    """The used points that coincide with another one, except one of the highest rank at each position. sizes : (n,) 0 for
    unused points"""
    places = _to_single(points)
    order = np.lexsort([rank, *places.T])
    order = order[sizes[order] > 0]
    return order[:-1][(places[order[1:]] == places[order[:-1]]).all(axis=1)]
