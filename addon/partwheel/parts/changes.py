# SPDX-License-Identifier: GPL-3.0-or-later
"""Revisions of meshes: counters of the changes that Blender reports."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from ..mesh import temporary_scene, arrays
from ..mesh.mesh_identity import MeshTable, mesh_key

# Per mesh: number of changes of geometry, of what modifiers show, and of updates of any kind.
_geometry_counts, _display_counts, _update_counts = MeshTable(), MeshTable(), MeshTable()
_undo_count = 0


def geometry_revision(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Return a value that differs after each reported change of geometry or visibility. Selecting is no change."""
    return _geometry_counts.get(mesh_key(mesh), 0), _undo_count


def revision(mesh: bpy.types.Mesh) -> tuple:
    """Return a value that differs after each change of geometry_revision() or display_revision()."""
    return geometry_revision(mesh), display_revision(mesh)


def display_revision(mesh: bpy.types.Mesh) -> int:
    """Return a value that differs after modifiers show the mesh differently, for example in another frame."""
    return _display_counts.get(mesh_key(mesh), 0)


def update_revision(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Return a value that differs after any update of the mesh that Blender reports, including of the selection."""
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
    """A new frame evaluates what is animated, and Blender calls no other handler for it. It edits no mesh. A
    render has an evaluation of its own, which no 3D view shows.
    """
    if depsgraph.mode == "RENDER" or temporary_scene.is_active:
        return
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Object) and update.id.type == "MESH":
            arrays.invalidate_snapshot()
            _increment_display(update.id)


def _increment_display(evaluated: bpy.types.Object) -> None:
    """In Edit Mode, only modifiers on the cage change what is shown."""
    if evaluated.mode != "EDIT" or arrays.find_cage_modifiers(evaluated):
        _increment(_display_counts, evaluated.original.data)


def _is_sculpt_stroke(update: bpy.types.DepsgraphUpdate, depsgraph: bpy.types.Depsgraph) -> bool:
    """Return whether an update reports a stroke of Sculpt Mode, which is reported as a change of shading only.

    Newer versions report the shading of all objects, and the scene, when something was added or removed.
    """
    return (update.id.mode == "SCULPT" and update.is_updated_shading
            and not any(isinstance(other.id, bpy.types.Scene) for other in depsgraph.updates))


def _increment(table: MeshTable, mesh: bpy.types.Mesh) -> None:
    table[mesh_key(mesh)] = table.get(mesh_key(mesh), 0) + 1


@persistent
def _on_undo(*_: object) -> None:
    global _undo_count
    arrays.invalidate_snapshot()
    _undo_count += 1


HANDLERS = {"depsgraph_update_post": _on_depsgraph_update, "frame_change_post": _on_frame_change,
            "undo_post": _on_undo, "redo_post": _on_undo}
