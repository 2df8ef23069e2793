# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls, and primitives in their place, as engines and robot simulators read them."""

from .files import FORMATS, write, write_obj
from .primitives import Primitive, around

__all__ = ["FORMATS", "Primitive", "around", "write", "write_obj"]
