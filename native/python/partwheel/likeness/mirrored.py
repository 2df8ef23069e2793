# SPDX-License-Identifier: GPL-3.0-or-later
"""The counterpart of a part on the other side of a symmetric model. With numpy."""

from typing import List, NamedTuple

import numpy as np

from ..components import to_mask
from ..cut import mirror_planes, reflect
from ..duplicates import without_duplicates
from ..hierarchy import Hierarchy
from ..triangles import nearest_targets, sample_triangles, triangle_areas
from .similar import slice_sums

PART_SAMPLES = 512  # points on the part
TARGET_SAMPLES = 8192  # points on the surface around its mirror image
MAX_SELF_OVERLAP = 0.5  # of a part with its own mirror image; a part that overlaps more lies in the plane
MIN_OVERLAP = 0.5  # of the mirror image with another node


class MirrorImage(NamedTuple):
    """The counterpart of a node."""

    node: int  # on the other side
    overlap: float  # intersection over union, by area, of that node and the mirror image, 0 to 1
    normal: np.ndarray  # (3,), of the plane, normal . x = offset
    offset: float


def mirrored_parts(hierarchy: Hierarchy, vertices: np.ndarray, triangles: np.ndarray, faces: np.ndarray,
                   node: int) -> List[MirrorImage]:
    """Find the counterparts of a node: one for each mirror plane of the model with a counterpart on its other side, the best
    plane first. faces : (T,) the source face of each triangle. Raises PartwheelError if the surface is invalid."""
    triangles, faces = without_duplicates(hierarchy, vertices, triangles, faces)
    corners = np.asarray(vertices, np.float64)[np.asarray(triangles)]
    areas = triangle_areas(corners)
    is_inside = to_mask(len(hierarchy.order), hierarchy.faces(node))[faces]
    if not is_inside.any():
        return []
    points = sample_triangles(corners[is_inside], areas[is_inside], PART_SAMPLES)[0]
    face_count, first, last = len(hierarchy.order), hierarchy.first, hierarchy.last
    area = slice_sums(np.bincount(faces, areas, face_count)[hierarchy.order], first, last)  # of each node
    result = []
    for normal, offset in mirror_planes(vertices, triangles):
        hit_faces = _nearest_faces(reflect(points, normal, offset), corners, areas, faces)
        hits = slice_sums(np.bincount(hit_faces, minlength=face_count)[hierarchy.order], first, last)
        intersection = np.minimum(hits / PART_SAMPLES * area[node], area)
        overlap = intersection / np.maximum(area[node] + area - intersection, 1e-300)
        if overlap[node] < MAX_SELF_OVERLAP:
            is_disjoint = (last <= first[node]) | (first >= last[node])
            best = int(np.where(is_disjoint, overlap, -1).argmax())
            if overlap[best] >= MIN_OVERLAP:
                result.append(MirrorImage(best, float(overlap[best]), normal, offset))
    return result


def _nearest_faces(points: np.ndarray, corners: np.ndarray, areas: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(n,) the source face nearest to each point (n, 3): that of the nearest sample or triangle center in the points'
    bounding box and a margin."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = np.linalg.norm(high - low) / 8
    in_box = ((corners.max(axis=1) >= low - margin) & (corners.min(axis=1) <= high + margin)).all(axis=1)
    if not in_box.any():
        in_box[:] = True
    corners, faces = corners[in_box], faces[in_box]
    samples, sampled = sample_triangles(corners, areas[in_box], TARGET_SAMPLES)
    targets, target_faces = np.vstack([samples, corners.mean(axis=1)]), np.concatenate([faces[sampled], faces])
    return target_faces[nearest_targets(points, targets)]
