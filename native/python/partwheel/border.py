# SPDX-License-Identifier: GPL-3.0-or-later
"""The border of a part, moved to the creases nearby. Native, with numpy."""

from ctypes import byref, c_void_p

import numpy as np

from .hierarchy import _Handle, checked_surface
from .library import check, load


class Creases:
    """A surface whose parts' borders can be moved to creases: see pw_creases in partwheel_edit.h. It never changes.

    vertices (V,3); triangles (T,3) indices into them; faces (T,) the polygon of each triangle and face_count their
    number, or both None where every triangle is one. Raises PartwheelError.
    """

    def __init__(self, vertices, triangles, faces=None, face_count=None):
        arrays, self.face_count = checked_surface(vertices, triangles, faces, face_count)
        vertices, triangles, faces = (*arrays, None)[:3]
        address = c_void_p()
        check(load().pw_creases_create(vertices.ctypes.data, len(vertices), triangles.ctypes.data, len(triangles),
                                       None if faces is None else faces.ctypes.data, self.face_count, byref(address)))
        self._handle = _Handle(address.value, load().pw_creases_free)

    def snapped(self, inside):
        """(face_count,) bool: a part with its border in the creases nearby, at the least cost. inside (face_count,)
        bool: the part. Raises PartwheelError for one without faces."""
        inside = np.asarray(inside)
        if inside.dtype != bool:
            raise TypeError(f"inside must be bool, not {inside.dtype}.")
        if inside.shape != (self.face_count,):
            raise ValueError(f"inside must have the shape ({self.face_count},), not {inside.shape}.")
        inside = np.ascontiguousarray(inside)
        result = np.empty_like(inside)
        check(load().pw_creases_snap(self._handle.address, inside.ctypes.data, len(inside), result.ctypes.data))
        return result


def snapped_border(vertices, triangles, faces, face_count, inside):
    """Creases(...).snapped(inside), for one part of a surface."""
    return Creases(vertices, triangles, faces, face_count).snapped(inside)
