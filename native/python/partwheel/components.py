# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components."""

import numpy as np


def to_mask(count: int, numbers: np.ndarray) -> np.ndarray:
    """(count,) bool: whether each number from 0 is one of these."""
    mask = np.zeros(count, bool)
    mask[numbers] = True
    return mask


def components(count: int, pairs: np.ndarray) -> np.ndarray:
    """(count,) the connected component of each vertex of a graph with edges pairs (n, 2), numbered from 0 by their lowest
    vertices. By label propagation with pointer jumping."""
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


def edge_components(edges: np.ndarray) -> np.ndarray:
    """(n,) the connected component of each edge (n, 2), from 0; vertices may have any numbers."""
    vertices, ends = np.unique(edges, return_inverse=True)
    ends = ends.reshape(-1, 2)
    return components(len(vertices), ends)[ends[:, 0]]


def triangle_components(triangles: np.ndarray) -> np.ndarray:
    """(T,) int, the component of each triangle (T, 3), from 0; a common vertex connects."""
    return edge_components(triangles[:, [[0, 1], [1, 2]]].reshape(-1, 2))[::2]
