# SPDX-License-Identifier: GPL-3.0-or-later
"""The part that was picked last in each mesh, and confirmed."""

from typing import NamedTuple

from ..mesh.kept import PerMesh, key
from ..mesh.refusing import Refused, can
from . import registry
from partwheel import Hierarchy

NO_PICK = "No part is picked. Pick one with Select Part by Wheel, and confirm it."


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


def chosen(obj, node):
    """(the hierarchy of the object's mesh as it is now, one of its nodes): this one, or for -1 the one that was picked
    last. Raises Refused."""
    found = registry.needed(obj)
    if node >= len(found.parent):
        raise Refused("There is no part {number}: there are {count}.", number=node, count=len(found.parent))
    pick = picked(obj)
    if node < 0 and not pick:
        raise Refused(NO_PICK)
    return found, node if node >= 0 else pick.node


class NeedsPick:
    """Mixed into an operator, ahead of bpy.types.Operator: it needs a part that was picked, in Edit Mode."""

    @classmethod
    def poll(cls, context):
        return can(cls, context.mode == "EDIT_MESH" and picked_as_told(context.edit_object), NO_PICK)


def forget(obj):
    """Lets the hierarchy of the object's mesh go, and with it the part."""
    registry.forget(obj.data)
    _picks.pop(key(obj.data), None)
