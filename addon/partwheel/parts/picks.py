# SPDX-License-Identifier: GPL-3.0-or-later
"""The part that was picked last in each mesh, and confirmed. Undo brings the one before back."""

from typing import NamedTuple

import bmesh
import bpy
import numpy as np
from bpy.app.handlers import persistent

from ..mesh import arrays
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


REMEMBERED = 32  # picks of a mesh that undo may come back to
_past = PerMesh()  # [(_mark() after the pick, Picked), ...], the newest last
_picks = PerMesh(gone=lambda picks, gone: registry.retired(picks[gone].hierarchy) or picks.pop(gone))


def remember(obj, face, node, snap=False):
    """The user has chosen this part of the object's mesh, which has a hierarchy."""
    _picks[key(obj.data)] = Picked(int(node), int(face), registry.known(obj.data), bool(snap))


def settled(obj):
    """What the pick has made of the mesh's selection is there now."""
    mesh = obj.data
    pick, past = _picks.get(key(mesh)), _past.setdefault(key(mesh), [])
    if pick:
        past[:] = [each for each in past if each[1].hierarchy is pick.hierarchy][1 - REMEMBERED:] + [(_mark(mesh), pick)]


def _mark(mesh):
    """(active face, how many are selected): what tells the picks of a mesh apart."""
    if mesh.is_editmode:
        active = bmesh.from_edit_mesh(mesh).faces.active
        return active.index if active else -1, mesh.total_face_sel
    return mesh.polygons.active, int(np.count_nonzero(arrays.read(mesh.polygons, "select", bool)))


@persistent
def _undone(*_):
    """The newest pick after which the selection was as it is now; in Object Mode none where nothing is. Else it stays."""
    for mesh in bpy.data.meshes:
        past = _past.get(key(mesh))
        if past:
            mark = _mark(mesh)
            pick = next((pick for before, pick in reversed(past) if before == mark), None)
            if pick:
                _picks[key(mesh)] = pick
            elif not (mesh.is_editmode or mark[1]):
                _picks.pop(key(mesh), None)


def drop(obj):
    """No part of the object's mesh is picked any more."""
    _picks.pop(key(obj.data), None)


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
    _past.pop(key(obj.data), None)
    drop(obj)


HANDLERS = {"undo_post": _undone, "redo_post": _undone}
