# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces of a part, with its own border or with that moved to the creases nearby (partwheel.Creases)."""

from __future__ import annotations

import bpy
import numpy as np

from ..mesh import arrays
from ..parts import registry
from partwheel import Creases, Hierarchy

_cache = None  # (Fingerprint, Creases) of the mesh that was asked about last


def get_part_faces(obj: bpy.types.Object, hierarchy: Hierarchy, node: int, snap: bool) -> np.ndarray:
    """(n,) the faces of a node of the object's hierarchy; snap: with its border in creases. In no certain order."""
    own = hierarchy.faces(node)
    return np.flatnonzero(get_part_mask(obj, hierarchy, node)).astype(np.int32) if snap and len(own) else own


def get_part_mask(obj: bpy.types.Object, hierarchy: Hierarchy, node: int) -> np.ndarray:
    """(F,) bool: the faces of a node with its border in creases. The hierarchy is what registry.get_hierarchy(obj)
    said."""
    part = arrays.make_mask(len(hierarchy.order), hierarchy.faces(node))
    return _get_creases(obj).snap(part) if part.any() else part


def _get_creases(obj: bpy.types.Object) -> Creases:
    """Of the object's mesh as it was when its hierarchy was asked for last."""
    global _cache
    seen = registry.find_entry(obj.data).fingerprint
    if not _cache or _cache[0] != seen:
        _cache = seen, Creases(*arrays.read_surface(obj.data))
    return _cache[1]
