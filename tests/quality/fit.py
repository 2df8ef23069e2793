# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits the numbers of native/src/parts/merge/network_weights.h to segmentations made by people, and says how well they do where
they were not fitted. `scripts/fit` runs it, with all that it needs.

usage: fit.py MESH_DIR SEG_DIR WORK_DIR [--score DIR --assets DIR --fused DIR [--share S F] [--node-share S F]] [--trees DIR] [--trace PROGRAM]
              [--rounds 4] [--folds 4] [--seeds 3] [--every 1] [--jobs N] [--without GROUP] [--write]

MESH_DIR/<id>.off, SEG_DIR/<id>/*.seg: of the Princeton Segmentation Benchmark, 20 ids a category. DIR/<id>.hierarchy:
the paper's trees; without --trees they are built first, into WORK_DIR. PROGRAM: quality_trace, built by `scripts/build
release quality_trace`.

The pair cost has two losses: the cross entropy with the probability that two random faces, one of each part, are in one
part of a person's segmentation; and a choice loss, so that the cheapest pair of a part most likely
belongs together. Which pairs occur depends on the cost itself, so there are rounds: the first one with a cost
by concavity and size alone, each later one fitted to the pairs of the last three rounds. The node score is fitted to the
nodes of the last three rounds (other trees are more data), with two losses as well: the cross entropy with the expected
overlap (intersection over union) with the segment of a click in the node, each segment clicked equally often; and a choice
loss, so that the best node of a click has the largest overlap. See choice_gradient() for both choice losses.

The result is the mean of several networks from different starts. Rounds before the last one use one network, because trees
that differ more are better data.

Artists' models (assets.py) are scored beside the benchmark, in the same table. With --share the pair cost is fitted to them, too: the weight
of a surface as it is and of a fused one, relative to a model of the benchmark. With --node-share the node score is fitted to them, too:
S and F are the shares of the epochs that use such models.

All is cross-validated: the categories, and the packs of assets, are dealt into folds, and the figures of a category or pack come from
networks that were fitted without it. A fit begins with random weights, and trees are greedy: the same fit from another seed changes `best` by
0.004 and 1-RI(K) by 0.008. So there are several seeds, and the figures are their means; smaller differences mean nothing.
Also printed are the scores, on all models, of the current network_weights.h and of networks fitted to all of them. --write
writes, of the latter, those with the largest sum of `best` and `click`.

--seeds 0 only scores the current network_weights.h, which was fitted to all of the benchmark. --folds 0 fits to all models
at once, and scores those.
--rounds 0 keeps the library's pair cost and fits the score only. --every takes only each Nth model of a category or pack.
--without: an ablation, the features of one group (GROUPS) are left out. One seed takes about four minutes on two idle cores,
without the trees.
"""

import argparse
import os
import subprocess
import sys
import zlib
from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # one process a core, and sums in one order
import numpy as np  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "core")]

from partwheel import Hierarchy, Mode, PartwheelError, meshes  # noqa: E402  (found only now)
from assets import read_assets  # noqa: E402
from merge_network import NODE_NAMES, PAIR_NAMES, SOURCE, network_weights  # noqa: E402

HEADER = SOURCE / "network_weights.h"
# parts: overlap of the union of the initial parts that lie mostly in a target; tree: of the best node of the click's path. These are
# ceilings. best: of the best stop. any: at the click with the best of the targets that contain it.
HEAD = " parts   tree   best  click within2 stops notch    any  RI(K) RI(auto)"
BEST, CLICK = 2, 3  # columns
NETWORKS, PAIR_UNITS, NODE_UNITS = 4, 16, 12  # networks that are averaged; hidden units of each
DIGITS = 4
PAIRS_PER_MODEL = 1200  # pairs sampled from a model
ROUNDS_USED = 3  # rounds whose data the fit of the next one uses
PART_PENALTY = 0.005  # as in likeliest_cut()
MAX_STOP_OVERLAP = 0.85  # as in wheel_stops()
CLICKS_PER_MODEL, MAX_PATH_LENGTH = 64, 64
CLICK_TEMPERATURE, CLICK_LOSS_WEIGHT = 0.04, 2  # see choice_gradient(); weight relative to the cross entropy
PARTS_PER_MODEL, MAX_PAIRS_PER_PART, PARTS_PER_STEP = 400, 12, 512
MERGE_TEMPERATURE, MERGE_LOSS_WEIGHT = 0.5, 20  # the same for pairs
BIAS_RATE = 0.3  # of the bias of assets, by plain gradient descent
# Groups of features, of which --without leaves one out. Some names are features of both pairs and nodes.
GROUPS = {
    "size": "area_s area_both volume_s volume_both area_step area volume sibling_area parent_area sibling_volume "
            "min_child_area",
    "convexity": "defect_both defect_s defect_l excess_to_s excess_to_all defect_added defect concavity sibling_defect "
                 "parent_defect defect_step max_child_defect whole_defect",
    "section": "interface_to_volume_s interface_to_volume_l interface_to_area_s interface_share_s "
               "interface_share_l section_to_thickness_s section_to_thickness_l isoperimetric_ratio "
               "interface_to_volume interface_to_area section_to_thickness",
    "length": "length_to_area_s length_share_s length_share_l length_to_area sibling_length",
    "thickness": "thickness_step thickness_s thickness_l thickness sibling_thickness whole_thickness",
    "creases": "crease concave curvature sharpness ridge valley wide_curvature parent_crease parent_concave "
               "parent_curvature sibling_crease",
    "order": "own_cost max_cost parent_cost cost_step is_root parts_after_merge parts_before_parent "
             "min_ancestor_cost max_ancestor_cost max_child_cost rejected_merges whole_rejected_merges "
             "sibling_cost sibling_max_cost sibling_rejected_merges",
}


# ---- A network with one hidden layer (Mlp in mlp.cpp), fitted by Adam

def likelihood_logistic(z):
    """(value, derivative of the cross entropy by z, given value - target): 1 / (1 + exp(-z))"""
    return 1 / (1 + np.exp(-z)), lambda error: error


def likelihood_rational(z):
    """The same for (1 + z / (1 + |z|)) / 2, which needs no exp."""
    return (1 + z / (1 + np.abs(z))) / 2, lambda error: 2 * error / (1 + 2 * np.abs(z))


class Networks:
    """Several networks, fitted to the same data from different starts. Their mean is one network with the hidden units of all.
    is_used: mask of the features that count; the others get weights of 0."""

    def __init__(self, x, weight, is_used, seed, ramps, networks):
        self.is_used, self.ramps, self.networks = np.asarray(is_used), ramps, networks
        self.rng = np.random.default_rng(seed)
        self.middle = np.average(x[:, is_used], axis=0, weights=weight)
        self.spread = np.sqrt(np.average((x[:, is_used] - self.middle) ** 2, axis=0, weights=weight)) + 1e-6
        inputs, units = self.is_used.sum(), networks * ramps
        self.p = [a.astype(np.float32) for a in (
            self.rng.normal(0, inputs ** -0.5, (inputs, units)), np.zeros(units),
            self.rng.normal(0, ramps ** -0.5, units), np.zeros(networks))]
        self.mean, self.square, self.steps = [np.zeros_like(a) for a in self.p], [np.zeros_like(a) for a in self.p], 0

    def inputs(self, x):
        """The used features, with mean 0 and standard deviation 1."""
        return ((x[:, self.is_used] - self.middle) / self.spread).astype(np.float32)

    def sums(self, z):
        """(rows, networks) outputs of the networks for inputs z."""
        self.z, ramp = z, z @ self.p[0] + self.p[1]
        self.size = 1 + np.abs(ramp)
        self.ramp = ramp / self.size
        return (self.ramp * self.p[2]).reshape(len(z), self.networks, self.ramps).sum(axis=2) + self.p[3]

    def descend(self, g, rate, decay=1e-4):
        """A step by Adam. g: the derivative of the loss by each output of the last sums()."""
        unit_gradient = np.repeat(g, self.ramps, axis=1)
        inner = unit_gradient * self.p[2] / self.size ** 2
        gradient = [self.z.T @ inner + decay * self.p[0], inner.sum(0), (self.ramp * unit_gradient).sum(0) + decay * self.p[2],
                    g.sum(0)]
        self.steps += 1
        for a, m, s, d in zip(self.p, self.mean, self.square, gradient):
            m += 0.1 * (d - m)
            s += 0.001 * (d * d - s)
            a -= rate * (m / (1 - 0.9 ** self.steps)) / (np.sqrt(s / (1 - 0.999 ** self.steps)) + 1e-8)

    def numbers(self):
        """The weights in the order of network_weights.h, rounded to DIGITS."""
        weights = self.p[0] / self.spread[:, None]
        rows = np.zeros((weights.shape[1], len(self.is_used) + 2))
        rows[:, 0], rows[:, -1] = self.p[1] - self.middle @ weights, self.p[2] / self.networks
        rows[:, 1 + np.flatnonzero(self.is_used)] = weights.T
        return np.array([float(f"{number:.{DIGITS}g}") for number in [*rows.ravel(), self.p[3].mean()]])


def evaluate(numbers, x):
    """The output of the network with these weights, see Networks.numbers(), for each row of features."""
    rows = numbers[:-1].reshape(-1, x.shape[1] + 2)
    ramp = x @ rows[:, 1:-1].T + rows[:, 0]
    return ramp / (1 + np.abs(ramp)) @ rows[:, -1] + numbers[-1]


# ---- Models and traces ---------------------------------------------------------------------------------------------

class People:
    """The segmentations of a model by S people. labels (S, F): unique over all segmentations; clicks: (face, label) of one random
    face per segment, chosen by area."""

    kinds = None  # see Asset

    def __init__(self, model, mesh_dir, seg_dir):
        mesh = meshes.read(mesh_dir / f"{model}.off")
        a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
        self.area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        labels, clicks, self.ends = [], [], [0]
        for path in sorted((seg_dir / str(model)).glob("*.seg")):
            raw = np.array(path.read_text().split(), int)
            names, label = np.unique(raw, return_inverse=True)
            if len(raw) != len(self.area) or len(names) < 2:
                continue
            labels.append(label + self.ends[-1])
            for k, name in enumerate(names):
                rng = np.random.default_rng(zlib.crc32(f"{model}/{path.name}/{name}".encode()))
                faces = np.flatnonzero(label == k)
                weight = self.area[faces]
                even = weight.sum() == 0
                clicks.append((rng.choice(faces) if even else rng.choice(faces, p=weight / weight.sum()),
                               k + self.ends[-1]))
            self.ends.append(self.ends[-1] + len(names))
        self.labels, self.clicks = np.array(labels), np.array(clicks)


class Traced:
    """The trace of merge_parts() for a model, as written by quality_trace."""

    def __init__(self, path):
        data = path.read_bytes()
        faces, first, last, pairs = np.frombuffer(data, np.int32, 4)
        at = 16

        def take(count, dtype, columns):
            nonlocal at
            values = np.frombuffer(data, dtype, count * columns, at)
            at += values.nbytes
            return values.reshape(count, columns)

        # (part of each face, number of parts, merges): as merged by cost, and after border snapping.
        self.first, self.last = ((take(faces, np.int32, 1)[:, 0], parts, take(parts - 1, np.int32, 2))
                                 for parts in (first, last))
        self.pairs = take(pairs, np.int32, 2)
        self.pair_measures = take(pairs, np.float64, len(PAIR_NAMES))
        self.node_measures = take(2 * last - 1, np.float64, len(NODE_NAMES))


def within_labels(people, weight, part_of_face, parts, merges):
    """(nodes, labels) total weight of the faces of each part, and of each merge of parts, in each label."""
    labels = people.ends[-1]
    cell = (part_of_face * labels + people.labels).ravel()
    sums = np.bincount(cell, weight, parts * labels).reshape(parts, labels)
    table = np.vstack([sums, np.zeros((len(merges), labels))])
    for j, pair in enumerate(merges):
        table[parts + j] = table[pair].sum(axis=0)
    return table


class Trace(Traced):
    """A trace compared with segmentations. area_in_label, faces_in_label, overlap (N, labels): of each node with each label."""

    def __init__(self, path, people):
        super().__init__(path)
        self.people = people
        annotators = len(people.labels)
        area = np.tile(people.area, annotators)
        self.initial_area_in_label = within_labels(people, area, *self.first)
        self.area_in_label, self.faces_in_label = (within_labels(people, weight, *self.last) for weight in (area, None))
        self.part_of_face, self.parts, self.merges = self.last
        self.parent = np.full(len(self.node_measures), -1)
        for j, pair in enumerate(self.merges):
            self.parent[pair] = self.parts + j
        self.initial_area, self.area = (x.sum(axis=1) / annotators for x in (self.initial_area_in_label, self.area_in_label))
        self.size = self.faces_in_label.sum(axis=1) / annotators
        label_area = self.area_in_label[-1]
        self.overlap = self.area_in_label / (self.area[:, None] + label_area - self.area_in_label)
        self.clicked = self.area_in_label[:self.parts] / label_area  # share of each target's clicks in each part
        if people.kinds:
            self.clicked[:, ::2] = 0  # columns 0, 2, ... are what is outside a target

    def same_part(self):
        """(pairs,) the probability that a random face of one and of the other are in the same part; of an asset, over the targets
        that at least one of both meets."""
        share = self.initial_area_in_label / np.maximum(self.initial_area, 1e-300)[:, None]
        a, b = (share[self.pairs[:, side]] for side in (0, 1))
        if not self.people.kinds:
            return (a * b).sum(axis=1) / len(self.people.labels)
        a, b = a[:, 1::2], b[:, 1::2]
        meets = 1 - (1 - a) * (1 - b)
        return 1 - (a * (1 - b) + b * (1 - a)).sum(axis=1) / np.maximum(meets.sum(axis=1), 1)

    def pair_data(self, data_share):
        """(features, probability, weight, is asset) of pairs, sampled by weight; (features, probability) of all pairs of a sample of
        parts; (parts, MAX_PAIRS_PER_PART) indices of each part's pairs, -1: none. data_share: of the usual weight and samples."""
        weight = np.sqrt(self.initial_area[self.pairs].min(axis=1) / self.initial_area[-1])
        weight /= weight.sum()
        count = PAIRS_PER_MODEL * data_share
        is_sampled = np.random.default_rng(len(weight)).random(len(weight)) < weight * count
        pairs, pairs_of_part = self.pairs_of_parts(data_share)
        same_part = self.same_part()
        return (self.pair_measures[is_sampled].astype(np.float32), same_part[is_sampled],
                np.maximum(weight[is_sampled], 1 / count) * data_share,
                np.full(is_sampled.sum(), bool(self.people.kinds)),
                self.pair_measures[pairs].astype(np.float32), same_part[pairs], pairs_of_part)

    def pairs_of_parts(self, data_share):
        """(pairs, (parts, MAX_PAIRS_PER_PART) indices of each part's pairs, -1: none), for a random sample of the parts with two
        pairs or more, weighted by size."""
        rng = np.random.default_rng(len(self.pairs))
        part, pair = self.pairs.T.ravel(), np.tile(np.arange(len(self.pairs)), 2)
        order = np.lexsort((rng.random(len(pair)), part))
        part, pair = part[order], pair[order]
        first = np.flatnonzero(np.diff(part, prepend=-1))
        count = np.diff(np.append(first, len(part)))
        first, count = first[count > 1], count[count > 1]
        weight = np.sqrt(self.initial_area[part[first]])
        sample_count = min(np.count_nonzero(weight), int(PARTS_PER_MODEL * data_share))
        sampled = rng.choice(len(first), sample_count, replace=False, p=weight / weight.sum()) if sample_count else first[:0]
        column = np.arange(MAX_PAIRS_PER_PART)
        has_pair = column < count[sampled, None]
        pairs, at = np.unique(pair[(first[sampled, None] + column)[has_pair]], return_inverse=True)
        pairs_of_part = np.full(has_pair.shape, -1)
        pairs_of_part[has_pair] = at
        return pairs, pairs_of_part

    def click_overlap(self, parts, nodes):
        """The expected overlap of each node with the segment that a click in each of as many parts means."""
        clicked = self.clicked[parts]
        return (clicked * self.overlap[nodes]).sum(axis=1) / np.maximum(clicked.sum(axis=1), 1e-300)

    def node_data(self, data_share):
        """(features, expected overlap, weight) of each node; of each part: its ancestors (MAX_PATH_LENGTH), -1: none, their expected
        overlap with the segment of a click in the part, and its share of the clicks; data_share, the share of the epochs that
        use the model."""
        weight = (self.area / self.area[-1]) ** 0.25
        share = self.clicked.sum(axis=1)
        sums = np.zeros((2, len(self.area)))
        paths = np.full((self.parts, MAX_PATH_LENGTH), -1, np.int32)
        overlap = np.zeros(paths.shape, np.float32)
        at = np.arange(self.parts)
        for k in range(MAX_PATH_LENGTH):
            exists = at >= 0
            paths[exists, k] = at[exists]
            overlap[exists, k] = self.click_overlap(np.flatnonzero(exists), at[exists])
            for total, value in zip(sums, (share[exists] * overlap[exists, k], share[exists])):
                np.add.at(total, at[exists], value)
            at = np.where(exists, self.parent[at], -1)
        weight *= sums[1] > 0
        return (self.node_measures.astype(np.float32), (sums[0] / np.maximum(sums[1], 1e-300)).astype(np.float32),
                (weight / weight.sum()).astype(np.float32), paths, overlap, share / share.sum(), data_share)

    def measures(self, scores):
        """[(kind, HEAD...)]: means over clicks; last 1 - Rand index of the cut into K parts and of the automatic one. Of an asset one
        for each target, without the latter two."""
        inside = self.area_in_label[:self.parts]
        inside, size = (np.where(inside > 0.5 * self.area[:self.parts, None], x, 0).sum(axis=0)
                        for x in (inside, self.area[:self.parts, None]))
        ceiling = inside / (size + self.area_in_label[-1] - inside)
        rows, wheels = [], {}
        for face, label in self.people.clicks:
            part = self.part_of_face[face]
            if part not in wheels:
                wheels[part] = self.wheel(part, scores)
            path, stops = wheels[part]
            overlap = self.overlap[stops, label]
            at, best = int(np.argmax(scores[stops])), int(overlap.argmax())
            rows.append((ceiling[label], self.overlap[path, label].max(), overlap[best], overlap[at], overlap[max(0, at - 2):at + 3].max(), len(stops), abs(best - at),
                         self.overlap[stops[at], self.people.labels[:, face]][self.people.labels[:, face] % 2 == 1].max()
                         if self.people.kinds else np.nan))
        if self.people.kinds:
            means = np.reshape(rows, (len(self.people.kinds), -1, len(rows[0]))).mean(axis=1)
            return [(kind, *row, np.nan, np.nan) for kind, row in zip(self.people.kinds, means)]
        cuts = [self.disagreement(self.undone(end - begin), i)
                for i, (begin, end) in enumerate(zip(self.people.ends, self.people.ends[1:]))]
        likely = self.likeliest(scores)
        auto = [self.disagreement(likely, i) for i in range(len(cuts))]
        return [("person", *np.mean(rows, axis=0), np.mean(cuts), np.mean(auto))]

    def wheel(self, part, scores):
        """(path, stops)"""
        path = [part]
        while self.parent[path[-1]] >= 0:
            path.append(self.parent[path[-1]])
        path, stops = np.array(path), []
        for n in path[np.argsort(-scores[path], kind="stable")]:
            if all(min(self.area[n], self.area[s]) <= MAX_STOP_OVERLAP * max(self.area[n], self.area[s]) for s in stops):
                stops.append(n)
        root = path[-1]
        if root not in stops:
            stops = [s for s in stops if self.area[s] < self.area[root]] + [root]
        return path, np.sort(stops)

    def undone(self, parts):
        alive = {len(self.parent) - 1}
        for j in range(len(self.merges) - 1, max(-1, len(self.merges) - parts), -1):
            alive.remove(self.parts + j)
            alive.update(self.merges[j].tolist())
        return sorted(alive)

    def likeliest(self, scores):
        best, divided = self.area * scores - PART_PENALTY * self.area[-1], np.zeros(len(scores), bool)
        for j, pair in enumerate(self.merges):
            if best[pair].sum() > best[self.parts + j]:
                best[self.parts + j], divided[self.parts + j] = best[pair].sum(), True
        cut, todo = [], [len(scores) - 1]
        while todo:
            n = todo.pop()
            if divided[n]:
                todo += self.merges[n - self.parts].tolist()
            else:
                cut.append(n)
        return cut

    def disagreement(self, cut, annotator):
        """1 - Rand Index of a cut and a person's segmentation."""
        ends = self.people.ends
        joint = self.faces_in_label[cut, ends[annotator]:ends[annotator + 1]]

        def pairs(n):
            return (n * (n - 1) / 2).sum()

        return (pairs(joint.sum(0)) + pairs(joint.sum(1)) - 2 * pairs(joint)) / pairs(self.size[-1:])


# ---- Fitting -------------------------------------------------------------------------------------------------------

def start_numbers():
    """The weights of the first round: by the concavity that merging adds, relative to the smaller part's hull, and its size."""
    weights = {"area_s": 0.1, "excess_to_s": 0.3}
    return np.array([0, *(weights.get(name, 0) for name in PAIR_NAMES), 1, 0])


def feature_mask(names, without):
    """Which of these features are not in the group `without`."""
    left_out = GROUPS[without].split() if without else []
    return np.array([name not in left_out for name in names])


def fit_pairs(data, without, seed, networks):
    x, y, weight, is_asset, of_parts, same_part = (np.concatenate(column) for column in list(zip(*data))[:6])
    begin = np.cumsum([0] + [len(model[4]) for model in data])
    pairs_of_part = np.concatenate([np.where(model[6] < 0, -1, model[6] + first) for model, first in zip(data, begin)])
    networks = Networks(x, weight, feature_mask(PAIR_NAMES, without), seed, PAIR_UNITS, networks)
    z, y, weight = networks.inputs(x), (1 - y).astype(np.float32), (weight / weight.mean()).astype(np.float32)
    of_parts = networks.inputs(of_parts)
    asset_bias = np.float32(0)  # targets of assets separate more pairs or fewer than people do
    epochs, batch = 14, 2048
    for epoch in range(epochs):
        at = networks.rng.permutation(len(y))
        for i in range(0, len(y), batch):
            k = at[i:i + batch]
            parts = pairs_of_part[networks.rng.integers(len(pairs_of_part), size=PARTS_PER_STEP)]
            pairs, parts[parts >= 0] = np.unique(parts[parts >= 0], return_inverse=True)
            sums = networks.sums(np.concatenate([z[k], of_parts[pairs]]))
            value, slope = likelihood_logistic(sums[:len(k)] + asset_bias * is_asset[k, None])
            gradient, rate = slope(value - y[k, None]) * weight[k, None] / len(k), 1.02 - epoch / epochs
            asset_bias -= np.float32(BIAS_RATE * rate) * gradient[is_asset[k]].mean(axis=1).sum()
            networks.descend(np.concatenate([
                gradient,
                MERGE_LOSS_WEIGHT * choice_gradient(-sums[len(k):], parts, same_part[pairs][parts], MERGE_TEMPERATURE),
            ]), 3e-3 * rate)
    return networks.numbers()


def fit_nodes(data, without, seed, networks):
    networks = Networks(*(np.concatenate(column) for column in zip(*((x, weight) for x, _, weight, *_ in data))),
                        feature_mask(NODE_NAMES, without), seed, NODE_UNITS, networks)
    inputs, epochs, batch = [networks.inputs(model[0]) for model in data], 30, 4
    for epoch in range(epochs):
        order = networks.rng.permutation(len(data))
        order = order[networks.rng.random(len(order)) < np.array([model[6] for model in data])[order]]
        for i in range(0, len(order), batch):
            z, y, weight, paths, overlap = [], [], [], [], []
            for k in order[i:i + batch]:
                clicked = networks.rng.choice(len(data[k][5]), CLICKS_PER_MODEL, p=data[k][5])
                path = data[k][3][clicked]
                paths.append(np.where(path >= 0, path + sum(map(len, z)), -1))
                overlap.append(data[k][4][clicked])
                for column, values in zip((z, y, weight), (inputs[k], *data[k][1:3])):
                    column.append(values)
            y, weight, paths, overlap = map(np.concatenate, (y, weight, paths, overlap))
            sums = networks.sums(np.concatenate(z))
            score, slope = likelihood_rational(sums)
            g = slope(score - y[:, None]) * (weight / weight.sum())[:, None]
            g -= CLICK_LOSS_WEIGHT * choice_gradient(score, paths, overlap, CLICK_TEMPERATURE) / 2 / (1 + np.abs(sums)) ** 2
            networks.descend(g, 4e-3 * (1.02 - epoch / epochs))
    return networks.numbers()


def choice_gradient(score, rows, value, temperature):
    """(scores, networks) the gradient by each score of the mean value of a choice from each row, if chosen with probability
    softmax(score / temperature). rows (n, k): indices of scores, -1: none; value (n, k) of each."""
    exists = rows >= 0
    probability = np.where(exists[..., None], score[rows] / temperature, -np.inf)
    probability = np.exp(probability - probability.max(axis=1, keepdims=True))
    probability /= probability.sum(axis=1, keepdims=True)
    value = value[..., None]
    gain = probability * (value - (probability * value).sum(axis=1, keepdims=True)) / temperature / len(rows)
    return np.stack([np.bincount(rows[exists], weights, len(score)) for weights in np.moveaxis(gain, 2, 0)[:, exists]],
                    axis=1).astype(np.float32)


def build_tree(name, mesh, directory):
    """Builds and saves the paper's tree of a model, unless it exists; returns whether that worked."""
    target = directory / f"{name}.hierarchy"
    if target.exists():
        return True
    try:
        hierarchy = Hierarchy.build(mesh.vertices, mesh.triangles, threads=1, mode=Mode.PAPER)
    except PartwheelError as error:
        print(f"{name} is left out: {error}", flush=True)
        return False
    target.write_bytes(hierarchy.save())
    return True


def deal(groups, folds):
    """{group: fold}"""
    return {group: i % folds for i, group in enumerate(groups)}


def print_table(rows):
    """rows: [(data set, group, kind, HEAD...)], one for each target or model. Prints the means by group and by kind."""
    print(f"{'data set':10} {'group':18} {'n':>4} {HEAD}")
    figures = np.array([row[3:] for row in rows])
    for name in dict.fromkeys(row[0] for row in rows):
        for column in (1, 2):
            for group in dict.fromkeys(row[column] for row in rows if row[0] == name):
                chosen = [row[0] == name and row[column] == group for row in rows]
                means = figures[chosen].mean(axis=0)
                print(f"{name:10} {group:18} {sum(chosen):4d}", *("     -" if np.isnan(x) else f"{x:6.3f}" for x in means))


def traced(command):
    subprocess.run(command, check=True)


def header(pair_numbers, node_numbers):
    def array(name, numbers, measures):
        rows = [*numbers[:-1].reshape(-1, measures + 2), numbers[-1:]]
        lines = []
        for row in rows:
            line = "   "
            for number in row:
                word = f" {number:.{DIGITS}g},"
                if len(line) + len(word) > 118:
                    lines.append(line)
                    line = "       "
                line += word
            lines.append(line)
        return (f"inline constexpr std::array<double, {len(numbers)}> {name} = {{\n" + "\n".join(lines) + "\n};\n")

    return (
        "// The weights of the two networks of merge_policy.h, in the order that Mlp() takes: one hidden unit per\n"
        "// paragraph (its bias, its input weights in the order of feature_names.h, its output weight), then the output bias.\n"
        "// Written by tests/quality/fit.py.\n#pragma once\n\n#include <array>\n\nnamespace partwheel {\n\n"
        + array("pair_network", pair_numbers, len(PAIR_NAMES)) + "\n"
        + array("node_network", node_numbers, len(NODE_NAMES)) + "\n}  // namespace partwheel\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("meshes", "segmentations", "work"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--score", type=Path, help="the folder of the assets' score.py")
    parser.add_argument("--assets", type=Path)
    parser.add_argument("--fused", type=Path, help="what fuse.py made of some of them")
    parser.add_argument("--share", type=float, nargs=2, default=(0.0, 0.0))
    parser.add_argument("--node-share", type=float, nargs=2, default=(0.0, 0.0))
    parser.add_argument("--trees", type=Path)
    parser.add_argument("--trace", type=Path, default=ROOT / "build" / "release" / "quality_trace")
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--folds", type=int, default=4)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--without", choices=GROUPS)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--write", action="store_true", help=f"writes {HEADER.relative_to(ROOT)}")
    args = parser.parse_args()
    if args.without and args.write:
        parser.error("an ablation's numbers are not for use")
    args.work.mkdir(parents=True, exist_ok=True)
    paths = {int(path.stem): path for path in sorted(args.meshes.glob("*.off"), key=lambda path: int(path.stem))}
    assets = {asset.name: asset for directory, is_fused in ((args.assets, False), (args.fused, True)) if directory
              for asset in read_assets(args.score, directory, is_fused)}
    # Of each model: data set, and category or pack.
    group = {model: ("benchmark", f"{(model - 1) // 20 * 20 + 1}-{(model - 1) // 20 * 20 + 20}") for model in paths}
    group |= {name: ("fused" if name.endswith("_fused") else "as it is", asset.pack) for name, asset in assets.items()}
    of_group = {}
    for model, key in group.items():
        of_group.setdefault(key, []).append(model)
    models = [model for members in of_group.values() for model in members[::args.every]]
    trees = args.trees or args.work
    if not args.trees:
        with ProcessPoolExecutor(args.jobs) as pool:
            built = pool.map(build_tree, models, [assets.get(m) or meshes.read(paths[m]) for m in models], repeat(trees))
            models = [model for model, is_built in zip(models, built) if is_built]
    models = [model for model in models if (trees / f"{model}.hierarchy").exists()]
    sets = max(1, args.folds)  # of weights, for each fold
    dealt = deal(sorted({c for name, c in of_group if name == "benchmark"}, key=lambda c: int(c.split("-")[0])), sets)
    dealt |= deal(sorted({c for name, c in of_group if name != "benchmark"}), sets)
    fold = {model: dealt[group[model][1]] for model in models}

    with ProcessPoolExecutor(args.jobs) as pool:
        segmented = [model for model in models if model in paths]
        people = pool.map(People, segmented, repeat(args.meshes), repeat(args.segmentations), chunksize=8)
        people = assets | dict(zip(segmented, people))

        def traces_of(name, numbers):
            """The trace of each model with its fold's pair cost; numbers: one for each fold, or "-", the library's."""
            directory = args.work / name
            directory.mkdir(exist_ok=True)
            paths = ["-"] * sets
            if numbers != "-":
                paths = [directory / f"fold{f}.txt" for f in range(sets)]
                for path, fold_numbers in zip(paths, numbers):
                    path.write_text("\n".join(repr(float(n)) for n in fold_numbers))
            list(pool.map(traced, [[args.trace, paths[fold[model]], directory, trees / f"{model}.hierarchy"]
                                   for model in models], chunksize=8))
            return {model: Trace(directory / f"{model}.trace", people[model]) for model in models}

        def fit_folds(fit, data, seed, networks):
            """The weights for each fold, fitted to all other folds; last the weights fitted to all."""
            chosen = [[d for model, d in data if fold[model] != f] for f in range(args.folds)] + [[d for _, d in data]]
            return list(pool.map(fit, chosen, repeat(args.without), repeat(seed), repeat(networks)))

        def evaluate_models(traces, node_numbers):
            """[(data set, group, kind, HEAD...)]"""
            rows = []
            for model, trace in traces.items():
                scores = likelihood_rational(evaluate(node_numbers[fold[model]], trace.node_measures))[0]
                rows += [(*group[model], *row) for row in trace.measures(scores)]
            return rows

        def data_of(method, traces, shares):
            """[(model, data)] of the models that count."""
            share = dict(zip(("benchmark", "as it is", "fused"), (1.0, *shares)))
            return [(model, method(trace, share[group[model][0]])) for model, trace in traces.items() if share[group[model][0]]]

        def pair_data(traces):
            return data_of(Trace.pair_data, traces, args.share)

        def node_data(traces):
            return data_of(Trace.node_data, traces, args.node_share)

        traces = traces_of("before", "-")
        before = evaluate_models(traces, [network_weights("node_network")] * sets)
        print("current ", summary(before), flush=True)
        if not args.seeds:
            print_table(before)
            return
        first = pair_data(traces_of("round0", [start_numbers()] * sets)) if args.rounds else []
        held_back, fits = [], []  # by seed: figures of each model; (figures, pair numbers, node numbers) fitted to all
        for seed in range(args.seeds):
            pair_rounds, node_rounds = [first], [] if args.rounds else [node_data(traces)]
            pairs = [network_weights("pair_network")] * (args.folds + 1)
            for number in range(1, args.rounds + 1):
                pairs = fit_folds(fit_pairs, sum(pair_rounds[-ROUNDS_USED:], []), seed, NETWORKS if number == args.rounds else 1)
                traces = traces_of(f"round{number}", pairs)
                pair_rounds.append(pair_data(traces))
                node_rounds.append(node_data(traces))
            nodes = fit_folds(fit_nodes, sum(node_rounds[-ROUNDS_USED:], []), seed, NETWORKS)
            held_back.append(evaluate_models(traces, nodes))
            after = held_back[-1]
            if args.folds:
                after = evaluate_models(traces_of("after", pairs[-1:] * args.folds), nodes[-1:] * args.folds)
            fits.append((after, pairs[-1], nodes[-1]))
            print(f"seed {seed:3d}", summary(held_back[-1]), flush=True)

    print_table([(*rows[0][:3], *np.mean([row[3:] for row in rows], axis=0)) for rows in zip(*held_back)])
    by_seed = np.array([means_of(rows) for rows in held_back])
    best = max(fits, key=lambda fit: means_of(fit[0])[[BEST, CLICK]].sum())
    print(f"{'':8} {HEAD} of the benchmark")
    for name, figures in (("mean", by_seed.mean(axis=0)), ("seeds +-", by_seed.std(axis=0)),
                          ("before *", means_of(before)), ("after *", means_of(best[0]))):
        print(f"{name:8}", *(f"{x:.4f}" for x in figures))
    print("* on all models, which they were fitted to: the current and the new network_weights.h")
    if args.write:
        HEADER.write_text(header(*best[1:]))


def means_of(rows, name="benchmark"):
    """The means of a data set, in the order of HEAD."""
    return np.mean([row[3:] for row in rows if row[0] == name], axis=0)


def summary(rows):
    """A line with the means of each data set, as far as it has them."""
    texts = []
    for name in dict.fromkeys(row[0] for row in rows):
        means = means_of(rows, name)
        texts.append(f"{name}: " + " ".join(f"{x:.4f}" for x in means[~np.isnan(means)]))
    return "; ".join(texts)


if __name__ == "__main__":
    main()
