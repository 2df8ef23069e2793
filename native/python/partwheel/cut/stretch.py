# SPDX-License-Identifier: GPL-3.0-or-later
"""The area distortion and the outline of a conformal map of a disk, without computing the map. The scale factor e^u follows
from the curvature: L u = -K, with cotangent weights L and angle defects K, and u = 0 on the boundary."""

from __future__ import annotations

from typing import TYPE_CHECKING, Callable, List, Optional

import numpy as np

if TYPE_CHECKING:
    from .patches import Patch, SeamMesh

MAX_COTANGENT = 50.0  # cotangents of degenerate triangles are clamped to this
SOLVER_TOLERANCE = 1e-4  # of conjugate gradients: relative residual
MAX_SOLVER_ITERATIONS = 3000
SMOOTHING_ROUNDS = 3  # of |u|, so that a peak is more than a single sharp vertex
SADDLE_WEIGHT = 0.5  # of u > 0 (saddles) relative to u < 0: cuts to saddles make the outline overlap itself
MIN_PEAK_FRACTION = 0.5  # of the highest peak
MIN_PEAK_SPACING = 2.0  # between peaks, in distances from the boundary
PEAK_DIGITS = 6  # decimals of relative heights: mirror images have equal ones, then the lower vertex comes first
MAX_TRIANGLE_FACTOR = 10.0  # limit of a triangle's area distortion in measure_distortion()
GRID_SIZE = 192  # pixels along the longer side of an outline's bounding box


class ConformalMap:
    """The conformal map of a disk to the plane that keeps the length of the boundary, which minimizes area distortion
    (Springborn, Schroeder, Pinkall 2008).

    log_scale : (vertices,) u, the logarithm of the scale factor at each vertex: negative on bulges, positive on saddles
    turning_angle : (vertices,) at a boundary vertex: the angle by which the outline turns there
    """

    def __init__(self, patch: Patch, previous: Optional[ConformalMap] = None) -> None:
        """previous : the map of the same mesh with fewer cuts, as the solver's initial guess"""
        self.patch, count, triangles = patch, patch.vertex_count, patch.triangles
        is_inner = ~patch.is_boundary
        angle, cotangent = patch.mesh.angles
        angle_defect = 2 * np.pi - np.bincount(triangles.ravel(), angle.ravel(), count)
        # The weight of an edge: half the sum of the cotangents of the corners opposite to it.
        a, b = triangles[:, [1, 2, 0]].ravel(), triangles[:, [2, 0, 1]].ravel()
        weight = np.clip(cotangent.ravel(), -MAX_COTANGENT, MAX_COTANGENT) / 2
        low, high = np.minimum(a, b), np.maximum(a, b)
        keys, edge = np.unique(low * count + high, return_inverse=True)
        low, high, weight = keys // count, keys % count, np.bincount(edge.ravel(), weight)
        diagonal = np.bincount(low, weight, count) + np.bincount(high, weight, count)

        def laplacian(values: np.ndarray) -> np.ndarray:
            return (diagonal * values - np.bincount(low, weight * values[high], count)
                    - np.bincount(high, weight * values[low], count))

        guess = np.zeros(count)
        if previous:
            guess[triangles] = previous.log_scale[previous.patch.triangles]
            guess[patch.is_boundary] = 0
        self.log_scale: np.ndarray = _conjugate_gradients(
            lambda values: np.where(is_inner, laplacian(values), 0), np.where(is_inner, -angle_defect, 0),
            np.where(diagonal > 0, diagonal, 1), guess)
        self.turning_angle = angle_defect - np.pi + laplacian(self.log_scale)

    def area_distortion(self) -> float:
        """See _area_distortion()."""
        return _area_distortion(np.exp(np.clip(2 * self.log_scale[self.patch.triangles].mean(axis=1), -50, 50)),
                                self.patch.mesh.areas)

    def peaks(self, boundary_distance: np.ndarray, max_count: int) -> List[int]:
        """The vertices where |u|, smoothed, is largest. Each is farther from the other ones than from the boundary.

        Parameters
        ----------
        boundary_distance : (vertices,) distance of each vertex from the boundary
        max_count : maximum number of peaks
        """
        patch, smooth = self.patch, self.log_scale
        a, b = patch.uncut_ends.T
        degree = 1 + np.bincount(a, minlength=patch.vertex_count) + np.bincount(b, minlength=patch.vertex_count)
        for _ in range(SMOOTHING_ROUNDS):
            smooth = np.where(patch.is_boundary, 0, (smooth + np.bincount(a, smooth[b], patch.vertex_count)
                                                     + np.bincount(b, smooth[a], patch.vertex_count)) / degree)
        height = np.where(smooth < 0, -smooth, SADDLE_WEIGHT * smooth)
        height = np.round(height / max(height.max(initial=0), 1e-300), PEAK_DIGITS)
        positions = np.empty((patch.vertex_count, 3))
        positions[patch.triangles] = patch.mesh.positions[patch.mesh.triangles]
        candidates = np.flatnonzero((height > MIN_PEAK_FRACTION) & np.isfinite(boundary_distance))
        candidates = candidates[np.argsort(-height[candidates], kind="stable")]
        peaks: List[int] = []
        while len(candidates) and len(peaks) < max_count:
            peaks.append(int(candidates[0]))
            distance = np.linalg.norm(positions[candidates] - positions[candidates[0]], axis=1)
            candidates = candidates[distance > MIN_PEAK_SPACING * np.maximum(boundary_distance[candidates],
                                                                             boundary_distance[candidates[0]])]
        return peaks

    def overlap_fraction(self) -> float:
        """The fraction of the area inside the outline that the map covers more than once."""
        vertices, lengths = self.patch.boundary_loop()
        heading = np.cumsum(self.turning_angle[vertices])
        steps = lengths[:, None] * np.column_stack([np.cos(heading), np.sin(heading)])
        steps -= lengths[:, None] * (steps.sum(axis=0) / max(lengths.sum(), 1e-300))  # closes the outline
        return _overlap_fraction(np.cumsum(steps, axis=0))


def measure_distortion(mesh: SeamMesh, uv: np.ndarray) -> float:
    """The area distortion of an unwrapping, comparable to ConformalMap.area_distortion(). A triangle counts at most
    MAX_TRIANGLE_FACTOR.

    Parameters
    ----------
    uv : (T, 3, 2) UVs of the triangles' corners
    """
    a, b, c = uv.transpose(1, 0, 2)
    doubled_areas = abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    return _area_distortion(doubled_areas / np.maximum(mesh.areas, 1e-300), mesh.areas, MAX_TRIANGLE_FACTOR)


def _area_distortion(factor: np.ndarray, areas: np.ndarray, max_factor: float = 1e9) -> float:
    """The area-weighted mean of max(f, 1/f), with f the factor (T,) by which each triangle's area is scaled, relative to
    the mean factor; 1 if there is no distortion."""
    weight = areas / max(areas.sum(), 1e-300)
    factor = factor / max(_dot(factor, weight), 1e-300)
    return _dot(np.minimum(np.maximum(factor, 1 / np.maximum(factor, 1e-9)), max_factor), weight)


def _overlap_fraction(outline: np.ndarray) -> float:
    """The fraction of the inside of a closed polygon (n, 2) where its winding number exceeds 1 in size; by the pixels of a
    grid, with one scanline per row."""
    low, size = outline.min(axis=0), np.ptp(outline, axis=0).max()
    if not size > 0:
        return 0.0
    x, y = ((outline - low) * (GRID_SIZE / size)).T
    next_x, next_y = np.roll(x, -1), np.roll(y, -1)
    first, last = np.ceil(np.minimum(y, next_y) - 0.5), np.ceil(np.maximum(y, next_y) - 0.5)
    row_count = (last - first).astype(int)
    edge = np.repeat(np.arange(len(x)), row_count)  # of each crossing of an edge and a row
    row = first[edge] + np.arange(len(edge)) - np.repeat(np.cumsum(row_count) - row_count, row_count)
    crossing = x[edge] + (row + 0.5 - y[edge]) / (next_y - y)[edge] * (next_x - x)[edge]
    column = np.clip(np.ceil(crossing - 0.5), 0, GRID_SIZE).astype(int)
    winding = np.zeros((GRID_SIZE + 1, GRID_SIZE + 1))
    np.add.at(winding, (np.clip(row, 0, GRID_SIZE).astype(int), column), np.where(next_y < y, 1, -1)[edge])
    winding = abs(np.cumsum(winding, axis=1))
    return np.count_nonzero(winding > 1) / max(int(np.count_nonzero(winding)), 1)


def _conjugate_gradients(operator: Callable[[np.ndarray], np.ndarray], right_side: np.ndarray, diagonal: np.ndarray,
                         guess: np.ndarray) -> np.ndarray:
    """Solve operator(x) = right_side with the Jacobi preconditioner; stops where the operator is not positive definite."""
    x, residual = guess, right_side - operator(guess)
    goal = SOLVER_TOLERANCE * SOLVER_TOLERANCE * _dot(right_side, right_side / diagonal)
    preconditioned = residual / diagonal
    direction, squared_norm = preconditioned, _dot(residual, preconditioned)
    for _ in range(MAX_SOLVER_ITERATIONS):
        if squared_norm <= goal:
            break
        image = operator(direction)
        curvature = _dot(direction, image)
        if curvature <= 0:
            break
        x = x + squared_norm / curvature * direction
        residual = residual - squared_norm / curvature * image
        preconditioned = residual / diagonal
        squared_norm, before = _dot(residual, preconditioned), squared_norm
        direction = preconditioned + squared_norm / before * direction
    return x


def _dot(one: np.ndarray, other: np.ndarray) -> float:
    """The dot product without BLAS, whose order of additions depends on the processor, and which waits for its threads."""
    return float((one * other).sum())
