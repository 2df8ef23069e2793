# SPDX-License-Identifier: GPL-3.0-or-later
"""Bridges between a mesh and the facets that divide its filling from points.

The facets end near the boundary loops of the mesh's own polygons, not on them. Strips of triangles join the two."""

import bmesh
import numpy as np

from . import closing

MAX_LOOP_DISTANCE = 1.0  # between two loops that are joined, see _loop_distance()
MIN_BRIDGED_FRACTION = 0.5  # of the length of its boundary loops, for a component of facets to be used


def bridge(bm: bmesh.types.BMesh, facets: tuple[np.ndarray, np.ndarray]) -> list[bmesh.types.BMFace]:
    """Adds facets to a bmesh and joins them to its boundary loops. Returns the new faces.

    A connected component of the facets is used if loops of the bmesh match most of the length of its boundary, one
    loop each. The polygons around a matched loop are turned to the facets' winding. All other boundary loops stay
    open, also those of holes that only the filling closes. facets: (vertices (n, 3), triangles (m, 3) wound outward)."""
    mesh_loops = closing.boundary_loops([edge for edge in bm.edges if edge.is_boundary])
    positions, triangles = facets
    if not mesh_loops or not len(triangles):
        return []
    components = _add_facet_components(bm, positions, triangles)
    facet_loops = [(component, ring) for component, (_, loops) in enumerate(components) for ring in loops]
    corners = [_positions(ring) for _, ring in facet_loops]
    matches = _match_loops(corners, [_positions(ring) for ring in mesh_loops])
    joints, lengths = [[] for _ in components], np.zeros((len(components), 2))
    for (component, ring), points, match in zip(facet_loops, corners, matches):
        length = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum()
        lengths[component] += np.array([1, match is not None]) * length
        if match is not None:
            joints[component].append((ring, mesh_loops[match]))
    is_used = lengths[:, 1] > MIN_BRIDGED_FRACTION * lengths[:, 0]
    _orient_components(bm, [joint for component_joints, use in zip(joints, is_used) if use for joint in component_joints])
    caps = []
    for (faces, _), component_joints, use in zip(components, joints, is_used):
        if not use or any(_have_same_direction(*joint) for joint in component_joints):
            verts = dict.fromkeys(vert for face in faces for vert in face.verts)
            bmesh.ops.delete(bm, geom=list(verts), context="VERTS")
            continue
        caps += faces
        for ring, match in component_joints:
            caps += _add_strip(bm, match, ring[::-1])
    return caps


def _orient_components(bm: bmesh.types.BMesh, joints: list[tuple[list, list]]) -> None:
    """Turns those components of the mesh whose joined loops mostly run in the facets' direction: a strip can only
    join loops of opposite directions. The loops of joints [(facet loop, mesh loop), ...] are reversed with them."""
    faces, components = bm.faces[:], {}  # component -> (its loops, votes)
    bm.faces.index_update()
    label = closing.label_components(bm, faces)
    for facet_loop, mesh_loop in joints:
        loops, votes = components.setdefault(label[mesh_loop[0].link_faces[0].index], ([], []))
        loops.append(mesh_loop)
        votes.append(len(mesh_loop) if _have_same_direction(facet_loop, mesh_loop) else -len(mesh_loop))
    for component, (loops, votes) in components.items():
        if sum(votes) > 0:
            for number in np.flatnonzero(label == component).tolist():
                faces[number].normal_flip()
            for mesh_loop in loops:
                mesh_loop.reverse()


def _add_facet_components(bm: bmesh.types.BMesh, positions: np.ndarray,
                          triangles: np.ndarray) -> list[tuple[list, list]]:
    """Adds the facets to the bmesh. Returns (faces, boundary loops) of each connected component."""
    used_vertices, triangles = np.unique(triangles, return_inverse=True)
    verts = [closing.add_vertex(bm, position) for position in positions[used_vertices].tolist()]
    new_faces = [bm.faces.new([verts[k] for k in triangle]) for triangle in triangles.reshape(-1, 3).tolist()]
    closing.split_non_manifold(bm)
    components = {}
    for face, label in zip(new_faces, closing.label_components(bm, new_faces).tolist()):
        components.setdefault(label, []).append(face)
    return [(faces, closing.boundary_loops([edge for face in faces for edge in face.edges if edge.is_boundary]))
            for faces in components.values()]


def _positions(loop: list[bmesh.types.BMVert]) -> np.ndarray:
    """(n, 3) positions of a loop's vertices."""
    return np.array([vert.co[:] for vert in loop])


def _match_loops(facet_loops: list[np.ndarray], mesh_loops: list[np.ndarray]) -> list[int | None]:
    """For each facet loop (n, 3), the index of its nearest mesh loop; None if too far, or if another claims it."""
    choices = []
    for loop in facet_loops:
        distances = [_loop_distance(loop, other) for other in mesh_loops]
        nearest = int(np.argmin(distances))
        choices.append(nearest if distances[nearest] < MAX_LOOP_DISTANCE else None)
    return [None if choice is None or choices.count(choice) > 1 else choice for choice in choices]


def _loop_distance(first: np.ndarray, second: np.ndarray) -> float:
    """Symmetric mean distance between two loops of points (n, 3), the larger of both directions, divided by the first
    one's mean radius."""
    radius = np.linalg.norm(first - first.mean(axis=0), axis=1).mean()
    distance = np.linalg.norm(first[:, None] - second[None], axis=2)
    return max(distance.min(axis=0).mean(), distance.min(axis=1).mean()) / max(radius, 1e-30)


def _have_same_direction(first: list[bmesh.types.BMVert], second: list[bmesh.types.BMVert]) -> bool:
    """Whether two loops of vertices run the same way."""
    first, second = _positions(first), _positions(second)
    nearest = np.linalg.norm(first[:, None] - second[None], axis=2).argmin(axis=1)
    first_tangents, second_tangents = (np.roll(loop, -1, axis=0) - np.roll(loop, 1, axis=0) for loop in (first, second))
    return float(np.einsum("ij,ij->", first_tangents, second_tangents[nearest])) > 0


def _add_strip(bm: bmesh.types.BMesh, first: list[bmesh.types.BMVert],
               second: list[bmesh.types.BMVert]) -> list[bmesh.types.BMFace]:
    """Adds triangles between two loops of vertices that run the same way, and returns them. They minimize the total
    length of the edges across, among all strips that contain the shortest one (dynamic programming, as in Fuchs,
    Kedem and Uselton 1977 for least area)."""
    a, b = _positions(first), _positions(second)
    start = np.unravel_index(np.linalg.norm(a[:, None] - b[None], axis=2).argmin(), (len(a), len(b)))
    first, second = ([*loop[index:], *loop[:index], loop[index]] for loop, index in zip((first, second), start))
    faces, i, j = [], 0, 0
    for is_first in _cheapest_steps(np.linalg.norm(_positions(first)[:, None] - _positions(second)[None], axis=2)):
        if is_first:
            faces.append(bm.faces.new((first[i], first[i + 1], second[j])))
            i += 1
        else:
            faces.append(bm.faces.new((first[i], second[j + 1], second[j])))
            j += 1
    return faces


def _cheapest_steps(costs: np.ndarray) -> list[bool]:
    """The monotone path of least total cost from the first to the last cell of costs (n+1, m+1): for each step,
    whether it is along the first axis."""
    n, m = np.array(costs.shape) - 1
    # Both loops end where they began: to use no edge across twice, a corner of the grid is closed on either side.
    costs = costs.copy()
    costs[0, m // 2 + 1:] = costs[n, :m // 2 + 1] = np.inf
    costs[n // 2 + 1:, 0] = costs[:n // 2 + 1, m] = np.inf
    costs[n, m] = 0
    least_cost = np.full((n + 2, m + 2), np.inf)  # with a row and a column of infinities before it
    least_cost[1, 1] = 0
    for count in range(1, n + m + 1):  # all cells at this number of steps from the first
        i = np.arange(max(count - m, 0), min(count, n) + 1)
        j = count - i
        least_cost[i + 1, j + 1] = np.minimum(least_cost[i, j + 1], least_cost[i + 1, j]) + costs[i, j]
    steps, i, j = [], n, m
    while i or j:
        steps.append(bool(least_cost[i, j + 1] <= least_cost[i + 1, j]))
        i, j = (i - 1, j) if steps[-1] else (i, j - 1)
    return steps[::-1]
