# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the parts of imported and appended meshes in the background, if the preferences say so."""

from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..mesh import MeshSnapshot, check_poll
from ..pick.build import FindsParts, start_build, filter_without_parts
from ..preferences import preferences

# (number of objects, address of the last operation) at the last check. Blender identifies an operation by nothing else.
_last_check = None


class MESH_OT_partwheel_imported(FindsParts, bpy.types.Operator):
    """Find the parts of newly imported meshes"""

    bl_idname = "mesh.partwheel_imported"
    bl_label = "Find Parts of Imported Meshes"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return check_poll(cls, context.mode == "OBJECT" and find_without_parts(context.view_layer),
                          "Select meshes without parts, in Object Mode.")

    def _objects_to_build(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return find_without_parts(context.view_layer)

    def _start_build(self, snapshot: MeshSnapshot) -> Any:
        return start_build(_WarningReporter(self), snapshot)


class _WarningReporter:
    """Reports for an operator that the user did not start: its errors become warnings, which don't pop up."""

    def __init__(self, operator: bpy.types.Operator) -> None:
        self._operator = operator

    def report(self, kind: set[str], sentences: str) -> None:
        self._operator.report({"WARNING"} if kind == {"ERROR"} else kind, sentences)


def find_without_parts(view_layer: bpy.types.ViewLayer) -> list[bpy.types.Object]:
    """Return the selected mesh objects that have faces but no parts, one for each mesh."""
    return filter_without_parts(obj for obj in view_layer.objects.selected if obj.type == "MESH" and obj.data.polygons)


@persistent
def _schedule_check(_scene: bpy.types.Scene, _depsgraph: bpy.types.Depsgraph) -> None:
    """Schedule _check() for when the current operation has ended."""
    if not bpy.app.background and preferences().on_import and not bpy.app.timers.is_registered(_check):
        bpy.app.timers.register(_check, first_interval=0)


def _check() -> None:
    """Start the search for parts after an import."""
    window = bpy.context.window_manager.windows[0]
    if _has_imported():
        active = next(iter(window.view_layer.objects.selected), None)  # some imports don't set it
        with bpy.context.temp_override(window=window, active_object=active):
            if bpy.ops.mesh.partwheel_imported.poll():
                bpy.ops.mesh.partwheel_imported("INVOKE_DEFAULT")


def _has_imported() -> bool:
    """Return whether an import added objects since the last check. Importers that use the file browser leave no
    operation in Blender's list. So new objects without a new operation are imports. Files that are dropped on the
    window do leave one, which its name tells from others."""
    former_check, last = _last_check, _last_operation()
    _record_check()
    if former_check is None or len(bpy.data.objects) <= former_check[0]:
        return False
    return former_check[1] == _last_check[1] or "import" in last.bl_idname.lower() or last.bl_idname == "WM_OT_append"


def _last_operation() -> bpy.types.Operator | None:
    """Return the last operation that *Adjust Last Operation* could repeat, or None."""
    operations = bpy.context.window_manager.operators
    return operations[-1] if operations else None


@persistent
def _record_check(*_: Any) -> None:
    """Record the state of the file. As a handler: objects that come from undo, redo or another file are not imports."""
    global _last_check
    last = _last_operation()
    _last_check = len(bpy.data.objects), last and last.as_pointer()


def unregister() -> None:
    if bpy.app.timers.is_registered(_check):
        bpy.app.timers.unregister(_check)


HANDLERS = {"depsgraph_update_post": _schedule_check, **dict.fromkeys(("undo_post", "redo_post", "load_post"), _record_check)}
