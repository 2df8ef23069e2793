# SPDX-License-Identifier: GPL-3.0-or-later
"""Canonical axes for a model, whichever axis of a file points up. Parts and cuts depend on the axes, through rounding and points
added inside; a model that is turned to its canonical axes first becomes the same pieces in all orientations."""

import numpy as np

STEPS = 1024  # on either side of the center, to which coordinates are rounded, so that sums are exact


def upright(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(3, 3) the rotation by right angles after which a surface has its long axis along z and its short one along y, both
    with their heavier sides up. For a model that is nearly the same when turned, such as a cube, other orientations of
    the file may give another rotation."""
    corners = vertices[triangles.ravel()]
    if not len(corners) or not np.isfinite(corners).all():
        return np.eye(3)  # nothing to turn
    low, high = corners.min(axis=0), corners.max(axis=0)
    offsets = np.rint((corners - (low / 2 + high / 2)) * (2 * STEPS / max((high - low).max(), 1e-100))).astype(np.int64)
    second, third = (offsets ** 2).sum(axis=0), (offsets ** 3).sum(axis=0)
    order = np.lexsort([-abs(third), -second])[[1, 2, 0]]
    turn = np.eye(3)[order] * np.where(third[order] < 0, -1, 1)[:, None]
    # The axis across which the model is most symmetric has the direction that makes it a rotation.
    turn[abs(third[order]).argmin()] *= np.linalg.det(turn)
    return turn
