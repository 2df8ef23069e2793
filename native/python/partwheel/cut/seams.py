# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams for unwrapping: along the borders of a cut, in creases, with more cuts where a part would not lie flat. Native, see
pw_hierarchy_seams in partwheel_edit.h."""

from typing import Optional

import numpy as np
from numpy.typing import ArrayLike

from ..border import to_welded_mesh_view
from ..hierarchy import to_array
from ..library import Context, check, load
from ..triangles import side_ends
from .cut import Cut

MAX_DISTORTION = 1.09  # predicted area distortion of a patch: measured for all patches of a model, it is 1.1
MAX_REFINEMENTS = 3  # rounds in which seams are added where a solver failed


def seams(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike], face_count: Optional[int], cut: Cut,
          max_distortion: float = MAX_DISTORTION, context: Optional[Context] = None) -> np.ndarray:
    """Seams along the borders of a cut, snapped to creases unless the cut keeps its borders. Cut open there, the surface becomes
    patches that are disks. Patches are divided further, preferably in creases, concave ones first, until no patch's conformal
    map overlaps itself or exceeds the area distortion, as far as cuts can help.

    Parameters
    ----------
    vertices : (V, 3), triangles : (T, 3), faces : (T,) the polygon of each triangle, face_count : F. The surface that the
        cut is of. Coincident vertices are welded, and seams contain all edges that coincide
    max_distortion : mean factor by which areas of a patch may differ
    context : to cancel from another thread and to read the progress

    Returns
    -------
    (n, 2) int, the vertices of the edges

    Raises
    ------
    PartwheelError : the surface is invalid, or the call was canceled
    """
    mesh, _ = to_welded_mesh_view(vertices, triangles, faces, face_count)
    is_seam = np.empty(3 * mesh.triangle_count, bool)
    check(load().pw_hierarchy_seams(context, cut.hierarchy._handle, mesh, cut.labels, cut.keeps_borders, max_distortion, is_seam))
    return np.unique(side_ends(triangles)[is_seam], axis=0)


def refine_seams(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike], face_count: Optional[int], cut: Cut,
                 seam_edges: np.ndarray, uv: np.ndarray, max_distortion: float = MAX_DISTORTION,
                 context: Optional[Context] = None) -> np.ndarray:
    """Divide the islands of an unwrapping whose area distortion is far above the prediction, once, along the tree.

    Parameters
    ----------
    vertices, triangles, faces, face_count, cut, max_distortion, context : see seams()
    seam_edges : (n, 2) result of seams() or of this function
    uv : (T, 3, 2) UVs of the triangles' corners, unwrapped by those seams

    Returns
    -------
    (n, 2) the refined seams; the same ones if no island failed, or none can be divided
    """
    triangles = np.asarray(triangles)
    mesh, old_to_new = to_welded_mesh_view(vertices, triangles, faces, face_count)
    key = [len(old_to_new), 1]
    is_seam = np.isin(side_ends(old_to_new[triangles]) @ key, np.sort(old_to_new[seam_edges], axis=1) @ key)
    uv = to_array(uv, "uv", np.float64, (mesh.triangle_count, 3, 2))
    check(load().pw_hierarchy_refine_seams(context, cut.hierarchy._handle, mesh, uv, max_distortion, is_seam))
    return np.unique(side_ends(triangles)[is_seam], axis=0)
