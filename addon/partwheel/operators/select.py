# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_select: a click picks a face, the wheel grows and shrinks the part around it."""

import traceback
from typing import Callable, NamedTuple

import bpy

from .. import session, wheel
from ..core import PartwheelError
from ..picking import Picker, view_under
from ..selection import Selection
from .build import idle, start

UP = {"WHEELUPMOUSE", "PAGE_UP", "NUMPAD_PLUS"}
DOWN = {"WHEELDOWNMOUSE", "PAGE_DOWN", "NUMPAD_MINUS"}
CONFIRM = {"RET", "NUMPAD_ENTER"}
CANCEL = {"RIGHTMOUSE", "ESC"}
# Navigation, and events that must reach Blender itself.
PASS = {
    "MIDDLEMOUSE", "MOUSEPAN", "MOUSEZOOM", "MOUSEROTATE", "TRACKPADPAN", "TRACKPADZOOM", "NDOF_MOTION", "HOME",
    "NUMPAD_0", "NUMPAD_1", "NUMPAD_2", "NUMPAD_3", "NUMPAD_4", "NUMPAD_5", "NUMPAD_6", "NUMPAD_7", "NUMPAD_8",
    "NUMPAD_9", "NUMPAD_PERIOD", "TIMER", "TIMER_REPORT", "WINDOW_DEACTIVATE",
}



class HandOff(NamedTuple):
    """A key that confirms the part that is held and starts another operator with it."""

    key: str  # Blender's name of the event type
    shift: bool
    label: str  # what it does, for the status bar, after "Confirm and"
    start: Callable  # start(context): called once the pick is confirmed, remembered and an undo step of its own


HANDOFFS = [
    HandOff("G", False, "Move Proportionally", lambda context: bpy.ops.transform.translate(
        "INVOKE_DEFAULT", use_proportional_edit=True, use_proportional_connected=True)),
    HandOff("C", False, "Copy as Solid", lambda context: bpy.ops.mesh.partwheel_copy("INVOKE_DEFAULT", True)),
    HandOff("X", False, "Remove", lambda context: bpy.ops.mesh.partwheel_remove("INVOKE_DEFAULT", True)),
    HandOff("D", True, "Duplicate", lambda context: bpy.ops.mesh.duplicate_move("INVOKE_DEFAULT")),
]

WAITING_KEYS = "Partwheel   LMB: Pick a Part   MMB: Navigate   Esc/RMB: Cancel"
PICKED_KEYS = ("Partwheel   Wheel, Page Up/Down, Numpad +/-: Larger or Smaller Part   LMB, Enter: Confirm   "
               + "   ".join(f"{'Shift ' if each.shift else ''}{each.key}: Confirm and {each.label}" for each in HANDOFFS)
               + "   MMB: Navigate   Esc/RMB: Cancel")


class MESH_OT_partwheel_select(bpy.types.Operator):
    """Pick a part of the mesh with a click, then make it larger or smaller with the mouse wheel"""

    bl_idname = "mesh.partwheel_select"
    bl_label = "Select Part by Wheel"
    bl_options = {"REGISTER", "UNDO"}

    face_index: bpy.props.IntProperty(name="Face", description="The face that was clicked", default=0, min=0)
    level: bpy.props.IntProperty(
        name="Level", description="Notches of the wheel from the part that the click alone takes: up is positive",
        default=0,
    )
    extend: bpy.props.BoolProperty(
        name="Extend", description="Add the part to what is selected, instead of replacing it",
        default=False, options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context):
        return context.mode == "EDIT_MESH" and context.edit_object is not None and idle(cls)

    # ---- Without a window ------------------------------------------------------------------------------------------

    def execute(self, context):
        obj = context.edit_object
        hierarchy = session.hierarchy(obj)
        if not hierarchy:
            building = start(self, context)
            hierarchy = building and building.wait(context)
        if not hierarchy:
            return {"CANCELLED"}
        try:
            picked = wheel.pick(hierarchy, self.face_index, self.level)
        except PartwheelError as error:
            self.report({"ERROR"}, f"Face {self.face_index} can't be picked: {error}")
            return {"CANCELLED"}
        # The hierarchy was asked for, so the mesh is up to date.
        Selection(obj, obj.data).select(obj, hierarchy.faces(picked.node), picked.face, self.extend)
        session.remember_pick(obj, picked.face, picked.node)
        return {"FINISHED"}

    # ---- With the mouse --------------------------------------------------------------------------------------------

    def invoke(self, context, event):
        if context.window is None or context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, "Parts are picked in a 3D view: start this with the mouse over one.")
            return {"CANCELLED"}
        self.state = wheel.Waiting()
        result = self._guarded(context, lambda: self._begun(context, event))
        if result == {"RUNNING_MODAL"}:
            context.window_manager.modal_handler_add(self)
        return result

    def modal(self, context, event):
        return self._guarded(context, lambda: self._handle(context, event))

    def cancel(self, context):
        """Blender itself ends the tool: the window closes or another file opens."""
        if isinstance(self.state, wheel.Building):
            self.building.abandon(context)
        else:
            self._end(context)

    def _guarded(self, context, step):
        """One step; whatever goes wrong in it, the selection is put back and the tool ends, with a report."""
        try:
            return step()
        except Exception as error:  # any: a tool that dies in the middle leaves Blender with its keys and its selection
            traceback.print_exc()
            self.report({"ERROR"}, f"Partwheel stopped: {error}. The full report is in the system console.")
            return self._cancelled(context)

    def _begun(self, context, event):
        obj = context.edit_object
        self.object_name, self.selection, self.picker = obj.name_full, Selection(obj), Picker()
        self.hierarchy = session.hierarchy(obj)
        if self.hierarchy:
            return self._click(context, event, missed="Click a face of the mesh")
        # Which face was meant is found now: the user may turn the view while the parts are being built.
        face, _ = self._face_under(context, event)
        self.building = start(self, context)
        if not self.building:
            return {"CANCELLED"}
        self.state = wheel.Building(face)
        self.building.watch(context)
        return {"RUNNING_MODAL"}

    def _built_on(self, context, event):
        """While the parts are being built all but Esc goes to Blender itself; then the face is picked."""
        if not self.building.step(context, event):
            return {"PASS_THROUGH"}
        face, self.state = self.state.face, wheel.Waiting()
        self.hierarchy = self.building.hierarchy
        if not self.hierarchy:
            return {"CANCELLED"}
        obj = context.edit_object
        if obj is None or obj.name_full != self.object_name or context.area is None:
            self.report({"INFO"}, "The parts are built. Start Select Part by Wheel in Edit Mode to pick them.")
            return {"CANCELLED"}
        self.selection, self.picker = Selection(obj), Picker()
        if face is not None:
            return self._show(context, wheel.pick(self.hierarchy, face))
        self._tell(context, "Click a face of the mesh", WAITING_KEYS)
        return {"RUNNING_MODAL"}

    def _handle(self, context, event):
        if isinstance(self.state, wheel.Building):
            return self._built_on(context, event)
        if not self._still_there(context):
            self.report({"WARNING"}, "Partwheel stopped: the mesh is no longer being edited as it was.")
            self._end(context)
            return {"CANCELLED"}
        modified = event.ctrl or event.alt or event.oskey
        if event.type in PASS or (modified and event.type in UP | DOWN | {"LEFTMOUSE"}):
            return {"PASS_THROUGH"}
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:  # Blender may call a quick second press a double click
            return {"RUNNING_MODAL"}
        if event.type in CANCEL:
            return self._cancelled(context)
        if isinstance(self.state, wheel.Waiting):
            if event.type == "LEFTMOUSE":
                return self._click(context, event, missed="There is no face there")
            return {"RUNNING_MODAL"}
        if event.type in UP | DOWN:
            return self._show(context, self.state.turned(1 if event.type in UP else -1))
        if event.type in CONFIRM or (event.type == "LEFTMOUSE" and view_under(context.window, event.mouse_x,
                                                                              event.mouse_y)):
            return self._confirmed(context)
        for each in HANDOFFS:
            if (event.type, bool(event.shift)) == (each.key, each.shift):
                return self._handed_on(context, each)
        return {"RUNNING_MODAL"}

    def _click(self, context, event, missed):
        """Picks the face under the mouse, or says why there is none and waits on."""
        face, other = self._face_under(context, event)
        if face is not None:
            return self._show(context, wheel.pick(self.hierarchy, face))
        if other:
            missed = f"That is {other}; only the active object, {context.edit_object.name}, can be picked from"
        self._tell(context, missed, WAITING_KEYS)
        return {"RUNNING_MODAL"}

    def _face_under(self, context, event):
        """(index of the active object's face under the mouse or None, name of another edited object that is there)."""
        view = view_under(context.window, event.mouse_x, event.mouse_y)
        if not view:
            return None, None
        _, region, region_view = view
        point = event.mouse_x - region.x, event.mouse_y - region.y
        hits = [(self.picker.face_under(each, region, region_view, point), each)
                for each in context.objects_in_mode_unique_data]
        hits = [(found, each) for found, each in hits if found]
        if not hits:
            return None, None
        (face, _), hit = min(hits, key=lambda pair: pair[0][1])
        return (face, None) if hit.data == context.edit_object.data else (None, hit.name)

    def _show(self, context, state):
        """Goes to a state with a picked part and selects it."""
        if state != self.state:
            self.state = state
            self.selection.select(context.edit_object, self.hierarchy.faces(state.node), state.face, self.extend)
        self._tell(context, f"Part {state.index + 1} of {len(state.stops)}, "
                            f"{len(self.hierarchy.faces(state.node))} faces", PICKED_KEYS)
        return {"RUNNING_MODAL"}

    def _confirmed(self, context):
        # What the panel of the last operation, and Repeat Last, do again.
        self.face_index, self.level = self.state.face, self.state.level
        session.remember_pick(context.edit_object, self.state.face, self.state.node)
        self._end(context)
        return {"FINISHED"}

    def _handed_on(self, context, hand_off):
        """Confirms and starts another operator at once. Blender's own undo step for a finished operator would come
        after that one has begun to change the mesh, so the step is made here, and the answer that makes none is given.
        """
        self._confirmed(context)
        bpy.ops.ed.undo_push(message=self.bl_label)
        hand_off.start(context)
        return {"CANCELLED"}

    def _cancelled(self, context):
        if isinstance(self.state, wheel.Building):
            self.building.abandon(context)
            return {"CANCELLED"}
        try:
            if self._still_there(context):
                self.selection.restore(context.edit_object)
        finally:
            self._end(context)
        return {"CANCELLED"}

    def _still_there(self, context):
        obj = context.edit_object
        return obj is not None and obj.name_full == self.object_name and self.selection.fits(obj)

    def _tell(self, context, header, keys):
        context.workspace.status_text_set(keys)
        if context.area:
            context.area.header_text_set(f"Partwheel: {header}")

    def _end(self, context):
        if context.workspace:
            context.workspace.status_text_set(None)
        if context.area:
            context.area.header_text_set(None)
