# SPDX-License-Identifier: GPL-3.0-or-later
"""The first triangle of a surface that a ray meets. Native, with numpy."""

from ctypes import byref, c_double, c_int32, c_void_p

import numpy as np

from .hierarchy import _Handle, checked_surface
from .library import check, load


class RayTarget:
    """A surface that rays can be sent at: see pw_ray_target in partwheel_edit.h. It never changes.

    vertices (V,3); triangles (T,3) indices into them. Raises PartwheelError.
    """

    def __init__(self, vertices, triangles):
        (vertices, triangles), _ = checked_surface(vertices, triangles, None, None)
        address = c_void_p()
        check(load().pw_ray_target_create(vertices.ctypes.data, len(vertices), triangles.ctypes.data, len(triangles),
                                          byref(address)))
        self._handle = _Handle(address.value, load().pw_ray_target_free)

    def first(self, origin, direction, beyond=0.0):
        """(triangle, distance) of the first hit farther than beyond, or None. origin, direction (3,); distances are in
        lengths of the direction. Raises PartwheelError for a ray that has none."""
        origin, direction = ((c_double * 3)(*each) for each in (origin, direction))
        triangle, distance = c_int32(), c_double()
        check(load().pw_ray_target_first(self._handle.address, origin, direction, beyond, byref(triangle),
                                         byref(distance)))
        return None if triangle.value < 0 else (triangle.value, distance.value)
