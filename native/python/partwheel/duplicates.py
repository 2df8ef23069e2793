# SPDX-License-Identifier: GPL-3.0-or-later
"""Duplicate faces of a surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional, Tuple

import numpy as np

from .hierarchy import to_mesh_view
from .library import check, load

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .hierarchy import Hierarchy


def duplicate_faces(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
                    face_count: Optional[int] = None) -> np.ndarray:
    """Finds duplicate faces, which Hierarchy.build() counts once.

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


def without_duplicates(hierarchy: Hierarchy, vertices: ArrayLike, triangles: ArrayLike,
                       faces: ArrayLike) -> Tuple[np.ndarray, np.ndarray]:
    """Removes duplicate faces from the source mesh of a hierarchy.

    Parameters
    ----------
    hierarchy : of the mesh
    vertices, triangles, faces : see Hierarchy.build()

    Returns
    -------
    (triangles (n, 3), faces (n,)) that remain
    """
    triangles, faces = np.asarray(triangles), np.asarray(faces)
    if hierarchy.summary.is_exact:  # it has no duplicates
        return triangles, faces
    is_original = duplicate_faces(vertices, triangles, faces, len(hierarchy.leaf))[faces] == faces
    return triangles[is_original], faces[is_original]
