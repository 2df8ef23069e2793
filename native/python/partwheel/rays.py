# SPDX-License-Identifier: GPL-3.0-or-later
"""Ray casting: the first triangle of a surface that a ray hits. Native, with numpy."""

from ctypes import c_double, c_int32
from typing import Optional, Sequence, Tuple

from numpy.typing import ArrayLike

from .hierarchy import to_mesh_view
from .library import NonCopyable, call_with_outputs, create_handle, load


class RayTarget(NonCopyable):
    """A surface to cast rays at, with a bounding volume hierarchy: see pw_ray_target in partwheel_edit.h. Immutable.

    Parameters
    ----------
    vertices : (V, 3) float
    triangles : (T, 3) int, indices into vertices

    Raises
    ------
    PartwheelError : the surface is invalid
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike) -> None:
        mesh = to_mesh_view(vertices, triangles)
        self._handle = create_handle(load().pw_ray_target_free, load().pw_ray_target_create, None, mesh)

    def first_hit(self, origin: Sequence[float], direction: Sequence[float],
                  min_distance: float = 0.0) -> Optional[Tuple[int, float]]:
        """The nearest hit that is farther than min_distance.

        Parameters
        ----------
        origin, direction : (3,)
        min_distance : in lengths of the direction

        Returns
        -------
        (triangle, distance), the distance in lengths of the direction; None if the ray hits nothing

        Raises
        ------
        PartwheelError : the direction is zero or not finite
        """
        origin, direction = ((c_double * 3)(*vector) for vector in (origin, direction))
        ray = origin, direction, min_distance
        triangle, distance = call_with_outputs([c_int32, c_double], load().pw_ray_target_first, self._handle, *ray)
        return None if triangle < 0 else (triangle, distance)
