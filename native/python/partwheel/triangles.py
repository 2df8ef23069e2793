# SPDX-License-Identifier: GPL-3.0-or-later
"""Sides and areas of triangles, and points on them."""

from typing import Tuple

import numpy as np
from numpy.typing import ArrayLike


def side_ends(triangles: ArrayLike) -> np.ndarray:
    """(3 T, 2) both ends of each side of triangles (T, 3), the lower one first."""
    return np.sort(np.asarray(triangles)[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)


def doubled_area_vectors(corners: np.ndarray) -> np.ndarray:
    """(T, 3) normals of triangles (T, 3, 3), whose lengths are twice the areas."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def triangle_areas(corners: np.ndarray) -> np.ndarray:
    """(T,) areas of triangles (T, 3, 3)."""
    return np.linalg.norm(doubled_area_vectors(corners), axis=1) / 2


def unit_vectors(vectors: np.ndarray) -> np.ndarray:
    """(..., 3) vectors scaled to length 1; zeros stay."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)


def winding_number(corners: np.ndarray) -> float:
    """How often triangles, by their first, second and third corners (3, T, 3), wind around the origin: the sum of their solid
    angles (van Oosterom and Strackee 1983), by 4 pi. Not an integer if they have an open border."""
    a, b, c = corners
    (la, lb, lc), dot = np.linalg.norm(corners, axis=2), lambda u, v: np.einsum("ij,ij->i", u, v)
    angles = np.arctan2(dot(a, np.cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
    return float(angles.sum() / (2 * np.pi))


def second_moments(weights: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """(3, 3) the sum of c c^T over the corners c of simplices (T, k, 3), plus s s^T of their sum s, by weights (T,): of
    a triangle of area A, A / 12 times this is the integral of x x^T; of a tetrahedron of volume V, V / 20 times this."""
    sums = corners.sum(axis=1)
    return np.einsum("t,tki,tkj->ij", weights, corners, corners) + np.einsum("t,ti,tj->ij", weights, sums, sums)


def sample_triangles(corners: np.ndarray, areas: np.ndarray, count: int) -> Tuple[np.ndarray, np.ndarray]:
    """(points (count, 3), triangle of each (count,)), evenly distributed on triangles with corners (T, 3, 3) and
    areas (T,), from a low-discrepancy sequence, the same ones at every call."""
    total = np.cumsum(areas)
    number = np.arange(count)
    sampled = np.minimum(np.searchsorted(total, (number + 0.5) / count * total[-1]), len(corners) - 1)
    # The R2 sequence, by powers of the plastic number (Roberts 2018), folded into the triangle.
    u, v = (0.5 + number * 0.7548776662466927) % 1, (0.5 + number * 0.5698402909980532) % 1
    is_outside = u + v > 1
    u, v = np.where(is_outside, 1 - u, u), np.where(is_outside, 1 - v, v)
    a, b, c = corners[sampled].transpose(1, 0, 2)
    return a + u[:, None] * (b - a) + v[:, None] * (c - a), sampled


def nearest_targets(points: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """(n,) the nearest target (m, 3) of each point (n, 3); by matrix products, in blocks."""
    center = targets.mean(axis=0)
    _, exponent = np.frexp(abs(targets - center).max())  # the squares of huge lengths are beyond float32
    points, targets = (np.ldexp(array - center, -exponent).astype(np.float32) for array in (points, targets))
    squared_norms = (targets ** 2).sum(axis=1)
    return np.concatenate([(squared_norms - 2 * block @ targets.T).argmin(axis=1) for block in np.array_split(points, 16)])
