# SPDX-License-Identifier: GPL-3.0-or-later
"""The part that was picked last in each mesh, and confirmed."""

from typing import NamedTuple

from ..mesh.kept import PerMesh, key
from . import registry
from partwheel import Hierarchy


class Picked(NamedTuple):
    """A part of a mesh that the user chose: a node of its hierarchy, and the face that was clicked. snap: whether it was
    taken with its border in creases."""

    node: int
    face: int
    hierarchy: Hierarchy
    snap: bool


_picks = PerMesh(gone=lambda picks, gone: registry.retired(picks[gone].hierarchy) or picks.pop(gone))


def remember(obj, face, node, snap=False):
    """The user has chosen this part of the object's mesh, which has a hierarchy."""
    _picks[key(obj.data)] = Picked(int(node), int(face), registry.known(obj.data), bool(snap))


def picked(obj):
    """The Picked that was chosen last in the object's mesh; None if there is none, or its hierarchy is not the mesh's
    any more."""
    pick = _picks.get(key(obj.data))
    return pick if pick and registry.hierarchy(obj) is pick.hierarchy else None


def picked_as_told(obj):
    """The same for panels and poll(), which Blender calls often: as far as registry.state() tells."""
    pick = _picks.get(key(obj.data))
    if not pick:
        return None
    fits, entry = registry.state(obj.data)
    return pick if fits in registry.USABLE and entry.hierarchy is pick.hierarchy else None


def forget(obj):
    """Lets the hierarchy of the object's mesh go, and with it the part."""
    registry.forget(obj.data)
    _picks.pop(key(obj.data), None)
