# SPDX-License-Identifier: GPL-3.0-or-later
"""object.partwheel_place: the active part follows the mouse and sits with its border on the surfaces in the view."""

import bpy
from mathutils import Vector

from ..mesh import Refused, check_poll, find_object, read_only_reason, report_errors, resolve_object
from ..solid import composition
from ..view import keys
from . import placement
from ..view.picking import find_surface_under, find_view_under_mouse
from ..translations.lookup import iface_
from .adjusting import Adjusting


class OBJECT_OT_partwheel_place(Adjusting, bpy.types.Operator):
    """Place the active part on a surface: it follows the mouse with its border on the surface"""

    bl_idname = "object.partwheel_place"
    bl_label = "Place Part"
    lost_message = "{operator} stopped: the part is no longer the active object."
    transform = None  # the part's transform before

    target: bpy.props.StringProperty(name="Onto", description="The object that the part is placed on")
    location: bpy.props.FloatVectorProperty(name="Location", description="Location of the part's border",
        subtype="TRANSLATION")
    normal: bpy.props.FloatVectorProperty(
        name="Normal", description="Normal of the surface at the location", subtype="DIRECTION", default=(0, 0, 1))
    scale: bpy.props.FloatProperty(name="Size", description="Factor of the part's size", default=1, min=1e-4)
    fit: bpy.props.BoolProperty(
        name="Fit Border", description="Fit the part to the target's nearest border, where a part was removed",
        options={"SKIP_SAVE"})
    mirror: bpy.props.BoolProperty(
        name="Mirror Copy", description="Add the mirror image across the target's own X axis", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.active_object
        is_mesh = context.mode == "OBJECT" and obj is not None and obj.type == "MESH"
        return (check_poll(cls, is_mesh, "In Object Mode, make the part that you want to place the active object.")
                and check_poll(cls, not obj.library, read_only_reason(obj)))

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        part = context.active_object
        target = resolve_object(self.target)
        if (self.fit or self.mirror) and (target is None or target.type != "MESH"):
            raise Refused("Choose the mesh object to place the part on.")
        for sentence in composition.loss_messages(part) if self.mirror else ():
            self.report({"WARNING"}, sentence)
        mirrored = placement.place(part, target, self._pose(), self.mirror)
        if mirrored:
            mirrored.select_set(True)
        return {"FINISHED"}

    def _pose(self) -> placement.Pose:
        return placement.Pose(Vector(self.location), Vector(self.normal), self.scale, self.angle, self.depth, self.fit)

    # ---- With the mouse

    def on_start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        part = context.active_object
        self.part_name, self.transform = part.name_full, placement.local_transform(part)
        self.start_matrix, self.part_loop = part.matrix_world.copy(), placement.anchor_loop(part)
        self.target, self.scale = "", 1
        self._call_before_saving(self._restore_transform)
        self._show_status(context, iface_("Move the mouse over a surface"), keys.PLACING)
        self._on_mouse_move(context, event)
        return {"RUNNING_MODAL"}

    def can_continue(self, context: bpy.types.Context) -> bool:
        part = context.active_object
        return part is not None and part.name_full == self.part_name and context.mode == "OBJECT"

    def _on_mouse_move(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """Follow the surface under the mouse, behind the part."""
        view = find_view_under_mouse(context, event)
        hit = view and find_surface_under(context, *view, lambda obj: obj.type == "MESH" and obj.name_full != self.part_name)
        if hit:
            self.location, self.normal, self.target = hit.location, hit.normal, hit.obj.name_full
            self._show(context)

    def _on_other_key(self, event: bpy.types.Event, _sign: int) -> bool:
        if event.type not in keys.FIT.events or not self.target:
            return False
        self.fit, self.scale = not self.fit, 1
        return True

    def on_confirm(self, context: bpy.types.Context) -> set[str]:
        if not self.target:
            self._show_status(context, iface_("There is no surface under the mouse yet"), keys.PLACING)
            return {"RUNNING_MODAL"}
        if self.mirror:
            composition.update_matrices()
            placement.create_mirror_copy(context.active_object, find_object(self.target)).select_set(True)
        return {"FINISHED"}

    def on_cancel(self, _context: bpy.types.Context) -> None:
        self._restore_transform()

    def _restore_transform(self) -> None:
        part = self.transform and find_object(self.part_name)
        if part:
            placement.restore_transform(part, self.transform)

    def _show(self, context: bpy.types.Context) -> None:
        if not self.target:
            return
        target = find_object(self.target)
        try:
            placement.move_to_pose(context.active_object, self.start_matrix, self.part_loop, target, self._pose())
        except Refused as error:
            self.fit = False
            placement.move_to_pose(context.active_object, self.start_matrix, self.part_loop, target, self._pose())
            self._show_status(context, str(error), keys.PLACING)
            return
        state = [iface_("Onto {name}").format(name=target.name), self._adjustment_text()]
        state += [iface_("fitted")] * self.fit + [iface_("with mirror copy")] * self.mirror
        self._show_status(context, ", ".join(state), keys.PLACING)
