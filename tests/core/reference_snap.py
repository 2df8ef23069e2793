# SPDX-License-Identifier: GPL-3.0-or-later
"""How the splits of a tree of parts are moved into creases, in Python, from what native/src/parts/snap/snap.h and
mesh/crease.h say, not from the C++. Ways, pieces and flows are scipy's."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, dijkstra, maximum_flow

REACH = 0.6
MOST_TETRAHEDRA = 12000
LEAST_AREA = 0.01
SMALLEST_HALF = 0.001
SHEET = 0.3
PULL = 0.3
STEPS = 1 << 24
MOST_STEPS = 1 << 36
SAME_DEPTH = 1e-9
FIRST, SECOND, NEITHER = 0, 1, -1


def crease_weight(bend):
    """bend: the sine of half the angle, below 0 where concave."""
    return (1 - abs(bend)) ** (1 if bend >= 0 else 10)


def snapped(*given):
    """(T,) the part of each tetrahedron, see Snapping."""
    return Snapping(*given).run()


class Snapping:
    """facets (F,2): the two tetrahedra of each facet inside; facet_area (F,); folds (F,): the cost of its edges on the
    surface; area (T,), place (T,3): of each tetrahedron; part_of (T,); joined: of which two each join is made; limbs: of each part, the node that it is in and that stays whole, or -1."""

    def __init__(self, facets, facet_area, folds, area, place, part_of, joined, limbs):
        self.limb = limbs[part_of]
        self.facets, self.facet_area, self.folds = facets, facet_area, folds
        self.area, self.place, self.part_of, self.joined = area, place, part_of, joined
        self.count = len(joined) + 1
        self.local = np.empty(len(area), int)  # scratch: the place of a tetrahedron in what is split

    def run(self):
        """(T,) the part of each tetrahedron."""
        parts_in = [np.array([p]) for p in range(self.count)]
        for one, other in self.joined:
            parts_in.append(np.concatenate([parts_in[one], parts_in[other]]))
        result = np.empty(len(self.area), int)
        todo = [(2 * self.count - 2, np.arange(len(self.area)), np.arange(len(self.facets)))]
        while todo:
            number, tets, facets = todo.pop()
            if number < self.count:
                result[tets] = number
                continue
            halves = sorted(self.joined[number - self.count])
            home = np.full(self.count, NEITHER)
            for side, half in enumerate(halves):
                home[parts_in[half]] = side
            self.local[tets] = np.arange(len(tets))
            self.tets, self.within = tets, facets
            self.ends = self.local[self.facets[facets]]
            side = home[self.part_of[tets]]
            areas = np.array([self.area[tets[side == half]].sum() for half in (FIRST, SECOND)]) / self.area.sum()
            for half in (FIRST, SECOND):
                if areas.sum() >= LEAST_AREA and areas[half] < SMALLEST_HALF and (np.ptp(side[self.ends], axis=1) > 0).any():
                    side[side == half] = NEITHER
            side = self.cut(self.gathered(self.settled(side)))
            of_facets = side[self.ends]
            for which, half in enumerate(halves):
                if (side == which).any():
                    todo.append((half, tets[side == which], facets[(of_facets == which).all(axis=1)]))
        return result

    def settled(self, side):
        """Tetrahedra of neither half go where the nearest settled tetrahedron is, by facets crossed; the first half if both are."""
        while (side == NEITHER).any():
            before = side.copy()
            for half in (SECOND, FIRST):
                for one, other in (self.ends.T, self.ends[:, ::-1].T):
                    side[one[(before[one] == NEITHER) & (before[other] == half)]] = half
            if (side == before).all():
                side[side == NEITHER] = FIRST
        return side

    def gathered(self, side):
        """What is apart from its half's largest piece goes over."""
        side = side.copy()
        for half in (FIRST, SECOND):
            mine = np.flatnonzero(side == half)
            if not len(mine):
                continue
            inside = self.ends[(side[self.ends] == half).all(axis=1)]
            piece = connected_components(matrix(inside, np.ones(len(inside)), len(side)), directed=False)[1]
            between = self.ends[side[self.ends[:, 0]] != side[self.ends[:, 1]]].ravel()
            beside = set(piece[between[side[between] == half]].tolist())
            names, lowest, number = np.unique(piece[mine], return_index=True, return_counts=True)
            areas = np.bincount(piece[mine], self.area[self.tets[mine]])[names].astype(np.float32)
            largest = names[np.lexsort([lowest, -number, -areas])[0]]
            side[mine[[p != largest and p in beside for p in piece[mine].tolist()]]] = 1 - half
        return side

    def cut(self, side):
        areas = np.bincount(side, self.area[self.tets], 2)
        reach = REACH * np.sqrt(areas.min())
        if reach == 0 or areas.sum() < LEAST_AREA * self.area.sum():
            return side
        depth, reach = self.depths(side, reach)
        deepest = np.array([depth[side == half].max() for half in (FIRST, SECOND)])
        most = np.minimum(reach, deepest / 2)[side]
        limb = 2 * (self.limb[self.tets] + 1) + side
        for one in np.unique(limb[limb > 1]):
            mine = limb == one
            most[mine] = np.minimum(most[mine], depth[mine].max() / 2)
        free = depth < most * (1 - SAME_DEPTH)
        one, other = self.ends.T
        away = np.where(side[one] != side[other], 0, np.minimum((depth[one] + depth[other]) / 2 / reach, 1))
        plain = SHEET * self.facet_area[self.within] / reach ** 2 + self.folds[self.within] / reach
        cost = 1 + np.floor(np.minimum((1 + PULL * away) * plain * STEPS, MOST_STEPS) + 0.5).astype(np.int64)

        # Nodes: what is free, then the first half's rest, from which the flow comes, and the second's.
        count = free.sum()
        node = np.where(free, np.cumsum(free) - 1, count + side)
        some = free[self.ends].any(axis=1)
        moved = side.copy()
        moved[free] = np.where(reached(node[self.ends[some]], cost[some], count + 2, count, count + 1)[:count], FIRST,
                               SECOND)
        is_small = np.bincount(moved, self.area[self.tets], 2).min() < SMALLEST_HALF * self.area.sum()
        return side if is_small or (self.gathered(moved) != moved).any() else moved

    def depths(self, side, reach):
        """(ways to the split, infinite beyond the reach; the reach, less where too many are within)"""
        one, other = self.ends.T
        apart = np.linalg.norm(self.place[self.tets[one]] - self.place[self.tets[other]], axis=1)
        inside = side[one] == side[other]
        start = np.full(len(side), np.inf)
        for t in (one, other):
            np.minimum.at(start, t[~inside], apart[~inside] / 2)
        first = np.flatnonzero(start < np.inf)
        origin = np.full(len(first), len(side))  # one more node, to which those at the split are as far as to the split
        ways = matrix(np.concatenate([self.ends[inside], np.stack([origin, first], axis=1)]),
                      np.concatenate([apart[inside], start[first]]), len(side) + 1)
        depth = dijkstra(ways, directed=False, indices=len(side), limit=reach)[:-1]
        if (depth < np.inf).sum() > MOST_TETRAHEDRA:
            reach = np.sort(depth)[MOST_TETRAHEDRA]
            depth[depth > reach] = np.inf
        return depth, reach


def matrix(ends, values, count):
    return coo_array((values, (ends[:, 0], ends[:, 1])), shape=(count, count)).tocsr()


def reached(edges, cost, count, source, sink):
    """(count,) the smallest side of the source among the cuts that cost least."""
    left = matrix(np.concatenate([edges, edges[:, ::-1]]), np.concatenate([cost, cost]), count)
    # scipy's flows have 32 bits: first in steps of 4096, then what this leaves, which is less than a step an edge.
    for step, most in (1 << 12, 1 << 29), (1, (len(edges) + 1) << 12):
        assert most < 1 << 30
        units = left.astype(np.int32)
        units.data[:] = np.minimum(left.data // step, most)
        flow = maximum_flow(units, source, sink)
        assert flow.flow_value < most
        left = left - flow.flow.astype(np.int64) * step
    left.eliminate_zeros()
    mask = np.zeros(count, bool)
    mask[breadth_first_order(left, source, return_predecessors=False)] = True
    return mask
