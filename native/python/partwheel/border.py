# SPDX-License-Identifier: GPL-3.0-or-later
"""The border of a part, moved to the creases nearby. Native, with numpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional

import numpy as np

from .hierarchy import surface
from .library import Handle, NonCopyable, check, load, made
from .weld import weld_surface

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Creases(NonCopyable):
    """A surface whose parts' borders can be moved to creases: see pw_creases in partwheel_edit.h. It never changes.

    vertices (V,3); triangles (T,3) indices into them; faces (T,) the polygon of each triangle and face_count their
    number, or both None where every triangle is one. Coincident vertices are welded. Raises PartwheelError.
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
                 face_count: Optional[int] = None) -> None:
        *given, self.face_count = surface(vertices, triangles, faces, face_count)
        _, given[2] = weld_surface(given[0], given[2])
        self._handle = Handle(load().pw_creases_free, made(load().pw_creases_create, *given, self.face_count))

    def snapped(self, inside: ArrayLike) -> np.ndarray:
        """(face_count,) bool: a part with its border in the creases nearby, at the least cost. inside (face_count,)
        bool: the part. Raises PartwheelError for one without faces."""
        inside = np.asarray(inside)
        if inside.dtype != bool:
            raise TypeError(f"inside must be bool, not {inside.dtype}.")
        if inside.shape != (self.face_count,):
            raise ValueError(f"inside must have the shape ({self.face_count},), not {inside.shape}.")
        inside = np.ascontiguousarray(inside)
        result = np.empty_like(inside)
        check(load().pw_creases_snap(self._handle, inside, len(inside), result))
        return result


def snapped_border(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike], face_count: Optional[int],
                   inside: ArrayLike) -> np.ndarray:
    """Creases(...).snapped(inside), for one part of a surface."""
    return Creases(vertices, triangles, faces, face_count).snapped(inside)
