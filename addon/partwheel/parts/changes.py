# SPDX-License-Identifier: GPL-3.0-or-later
"""Invalidates what is known of meshes when Blender reports a change."""

import bpy
from bpy.app.handlers import persistent

from ..mesh import arrays, mesh_state
from ..mesh.mesh_state import Reason, invalidate
from . import picks


@persistent
def _on_depsgraph_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    if mesh_state.is_ignoring_reports:
        return
    for update in depsgraph.updates:
        if isinstance(update.id, bpy.types.Mesh):
            invalidate(Reason.UPDATE, update.id.original)
        of_mesh = isinstance(update.id, bpy.types.Object) and update.id.type == "MESH"
        if not (update.is_updated_geometry or of_mesh and _is_sculpt_stroke(update, depsgraph)):
            continue
        if isinstance(update.id, bpy.types.Mesh):
            invalidate(Reason.GEOMETRY, update.id.original)
        elif of_mesh:
            _invalidate_display(update.id)


@persistent
def _on_frame_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """A new frame evaluates what is animated, and Blender calls no other handler for it. It edits no mesh. A
    render has an evaluation of its own, which no 3D view shows."""
    if depsgraph.mode == "RENDER" or mesh_state.is_ignoring_reports:
        return
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Object) and update.id.type == "MESH":
            _invalidate_display(update.id)


def _invalidate_display(evaluated: bpy.types.Object) -> None:
    """Record that modifiers show the object's mesh differently; in Edit Mode, only those on the cage do."""
    if evaluated.mode != "EDIT" or arrays.find_cage_modifiers(evaluated):
        invalidate(Reason.DISPLAY, evaluated.original.data)


def _is_sculpt_stroke(update: bpy.types.DepsgraphUpdate, depsgraph: bpy.types.Depsgraph) -> bool:
    """Return whether an update reports a stroke of Sculpt Mode, which is reported as a change of shading only. Newer
    versions report the shading of all objects, and the scene, when something was added or removed."""
    return (update.id.mode == "SCULPT" and update.is_updated_shading
            and not any(isinstance(other.id, bpy.types.Scene) for other in depsgraph.updates))


@persistent
def _on_undo(*_: object) -> None:
    invalidate(Reason.UNDO)
    picks.restore_picks()


HANDLERS = {"depsgraph_update_post": _on_depsgraph_update, "frame_change_post": _on_frame_change,
            "undo_post": _on_undo, "redo_post": _on_undo}
