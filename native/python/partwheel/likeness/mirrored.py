# SPDX-License-Identifier: GPL-3.0-or-later
"""The counterpart of a part on the other side of a symmetric model. With numpy."""

from typing import List, NamedTuple

import numpy as np

from ..components import to_mask
from ..cut import mirror_planes
from ..duplicates import without_duplicates
from ..hierarchy import Hierarchy
from ..triangles import doubled_area_vectors, nearest_targets, sample_triangles

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
    doubled_areas = np.linalg.norm(doubled_area_vectors(corners), axis=1)
    is_inside = to_mask(len(hierarchy.order), hierarchy.faces(node))[faces]
    if not is_inside.any():
        return []
    points = sample_triangles(corners[is_inside], doubled_areas[is_inside], PART_SAMPLES)[0]
    area = np.cumsum(np.concatenate([[0], np.bincount(faces, doubled_areas, len(hierarchy.order))[hierarchy.order]]))
    area = area[hierarchy.last] - area[hierarchy.first]  # doubled, of each node
    result = []
    for normal, offset in mirror_planes(vertices, triangles):
        reflected = points - 2 * np.outer(points @ normal - offset, normal)
        hits = np.bincount(_nearest_faces(reflected, corners, doubled_areas, faces), minlength=len(hierarchy.order))[hierarchy.order]
        hits = np.concatenate([[0], np.cumsum(hits)]) / PART_SAMPLES
        intersection = np.minimum((hits[hierarchy.last] - hits[hierarchy.first]) * area[node], area)
        overlap = intersection / np.maximum(area[node] + area - intersection, 1e-300)
        if overlap[node] < MAX_SELF_OVERLAP:
            is_disjoint = (hierarchy.last <= hierarchy.first[node]) | (hierarchy.first >= hierarchy.last[node])
            best = int(np.where(is_disjoint, overlap, -1).argmax())
            if overlap[best] >= MIN_OVERLAP:
                result.append(MirrorImage(best, float(overlap[best]), normal, offset))
    return result


def _nearest_faces(points: np.ndarray, corners: np.ndarray, weights: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(n,) the source face nearest to each point (n, 3): that of the nearest sample or triangle center in the points'
    bounding box and a margin."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = np.linalg.norm(high - low) / 8
    in_box = ((corners.max(axis=1) >= low - margin) & (corners.min(axis=1) <= high + margin)).all(axis=1)
    if not in_box.any():
        in_box[:] = True
    corners, faces = corners[in_box], faces[in_box]
    samples, sampled = sample_triangles(corners, weights[in_box], TARGET_SAMPLES)
    targets, target_faces = np.vstack([samples, corners.mean(axis=1)]), np.concatenate([faces[sampled], faces])
    return target_faces[nearest_targets(points, targets)]
