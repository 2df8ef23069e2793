# SPDX-License-Identifier: GPL-3.0-or-later
"""Fairing: makes a band of a surface as smooth as its surroundings allow. Native, with numpy."""

import numpy as np
from numpy.typing import ArrayLike

from .hierarchy import to_array
from .library import check, load


def fair_vertices(vertices: ArrayLike, edges: ArrayLike, free: ArrayLike) -> np.ndarray:
    """Move the free vertices to where the surface is smoothest; the other vertices stay. See pw_fair_vertices in
    partwheel_edit.h for the energy.

    Parameters
    ----------
    vertices : (V, 3) float
    edges : (E, 2) int, indices into vertices
    free : (V,) bool

    Returns
    -------
    (V, 3) float64, all vertices

    Raises
    ------
    PartwheelError : an edge has a vertex that does not exist, or a coordinate is not finite
    ValueError : an array has another shape
    """
    vertices, edges = to_array(vertices, "vertices", np.float64, (None, 3)), to_array(edges, "edges", np.int32, (None, 2))
    free = to_array(free, "free", bool, (len(vertices),))
    result = np.empty_like(vertices)
    check(load().pw_fair_vertices(None, vertices, len(vertices), edges, len(edges), free, result))
    return result
