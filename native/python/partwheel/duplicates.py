# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of a surface that are there several times."""

import numpy as np

from .hierarchy import surface
from .library import check, load


def duplicate_faces(vertices, triangles, faces=None, face_count=None):
    """(F,) of each source face the one that it is a duplicate of, or itself. Duplicates have the same corners, wherever
    they start and whichever way they wind, on vertices of their own or not; a flat polygon has smaller faces that it is
    made of as duplicates. The arguments are those of Hierarchy.build(), which counts duplicates once. Raises PartwheelError."""
    given = surface(vertices, triangles, faces, face_count)
    original = np.empty(given.face_count, np.int32)
    check(load().pw_duplicate_faces(None, given, original))
    return original


def without_duplicates(hierarchy, vertices, triangles, faces):
    """(triangles, faces) of the surface that the hierarchy is of, without those of duplicates."""
    triangles, faces = np.asarray(triangles), np.asarray(faces)
    if hierarchy.summary.exact:  # which has none
        return triangles, faces
    once = duplicate_faces(vertices, triangles, faces, len(hierarchy.leaf))[faces] == faces
    return triangles[once], faces[once]
