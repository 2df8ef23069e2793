# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components."""

import numpy as np


def components(count: int, pairs: np.ndarray) -> np.ndarray:
    """Connected components of a graph, by label propagation with pointer jumping.

    Parameters
    ----------
    count : number of vertices
    pairs : (n, 2) edges

    Returns
    -------
    (count,) the component of each vertex, numbered from 0 by their lowest vertices
    """
    lowest = np.arange(count)
    while True:
        ends = lowest[pairs]
        low, high = ends.min(axis=1), ends.max(axis=1)
        differs = low < high
        if not differs.any():
            return np.unique(lowest, return_inverse=True)[1].ravel()
        pairs, low, high = pairs[differs], low[differs], high[differs]
        order = np.argsort(-low, kind="stable")  # the lowest label is written last, and stays
        lowest[high[order]] = low[order]
        while ((jumped := lowest[lowest]) != lowest).any():
            lowest = jumped
