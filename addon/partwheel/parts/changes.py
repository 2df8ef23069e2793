# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender has told of changes to meshes, and of what is shown of them in another frame."""

import bpy
from bpy.app.handlers import persistent

from ..mesh import apart, arrays
from ..mesh.mesh_identity import MeshTable, mesh_key

# How often the mesh was changed, or what modifiers show of it, or anything told of it.
_edits, _shown, _told = MeshTable(), MeshTable(), MeshTable()
_undos = 0


def edits(mesh):
    """Something that is another after each change of the mesh's geometry, or of what is hidden, that Blender told of.
    Selecting is none."""
    return _edits.get(mesh_key(mesh), 0), _undos


def revision(mesh):
    """The same, and another also after a change of what modifiers show of it, be it on the cage."""
    return edits(mesh), shown(mesh)


def shown(mesh):
    """Something that is another after a change of what modifiers show of the mesh: in another frame, for instance."""
    return _shown.get(mesh_key(mesh), 0)


def told(mesh):
    """Something that is another after whatever Blender told of the mesh, be it that something was selected in it."""
    return _told.get(mesh_key(mesh), 0), _undos


@persistent
def _edited(_scene, depsgraph):
    if arrays.writing_back or apart.active:
        return
    for update in depsgraph.updates:
        if isinstance(update.id, bpy.types.Mesh):
            _count(_told, update.id.original)
        of_mesh = isinstance(update.id, bpy.types.Object) and update.id.type == "MESH"
        if not (update.is_updated_geometry or of_mesh and _stroke(update, depsgraph)):
            continue
        arrays.changed()
        if isinstance(update.id, bpy.types.Mesh):
            _count(_edits, update.id.original)
        elif of_mesh:
            _count_shown(update.id)


@persistent
def _frame_changed(_scene, depsgraph):
    """A new frame evaluates what is animated, and Blender calls no other handler for it. No mesh is edited by it. A render
    has an evaluation of its own, which no 3D view shows."""
    if depsgraph.mode == "RENDER" or apart.active:
        return
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Object) and update.id.type == "MESH":
            arrays.changed()
            _count_shown(update.id)


def _count_shown(evaluated):
    """In Edit Mode only modifiers on the cage change what is shown."""
    if evaluated.mode != "EDIT" or arrays.on_cage(evaluated):
        _count(_shown, evaluated.original.data)


def _stroke(update, depsgraph):
    """Whether an update of an object tells of a stroke of Sculpt Mode: of its shading, which is all that is told of one.
    Newer Blenders tell of the shading of all objects, and of the scene, when something was added or removed."""
    return (update.id.mode == "SCULPT" and update.is_updated_shading
            and not any(isinstance(each.id, bpy.types.Scene) for each in depsgraph.updates))


def _count(table, mesh):
    table[mesh_key(mesh)] = table.get(mesh_key(mesh), 0) + 1


@persistent
def _undone(*_):
    global _undos
    arrays.changed()
    _undos += 1


HANDLERS = {"depsgraph_update_post": _edited, "frame_change_post": _frame_changed, "undo_post": _undone, "redo_post": _undone}
