# SPDX-License-Identifier: GPL-3.0-or-later
"""A picked part moved, turned or scaled proportionally: by Blender's own tools, or within the part alone by ours.

Blender's tools are told by the call to be proportional, connected, and how far they reach: by the part's size. They keep
the reach as the user's new setting when they end, so it is put back then.
"""

import bpy
import numpy as np

from .. import mesh_arrays, session

TRANSFORMS = {"G": ("translate", "Move"), "R": ("rotate", "Rotate"), "S": ("resize", "Scale")}
REACH = 0.5  # beyond the part, by the square root of its area
TICK = 0.05  # seconds between two looks for the end of Blender's tool

_waiting = None  # the timer that looks


def around(key):
    """start(context) of Blender's own proportional tool: the part moves as one, its surroundings follow."""
    def start(context):
        global _waiting
        unregister()  # or the reach that the last tool has left would be taken for the user's
        settings = context.tool_settings
        users, reach = settings.proportional_size, _reach(context.edit_object)
        if np.float32(reach) == np.float32(users):  # or that Blender has kept it would not be seen
            reach *= 1.001
        tool = getattr(bpy.ops.transform, TRANSFORMS[key][0])
        tool("INVOKE_DEFAULT", use_proportional_edit=True, use_proportional_connected=True, proportional_size=reach)
        _waiting = _putting_back(context.scene.name_full, users)
        bpy.app.timers.register(_waiting, first_interval=0)
    return start


def _reach(obj):
    """In the world's unit."""
    area = mesh_arrays.read(obj.data.polygons, "area", np.float32)
    part = session.hierarchy(obj).faces(session.picked(obj).node)
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


def within(key):
    """start(context) of ours: the part follows less and less towards its border, and nothing beyond it moves."""
    def start(_context):
        bpy.ops.mesh.partwheel_deform("INVOKE_DEFAULT", True, method="PROPORTIONAL", start=key)
    return start


def unregister():
    """No timer goes on; the user's reach is put back, if Blender's tool has ended."""
    global _waiting
    if _waiting and bpy.app.timers.is_registered(_waiting):
        _waiting()
        bpy.app.timers.unregister(_waiting)
    _waiting = None
