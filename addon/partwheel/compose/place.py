# SPDX-License-Identifier: GPL-3.0-or-later
"""object.partwheel_place: the active part follows the mouse over the surfaces in the view, its border onto them."""

import math

import bpy
from mathutils import Vector

from ..mesh import objects
from ..solid import composition
from ..view import keys
from . import placement
from ..view.picking import surface_under, view_under
from ..view.in_view import InView

CONFIRM, CANCEL = keys.CLICK.events | keys.CONFIRM.events, keys.CANCEL.events
PASS = keys.NAVIGATE.events | keys.SYSTEM
SIZE_STEP, TURN_STEP, DEPTH_STEP = 1.05, math.radians(5), 0.05


class OBJECT_OT_partwheel_place(InView, bpy.types.Operator):
    """Place the active part on a surface: it follows the mouse, its border on the surface and turned to it"""

    bl_idname = "object.partwheel_place"
    bl_label = "Place Part"
    bl_options = {"REGISTER", "UNDO"}
    lost = "the part is no longer the active object"
    transform = None  # its own, before

    target: bpy.props.StringProperty(name="Onto", description="The object that the part is placed on")
    location: bpy.props.FloatVectorProperty(name="Location", description="Where its border goes", subtype="TRANSLATION")
    normal: bpy.props.FloatVectorProperty(
        name="Normal", description="Of the surface there", subtype="DIRECTION", default=(0, 0, 1))
    scale: bpy.props.FloatProperty(name="Size", description="Times the size that it had", default=1, min=1e-4)
    angle: bpy.props.FloatProperty(
        name="Turn", description="About the normal", subtype="ANGLE", default=0, options={"SKIP_SAVE"})
    depth: bpy.props.FloatProperty(
        name="Depth", description="How far it is sunk in, times the radius of its border", default=0,
        options={"SKIP_SAVE"})
    fit: bpy.props.BoolProperty(
        name="Fit Border", description="Onto the target's nearest border, where a part was removed, and of its size",
        default=False, options={"SKIP_SAVE"})
    mirror: bpy.props.BoolProperty(
        name="Mirror Copy", description="Add the mirror image across the target's own X axis", default=False,
        options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        if context.mode != "OBJECT" or obj is None or obj.type != "MESH":
            cls.poll_message_set("In Object Mode, make the part to be placed the active object")
            return False
        return True

    def execute(self, context):
        part = context.active_object
        target = objects.wanted(self.target)
        if (self.fit or self.mirror) and (target is None or target.type != "MESH"):
            self.report({"ERROR"}, "Say which mesh object the part is placed on.")
            return {"CANCELLED"}
        try:
            mirrored = placement.place(part, target, self._pose(), self.mirror)
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if mirrored:
            mirrored.select_set(True)
        return {"FINISHED"}

    def _pose(self):
        return placement.Pose(Vector(self.location), Vector(self.normal), self.scale, self.angle, self.depth, self.fit)

    # ---- With the mouse --------------------------------------------------------------------------------------------

    def _begin(self, context, event):
        part = context.active_object
        self.part_name, self.transform = part.name_full, placement.own_transform(part)
        self.start, self.own = part.matrix_world.copy(), placement.anchor(part)
        self.target, self.scale = "", 1
        self._before_saving(self._put_back)
        self._tell(context, "Move the mouse over a surface", keys.PLACING)
        self._follow(context, event)
        return {"RUNNING_MODAL"}

    def _still_there(self, context):
        part = context.active_object
        return part is not None and part.name_full == self.part_name and context.mode == "OBJECT"

    def _handle(self, context, event):
        if event.type in PASS:
            return {"PASS_THROUGH"}
        if event.type == "MOUSEMOVE":
            self._follow(context, event)
            return {"RUNNING_MODAL"}
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return {"RUNNING_MODAL"}
        if event.type in CANCEL:
            return {"CANCELLED"}
        if event.type in CONFIRM:
            if not self.target:
                self._tell(context, "There is no surface under the mouse yet", keys.PLACING)
                return {"RUNNING_MODAL"}
            if self.mirror:
                composition.update_matrices()
                placement.mirrored(context.active_object, objects.named(self.target)).select_set(True)
            return {"FINISHED"}
        sign = keys.SIGNS.get(event.type, 0)
        if event.type in keys.TURN.events and event.shift:
            self.angle += sign * TURN_STEP
        elif event.type in keys.SIZE.events:
            self.scale *= SIZE_STEP ** sign
        elif event.type in keys.DEPTH.events:
            self.depth -= sign * DEPTH_STEP
        elif event.type in keys.FIT.events and self.target:
            self.fit, self.scale = not self.fit, 1
        elif event.type in keys.MIRROR.events:
            self.mirror = not self.mirror
        else:
            return {"RUNNING_MODAL"}
        self._show(context)
        return {"RUNNING_MODAL"}

    def _take_back(self, _context):
        self._put_back()

    def _put_back(self):
        part = self.transform and objects.named(self.part_name)
        if part:
            placement.put_back(part, self.transform)

    def _follow(self, context, event):
        hit = self._surface_under(context, event)
        if hit:
            self.location, self.normal, self.target = hit
            self._show(context)

    def _surface_under(self, context, event):
        """(location, normal towards the eye, object's full name) of what is under the mouse behind the part itself."""
        view = view_under(context.window, event.mouse_x, event.mouse_y)
        if not view:
            return None
        _, region, _ = view
        point = event.mouse_x - region.x, event.mouse_y - region.y
        found = surface_under(context, *view, point,
                              lambda obj: obj.type == "MESH" and obj.name_full != self.part_name)
        return found and (found.location, found.normal, found.obj.name_full)

    def _show(self, context):
        if not self.target:
            return
        target = objects.named(self.target)
        try:
            placement.put(context.active_object, self.start, self.own, target, self._pose())
        except ValueError as error:
            self.fit = False
            placement.put(context.active_object, self.start, self.own, target, self._pose())
            self._tell(context, str(error), keys.PLACING)
            return
        state = [f"Onto {target.name}", f"size {self.scale:.2f}", f"turn {math.degrees(self.angle):.0f}°",
                 f"depth {self.depth:.2f}"]
        self._tell(context, ", ".join(state + ["fitted"] * self.fit + ["with mirror copy"] * self.mirror), keys.PLACING)


CLASSES = (OBJECT_OT_partwheel_place,)
