# SPDX-License-Identifier: GPL-3.0-or-later
"""The center of rotation of a joint that keeps the volume of the bent surface."""


import numpy as np

from .borders import PartBorder

MAX_OFFSET = 0.5  # largest distance from the border's center, in its radii; several loops may have no better center
MIN_VECTOR_AREA = 1e-3  # in squared radii of the border: below it the hinge is undetermined, and the center is used


def hinge(vertices: np.ndarray, triangles: np.ndarray, border: PartBorder, weight: np.ndarray) -> np.ndarray:
    """(3,) the center h of a joint's rotation that keeps the volume: for any axis exactly to first order in the angle, nearly
    so for large angles.

    If each vertex x turns by w(x), its weight from 0 to 1, times a small angle about an axis through h, the volume changes by
    the integral of grad w . (axis x (x - h)). This vanishes for all axes if h x G = M, with G the integral of grad w and M
    the integral of x x grad w. By Stokes, both are integrals along the level curves of w on the surface: G = 1/2 integral x x
    dl dw, M = -1/2 integral |x|^2 dl dw. So only triangles where w changes count, and holes elsewhere don't matter. The
    component of h along G is free; it is the border center's."""
    corner_weights = weight[triangles]
    is_changing = np.ptp(corner_weights, axis=1) > 0
    corners, corner_weights = vertices[triangles[is_changing]] - border.center, corner_weights[is_changing]
    opposite_edges = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    line = (corner_weights[:, :, None] * opposite_edges).sum(axis=1) / 2  # integral of dl dw over each triangle
    mean_square = ((corners ** 2).sum(axis=(1, 2)) + (corners.sum(axis=1) ** 2).sum(axis=1)) / 12  # mean |x|^2
    area = np.cross(corners.mean(axis=1), line).sum(axis=0) / 2
    moment = -(mean_square[:, None] * line).sum(axis=0) / 2
    squared_area = area @ area
    if squared_area <= (MIN_VECTOR_AREA * border.radius ** 2) ** 2:
        return border.center
    offset = np.cross(area, moment) / squared_area
    return border.center + offset * min(1, MAX_OFFSET * border.radius / max(float(np.linalg.norm(offset)), 1e-300))
