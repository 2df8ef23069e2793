# SPDX-License-Identifier: GPL-3.0-or-later
"""The first triangle of a surface that a ray meets. Native, with numpy."""

from __future__ import annotations

from ctypes import c_double, c_int32
from typing import TYPE_CHECKING, Optional, Sequence, Tuple

from .hierarchy import surface
from .library import Handle, NonCopyable, load, made, told

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class RayTarget(NonCopyable):
    """A surface that rays can be sent at: see pw_ray_target in partwheel_edit.h. It never changes.

    vertices (V,3); triangles (T,3) indices into them. Raises PartwheelError.
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike) -> None:
        given = surface(vertices, triangles)[:4]
        self._handle = Handle(load().pw_ray_target_free, made(load().pw_ray_target_create, *given))

    def first(self, origin: Sequence[float], direction: Sequence[float],
              beyond: float = 0.0) -> Optional[Tuple[int, float]]:
        """(triangle, distance) of the first hit farther than beyond, or None. origin, direction (3,); distances are in
        lengths of the direction. Raises PartwheelError for a ray that has none."""
        origin, direction = ((c_double * 3)(*each) for each in (origin, direction))
        ray = origin, direction, beyond
        triangle, distance = told([c_int32, c_double], load().pw_ray_target_first, self._handle, *ray)
        return None if triangle < 0 else (triangle, distance)
