# SPDX-License-Identifier: GPL-3.0-or-later
"""The part on the other side of a model that is its own mirror image. By numpy."""

from typing import NamedTuple

import numpy as np

from ..compatible import sample_triangles
from ..cut import mirror_planes
from ..duplicates import without_duplicates

POINTS, FIELD = 512, 8192  # on the part; on what lies about its mirror image
BESIDE = 0.5  # overlap of a part's mirror image with the part itself, from which on it lies in the plane
FOUND = 0.5  # with another node: less is none


class Image(NamedTuple):
    """node: the part on the other side. overlap: of that with the mirror image, by area, 0..1. normal (3,), offset: the
    plane."""

    node: int
    overlap: float
    normal: np.ndarray
    offset: float


def mirrored(hierarchy, vertices, triangles, faces, node):
    """[Image, ...] of a node, one for each plane in which the model is its own mirror image and the node has another
    part on its other side, the model's best plane first. vertices (V,3), triangles (T,3), faces (T,) the source face of
    each: the surface that the hierarchy is of. Raises PartwheelError."""
    triangles, faces = without_duplicates(hierarchy, vertices, triangles, faces)
    corners = np.asarray(vertices, np.float64)[np.asarray(triangles)]
    double = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    inside = np.zeros(len(hierarchy.order), bool)
    inside[hierarchy.faces(node)] = True
    own = inside[faces]
    if not own.any():
        return []
    points = sample_triangles(corners[own], double[own], POINTS)[0]
    area = np.cumsum(np.concatenate([[0], np.bincount(faces, double, len(inside))[hierarchy.order]]))
    area = area[hierarchy.last] - area[hierarchy.first]
    found = []
    for normal, offset in mirror_planes(vertices, triangles):
        images = points - 2 * np.outer(points @ normal - offset, normal)
        hits = np.bincount(_faces_at(images, corners, double, faces), minlength=len(inside))[hierarchy.order]
        hits = np.concatenate([[0], np.cumsum(hits)]) / POINTS
        common = np.minimum((hits[hierarchy.last] - hits[hierarchy.first]) * area[node], area)
        overlap = common / np.maximum(area[node] + area - common, 1e-300)
        if overlap[node] < BESIDE:
            apart = (hierarchy.last <= hierarchy.first[node]) | (hierarchy.first >= hierarchy.last[node])
            best = int(np.where(apart, overlap, -1).argmax())
            if overlap[best] >= FOUND:
                found.append(Image(best, float(overlap[best]), normal, offset))
    return found


def _faces_at(points, corners, weights, faces):
    """(n,) the source face that is nearest to each point."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = np.linalg.norm(high - low) / 8
    about = ((corners.max(axis=1) >= low - margin) & (corners.min(axis=1) <= high + margin)).all(axis=1)
    if not about.any():
        about[:] = True
    corners, faces = corners[about], faces[about]
    spread, chosen = sample_triangles(corners, weights[about], FIELD)
    field, of = np.vstack([spread, corners.mean(axis=1)]), np.concatenate([faces[chosen], faces])
    field, points = field - low, points - low
    lengths = (field ** 2).sum(axis=1)
    return of[np.concatenate([(lengths - 2 * some @ field.T).argmin(axis=1) for some in np.array_split(points, 16)])]
