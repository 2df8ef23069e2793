# SPDX-License-Identifier: GPL-3.0-or-later
"""Places pieces on print beds: each on its largest flat side, side by side in rows. With manifold3d. Lengths are in
millimeters."""

from itertools import permutations
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from ..triangles import doubled_area_vectors, unit_vectors

DISTANCE = 5.0  # between two pieces
FLATNESS = 0.01  # largest distance from the bed of a triangle that lies on it
MAX_SIDES = 20  # of a piece's hull that are tried as its base, the largest first
TOLERANCE = 1e-3  # by which a piece may exceed the bed, because of rounding

Body = Tuple[np.ndarray, np.ndarray]  # vertices (V, 3), triangles (T, 3)


def place_on_beds(solids: Dict[int, Body], bed: Sequence[float], manifold: Any) -> List[Dict[int, np.ndarray]]:
    """The pieces {piece: (vertices (V, 3), triangles (T, 3))} on each bed, with the (3, 4) matrix that places each. Beds
    reach from 0 to their size (3,). Pieces that are larger than the bed are left out."""
    rotations = {piece: rotation for piece, solid in solids.items()
                 if (rotation := _find_best_rotation(*solid, bed, manifold)) is not None}
    sizes = {piece: np.ptp(solids[piece][0] @ rotation.T, axis=0) for piece, rotation in rotations.items()}
    beds: List[Dict[int, np.ndarray]] = []
    x = y = depth = np.inf
    for piece in sorted(sizes, key=lambda piece: -sizes[piece][1]):  # the deepest first, so that rows stay full
        if x + sizes[piece][0] > bed[0] + TOLERANCE:  # a row is full
            x, y, depth = 0.0, y + depth + DISTANCE, sizes[piece][1]
        if y + depth > bed[1] + TOLERANCE:
            x = y = 0.0
            depth = sizes[piece][1]
            beds.append({})
        low = (solids[piece][0] @ rotations[piece].T).min(axis=0)
        beds[-1][piece] = np.column_stack([rotations[piece], np.array([x, y, 0.0]) - low])
        x += sizes[piece][0] + DISTANCE
    return beds


def _find_best_rotation(vertices: np.ndarray, triangles: np.ndarray, bed: Sequence[float],
                        manifold: Any) -> Optional[np.ndarray]:
    """(3, 3) the rotation with the most area on the bed, of those that fit; None if none does."""
    normals = doubled_area_vectors(vertices[triangles])
    best: Optional[Tuple[float, np.ndarray]] = None
    for rotation in _candidate_rotations(vertices, manifold):
        turned = vertices @ rotation.T
        if (np.ptp(turned, axis=0) > np.asarray(bed) + TOLERANCE).any():
            continue
        is_on_bed = (turned[triangles, 2] < turned[:, 2].min() + FLATNESS).all(axis=1)
        area = float(np.linalg.norm(normals[is_on_bed], axis=1).sum())
        if best is None or area > best[0] * (1 + 1e-9):
            best = area, rotation
    return best[1] if best else None


def _candidate_rotations(vertices: np.ndarray, manifold: Any) -> Iterator[np.ndarray]:
    """Rotations (3, 3) that put a side of the hull on the bed, or an axis up: two for each side, one with its long extent
    along x and one along y."""
    mesh = manifold.Manifold.hull_points(vertices).to_mesh64()
    normals = doubled_area_vectors(np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts)])
    _, side = np.unique(unit_vectors(normals).round(3), axis=0, return_inverse=True)
    sums = np.array([np.bincount(side.ravel(), column) for column in normals.T]).T
    for down in sums[np.argsort(-np.linalg.norm(sums, axis=1))[:MAX_SIDES]]:
        z = -down / np.linalg.norm(down)
        flat = vertices - np.outer(vertices @ z, z)
        x = np.linalg.svd(flat - flat.mean(axis=0), full_matrices=False)[2][0]
        yield np.array([x, np.cross(z, x), z])
        yield np.array([np.cross(z, x), -x, z])
    for order in permutations(range(3)):
        rotation = np.eye(3)[list(order)]
        rotation[2] *= np.linalg.det(rotation)
        yield rotation
