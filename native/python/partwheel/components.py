# SPDX-License-Identifier: GPL-3.0-or-later
"""Connected components."""

import numpy as np


def components(count, pairs):
    """(count,) the number, from 0, of the group that each is in: both of a pair (n,2) are in one."""
    lowest = np.arange(count)
    while True:
        ends = lowest[pairs]
        low, high = ends.min(axis=1), ends.max(axis=1)
        apart = low < high
        if not apart.any():
            return np.unique(lowest, return_inverse=True)[1].ravel()
        pairs, low, high = pairs[apart], low[apart], high[apart]
        order = np.argsort(-low, kind="stable")  # the lowest one is written last
        lowest[high[order]] = low[order]
        while ((further := lowest[lowest]) != lowest).any():
            lowest = further
