# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the preferences say so, the parts of what was just imported or appended are found without being asked for: one
mesh after the other, beside Blender's own work, as mesh.partwheel_build does it."""

import bpy
from bpy.app.handlers import persistent

from ..mesh.poll import check_poll
from ..pick.build import FindsParts, start_build, filter_without_parts
from ..preferences import preferences

_before = None  # how many objects there were at the last look, and where the last operation lies, its only identity


class MESH_OT_partwheel_imported(FindsParts, bpy.types.Operator):
    """Find the parts of the selected meshes that have none, on behalf of what imported them"""

    bl_idname = "mesh.partwheel_imported"
    bl_label = "Find Parts of Imported Meshes"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context):
        return check_poll(cls, context.mode == "OBJECT" and lacking(context.view_layer),
                          "This is for selected meshes without parts, in Object Mode.")

    def _lacking(self, context):
        return lacking(context.view_layer)

    def _start(self, obj):
        return start_build(_Quiet(self), obj)


class _Quiet:
    """For an operator that nobody has asked for: what fails is no error that pops up."""

    def __init__(self, operator):
        self._operator = operator

    def report(self, kind, sentences):
        self._operator.report({"WARNING"} if kind == {"ERROR"} else kind, sentences)


def lacking(view_layer):
    """The selected objects whose meshes have faces but no parts; of those that share a mesh one."""
    return filter_without_parts(obj for obj in view_layer.objects.selected if obj.type == "MESH" and obj.data.polygons)


@persistent
def _changed(_scene, _depsgraph):
    """What was done can be told when it is over."""
    if not bpy.app.background and preferences().on_import and not bpy.app.timers.is_registered(_look):
        bpy.app.timers.register(_look, first_interval=0)


def _look():
    window = bpy.context.window_manager.windows[0]
    if _imported():
        active = next(iter(window.view_layer.objects.selected), None)  # an import has not always made one of its own so
        with bpy.context.temp_override(window=window, active_object=active):
            if bpy.ops.mesh.partwheel_imported.poll():
                bpy.ops.mesh.partwheel_imported("INVOKE_DEFAULT")


def _imported():
    """Whether there are more objects than at the last look and no operation that can be repeated has added them. For Blender
    keeps no account of what its file browser was opened for; what is dropped on its window is an operation like others."""
    before, last = _before, _last()
    _begin_anew()
    if before is None or len(bpy.data.objects) <= before[0]:
        return False
    return before[1] == _before[1] or "import" in last.bl_idname.lower() or last.bl_idname == "WM_OT_append"


def _last():
    operations = bpy.context.window_manager.operators
    return operations[-1] if operations else None


@persistent
def _begin_anew(*_):
    """What undo brings back, or another file, is no import."""
    global _before
    last = _last()
    _before = len(bpy.data.objects), last and last.as_pointer()


def unregister():
    if bpy.app.timers.is_registered(_look):
        bpy.app.timers.unregister(_look)


CLASSES = (MESH_OT_partwheel_imported,)
HANDLERS = {"depsgraph_update_post": _changed, **dict.fromkeys(("undo_post", "redo_post", "load_post"), _begin_anew)}
