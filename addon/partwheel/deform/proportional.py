# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_move: a picked part is moved by Blender's own tool with proportional editing.

It is told by the call to be proportional, connected, and how far it reaches: by the part's size. It keeps the reach as
the user's new setting when it ends, so that is put back then.

Blender's tool doesn't weld coincident vertices (partwheel.weld): connected, it would tear the mesh where they are. Where
there are any, distances are straight instead, the same for vertices at one place.
"""

import bpy
import numpy as np

from partwheel.weld import is_welding, weld_coincident_vertices
from ..mesh import arrays
from ..parts import picks, registry
from ..words.say import rpt_

REACH = 0.5  # beyond the part, by the square root of its area
TICK = 0.05  # seconds between two looks for the end of Blender's tool

_waiting = None  # the timer that looks


class MESH_OT_partwheel_move(picks.NeedsPick, bpy.types.Operator):
    """Move the part that was picked last; its surroundings follow, as far as suits its size. R turns and S scales it"""

    bl_idname = "mesh.partwheel_move"
    bl_label = "Move Part Proportionally"
    bl_options = {"INTERNAL"}

    def invoke(self, context, _event):
        if not picks.get_pick(context.edit_object):
            self.report({"ERROR"}, rpt_(picks.NO_PICK))
            return {"CANCELLED"}
        global _waiting
        unregister()  # or the reach that the last tool has left would be taken for the user's
        settings, arguments = context.tool_settings, falloff(context.edit_object)
        users = settings.proportional_size
        if np.float32(arguments["proportional_size"]) == np.float32(users):  # or that Blender has kept it would not be seen
            arguments["proportional_size"] *= 1.001
        bpy.ops.transform.translate("INVOKE_DEFAULT", **arguments)
        _waiting = _putting_back(context.scene.name_full, users)
        bpy.app.timers.register(_waiting, first_interval=0)
        return {"FINISHED"}


def falloff(obj):
    """What Blender's tool is told, the size in the world's unit."""
    split = is_welding(weld_coincident_vertices(arrays.read_edited_positions(obj), arrays.read_triangles(obj.data)[0]))
    return {"use_proportional_edit": True, "use_proportional_connected": not split, "proportional_size": _reach(obj)}


def _reach(obj):
    area = arrays.read(obj.data.polygons, "area", np.float32)
    part = registry.get_hierarchy(obj).faces(picks.get_pick(obj).node)
    return REACH * float(np.sqrt(area[part].sum())) * obj.matrix_world.median_scale


def _putting_back(scene, users):
    """A timer that gives a scene the user's reach again as soon as Blender's tool, which ends by writing its own, has
    done so."""
    def look():
        settings = getattr(bpy.data.scenes.get(scene), "tool_settings", None)
        if settings is None:
            return None
        if settings.proportional_size == users:
            return TICK if _transforming() else None
        settings.proportional_size = users
        return None
    return look


def _transforming():
    """Whether one of Blender's transform tools runs. Before Blender 4.2 that isn't known: then it may."""
    windows = bpy.context.window_manager.windows
    if not all(hasattr(window, "modal_operators") for window in windows):
        return True
    return any(each.bl_idname.startswith("TRANSFORM_OT") for window in windows for each in window.modal_operators)


CLASSES = (MESH_OT_partwheel_move,)


def unregister():
    """No timer goes on; the user's reach is put back, if Blender's tool has ended."""
    global _waiting
    if _waiting and bpy.app.timers.is_registered(_waiting):
        _waiting()
        bpy.app.timers.unregister(_waiting)
    _waiting = None
