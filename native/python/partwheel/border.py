# SPDX-License-Identifier: GPL-3.0-or-later
"""Border snapping: moves the border of a part into the creases nearby. Native, with numpy."""

from typing import Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike

from .hierarchy import to_array, to_mesh_view
from .library import MeshView, NonCopyable, check, create_handle, load
from .weld import weld_surface


def to_welded_mesh_view(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike],
                        face_count: Optional[int]) -> Tuple[MeshView, np.ndarray]:
    """(the surface with coincident vertices welded, old_to_new (V,): see weld_surface()). Parameters, errors: see Creases."""
    mesh = to_mesh_view(vertices, triangles, faces, face_count)
    points, corners, face_of_triangle = mesh.arrays
    old_to_new, corners = weld_surface(points, corners)
    return to_mesh_view(points, corners, face_of_triangle, mesh.face_count), old_to_new


class Creases(NonCopyable):
    """The creases of a surface, to snap the borders of any number of its parts: see pw_creases in partwheel_edit.h.
    Immutable.

    Parameters
    ----------
    vertices : (V, 3) float
    triangles : (T, 3) int, indices into vertices. Coincident vertices are welded
    faces : (T,) int, the polygon of each triangle; None if each triangle is a polygon
    face_count : F, the number of polygons; None for the highest in faces plus 1

    Raises
    ------
    PartwheelError : the surface is invalid
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
                 face_count: Optional[int] = None) -> None:
        mesh, _ = to_welded_mesh_view(vertices, triangles, faces, face_count)
        self.face_count = mesh.face_count
        self._handle = create_handle(load().pw_creases_free, load().pw_creases_create, None, mesh)

    def snap(self, inside: ArrayLike) -> np.ndarray:
        """Move the border of a part into the creases nearby, by a minimum cut.

        Parameters
        ----------
        inside : (F,) bool, the faces of the part

        Returns
        -------
        (F,) bool, the faces of the part after border snapping

        Raises
        ------
        PartwheelError : the part has no face
        TypeError, ValueError : inside has another dtype or shape
        """
        inside = np.asarray(inside)
        if inside.dtype != bool:
            raise TypeError(f"inside must be bool, not {inside.dtype}.")
        inside = to_array(inside, "inside", bool, (self.face_count,))
        result = np.empty_like(inside)
        check(load().pw_creases_snap(self._handle, inside, len(inside), result))
        return result
