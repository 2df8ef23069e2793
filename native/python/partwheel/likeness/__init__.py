# SPDX-License-Identifier: GPL-3.0-or-later
"""Which parts of a model are alike, and which are each other's mirror images."""

from .mirrored import Image, mirrored
from .similar import THRESHOLD, measures, nearest, similar

__all__ = ["THRESHOLD", "Image", "measures", "mirrored", "nearest", "similar"]
