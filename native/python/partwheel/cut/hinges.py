# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a joint is to turn, so that what bends there keeps its volume."""

import numpy as np

FARTHEST = 0.5  # of a border's radius: so far from its middle at most; borders of several loops have no better place
SLANTED = 1e-3  # of a border's radius squared: loops that enclose less have no place of their own


def hinge(vertices, triangles, border, share):
    """(3,) a place beside the Border's middle: turned about any axis through it, each vertex by its share (V,) of a small
    angle, the surface keeps its volume, and nearly so by a large one. vertices (V,3), triangles (T,3).

    Each vertex turning by its share w, the volume changes by the integral of grad w . (axis x (x - hinge)). That is to
    vanish for all axes, so hinge x G = M with G = integral of grad w, M = integral of x x grad w. By Stokes both are
    integrals along the lines of equal w on the surface, so only triangles count where w changes, and holes elsewhere
    don't matter: G = 1/2 of that of x x dl, M = -1/2 of that of x^2 dl. What is along G is free, and left as it is."""
    at = share[triangles]
    changes = np.ptp(at, axis=1) > 0
    corners, at = vertices[triangles[changes]] - border.center, at[changes]
    opposite = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    line = (at[:, :, None] * opposite).sum(axis=1) / 2  # of all lines in a triangle, dl dw
    squared = ((corners ** 2).sum(axis=(1, 2)) + (corners.sum(axis=1) ** 2).sum(axis=1)) / 12  # the mean of x^2
    area = np.cross(corners.mean(axis=1), line).sum(axis=0) / 2
    moment = -(squared[:, None] * line).sum(axis=0) / 2
    size = area @ area
    if size <= (SLANTED * border.radius ** 2) ** 2:
        return border.center
    away = np.cross(area, moment) / size
    return border.center + away * min(1, FARTHEST * border.radius / max(np.linalg.norm(away), 1e-300))
