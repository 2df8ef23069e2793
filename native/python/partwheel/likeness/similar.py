# SPDX-License-Identifier: GPL-3.0-or-later
"""Similar parts of a model: all fingers from one, all legs of a table. With numpy.

The faces of each node are one slice of one array, so areas, moments and border sizes of all nodes are differences of
prefix sums. Nodes with similar measures are aligned with the part, by rotations and reflections from the principal axes and
by ICP; of nested nodes, only the most similar one is returned. Likeness also depends on the score and, up to a limit, on
the distance to the rest of the model. Sizes count and borders need not match, unlike in partwheel.compatible, which fits
parts of any size to a border.
"""

from typing import List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import ArrayLike

from ..deform import rigid_motion
from ..duplicates import without_duplicates
from ..hierarchy import Hierarchy
from ..triangles import doubled_area_vectors, sample_triangles, triangle_areas

# Sampling
SAMPLES, FINE_SAMPLES = 192, 768  # points on a part: to align it, to measure distances to it
COARSE_STEP = 4  # of the aligned points every 4th is used to choose rotations
MODEL_SAMPLES = 1536  # points on the whole model
# Candidates
MAX_LOG_DIFFERENCE = 0.5  # mean difference of the logarithms of lengths: nodes that differ more are not aligned
MAX_ALIGNED, MAX_NESTED = 120, 5  # nodes to align, and of these nodes that overlap another one
# Alignment
ROTATION_COUNT = 8  # rotations about the longest axis
MAX_REFINED, ICP_ITERATIONS = 3, 8  # initial rotations that ICP refines, and its iterations
MAX_ROUGH_DISTANCE = 0.12  # mean distance before ICP, in square roots of the area: above it there is no ICP
DISTANCE_QUANTILE = 0.9  # of the distances between two surfaces
# likeness = exp(-(LENGTH_WEIGHT mean |log difference of lengths| + DISTANCE_WEIGHT distance^2
#   + SURROUNDINGS_WEIGHT min(difference of surroundings, MAX_SURROUNDINGS_DIFFERENCE)
#   + LOW_SCORE_WEIGHT max(0, PART_SCORE - score) + SCORE_WEIGHT max(0, score of the part - score)))
# The weights were fitted to segments that people chose (tests/quality/similar.py).
LENGTH_WEIGHT, DISTANCE_WEIGHT, SURROUNDINGS_WEIGHT, LOW_SCORE_WEIGHT, SCORE_WEIGHT = 1.5, 20.0, 2.0, 0.7, 0.35
PART_SCORE = 0.7  # a node with this score is certainly a part
MAX_SURROUNDINGS_DIFFERENCE = 0.15  # beyond it the position in the model does not count
THRESHOLD = 0.49  # likeness of similar parts
SURROUNDING_QUANTILES = np.linspace(0.02, 0.98, 25)  # of the distances from a node's center to the model's surface
# Numerics
DIGITS = 9  # decimals of a likeness
MIN_RELATIVE_LENGTH = 0.05  # of lengths, in square roots of the area: shorter ones all count as this


class NodeMeasures(NamedTuple):
    """Measures of all N nodes of a hierarchy."""

    lengths: np.ndarray  # (N, 6) logarithms of lengths: area, volume, three principal extents, border
    center: np.ndarray  # (N, 3)
    first: np.ndarray  # (N,) node n has the triangles corners[first[n]:last[n]]
    last: np.ndarray
    corners: np.ndarray  # (T, 3, 3)
    model_points: np.ndarray  # (n, 3) points on the whole model
    model_size: float  # square root of its area


def measure_nodes(hierarchy: Hierarchy, vertices: ArrayLike, triangles: np.ndarray, faces: np.ndarray,
                  matrix: ArrayLike = np.eye(4)) -> NodeMeasures:
    """Measure all nodes of a hierarchy. O(T + N). faces : (T,) the source face of each triangle; matrix : (4, 4) from the
    vertices to the space where parts are compared"""
    triangles, faces = without_duplicates(hierarchy, vertices, triangles, faces)
    position = np.empty(len(hierarchy.order), np.int64)  # of each face in the hierarchy's order
    position[hierarchy.order] = np.arange(len(position))
    triangle_order = np.argsort(position[faces], kind="stable")
    ends = np.searchsorted(position[faces][triangle_order], np.arange(len(position) + 1))
    first, last = ends[hierarchy.first], ends[hierarchy.last]
    vertices, linear = np.asarray(vertices, np.float64), np.asarray(matrix, np.float64)[:3, :3]
    corners = ((vertices - vertices.mean(axis=0)) @ linear.T)[np.asarray(triangles)[triangle_order]]

    normals = doubled_area_vectors(corners) / 2
    areas = np.linalg.norm(normals, axis=1)
    sums = corners.sum(axis=1)
    # Integral of x x^T over a triangle: area / 12 (sum of c c^T over corners c, plus s s^T of their sum s).
    squares = (np.einsum("tki,tkj->tij", corners, corners) + sums[:, :, None] * sums[:, None]) * (areas / 12)[:, None, None]

    area = np.maximum(slice_sums(areas, first, last), 1e-300)
    center = slice_sums(sums * (areas / 3)[:, None], first, last) / area[:, None]
    moments = slice_sums(squares, first, last) / area[:, None, None] - center[:, :, None] * center[:, None]
    root_area = np.sqrt(area)
    extents = np.sqrt(np.maximum(np.linalg.eigvalsh(moments), 0))
    # The radius of a disk with the border's vector area.
    border = np.sqrt(np.linalg.norm(slice_sums(normals, first, last), axis=1) / np.pi)
    volume = np.cbrt(np.maximum(hierarchy.volume * abs(np.linalg.det(linear)), 0))
    min_length = MIN_RELATIVE_LENGTH * root_area
    lengths = np.log(np.column_stack([root_area, *(np.maximum(length, min_length)
                                                   for length in (volume, *extents.T, border))]))
    return NodeMeasures(lengths, center, first, last, corners, sample_triangles(corners, areas, MODEL_SAMPLES)[0],
                        np.sqrt(areas.sum()))


def slice_sums(values: np.ndarray, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """(N, ...) sums of values[first:last] (n, ...) for N slices."""
    prefix = np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(values, axis=0)])
    return prefix[last] - prefix[first]


def similar_parts(hierarchy: Hierarchy, measures: NodeMeasures, node: int,
                  other_model: Optional[Tuple[Hierarchy, NodeMeasures]] = None) -> List[Tuple[int, float]]:
    """The parts that are most similar to a node, which they don't overlap: disjoint (node, likeness), most similar first.
    likeness: 1 for the same shape and size, also for mirror images, down to 0. Empty for a node without faces. other_model :
    (hierarchy, measures) of another model to search instead"""
    if measures.first[node] == measures.last[node]:
        return []
    other_hierarchy, other_measures = other_model or (hierarchy, measures)
    length_difference = abs(other_measures.lengths - measures.lengths[node]).mean(axis=1)
    first, last, score = other_hierarchy.first, other_hierarchy.last, other_hierarchy.score
    is_candidate = (other_measures.last > other_measures.first) & (length_difference < MAX_LOG_DIFFERENCE)
    if not other_model:
        is_candidate &= (last <= first[node]) | (first >= last[node])
    candidates = np.flatnonzero(is_candidate)
    min_score = PART_SCORE if hierarchy.score[node] > 0 else 0  # scores don't count for a part that has none
    partial_cost = (LENGTH_WEIGHT * length_difference + LOW_SCORE_WEIGHT * np.maximum(0, min_score - score)
                    + SCORE_WEIGHT * np.maximum(0, hierarchy.score[node] - score))
    aligned: List[int] = []
    for other in candidates[np.argsort(partial_cost[candidates], kind="stable")].tolist():
        if sum(first[other] < last[node] and first[node] < last[other] for node in aligned) < MAX_NESTED:
            aligned.append(other)
            if len(aligned) == MAX_ALIGNED:
                break
    surface, ranking = SampledSurface(measures, node), []
    surroundings_difference = abs(_surroundings(other_measures, aligned)
                                  - _surroundings(measures, [node])).mean(axis=1) / measures.model_size
    for other, difference in zip(aligned, np.minimum(surroundings_difference, MAX_SURROUNDINGS_DIFFERENCE).tolist()):
        cost = (partial_cost[other] + SURROUNDINGS_WEIGHT * difference
                + DISTANCE_WEIGHT * aligned_distance(surface, SampledSurface(other_measures, other)) ** 2)
        # The last bits of matrix products depend on memory alignment; rounding keeps the likeness independent of it.
        ranking.append((-round(float(np.exp(-cost)), DIGITS), other))
    result: List[Tuple[int, float]] = []
    for negative_likeness, other in sorted(ranking):
        if all(last[other] <= first[similar] or first[other] >= last[similar] for similar, _ in result):
            result.append((other, -negative_likeness))
    return result


def _surroundings(measures: NodeMeasures, nodes: Sequence[int]) -> np.ndarray:
    """(n, 25) quantiles of the distances from each node's center to the surface of the whole model."""
    return np.quantile(np.sqrt(_squared_distances(measures.center[nodes], measures.model_points)), SURROUNDING_QUANTILES,
                       axis=1).T


class SampledSurface:
    """Points on a node's surface, relative to their centroid.

    fine_points : (FINE_SAMPLES, 3)
    points : (SAMPLES, 3)
    size : square root of the area
    axes : (3, 3) principal axes as rows, the longest first
    """

    def __init__(self, measures: NodeMeasures, node: int) -> None:
        corners = measures.corners[measures.first[node]:measures.last[node]]
        areas = triangle_areas(corners)
        self.fine_points = sample_triangles(corners, areas, FINE_SAMPLES)[0]
        self.points = sample_triangles(corners, areas, SAMPLES)[0]
        center = self.fine_points.mean(axis=0)
        self.fine_points -= center
        self.points -= center
        self.size = np.sqrt(max(areas.sum(), 1e-300))
        self.axes = np.linalg.eigh(self.fine_points.T @ self.fine_points)[1].T[::-1]


def aligned_distance(one: SampledSurface, other: SampledSurface) -> float:
    """The DISTANCE_QUANTILE of the distances between two surfaces, averaged over both directions, after the first is
    aligned with the other; relative to the other's size."""
    rotations, target = _candidate_rotations(one.axes, other.axes), other.points
    rough = np.sqrt(_squared_distances(one.points[::COARSE_STEP] @ rotations.transpose(0, 2, 1), target[::2]).min(axis=2)
                    ).mean(axis=1)
    if rough.min() > MAX_ROUGH_DISTANCE * other.size:
        return float(rough.min() / other.size)
    best = np.inf
    for rotation in rotations[np.argsort(rough.round(DIGITS), kind="stable")[:MAX_REFINED]]:
        rotation, translation = _refine_alignment(one.points, target, rotation)
        total = sum(np.sqrt(np.quantile(_squared_distances(points @ rotation.T + translation, targets).min(axis=axis),
                                        DISTANCE_QUANTILE))
                    for points, targets, axis in ((one.points, other.fine_points, 1), (one.fine_points, target, 0)))
        best = min(best, total / 2)
    return float(best / other.size)


def _candidate_rotations(axes: np.ndarray, other_axes: np.ndarray) -> np.ndarray:
    """(n, 3, 3) rotations and reflections that bring principal axes to others, with all signs, and ROTATION_COUNT angles
    about the longest axis."""
    angles = np.arange(ROTATION_COUNT) * np.pi / ROTATION_COUNT
    about_x = np.zeros((ROTATION_COUNT, 3, 3))
    about_x[:, 0, 0] = 1
    about_x[:, 1, 1] = about_x[:, 2, 2] = np.cos(angles)
    about_x[:, 2, 1] = np.sin(angles)
    about_x[:, 1, 2] = -about_x[:, 2, 1]
    signs = 1.0 - 2 * np.array(list(np.ndindex(2, 2, 2)))
    return np.einsum("ia,sa,tab,bj->stij", other_axes.T, signs, about_x, axes).reshape(-1, 3, 3)


def _refine_alignment(points: np.ndarray, target: np.ndarray, rotation: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """(rotation (3, 3), translation (3,)) after ICP from an initial rotation."""
    translation = np.zeros(3)
    for _ in range(ICP_ITERATIONS):
        moved = points @ rotation.T + translation
        squared = _squared_distances(moved, target)
        # Pairs in both directions, or a small surface could slide along a large one.
        pairs = (np.vstack([moved, moved[squared.argmin(axis=0)]]), np.vstack([target[squared.argmin(axis=1)], target]))
        step, shift = rigid_motion(*pairs)
        rotation, translation = step @ rotation, step @ translation + shift
    return rotation, translation


def _squared_distances(points: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """(..., n, m) squared distances between points (..., n, 3) and targets (m, 3)."""
    return np.maximum((points ** 2).sum(axis=-1)[..., None] + (targets ** 2).sum(axis=-1) - 2 * points @ targets.T, 0)


def best_node(hierarchy: Hierarchy, inside: np.ndarray) -> Tuple[int, float]:
    """(node, intersection over union of the face counts) of the node with the largest overlap with a set of faces, inside
    (F,) bool; of nodes with the same faces the one with the best score."""
    first, last = hierarchy.first, hierarchy.last
    intersection = slice_sums(inside[hierarchy.order], first, last)
    overlap = intersection / np.maximum(last - first + inside.sum() - intersection, 1)
    best = int(np.lexsort((hierarchy.score, overlap))[-1])
    return best, float(overlap[best])
