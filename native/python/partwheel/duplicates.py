# SPDX-License-Identifier: GPL-3.0-or-later
"""Duplicate faces of a surface."""

from typing import Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike

from .components import components
from .hierarchy import Hierarchy, to_mesh_view
from .library import check, load


def duplicate_faces(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
                    face_count: Optional[int] = None) -> np.ndarray:
    """Finds duplicate faces. Of those in one shell, Hierarchy.build() counts one: duplicates_within_shells().

    Duplicates have corners at the same positions, in any rotation or orientation. Smaller faces that together cover a
    flat polygon are duplicates of it, too.

    Parameters
    ----------
    vertices, triangles, faces, face_count : see Hierarchy.build()

    Returns
    -------
    (F,) int32, for each source face the one that it duplicates, or itself

    Raises
    ------
    PartwheelError : the surface is invalid
    """
    mesh = to_mesh_view(vertices, triangles, faces, face_count)
    original = np.empty(mesh.face_count, np.int32)
    check(load().pw_duplicate_faces(None, mesh, original))
    return original


def duplicates_within_shells(hierarchy: Hierarchy, vertices: ArrayLike, triangles: ArrayLike,
                             faces: ArrayLike) -> Tuple[np.ndarray, np.ndarray]:
    """Finds the duplicate faces that a hierarchy counts once: those of the same shell. Where two shells have the same face,
    each keeps its own.

    Parameters
    ----------
    hierarchy : of the mesh
    vertices, triangles, faces : see Hierarchy.build()

    Returns
    -------
    original : (F,) for each source face the one of its shell that it duplicates, or itself
    shell : (F,) a number for each face's shell; all 0 if no two faces are alike
    """
    count, triangles, faces = len(hierarchy.leaf), np.asarray(triangles), np.asarray(faces)
    own, shell = np.arange(count), np.zeros(count, int)
    if hierarchy.summary.is_exact and hierarchy.summary.shells == 1:  # it has no duplicates
        return own, shell
    original = duplicate_faces(vertices, triangles, faces, count)
    if hierarchy.summary.shells > 1 and (original != own).any():
        tetrahedra = hierarchy.tetrahedra
        of_vertex = components(len(hierarchy.vertices), tetrahedra[:, [0, 1, 1, 2, 2, 3]].reshape(-1, 2))
        shell = of_vertex[tetrahedra[hierarchy.leaf, 0]]
        for number in np.unique(shell[shell[original] != shell]):
            inside, is_inside = np.flatnonzero(shell == number), shell[faces] == number
            used, corners = np.unique(triangles[is_inside], return_inverse=True)
            original[inside] = inside[duplicate_faces(np.asarray(vertices)[used], corners.reshape(-1, 3),
                                                      np.searchsorted(inside, faces[is_inside]), len(inside))]
    return original, shell


def without_duplicates(hierarchy: Hierarchy, vertices: ArrayLike, triangles: ArrayLike,
                       faces: ArrayLike) -> Tuple[np.ndarray, np.ndarray]:
    """(triangles (n, 3), faces (n,)) of a hierarchy's source mesh without duplicate faces, see duplicates_within_shells()."""
    triangles, faces = np.asarray(triangles), np.asarray(faces)
    is_original = duplicates_within_shells(hierarchy, vertices, triangles, faces)[0][faces] == faces
    return triangles[is_original], faces[is_original]
