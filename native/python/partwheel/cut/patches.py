# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface as a sheet that is cut open along some of its edges: a connected one into a patch that is a disk."""

from functools import cached_property

import numpy as np

from ..components import components

CREASE, HIDDEN = 4.0, 2.0  # how much less a cut costs along an edge at a right angle; in a hollow so much less again
DIGITS = 9  # of costs, after the point: beyond them processors differ
RINGS = 4  # so many of the shortest are tried, where a surface without a border is cut open first
SHORTEST = 1e-6  # an edge counts as so long at least, in means: ways that cost nothing lead in circles


class Sheet:
    """A surface's triangles, and the edges at which two of them meet.

    places (V,3); triangles (T,3); faces (T,) the polygon of each; areas (T,). ends (E,2) of all edges, ends[:, 0] <
    ends[:, 1]; crowded (n,) the numbers of those with more than two triangles. Of those with two: edge (P,) its number,
    pair (P,2) the triangles, corners (P,2,2) of one end and of the other in both of them, as 3 * triangle + corner;
    inner (P,) bool: within a polygon, which is not to be cut; cost (P,) of a cut there: the length, less at creases.
    """

    def __init__(self, vertices, triangles, faces):
        self.places, self.triangles = np.asarray(vertices, np.float64), np.asarray(triangles)
        self.faces = np.asarray(faces)
        sides = self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        self.ends, of = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
        order = np.argsort(of.ravel(), kind="stable")
        first = np.searchsorted(of.ravel()[order], np.arange(len(self.ends)))
        count = np.diff(np.append(first, len(order)))
        self.edge, self.crowded = np.flatnonzero(count == 2), np.flatnonzero(count > 2)
        side = order[first[self.edge][:, None] + [0, 1]]
        self.pair = side // 3
        corners = np.stack([side, _next(side)], axis=1)
        backwards = sides[side, 0] > sides[side, 1]
        self.corners = np.where(backwards[:, None], corners[:, ::-1], corners)
        self.inner = self.faces[self.pair[:, 0]] == self.faces[self.pair[:, 1]]
        a, b, c = self.places[self.triangles].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        double = np.linalg.norm(normal, axis=1)
        self.areas = double / 2
        self.cost = self._costs(normal / np.maximum(double, 1e-300)[:, None], (a + b + c) / 3)

    def _costs(self, normals, middles):
        one, other = self.pair.T
        start, end = self.places[self.ends[self.edge]].transpose(1, 0, 2)
        sharp = np.sqrt(np.maximum(1 - np.einsum("ij,ij->i", normals[one], normals[other]), 0))  # 1 at a right angle
        hollow = np.einsum("ij,ij->i", normals[one], middles[other] - start) > 0
        length = np.linalg.norm(end - start, axis=1)
        unit = 2.0 ** np.floor(np.log2(max(length.mean(), 1e-300))) if len(length) else 1.0
        cost = np.maximum(length / unit, SHORTEST) / (1 + CREASE * sharp * np.where(hollow, HIDDEN, 1))
        return np.round(cost, DIGITS) * unit

    def part(self, chosen):
        """The Sheet of some triangles (n,), numbered in this order; edges keep their numbers."""
        part, number = object.__new__(Sheet), np.full(len(self.triangles), -1)
        number[chosen] = np.arange(len(chosen))
        kept = (number[self.pair] >= 0).all(axis=1)
        part.places, part.ends, part.crowded = self.places, self.ends, self.crowded
        part.triangles, part.faces, part.areas = self.triangles[chosen], self.faces[chosen], self.areas[chosen]
        part.edge, part.inner, part.cost = self.edge[kept], self.inner[kept], self.cost[kept]
        part.pair = number[self.pair[kept]]
        part.corners = 3 * number[self.corners[kept] // 3] + self.corners[kept] % 3
        return part

    @cached_property
    def angles(self):
        """((T,3) the angle at each corner, (T,3) its cotangent)"""
        corners = self.places[self.triangles]
        on, back = corners[:, [1, 2, 0]] - corners, corners[:, [2, 0, 1]] - corners
        dot, cross = np.einsum("tki,tki->tk", on, back), np.linalg.norm(np.cross(on, back), axis=2)
        return np.arctan2(cross, dot), dot / np.maximum(cross, 1e-300)

    def pieces(self, labels):
        """[(n,) triangles, ...] that hang together and have one label (T,)."""
        number = components(len(labels), self.pair[labels[self.pair[:, 0]] == labels[self.pair[:, 1]]])
        order = np.argsort(number, kind="stable")
        return np.split(order, np.flatnonzero(np.diff(number[order])) + 1) if len(order) else []


class Patch:
    """A connected Sheet, cut open at some edges but still in one piece.

    vertex (T,3) its triangles' vertices, count of them: those of the sheet are several where it is cut open. rim (count,)
    bool: at the border. kept (K,) the pairs that are not cut, joined (K,2) the vertices at their ends."""

    def __init__(self, sheet, cut):
        self.sheet, self.kept = sheet, np.flatnonzero(~cut)
        corners = sheet.corners[self.kept]
        number = components(3 * len(sheet.triangles), corners.reshape(-1, 2))
        self.vertex, self.count = number.reshape(-1, 3), int(number.max()) + 1
        self.joined = number[corners[:, :, 0]]
        outer = np.ones(3 * len(sheet.triangles), bool)
        outer[np.where(corners[:, 1] == _next(corners[:, 0]), corners[:, 0], corners[:, 1])] = False
        sides = np.flatnonzero(outer)
        self.sides = np.column_stack([sides, _next(sides)])  # at the rim
        self.rim = np.zeros(self.count, bool)
        self.rim[number[self.sides]] = True

    def euler(self):
        """The Euler characteristic: 1 of a disk."""
        return self.count - len(self.kept) - len(self.sides) + len(self.sheet.triangles)

    def outline(self):
        """((n,) the vertices around a disk, in order, (n,) how far it is from each to the next)"""
        corners = self.sheet.places[self.sheet.triangles].reshape(-1, 3)[self.sides]
        lengths = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
        beside = {}
        for number, ends in enumerate(self.vertex.ravel()[self.sides].tolist()):
            for one, other in (ends, ends[::-1]):
                beside.setdefault(one, []).append((number, other))
        vertex = first = next(iter(beside))
        around, by, side = [], [], -1
        while vertex != first or not around:
            around.append(vertex)
            side, vertex = next(way for way in beside[vertex] if way[0] != side)
            by.append(side)
        return np.array(around), lengths[by]

    def ways(self, start):
        """(distance, by, before), (count,) each: how far a vertex is from start (n,), the kept pair by which the way of
        least cost comes there, and from which vertex; -1 at the start itself and where no way leads."""
        usable = np.flatnonzero(~self.sheet.inner[self.kept])
        ends, cost = self.joined[usable], self.sheet.cost[self.kept[usable]]
        order = np.argsort(ends.ravel(), kind="stable")
        to, before, number = ends.ravel()[order], ends[:, ::-1].ravel()[order], usable[order // 2]
        cost, first = cost[order // 2], np.flatnonzero(np.diff(to, prepend=-1))
        distance = np.full(self.count, np.inf)
        distance[start] = 0
        while len(to):
            found = np.minimum(np.minimum.reduceat(distance[before] + cost, first), distance[to[first]])
            if (found == distance[to[first]]).all():
                break
            distance[to[first]] = found
        by, source = np.full(self.count, -1), np.full(self.count, -1)
        last = np.flatnonzero((distance[before] + cost == distance[to]) & np.isfinite(distance[to]))[::-1]
        by[to[last]], source[to[last]] = number[last], before[last]
        by[start] = source[start] = -1
        return distance, by, source


def cut_back(patch, cut, by, before, vertex):
    """Cuts (P,) along the way that came to a vertex."""
    while by[vertex] >= 0:
        cut[patch.kept[by[vertex]]] = True
        vertex = before[vertex]


def opened(sheet, cut=None):
    """cut (P,) bool that makes a connected Sheet, that has these cuts, a disk: a tube along a way from one end to the
    other, a sphere from one of its farthest points to the other, a handle around and along."""
    cut = np.zeros(len(sheet.edge), bool) if cut is None else cut.copy()
    patch = Patch(sheet, cut)
    euler = patch.euler()
    if euler == 1:
        return cut
    closed = not patch.rim.any()
    start = [_farthest(patch.ways([0])[0])] if closed else np.flatnonzero(patch.rim)
    distance, by, before = patch.ways(start)
    if euler == 2:
        cut_back(patch, cut, by, before, _farthest(distance))
        return cut
    # The shortest ways to the start make a tree. Across the other edges triangles are left together, as long as that
    # closes no ring, the edges first that the longest ways lead through. What then remains are the shortest ways, one
    # edge each and back to the start from both its ends, that together leave a disk.
    used = np.zeros(len(patch.kept), bool)
    used[by[by >= 0]] = True
    others = np.flatnonzero(~used)
    through = distance[patch.joined[others]].sum(axis=1) + sheet.cost[patch.kept[others]]
    through[sheet.inner[patch.kept[others]]] = np.inf
    group = list(range(len(sheet.triangles)))

    def find(triangle):
        while group[triangle] != triangle:
            group[triangle] = triangle = group[group[triangle]]
        return triangle

    needed = []
    for number in others[np.argsort(-through, kind="stable")].tolist():
        one, other = map(find, sheet.pair[patch.kept[number]].tolist())
        if one != other:
            group[max(one, other)] = min(one, other)
        else:
            needed.append(number)

    def through_all(numbers):
        new = cut.copy()
        for number in numbers:
            new[patch.kept[number]] = True
            for vertex in patch.joined[number].tolist():
                cut_back(patch, new, by, before, vertex)
        return new

    if closed:  # all lead through one point: better from one of the rings on
        rings = [opened(sheet, through_all([number])) for number in needed[-RINGS:]]
        return min(rings, key=lambda each: sheet.cost[each].sum())
    return through_all(needed)


def _farthest(distance):
    return int(np.where(np.isfinite(distance), distance, -1).argmax())


def _next(corner):
    """The next one of the same triangle."""
    return corner + np.where(corner % 3 == 2, -2, 1)
