# SPDX-License-Identifier: GPL-3.0-or-later
"""A band of a surface made as smooth as its surroundings let it be. Native, with numpy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .library import check, load

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def faired(vertices: ArrayLike, edges: ArrayLike, free: ArrayLike) -> np.ndarray:
    """(V,3) the vertices, of which the free ones lie as smoothly as the others let them, see pw_faired in partwheel_edit.h.
    vertices (V,3), edges (E,2) vertex indices, free (V,) bool. Raises PartwheelError."""
    vertices, edges = np.ascontiguousarray(vertices, np.float64), np.ascontiguousarray(edges, np.int32)
    free = np.ascontiguousarray(free, bool)
    if vertices.shape[1:] != (3,) or edges.shape[1:] != (2,) or free.shape != vertices.shape[:1]:
        raise ValueError("vertices must be (V,3), edges (E,2) and free (V,).")
    result = np.empty_like(vertices)
    check(load().pw_faired(vertices, len(vertices), edges, len(edges), free, result))
    return result
