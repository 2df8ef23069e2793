# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces of a part, with its own border or with the border snapped to creases (partwheel.Creases)."""

import numpy as np

from ..mesh import MeshSnapshot, arrays
from partwheel import Creases, Hierarchy


def get_part_faces(snapshot: MeshSnapshot, hierarchy: Hierarchy, node: int, snap: bool) -> np.ndarray:
    """Return the faces (n,) of a node, unordered. snap: with its border snapped to creases."""
    faces = hierarchy.faces(node)
    return np.flatnonzero(get_part_mask(snapshot, hierarchy, node)).astype(np.int32) if snap and len(faces) else faces


def get_part_mask(snapshot: MeshSnapshot, hierarchy: Hierarchy, node: int) -> np.ndarray:
    """Return a mask (F,) of a node's faces, its border in creases. hierarchy: from registry.get_hierarchy(snapshot)."""
    part = arrays.make_mask(len(hierarchy.order), hierarchy.faces(node))
    return _get_creases(snapshot).snap(part) if part.any() else part


def _get_creases(snapshot: MeshSnapshot) -> Creases:
    """Return the Creases of the mesh as it was when get_hierarchy() was called last."""
    state = snapshot.state
    if not state.creases or state.creases[0] != state.entry.fingerprint:
        state.creases = state.entry.fingerprint, Creases(*arrays.read_surface(snapshot.mesh))
    return state.creases[1]
