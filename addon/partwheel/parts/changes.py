# SPDX-License-Identifier: GPL-3.0-or-later
"""What Blender has told of changes to meshes, and of what is shown of them in another frame."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from ..mesh import temporary_scene, arrays
from ..mesh.mesh_identity import MeshTable, mesh_key

# How often the mesh was changed, or what modifiers show of it, or anything told of it.
_geometry_counts, _display_counts, _update_counts = MeshTable(), MeshTable(), MeshTable()
_undo_count = 0


def geometry_revision(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Something that is another after each change of the mesh's geometry, or of what is hidden, that Blender told of.
    Selecting is none."""
    return _geometry_counts.get(mesh_key(mesh), 0), _undo_count


def revision(mesh: bpy.types.Mesh) -> tuple:
    """The same, and another also after a change of what modifiers show of it, be it on the cage."""
    return geometry_revision(mesh), display_revision(mesh)


def display_revision(mesh: bpy.types.Mesh) -> int:
    """Something that is another after a change of what modifiers show of the mesh: in another frame, for instance."""
    return _display_counts.get(mesh_key(mesh), 0)


def update_revision(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Something that is another after whatever Blender told of the mesh, be it that something was selected in it."""
    return _update_counts.get(mesh_key(mesh), 0), _undo_count


@persistent
def _on_depsgraph_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if arrays.is_writing_back or temporary_scene.is_active:
        return
    for update in depsgraph.updates:
        if isinstance(update.id, bpy.types.Mesh):
            _increment(_update_counts, update.id.original)
        of_mesh = isinstance(update.id, bpy.types.Object) and update.id.type == "MESH"
        if not (update.is_updated_geometry or of_mesh and _is_sculpt_stroke(update, depsgraph)):
            continue
        arrays.invalidate_snapshot()
        if isinstance(update.id, bpy.types.Mesh):
            _increment(_geometry_counts, update.id.original)
        elif of_mesh:
            _increment_display(update.id)


@persistent
def _on_frame_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """A new frame evaluates what is animated, and Blender calls no other handler for it. No mesh is edited by it. A render
    has an evaluation of its own, which no 3D view shows."""
    if depsgraph.mode == "RENDER" or temporary_scene.is_active:
        return
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Object) and update.id.type == "MESH":
            arrays.invalidate_snapshot()
            _increment_display(update.id)


def _increment_display(evaluated: bpy.types.Object) -> None:
    """In Edit Mode only modifiers on the cage change what is shown."""
    if evaluated.mode != "EDIT" or arrays.find_cage_modifiers(evaluated):
        _increment(_display_counts, evaluated.original.data)


def _is_sculpt_stroke(update: bpy.types.DepsgraphUpdate, depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether an update of an object tells of a stroke of Sculpt Mode: of its shading, which is all that is told of one.
    Newer Blenders tell of the shading of all objects, and of the scene, when something was added or removed."""
    return (update.id.mode == "SCULPT" and update.is_updated_shading
            and not any(isinstance(each.id, bpy.types.Scene) for each in depsgraph.updates))


def _increment(table: MeshTable, mesh: bpy.types.Mesh) -> None:
    table[mesh_key(mesh)] = table.get(mesh_key(mesh), 0) + 1


@persistent
def _on_undo(*_: object) -> None:
    global _undo_count
    arrays.invalidate_snapshot()
    _undo_count += 1


HANDLERS = {"depsgraph_update_post": _on_depsgraph_update, "frame_change_post": _on_frame_change, "undo_post": _on_undo, "redo_post": _on_undo}
