# SPDX-License-Identifier: GPL-3.0-or-later
"""What merge_parts() computes, in Python, from the formulas in native/src/parts/merge/merge_policy.h and feature_names.h, not from
the C++: parts, folds, borders, measures, both networks, the order of joining, scores. Splits are snapped in reference_snap.py. Hulls are scipy's."""

import heapq
from dataclasses import dataclass, field

import numpy as np
from reference_snap import crease_weight, snapped
from merge_network import NODE_NAMES, PAIR_NAMES, network_weights
from scipy.spatial import ConvexHull

MOST_PARTS = 600
LIMB = 0.8  # the least score
LARGEST_COST = 8.0
CONCAVE_BEND = -0.02
SHARP_BEND = 0.2
MIDDLING_CURVATURE = 4.0
SMOOTHING, WIDE_SMOOTHING = 4, 24
CONVEX = 1e-6  # of the hull's volume, see cluster.h


class Network:
    """One hidden layer of softsigns."""

    def __init__(self, name, inputs):
        numbers = network_weights(name)
        rows = numbers[:-1].reshape(-1, inputs + 2)
        self.bias, self.weights, self.out, self.constant = rows[:, 0], rows[:, 1:-1], rows[:, -1], numbers[-1]

    def __call__(self, inputs):
        return softsign(self.weights @ inputs + self.bias) @ self.out + self.constant


def softsign(z):
    return z / (1 + np.abs(z))


def log(x):
    return min(max(np.log2(x), -20.0), 20.0) if x > 0 else -20.0


def within(x, low, high):
    return min(max(x, low), high)


def quotient(part, whole):
    return part / whole if whole > 0 else 0.0


def share(part, whole):
    return within(quotient(part, whole), 0.0, 1.0)


@dataclass
class Part:
    volume: float
    area: float
    hull: float
    corners: np.ndarray  # of the hull
    low: int  # the lowest tetrahedron
    tetrahedra: list  # arrays of them
    own_cost: float = -LARGEST_COST
    max_cost: float = -LARGEST_COST
    pairs: list = field(default_factory=list)
    rim: np.ndarray = None

    @property
    def gap(self):
        return within(1 - self.volume / self.hull, 0.0, 1.0) if self.hull > 0 else 0.0

    @property
    def dents(self):
        return max(0.0, self.hull - self.volume)

    @property
    def thick(self):
        return log(self.volume) - log(self.area)


INTERFACE, LENGTH, CREASE, SHARPNESS, CONCAVE, RIDGE, VALLEY, CURVATURE, WIDE = range(9)  # of a border
FOLDS = {"crease": CREASE, "curvature": CURVATURE, "sharpness": SHARPNESS, "ridge": RIDGE, "valley": VALLEY,
         "wide_curvature": WIDE}


@dataclass
class Pair:
    a: int
    b: int
    border: np.ndarray
    hull: float = 0.0  # the largest known
    cost: float = -np.inf
    guessed: bool = True
    alive: bool = True


class MergedParts:
    """The parts of a mesh without mirror planes joined: parts, first those of the tree given (mode PAPER's) with their
    borders snapped, then the joined ones; joined, of which two each of these was made; scores, of each part and joined
    part."""

    def __init__(self, vertices, tetrahedra, merges, components):
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        self.points = (vertices - low) / (high - low).max()
        self.tetrahedra = tetrahedra
        self.tets = len(tetrahedra)
        self.pair_cost = Network("pair_network", len(PAIR_NAMES))
        self.node_score = Network("node_network", len(NODE_NAMES))
        corners = self.points[tetrahedra]
        self.volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
        assert (self.volumes > -1e-15).all()
        self.find_surface()
        self.measure(self.choose_parts(merges, components))
        self.join_neighbours()
        self.join_components(merges, components)
        self.snap()
        self.score()

    def hull(self, vertices):
        """(volume, corners) of the convex hull of these vertices."""
        vertices = np.unique(vertices)
        if len(vertices) == 4:
            a, b, c, d = self.points[vertices]
            return abs(np.dot(np.cross(b - a, c - a), d - a)) / 6, vertices
        hull = ConvexHull(self.points[vertices])
        return hull.volume, vertices[hull.vertices]

    # ---- The surface

    def find_surface(self):
        """The facets between tetrahedra, (tetrahedron, tetrahedron, area); the outer triangles, outward."""
        corner = np.array([(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)])  # outward where the volume is positive
        triangles = self.tetrahedra[:, corner].reshape(-1, 3)
        owner = np.repeat(np.arange(self.tets), 4)
        key = np.sort(triangles, axis=1)
        order = np.lexsort(key.T)
        same = (key[order[1:]] == key[order[:-1]]).all(axis=1)
        shared = np.flatnonzero(same)
        one, other = order[shared], order[shared + 1]
        a, b, c = (self.points[triangles[:, i]] for i in range(3))
        across = np.cross(b - a, c - a)
        length = np.linalg.norm(across, axis=1)
        self.facets = np.stack([owner[one], owner[other]], axis=1)
        self.facet_corners, self.facet_area = triangles[one], length[one] / 2
        outer = np.ones(len(triangles), bool)
        outer[one] = outer[other] = False
        self.outer, self.outer_tet = triangles[outer], owner[outer]
        self.outer_area = length[outer] / 2
        self.normals = across[outer] / length[outer][:, None]

    def folds(self):
        """(vertex, vertex, triangle, triangle, length, bend)"""
        at = {}
        for t, triangle in enumerate(self.outer.tolist()):
            for v, w in zip(triangle, triangle[1:] + triangle[:1]):
                at.setdefault((v, w), []).append(t)
        for (v, w), (t,) in at.items():
            if v > w:
                continue
            (s,) = at[w, v]
            along = self.points[w] - self.points[v]
            # Convex: going along an edge of t, the other triangle's normal has turned to the right-handed side.
            turn = np.dot(np.cross(self.normals[t], self.normals[s]), along)
            half = np.linalg.norm(self.normals[t] - self.normals[s]) / 2
            yield v, w, t, s, np.linalg.norm(along), half if turn >= 0 else -half

    # ---- Parts

    def choose_parts(self, merges, components):
        """(T,) the part of each tetrahedron."""
        below = [np.array([t]) for t in range(self.tets)]
        area = list(np.bincount(self.outer_tet, self.outer_area, self.tets))
        for left, right in merges.tolist():
            below.append(np.concatenate([below[left], below[right]]))
            area.append(area[left] + area[right])
        chosen, queue = [], []

        def offer(cluster):
            if cluster >= self.tets:
                hull = self.hull(self.tetrahedra[below[cluster]])[0]
                concavity = hull - self.volumes[below[cluster]].sum()
                if concavity > CONVEX * hull and area[cluster] > 0:
                    heapq.heappush(queue, (-np.float32(concavity / hull * area[cluster]), cluster))
                    return
            chosen.append(cluster)

        last = len(merges) - (components - 1)
        inside = set(merges[:last].ravel().tolist())
        for cluster in range(self.tets + last):
            if cluster not in inside:
                offer(cluster)
        while queue and len(queue) + len(chosen) < MOST_PARTS:
            _, cluster = heapq.heappop(queue)
            for half in merges[cluster - self.tets].tolist():
                offer(half)
        part_of = np.empty(self.tets, int)
        for p, cluster in enumerate(sorted(chosen + [cluster for _, cluster in queue])):
            part_of[below[cluster]] = p
        return part_of

    def measure(self, part_of):
        """Nothing is joined yet."""
        self.fine, self.part_of, self.joined, self.queue = part_of.max() + 1, part_of, [], []
        area = np.bincount(self.outer_tet, self.outer_area, self.tets)
        self.parts = []
        for p in range(self.fine):
            mine = np.flatnonzero(part_of == p)
            self.parts.append(Part(self.volumes[mine].sum(), area[mine].sum(), *self.hull(self.tetrahedra[mine]),
                                   int(mine[0]), [mine]))
        self.volume = sum(part.volume for part in self.parts)
        self.area = sum(part.area for part in self.parts)
        self.whole_hull = self.hull(self.tetrahedra)[0]
        self.find_borders()

    def find_borders(self):
        folds = list(self.folds())
        bent, around = np.zeros(len(self.points)), np.zeros(len(self.points))
        for v, w, _, _, length, bend in folds:
            bent[v] += length * bend / 2
            bent[w] += length * bend / 2
        np.add.at(around, self.outer.ravel(), np.repeat(self.outer_area / 3, 3))
        ends = np.array([fold[:2] for fold in folds])
        curvatures = []
        for done in range(1, WIDE_SMOOTHING + 1):
            for sums in (bent, around):
                before = sums.copy()
                np.add.at(sums, ends[:, 0], before[ends[:, 1]])
                np.add.at(sums, ends[:, 1], before[ends[:, 0]])
            if done in (SMOOTHING, WIDE_SMOOTHING):
                h = np.where(around > 0, bent / np.where(around > 0, around, 1), 0) * np.sqrt(self.area)
                curvatures.append(h)

        borders = {}
        for (p, q), size in zip(np.sort(self.part_of[self.facets], axis=1).tolist(), self.facet_area):
            if p != q:
                borders.setdefault((p, q), np.zeros(9))[INTERFACE] += size
        for v, w, t, s, length, bend in folds:
            border = borders.get(tuple(sorted((self.part_of[self.outer_tet[t]], self.part_of[self.outer_tet[s]]))))
            if border is None:
                continue
            means = [(h[v] + h[w]) / 2 for h in curvatures]
            squashed = [mean / (MIDDLING_CURVATURE + abs(mean)) for mean in means]
            border += length * np.array((0, 1, bend, abs(bend), bend < CONCAVE_BEND, bend > SHARP_BEND, bend < -SHARP_BEND,
                                         *squashed))
        self.pairs = [Pair(int(a), int(b), borders[a, b]) for a, b in sorted(borders)]
        for number, pair in enumerate(self.pairs):
            for p in (pair.a, pair.b):
                self.parts[p].pairs.append(number)
        for part in self.parts:
            self.add_up_rim(part)

    def add_up_rim(self, part):
        part.rim = sum((self.pairs[number].border for number in part.pairs), np.zeros(9))

    # ---- Joining

    def pair_measures(self, pair, hull):
        """In the order of PAIR_NAMES."""
        one, other = self.parts[pair.a], self.parts[pair.b]
        s, l = sorted((one, other), key=lambda part: (np.float32(part.area), part.low))
        border, volume, area = pair.border, s.volume + l.volume, s.area + l.area
        excess = max(0.0, hull - volume - s.dents - l.dents)
        gap = within(1 - volume / hull, 0.0, 1.0) if hull > 0 else 0.0
        face, length = log(border[INTERFACE]), log(border[LENGTH])
        size = log(self.volume) / 3
        measures = dict(
            area_s=log(s.area) - log(self.area), area_both=log(area) - log(self.area),
            volume_s=log(s.volume) - log(self.volume), volume_both=log(volume) - log(self.volume),
            defect_both=gap, defect_s=s.gap, defect_l=l.gap,
            excess_to_s=log(1e-4 + quotient(excess, s.hull)), excess_to_all=log(1e-8 + excess / self.whole_hull),
            interface_to_volume_s=within(face - 2 / 3 * log(s.volume), -8, 4),
            interface_to_area_s=within(face - log(s.area), -8, 4),
            length_to_area_s=within(length - log(s.area) / 2, -8, 4),
            length_share_s=share(border[LENGTH], s.rim[LENGTH]), length_share_l=share(border[LENGTH], l.rim[LENGTH]),
            interface_share_s=share(border[INTERFACE], s.rim[INTERFACE]),
            interface_share_l=share(border[INTERFACE], l.rim[INTERFACE]),
            thickness_step=within(s.thick - l.thick, -6, 6),
            section_to_thickness_s=within(face - length - s.thick, -8, 4),
            section_to_thickness_l=within(face - length - l.thick, -8, 4), concave=share(border[CONCAVE], border[LENGTH]),
            **{name: quotient(border[at], border[LENGTH]) for name, at in FOLDS.items()},
            isoperimetric_ratio=within(2 * length - face, -4, 8),
            interface_to_volume_l=within(face - 2 / 3 * log(l.volume), -10, 4),
            defect_added=gap - max(s.gap, l.gap), area_step=log(l.area) - log(s.area),
            thickness_s=within(s.thick - size, -8, 2), thickness_l=within(l.thick - size, -8, 2))
        return np.array([measures[name] for name in PAIR_NAMES])

    def cost(self, measures):
        return float(np.float32(self.pair_cost(measures)))

    def hull_of_both(self, pair):
        return self.hull(np.concatenate([self.parts[pair.a].corners, self.parts[pair.b].corners]))[0]

    def enter(self, number):
        pair = self.pairs[number]
        a, b = self.parts[pair.a], self.parts[pair.b]
        if a.area == 0 or b.area == 0:
            pair.cost, pair.guessed = -1e6 - pair.border[INTERFACE] / self.area, False
        else:
            least = self.pair_measures(pair, max(pair.hull, a.hull + b.hull))
            pair.cost, pair.guessed = max(pair.cost, self.cost(least)), True
        heapq.heappush(self.queue, (pair.cost, number))

    def join_neighbours(self):
        for number in range(len(self.pairs)):
            self.enter(number)
        while self.queue:
            cost, number = heapq.heappop(self.queue)
            pair = self.pairs[number]
            if not pair.alive or pair.cost != cost:
                continue
            if not pair.guessed:
                self.join(pair.a, pair.b, cost)
                for grown in self.parts[-1].pairs:
                    self.enter(grown)
                continue
            pair.hull = self.hull_of_both(pair)
            pair.cost, pair.guessed = self.cost(self.pair_measures(pair, pair.hull)), False
            heapq.heappush(self.queue, (pair.cost, number))

    def join(self, a, b, cost):
        one, other, both = self.parts[a], self.parts[b], len(self.parts)
        own = within(cost, -LARGEST_COST, LARGEST_COST)
        union = Part(one.volume + other.volume, one.area + other.area,
                     *self.hull(np.concatenate([one.corners, other.corners])), min(one.low, other.low),
                     one.tetrahedra + other.tetrahedra, own, max(own, one.max_cost, other.max_cost))
        self.parts.append(union)
        self.joined.append((a, b))
        kept = {}
        for old in (a, b):
            for number in self.parts[old].pairs:
                pair = self.pairs[number]
                if not pair.alive:
                    continue
                third = pair.b if pair.a == old else pair.a
                if third in (a, b):
                    pair.alive = False
                elif third not in kept:
                    kept[third] = number
                    pair.a, pair.b = third, both
                else:
                    first = self.pairs[kept[third]]
                    first.border = first.border + pair.border
                    first.hull, first.cost = max(first.hull, pair.hull), min(first.cost, pair.cost)
                    pair.alive = False
        union.pairs = list(kept.values())
        self.add_up_rim(union)

    def join_components(self, merges, components):
        last = len(merges) - (components - 1)
        lowest = list(range(self.tets))
        whole = {part.low: p for p, part in enumerate(self.parts)}  # a later part has taken in the earlier
        for m, (left, right) in enumerate(merges.tolist()):
            one, other = lowest[left], lowest[right]
            lowest.append(min(one, other))
            if m >= last:
                self.join(whole[one], whole[other], LARGEST_COST)
                whole[min(one, other)] = len(self.parts) - 1

    # ---- Snapping

    def snap(self):
        """The parts with their borders in creases, joined as before; those that lost everything are gone."""
        joined, costs = self.joined, [part.own_cost for part in self.parts[self.fine:]]
        part_of = snapped(*self.sheets(), self.part_of, joined, self.limbs())
        left, part_of = np.unique(part_of, return_inverse=True)
        now = dict(zip(left.tolist(), range(len(left))))
        fine = self.fine
        self.measure(part_of)
        for j, ((a, b), cost) in enumerate(zip(joined, costs)):
            if a in now and b in now:
                now[fine + j] = len(self.parts)
                self.join(now[a], now[b], cost)
            elif a in now or b in now:
                now[fine + j] = now[a] if a in now else now[b]

    def limbs(self):
        """(fine,) the node of the best cut that contains each part, if it scores LIMB or more; else -1."""
        self.score()
        best = [part.area * score for part, score in zip(self.parts, self.scores)]
        limb = [n if score >= LIMB else -1 for n, score in enumerate(self.scores)]
        for j, (a, b) in enumerate(self.joined, self.fine):
            if best[a] + best[b] > best[j]:
                best[j], limb[j] = best[a] + best[b], None
        for j in range(len(self.parts) - 1, self.fine - 1, -1):
            for half in self.joined[j - self.fine]:
                limb[half] = limb[half] if limb[j] is None else limb[j]
        return np.array(limb[:self.fine])

    def sheets(self):
        """What sheets cost: facets, their areas and folds; areas and places of tetrahedra."""
        at_edge = {(v, w): length * crease_weight(bend) for v, w, _, _, length, bend in self.folds()}
        folds = np.zeros(len(self.facets))
        for i in range(3):
            edges = np.sort(self.facet_corners[:, [i, (i + 1) % 3]], axis=1).tolist()
            folds += [at_edge.get((v, w), 0) for v, w in edges]
        outer = np.bincount(self.outer_tet, minlength=self.tets)
        place = self.points[self.tetrahedra].mean(axis=1)
        on_surface = np.zeros_like(place)
        np.add.at(on_surface, self.outer_tet, self.points[self.outer].mean(axis=1))
        place[outer > 0] = on_surface[outer > 0] / outer[outer > 0, None]
        area = np.bincount(self.outer_tet, self.outer_area, self.tets)
        return self.facets, self.facet_area, folds, area, place

    # ---- Scores

    def own_measures(self, part):
        face, length, rim = log(part.rim[INTERFACE]), log(part.rim[LENGTH]), part.rim
        return dict(
            area=log(part.area) - log(self.area), volume=log(part.volume) - log(self.volume), defect=part.gap,
            length_to_area=within(length - log(part.area) / 2, -8, 4),
            interface_to_volume=within(face - 2 / 3 * log(part.volume), -8, 4), concave=quotient(rim[CONCAVE], rim[LENGTH]),
            **{name: quotient(rim[at], rim[LENGTH]) for name, at in FOLDS.items()},
            interface_to_area=within(face - log(part.area), -8, 4), own_cost=part.own_cost, max_cost=part.max_cost,
            thickness=within(part.thick - log(self.volume) / 3, -8, 2),
            isoperimetric_ratio=within(2 * length - face, -4, 8),
            section_to_thickness=within(face - length - part.thick, -8, 4),
            concavity=log(1e-6 + part.dents / self.whole_hull))

    def score(self):
        parent, sibling = {}, {}
        for j, (a, b) in enumerate(self.joined):
            parent[a] = parent[b] = self.fine + j
            sibling[a], sibling[b] = b, a
        own = [self.own_measures(part) for part in self.parts]
        rejected = [[] for _ in self.parts]  # costs of the merges within each that the network rejects
        for j, (a, b) in enumerate(self.joined, self.fine):
            rejected[j] = rejected[a] + rejected[b] + [cost for cost in [own[j]["own_cost"]] if 0 < cost < LARGEST_COST]
        whole_gap = 1 - self.volume / self.whole_hull
        self.scores = []
        for n in range(len(self.parts)):
            ancestors, up = [], parent.get(n)
            while up is not None:
                ancestors.append(own[up]["own_cost"])
                up = parent.get(up)
            root = n not in parent
            mine, above, beside = own[n], own[parent.get(n, n)], own[sibling.get(n, n)]
            parent_cost = LARGEST_COST if root else above["own_cost"]
            halves = [own[half] for half in self.joined[n - self.fine]] if n >= self.fine else []

            def parts_after(node):  # how many there are once it has been made
                return self.fine - max(0, node - self.fine + 1)

            measures = dict(
                mine, parent_cost=parent_cost, cost_step=parent_cost - mine["own_cost"],
                sibling_area=beside["area"] - mine["area"], parent_area=above["area"] - mine["area"],
                sibling_defect=beside["defect"], sibling_thickness=beside["thickness"], sibling_crease=beside["crease"],
                sibling_length=beside["length_to_area"], sibling_cost=beside["own_cost"],
                sibling_max_cost=beside["max_cost"], sibling_rejected_merges=log(1 + len(rejected[sibling.get(n, n)])),
                parent_defect=above["defect"],
                parent_crease=above["crease"], parent_concave=above["concave"], parent_curvature=above["curvature"],
                is_root=float(root), defect_step=above["defect"] - mine["defect"], parts_after_merge=log(parts_after(n)),
                parts_before_parent=0.0 if root else log(parts_after(parent[n]) + 1),
                min_ancestor_cost=min([LARGEST_COST, *ancestors]),
                max_ancestor_cost=LARGEST_COST if root else max([-LARGEST_COST, *ancestors]),
                sibling_volume=abs(beside["volume"] - mine["volume"]),
                max_child_cost=max([half["own_cost"] for half in halves], default=-LARGEST_COST),
                max_child_defect=max([half["defect"] for half in halves], default=0.0),
                min_child_area=min([half["area"] for half in halves], default=mine["area"]) - mine["area"],
                rejected_merges=log(1 + len(rejected[n])), whole_rejected_merges=log(1 + len(rejected[-1])),
                whole_defect=within(whole_gap, 0.0, 1.0),
                whole_thickness=within(2 / 3 * log(self.volume) - log(self.area), -8, 2))
            z = self.node_score(np.array([measures[name] for name in NODE_NAMES]))
            self.scores.append((1 + softsign(z)) / 2)

