# SPDX-License-Identifier: GPL-3.0-or-later
"""Collision shapes, convex hulls or primitives, in the file formats of engines and robot simulators."""

from .files import FORMATS, UNREAL_PREFIXES, write, write_obj
from .mass import DEFAULT_DENSITY, MassProperties, mass_properties
from .primitives import KINDS, Primitive, fit_primitive, kind_of
from .robots import Robot, UrdfError, convert_urdf

__all__ = ["DEFAULT_DENSITY", "FORMATS", "KINDS", "UNREAL_PREFIXES", "MassProperties", "Primitive", "Robot", "UrdfError",
           "convert_urdf", "fit_primitive", "kind_of", "mass_properties", "write", "write_obj"]
