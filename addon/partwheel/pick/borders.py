# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces of a part, with its own border or with that moved to the creases nearby (partwheel.Creases)."""

import numpy as np

from ..mesh import arrays
from ..parts import registry
from partwheel import Creases

_kept = None  # (Fingerprint, Creases) of the mesh that was asked about last


def faces(obj, hierarchy, node, snap):
    """(n,) the faces of a node of the object's hierarchy; snap: with its border in creases. In no certain order."""
    own = hierarchy.faces(node)
    return np.flatnonzero(inside(obj, hierarchy, node)).astype(np.int32) if snap and len(own) else own


def inside(obj, hierarchy, node):
    """(F,) bool: the faces of a node with its border in creases. The hierarchy is what registry.hierarchy(obj) said."""
    part = arrays.mask(len(hierarchy.order), hierarchy.faces(node))
    return _creases(obj).snap(part) if part.any() else part


def _creases(obj):
    """Of the object's mesh as it was when its hierarchy was asked for last."""
    global _kept
    seen = registry.entry_of(obj.data).seen
    if not _kept or _kept[0] != seen:
        _kept = seen, Creases(*arrays.surface(obj.data))
    return _kept[1]
