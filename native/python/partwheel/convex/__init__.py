# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls, and primitives in their place, as engines and robot simulators read them."""

from .files import FORMATS, UNREAL, write, write_obj
from .primitives import KINDS, Primitive, around, kind_of

__all__ = ["FORMATS", "KINDS", "UNREAL", "Primitive", "around", "kind_of", "write", "write_obj"]
