# SPDX-License-Identifier: GPL-3.0-or-later
"""The source face of each triangle of a solid, also on the backs of sheets."""

import numpy as np

from ..components import to_mask
from ..hierarchy import Solid
from ..rays import RayTarget
from ..triangles import doubled_area_vectors

MAX_THICKNESS = 0.02  # of a sheet's solid, by the diagonal of the box of its vertices


def find_source_faces(solid: Solid, target: RayTarget, faces: np.ndarray) -> np.ndarray:
    """(m,) the source face of each triangle of a solid; -1 in caps and filled holes. The back of a sheet, which is filled as
    a thin solid, has the face in front of it. target : the model's surface; faces : (T,) the source face of each of its
    triangles"""
    result = solid.source_faces.copy()
    is_own = to_mask(faces.max() + 1, result[result >= 0])
    limit = MAX_THICKNESS * np.linalg.norm(np.ptp(solid.vertices, axis=0))
    is_back = (result < 0) & (solid.neighbor_tets < 0)
    corners = solid.vertices[solid.triangles[is_back]]
    normals = doubled_area_vectors(corners)
    lengths = np.linalg.norm(normals, axis=1)
    for triangle, origin, normal, length in zip(np.flatnonzero(is_back), corners.mean(axis=1), normals, lengths):
        hit = target.first_hit(origin, -normal / length) if length else None
        if hit and hit[1] <= limit and is_own[faces[hit[0]]]:
            result[triangle] = faces[hit[0]]
    return result
