# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors of parts."""

import numpy as np
from numpy.typing import ArrayLike


def colors(numbers: ArrayLike) -> np.ndarray:
    """(n, 3) RGB, 0 to 1, for whole numbers (n,); numbers that are close get colors that are far apart (golden-ratio
    hues)."""
    numbers = np.asarray(numbers)
    hue = (numbers * 0.6180339887) % 1
    value = 0.75 + 0.25 * ((numbers * 0.7548776662) % 1)
    rgb = np.clip(np.abs((hue[:, None] * 6 + [0, 4, 2]) % 6 - 3) - 1, 0, 1)
    return value[:, None] * (0.35 + 0.65 * rgb)
