# SPDX-License-Identifier: GPL-3.0-or-later
"""The border of a part, moved to the creases nearby. Native, with numpy."""

import numpy as np

from .hierarchy import checked_surface
from .library import check, load


def snapped_border(vertices, triangles, faces, face_count, inside):
    """(face_count,) bool: the part with its border in the creases nearby, see pw_snapped_border in partwheel.h.

    vertices (V,3); triangles (T,3) indices into them; faces (T,) the polygon of each triangle and face_count their
    number, or both None where every triangle is one; inside (face_count,) bool: the part. Raises PartwheelError.
    """
    arrays, face_count = checked_surface(vertices, triangles, faces, face_count)
    inside = np.asarray(inside)
    if inside.dtype != bool:
        raise TypeError(f"inside must be bool, not {inside.dtype}.")
    if inside.shape != (face_count,):
        raise ValueError(f"inside must have the shape ({face_count},), not {inside.shape}.")
    inside = np.ascontiguousarray(inside)
    result = np.empty_like(inside)
    vertices, triangles, faces = (*arrays, None)[:3]
    check(load().pw_snapped_border(vertices.ctypes.data, len(vertices), triangles.ctypes.data, len(triangles),
                                   None if faces is None else faces.ctypes.data, face_count, inside.ctypes.data,
                                   result.ctypes.data))
    return result
