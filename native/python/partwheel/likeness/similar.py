# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a model that are alike: all fingers from one, all legs of a table. By numpy.

Every node's faces are one slice of one array, so areas, moments and the border's size of all nodes are differences of
running sums. What differs little from the part in these is brought onto it, turned and reflected as it fits best
(iterated closest points, from the principal axes), and of nodes within each other the most alike is taken. It counts
too where a node is in the whole, up to a limit, and whether people would take it for a part. Unlike partwheel.compatible,
which fits parts of any size to a border, sizes count here and borders do not have to meet.
"""

from typing import NamedTuple

import numpy as np

from ..compatible import sample_triangles
from ..duplicates import without_duplicates

POINTS, FINE, COARSE = 192, 768, 4  # on a surface: to align; to measure with; of how many one is enough to choose turns
TURNS, TRIES, STEPS = 8, 3, 8  # about the longest axis; how many of all turns are refined, and in how many steps
UNLIKE = 0.5  # mean difference of logarithms of lengths up to which a node is aligned at all
MOST, NESTED = 120, 5  # nodes that are aligned, and of those how many in one place
# Weights, fitted to people's segments (tests/quality/similar.py): of lengths, of the distance squared, of the surroundings,
# of a score below PART, of one below the part's own.
LENGTHS, ALIGNED, AROUND, LOW, LACKING = 1.5, 20.0, 2.0, 0.7, 0.35
PART = 0.7  # score from which on a node is surely one that people take for a part
ELSEWHERE = 0.15  # surroundings that differ more differ no more: a twin is one wherever it is
THRESHOLD = 0.49  # of likeness, from which on parts are taken for alike
CLOSE = 0.9  # of the points lie within the distance of two surfaces
WHOLE = 1536  # points on the whole surface,
FAR = np.linspace(0.02, 0.98, 25)  # and these shares of them within which distances
HOPELESS = 0.12  # mean distance, in roots of the area, before refining: such are not refined
DIGITS = 9
NARROW = 0.05  # of the root of the area: the radius of a border below which it doesn't count how much


class Measures(NamedTuple):
    """lengths (N,6): logarithms, of each node's area, volume, principal extents and border. middle (N,3). first, last
    (N,): its slice of corners (T,3,3), the triangles. whole (n,3): points on all of them; size: the root of their area.
    """

    lengths: np.ndarray
    middle: np.ndarray
    first: np.ndarray
    last: np.ndarray
    corners: np.ndarray
    whole: np.ndarray
    size: float


def measures(hierarchy, vertices, triangles, faces, matrix=np.eye(4)):
    """The Measures of all nodes. vertices (V,3), triangles (T,3), faces (T,) the source face of each: the surface that
    the hierarchy is of. matrix (4,4): from there to where parts are compared."""
    triangles, faces = without_duplicates(hierarchy, vertices, triangles, faces)
    place = np.empty(len(hierarchy.order), np.int64)
    place[hierarchy.order] = np.arange(len(place))
    sequence = np.argsort(place[faces], kind="stable")
    ends = np.searchsorted(place[faces][sequence], np.arange(len(place) + 1))
    first, last = ends[hierarchy.first], ends[hierarchy.last]
    vertices, turn = np.asarray(vertices, np.float64), np.asarray(matrix, np.float64)[:3, :3]
    corners = ((vertices - vertices.mean(axis=0)) @ turn.T)[np.asarray(triangles)[sequence]]

    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    areas = np.linalg.norm(normals, axis=1)
    sums = corners.sum(axis=1)
    # Of the squares over a triangle: the corners' and their sum's, a twelfth of the area each.
    squares = (np.einsum("tki,tkj->tij", corners, corners) + sums[:, :, None] * sums[:, None]) * (areas / 12)[:, None, None]

    def total(values):
        running = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
        return running[last] - running[first]

    area = np.maximum(total(areas), 1e-300)
    middle = total(sums * (areas / 3)[:, None]) / area[:, None]
    moments = total(squares) / area[:, None, None] - middle[:, :, None] * middle[:, None]
    root = np.sqrt(area)
    extents = np.sqrt(np.maximum(np.linalg.eigvalsh(moments), 0))
    border = np.sqrt(np.linalg.norm(total(normals), axis=1) / np.pi)
    volume = np.cbrt(np.maximum(hierarchy.volume * abs(np.linalg.det(turn)), 0))
    floor = NARROW * root
    lengths = np.log(np.column_stack([root, *(np.maximum(each, floor) for each in (volume, *extents.T, border))]))
    return Measures(lengths, middle, first, last, corners, sample_triangles(corners, areas, WHOLE)[0], np.sqrt(areas.sum()))


def similar(hierarchy, measured, node, among=None):
    """[(node, likeness), ...] beside a node: those that are most like it, apart from each other and from it, the most
    alike first. likeness: 1 for the same shape and size, down to 0; mirror images count as the same. So all that are
    alike from a threshold on are the list's beginning. Of a node inside, without faces, there are none.
    among: (hierarchy, measured) of another model, whose nodes are looked at instead."""
    if measured.first[node] == measured.last[node]:
        return []
    there, those = among or (hierarchy, measured)
    unlike = abs(those.lengths - measured.lengths[node]).mean(axis=1)
    first, last, score = there.first, there.last, there.score
    candidates = (those.last > those.first) & (unlike < UNLIKE)
    if not among:
        candidates &= (last <= first[node]) | (first >= last[node])
    near = np.flatnonzero(candidates)
    least = PART if hierarchy.score[node] > 0 else 0  # of a part that has no score none is asked for
    known = (LENGTHS * unlike + LOW * np.maximum(0, least - score)
             + LACKING * np.maximum(0, hierarchy.score[node] - score))
    chosen = []
    for other in near[np.argsort(known[near], kind="stable")].tolist():
        if sum(first[other] < last[each] and first[each] < last[other] for each in chosen) < NESTED:
            chosen.append(other)
            if len(chosen) == MOST:
                break
    own, found = Surface(measured, node), []
    elsewhere = abs(_surroundings(those, chosen) - _surroundings(measured, [node])).mean(axis=1) / measured.size
    for other, around in zip(chosen, np.minimum(elsewhere, ELSEWHERE).tolist()):
        apart = known[other] + AROUND * around + ALIGNED * distance(own, Surface(those, other)) ** 2
        # Products of matrices differ in their last bits with where these lie in memory: that is no part of a likeness.
        found.append((-round(float(np.exp(-apart)), DIGITS), other))
    kept = []
    for likeness, other in sorted(found):
        if all(last[other] <= first[each] or first[other] >= last[each] for each, _ in kept):
            kept.append((other, -likeness))
    return kept


def _surroundings(measured, nodes):
    """(n,25) how far from each node's middle the whole's surface is: within which distances shares of it are."""
    return np.quantile(np.sqrt(_squared(measured.middle[nodes], measured.whole)), FAR, axis=1).T


class Surface:
    """Points on a node's surface, about their middle; fine: more of them."""

    def __init__(self, measured, node):
        corners = measured.corners[measured.first[node]:measured.last[node]]
        double = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        self.fine = sample_triangles(corners, double, FINE)[0]
        self.points = sample_triangles(corners, double, POINTS)[0]
        middle = self.fine.mean(axis=0)
        self.fine -= middle
        self.points -= middle
        self.size = np.sqrt(max(double.sum() / 2, 1e-300))
        self.axes = np.linalg.eigh(self.fine.T @ self.fine)[1].T[::-1]


def distance(one, other):
    """How far two Surfaces are from each other once one is brought onto the other: within which CLOSE of their points are,
    relative to the other's size."""
    turns, staying = _turns(one.axes, other.axes), other.points
    rough = np.sqrt(_squared(one.points[::COARSE] @ turns.transpose(0, 2, 1), staying[::2]).min(axis=2)).mean(axis=1)
    if rough.min() > HOPELESS * other.size:
        return float(rough.min() / other.size)
    best = np.inf
    for turn in turns[np.argsort(rough.round(DIGITS), kind="stable")[:TRIES]]:
        turn, shift = _refined(one.points, staying, turn)
        there = sum(np.sqrt(np.quantile(_squared(points @ turn.T + shift, onto).min(axis=axis), CLOSE))
                    for points, onto, axis in ((one.points, other.fine, 1), (one.fine, staying, 0)))
        best = min(best, there / 2)
    return float(best / other.size)


def _turns(axes, others):
    """(n,3,3) that bring the axes of one to those of the other: either way round, reflected, and turned about the
    longest."""
    angles = np.arange(TURNS) * np.pi / TURNS
    about = np.zeros((TURNS, 3, 3))
    about[:, 0, 0] = 1
    about[:, 1, 1] = about[:, 2, 2] = np.cos(angles)
    about[:, 2, 1] = np.sin(angles)
    about[:, 1, 2] = -about[:, 2, 1]
    signs = 1.0 - 2 * np.array(list(np.ndindex(2, 2, 2)))
    return np.einsum("ia,sa,tab,bj->stij", others.T, signs, about, axes).reshape(-1, 3, 3)


def _refined(points, staying, turn):
    """(turn (3,3), shift (3,)): from a turn to where each surface's points meet the other's."""
    shift = np.zeros(3)
    for _ in range(STEPS):
        there = points @ turn.T + shift
        squared = _squared(there, staying)
        # Pairs from both sides, lest a small surface slide about on a large one.
        pairs = (np.vstack([there, there[squared.argmin(axis=0)]]), np.vstack([staying[squared.argmin(axis=1)], staying]))
        middles = [each.mean(axis=0) for each in pairs]
        left, _, right = np.linalg.svd((pairs[1] - middles[1]).T @ (pairs[0] - middles[0]))
        motion = left @ np.diag([1, 1, np.sign(np.linalg.det(left @ right))]) @ right
        turn, shift = motion @ turn, motion @ (shift - middles[0]) + middles[1]
    return turn, shift


def _squared(moving, staying):
    """(...,n,m) distances squared."""
    return np.maximum((moving ** 2).sum(axis=-1)[..., None] + (staying ** 2).sum(axis=-1) - 2 * moving @ staying.T, 0)


def nearest(hierarchy, inside):
    """(the node that has most in common with a set of faces, its overlap with them by their number, 0..1). inside (F,)
    bool: the faces. Of nodes with the same faces that which people would take most likely."""
    running = np.concatenate([[0], np.cumsum(inside[hierarchy.order])])
    common = running[hierarchy.last] - running[hierarchy.first]
    overlap = common / np.maximum(hierarchy.last - hierarchy.first + running[-1] - common, 1)
    best = int(np.lexsort((hierarchy.score, overlap))[-1])
    return best, float(overlap[best])
