# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls as engines and robot simulators read them."""

from .files import FORMATS, write, write_obj

__all__ = ["FORMATS", "write", "write_obj"]
