# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_move: moves a picked part by Blender's own tool with proportional editing.

The call sets proportional editing, connected, with a size that fits the part. Blender's tool stores this size as the
user's setting when it ends, so the operator restores the user's value then.

Blender's tool doesn't weld coincident vertices (partwheel.weld): with connected, it would tear the mesh there. If
there are any, distances are straight lines, the same for all vertices at one position."""

from collections.abc import Callable

import bpy
import numpy as np

from partwheel.weld import is_welding
from ..mesh import MeshSnapshot, arrays
from ..parts import picks
from ..translations.lookup import rpt_

FALLOFF_FACTOR = 0.5  # falloff radius by the square root of the part's area
TIMER_STEP = 0.05  # seconds between two checks whether Blender's tool has ended

_timer = None  # the timer function that checks


class MESH_OT_partwheel_move(picks.NeedsPick, bpy.types.Operator):
    """Move the last picked part; its surroundings follow, depending on its size. R rotates and S scales it"""

    bl_idname = "mesh.partwheel_move"
    bl_label = "Move Part Proportionally"
    bl_options = {"INTERNAL"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        snapshot = MeshSnapshot(context.edit_object)
        pick = picks.get_pick(snapshot)
        if not pick:
            self.report({"ERROR"}, rpt_(picks.NO_PICK))
            return {"CANCELLED"}
        global _timer
        unregister()  # otherwise the size that the last run left would count as the user's
        settings, arguments = context.tool_settings, transform_arguments(snapshot.obj, pick)
        user_size = settings.proportional_size
        # The sizes must differ, or a change by Blender would go unnoticed.
        if np.float32(arguments["proportional_size"]) == np.float32(user_size):
            arguments["proportional_size"] *= 1.001
        bpy.ops.transform.translate("INVOKE_DEFAULT", **arguments)
        _timer = _create_restore_timer(context.scene.name_full, user_size)
        bpy.app.timers.register(_timer, first_interval=0)
        return {"FINISHED"}


def transform_arguments(obj: bpy.types.Object, pick: picks.Pick) -> dict[str, bool | float]:
    """Arguments of Blender's tool; the size is in the world's unit."""
    split = is_welding(arrays.find_coincident_vertices(obj.data, arrays.read_edited_positions(obj), sheets=True))
    area = arrays.read(obj.data.polygons, "area", np.float32)[pick.hierarchy.faces(pick.node)].sum()
    return {"use_proportional_edit": True, "use_proportional_connected": not split,
            "proportional_size": FALLOFF_FACTOR * float(np.sqrt(area)) * obj.matrix_world.median_scale}


def _create_restore_timer(scene: str, user_size: float) -> Callable[[], float | None]:
    """A timer function that restores the user's size in a scene after Blender's tool has ended and written its own."""
    def check() -> float | None:
        settings = getattr(bpy.data.scenes.get(scene), "tool_settings", None)
        if settings is None:
            return None
        if settings.proportional_size == user_size:
            return TIMER_STEP if _is_transforming() else None
        settings.proportional_size = user_size
        return None
    return check


def _is_transforming() -> bool:
    """Whether one of Blender's transform tools may be running. Always True before Blender 4.2: older versions can't tell."""
    windows = bpy.context.window_manager.windows
    if not all(hasattr(window, "modal_operators") for window in windows):
        return True
    return any(operator.bl_idname.startswith("TRANSFORM_OT") for window in windows
               for operator in window.modal_operators)


def unregister() -> None:
    """Stops the timer, and restores the user's size if Blender's tool has ended."""
    global _timer
    if _timer and bpy.app.timers.is_registered(_timer):
        _timer()
        bpy.app.timers.unregister(_timer)
    _timer = None
