# SPDX-License-Identifier: GPL-3.0-or-later
"""Collision shapes, convex hulls or primitives, in the file formats of engines and robot simulators."""

from .files import FORMATS, UNREAL_PREFIXES, write, write_obj
from .primitives import KINDS, Primitive, fit_primitive, kind_of

__all__ = ["FORMATS", "KINDS", "UNREAL_PREFIXES", "Primitive", "fit_primitive", "kind_of", "write", "write_obj"]
