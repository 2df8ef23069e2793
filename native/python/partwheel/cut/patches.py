# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle meshes that are cut open along edges, into patches that are topological disks."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from ..components import components

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

# A cut along an edge of length L costs L / (1 + CREASE_DISCOUNT s), with s = 1 at a right angle, times CONCAVE_FACTOR in a
# concave crease.
CREASE_DISCOUNT, CONCAVE_FACTOR = 4.0, 2.0
COST_DIGITS = 9  # decimals of costs, in units of about the mean length; the rest differs between processors
MAX_TRIED_LOOPS = 4  # loops that are tried as the first cut of a closed surface, those with the shortest paths
MIN_RELATIVE_LENGTH = 1e-6  # of an edge, in mean lengths: paths of no cost would be cyclic


class SeamMesh:
    """A triangle mesh, and its interior edges, those with two triangles, with the cost of a cut along each.

    positions : (V, 3)
    triangles : (T, 3)
    faces : (T,) the polygon of each triangle
    areas : (T,)
    edges : (E, 2) all edges, edges[:, 0] < edges[:, 1]
    non_manifold_edges : (n,) indices into edges, those with more than two triangles
    interior_edges : (I,) indices into edges
    edge_triangles : (I, 2) the triangles of each interior edge
    edge_corners : (I, 2, 2) corners, as 3 * triangle + corner: [i, e, t] is at end e of edge i, in its triangle t
    is_diagonal : (I,) bool, edges within a polygon, which can't be cut
    cut_cost : (I,)
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, faces: ArrayLike) -> None:
        self.positions, self.triangles = np.asarray(vertices, np.float64), np.asarray(triangles)
        self.faces = np.asarray(faces)
        sides = self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)  # side 3 t + k begins at corner k of triangle t
        self.edges, side_edge = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
        order = np.argsort(side_edge.ravel(), kind="stable")
        first = np.searchsorted(side_edge.ravel()[order], np.arange(len(self.edges)))
        count = np.diff(np.append(first, len(order)))
        self.interior_edges, self.non_manifold_edges = np.flatnonzero(count == 2), np.flatnonzero(count > 2)
        side = order[first[self.interior_edges][:, None] + [0, 1]]
        self.edge_triangles = side // 3
        corners = np.stack([side, _next_corner(side)], axis=1)
        is_reversed = sides[side, 0] > sides[side, 1]
        self.edge_corners = np.where(is_reversed[:, None], corners[:, ::-1], corners)
        self.is_diagonal = self.faces[self.edge_triangles[:, 0]] == self.faces[self.edge_triangles[:, 1]]
        a, b, c = self.positions[self.triangles].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        doubled_area = np.linalg.norm(normal, axis=1)
        self.areas = doubled_area / 2
        self.cut_cost = self._cut_costs(normal / np.maximum(doubled_area, 1e-300)[:, None], (a + b + c) / 3)

    def _cut_costs(self, normals: np.ndarray, centers: np.ndarray) -> np.ndarray:
        one, other = self.edge_triangles.T
        start, end = self.positions[self.edges[self.interior_edges]].transpose(1, 0, 2)
        sharpness = np.sqrt(np.maximum(1 - np.einsum("ij,ij->i", normals[one], normals[other]), 0))  # 1 at a right angle
        is_concave = np.einsum("ij,ij->i", normals[one], centers[other] - start) > 0
        length = np.linalg.norm(end - start, axis=1)
        unit = 2.0 ** np.floor(np.log2(max(length.mean(), 1e-300))) if len(length) else 1.0
        cost = np.maximum(length / unit, MIN_RELATIVE_LENGTH) / (
            1 + CREASE_DISCOUNT * sharpness * np.where(is_concave, CONCAVE_FACTOR, 1))
        return np.round(cost, COST_DIGITS) * unit

    def submesh(self, selected: np.ndarray) -> SeamMesh:
        """The SeamMesh of some triangles (n,), numbered in this order. It shares vertices and edges with this one."""
        result, new_number = object.__new__(SeamMesh), np.full(len(self.triangles), -1)
        new_number[selected] = np.arange(len(selected))
        remains = (new_number[self.edge_triangles] >= 0).all(axis=1)
        result.positions, result.edges, result.non_manifold_edges = self.positions, self.edges, self.non_manifold_edges
        result.triangles, result.faces, result.areas = self.triangles[selected], self.faces[selected], self.areas[selected]
        result.interior_edges, result.is_diagonal = self.interior_edges[remains], self.is_diagonal[remains]
        result.cut_cost = self.cut_cost[remains]
        result.edge_triangles = new_number[self.edge_triangles[remains]]
        result.edge_corners = 3 * new_number[self.edge_corners[remains] // 3] + self.edge_corners[remains] % 3
        return result

    @cached_property
    def angles(self) -> Tuple[np.ndarray, np.ndarray]:
        """(angle at each corner (T, 3), its cotangent (T, 3))"""
        corners = self.positions[self.triangles]
        to_next, to_previous = corners[:, [1, 2, 0]] - corners, corners[:, [2, 0, 1]] - corners
        dot = np.einsum("tki,tki->tk", to_next, to_previous)
        cross = np.linalg.norm(np.cross(to_next, to_previous), axis=2)
        return np.arctan2(cross, dot), dot / np.maximum(cross, 1e-300)

    def label_components(self, labels: np.ndarray) -> List[np.ndarray]:
        """The connected components of triangles with one label (T,): of each its triangles (n,)."""
        is_same = labels[self.edge_triangles[:, 0]] == labels[self.edge_triangles[:, 1]]
        number = components(len(labels), self.edge_triangles[is_same])
        order = np.argsort(number, kind="stable")
        return np.split(order, np.flatnonzero(np.diff(number[order])) + 1) if len(order) else []


class Patch:
    """A connected SeamMesh, cut open along edges, but still connected. A vertex of the mesh is several vertices of the
    patch where it is cut open.

    triangles : (T, 3) vertices of the patch
    vertex_count : number of vertices
    is_boundary : (vertex_count,) bool
    uncut : (K,) the interior edges that are not cut, indices into SeamMesh.interior_edges
    uncut_ends : (K, 2) their vertices
    boundary_sides : (n, 2) corners, as 3 * triangle + corner, at both ends of each boundary edge
    """

    def __init__(self, mesh: SeamMesh, is_cut: np.ndarray) -> None:
        """is_cut : (I,) bool, the interior edges that are cut"""
        self.mesh, self.uncut = mesh, np.flatnonzero(~is_cut)
        corners = mesh.edge_corners[self.uncut]
        number = components(3 * len(mesh.triangles), corners.reshape(-1, 2))
        self.triangles, self.vertex_count = number.reshape(-1, 3), int(number.max()) + 1
        self.uncut_ends = number[corners[:, :, 0]]
        is_outer = np.ones(3 * len(mesh.triangles), bool)
        is_outer[np.where(corners[:, 1] == _next_corner(corners[:, 0]), corners[:, 0], corners[:, 1])] = False
        starts = np.flatnonzero(is_outer)
        self.boundary_sides = np.column_stack([starts, _next_corner(starts)])
        self.is_boundary = np.zeros(self.vertex_count, bool)
        self.is_boundary[number[self.boundary_sides]] = True

    def euler_characteristic(self) -> int:
        """Vertices - edges + triangles: 1 for a disk."""
        return self.vertex_count - len(self.uncut) - len(self.boundary_sides) + len(self.mesh.triangles)

    def boundary_loop(self) -> Tuple[np.ndarray, np.ndarray]:
        """(vertices (n,) around a disk in order, length (n,) of the edge from each to the next)"""
        corners = self.mesh.positions[self.mesh.triangles].reshape(-1, 3)[self.boundary_sides]
        lengths = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
        neighbors: Dict[int, List[Tuple[int, int]]] = {}  # vertex -> (side, vertex at its other end)
        for number, ends in enumerate(self.triangles.ravel()[self.boundary_sides].tolist()):
            for one, other in (ends, ends[::-1]):
                neighbors.setdefault(one, []).append((number, other))
        vertex = first = next(iter(neighbors))
        vertices: List[int] = []
        sides: List[int] = []
        side = -1
        while vertex != first or not vertices:
            vertices.append(vertex)
            side, vertex = next(step for step in neighbors[vertex] if step[0] != side)
            sides.append(side)
        return np.array(vertices), lengths[sides]

    def shortest_paths(self, start: Union[np.ndarray, List[int]]) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Shortest paths from the nearest start vertex (n,) along edges that may be cut, by their cost (Bellman-Ford).

        Returns
        -------
        (distance, via, previous), each (vertex_count,): the cost of the path to each vertex, its last edge as an index into
        uncut, and the vertex before that edge. -1 at the start and where there is no path; the distance there is infinite
        """
        usable = np.flatnonzero(~self.mesh.is_diagonal[self.uncut])
        ends, cost = self.uncut_ends[usable], self.mesh.cut_cost[self.uncut[usable]]
        # Directed edges source -> target, sorted by target.
        order = np.argsort(ends.ravel(), kind="stable")
        target, source, number = ends.ravel()[order], ends[:, ::-1].ravel()[order], usable[order // 2]
        cost, first = cost[order // 2], np.flatnonzero(np.diff(target, prepend=-1))
        distance = np.full(self.vertex_count, np.inf)
        distance[start] = 0
        while len(target):
            shorter = np.minimum(np.minimum.reduceat(distance[source] + cost, first), distance[target[first]])
            if (shorter == distance[target[first]]).all():
                break
            distance[target[first]] = shorter
        via, previous = np.full(self.vertex_count, -1), np.full(self.vertex_count, -1)
        last_edges = np.flatnonzero((distance[source] + cost == distance[target]) & np.isfinite(distance[target]))[::-1]
        via[target[last_edges]], previous[target[last_edges]] = number[last_edges], source[last_edges]
        via[start] = previous[start] = -1
        return distance, via, previous


def cut_path(patch: Patch, is_cut: np.ndarray, via: np.ndarray, previous: np.ndarray, vertex: int) -> None:
    """Cut a patch along the shortest path to a vertex.

    Parameters
    ----------
    patch : the patch
    is_cut : (I,) bool, changed in place: set at the edges of the path
    via, previous : see Patch.shortest_paths()
    vertex : the end of the path
    """
    while via[vertex] >= 0:
        is_cut[patch.uncut[via[vertex]]] = True
        vertex = previous[vertex]


def cut_to_disk(mesh: SeamMesh, is_cut: Optional[np.ndarray] = None) -> np.ndarray:
    """Cut a connected mesh so that it becomes a disk, with shortest paths: a tube from end to end, a sphere between two of
    its farthest points, a surface with handles or more holes by a tree-cotree decomposition (Erickson, Har-Peled 2004).

    Parameters
    ----------
    is_cut : (I,) bool, cuts that exist already

    Returns
    -------
    (I,) bool, all cuts
    """
    is_cut = np.zeros(len(mesh.interior_edges), bool) if is_cut is None else is_cut.copy()
    patch = Patch(mesh, is_cut)
    euler_characteristic = patch.euler_characteristic()
    if euler_characteristic == 1:
        return is_cut
    is_closed = not patch.is_boundary.any()
    start = [_farthest_vertex(patch.shortest_paths([0])[0])] if is_closed else np.flatnonzero(patch.is_boundary)
    distance, via, previous = patch.shortest_paths(start)
    if euler_characteristic == 2:
        cut_path(patch, is_cut, via, previous, _farthest_vertex(distance))
        return is_cut
    # The tree: all shortest paths. The cotree: a maximum spanning tree of the triangles across the other edges, by the
    # length of the loop through each edge. The loops through the remaining edges cut the surface to a disk.
    in_tree = np.zeros(len(patch.uncut), bool)
    in_tree[via[via >= 0]] = True
    other_edges = np.flatnonzero(~in_tree)
    loop_cost = distance[patch.uncut_ends[other_edges]].sum(axis=1) + mesh.cut_cost[patch.uncut[other_edges]]
    loop_cost[mesh.is_diagonal[patch.uncut[other_edges]]] = np.inf
    parent = list(range(len(mesh.triangles)))  # union-find

    def find(triangle: int) -> int:
        while parent[triangle] != triangle:
            parent[triangle] = triangle = parent[parent[triangle]]
        return triangle

    loop_edges: List[int] = []
    for number in other_edges[np.argsort(-loop_cost, kind="stable")].tolist():
        one, other = map(find, mesh.edge_triangles[patch.uncut[number]].tolist())
        if one != other:
            parent[max(one, other)] = min(one, other)
        else:
            loop_edges.append(number)

    def cut_loops(numbers: Sequence[int]) -> np.ndarray:
        result = is_cut.copy()
        for number in numbers:
            result[patch.uncut[number]] = True
            for vertex in patch.uncut_ends[number].tolist():
                cut_path(patch, result, via, previous, vertex)
        return result

    if is_closed:  # all loops pass through the start, which is arbitrary: cut one loop, then continue from that
        candidates = [cut_to_disk(mesh, cut_loops([number])) for number in loop_edges[-MAX_TRIED_LOOPS:]]
        return min(candidates, key=lambda candidate: mesh.cut_cost[candidate].sum())
    return cut_loops(loop_edges)


def _farthest_vertex(distance: np.ndarray) -> int:
    return int(np.where(np.isfinite(distance), distance, -1).argmax())


def _next_corner(corner: np.ndarray) -> np.ndarray:
    """The next corner of the same triangle; corners as 3 * triangle + corner."""
    return corner + np.where(corner % 3 == 2, -2, 1)
