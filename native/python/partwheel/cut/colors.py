# SPDX-License-Identifier: GPL-3.0-or-later
"""Colours of parts."""

import numpy as np


def colors(numbers):
    """(n,3) a colour, 0..1, for each whole number (n,), far from those of the numbers next to it."""
    numbers = np.asarray(numbers)
    hue = (numbers * 0.6180339887) % 1
    value = 0.75 + 0.25 * ((numbers * 0.7548776662) % 1)
    bow = np.clip(np.abs((hue[:, None] * 6 + [0, 4, 2]) % 6 - 3) - 1, 0, 1)
    return value[:, None] * (0.35 + 0.65 * bow)
