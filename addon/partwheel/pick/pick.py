# SPDX-License-Identifier: GPL-3.0-or-later
"""Picking a part with mouse and keys: the base of the operators in all modes.

A click picks a face; the wheel grows and shrinks the part around it until it is confirmed or canceled. An operator is
composed of a picker (face_picker.py: what can be clicked), a target (PartPicker.create_target(): how the part is shown
in the mesh until then) and a display (display.py: what is drawn)."""

import contextlib
import functools
from dataclasses import replace

import bpy
import numpy as np

from ..mesh import MeshSnapshot, Refused, Selections, find_object, read_only_reason, report_errors
from ..parts import builds, picks, registry
from ..preferences import preferences
from ..view import keys, picking
from ..view.stepper import StepButtons
from . import borders, states
from partwheel import Hierarchy, PartwheelError
from .click_area import ClickArea
from .display import pick_display
from .view_cache import prepare_next_slice, get_view_cache
from ..view.visible_surface import NO_FACE
from .build import start_build, build_and_wait
from ..view.in_view import InView
from ..translations.lookup import iface_, get_operator_label, format_percent, rpt_
from .object_groups import find_object_groups


class PreviewTarget:
    """Leaves the mesh as it is until the part is confirmed: changing a million elements would be slow."""

    def __init__(self, obj: bpy.types.Object) -> None:
        self.name, self.mode, self.faces = obj.name_full, obj.mode, len(obj.data.polygons)

    def select(self, obj: bpy.types.Object, faces: np.ndarray, face: int, extend: bool, deselect: bool,
               group: frozenset) -> None:
        """Show the part, as far as pick_display does not."""

    def selected_before(self, _obj: bpy.types.Object) -> np.ndarray | None:
        """Return the faces to which the part is added, as far as they can be seen."""
        return None

    def restore(self) -> None:
        """Undo select()."""

    def is_valid(self) -> bool:
        """Return whether the object is in the same mode and has as many faces as before."""
        obj = find_object(self.name)
        return obj is not None and obj.mode == self.mode and len(obj.data.polygons) == self.faces


class PartPicker(InView):
    """Mixin for operators. level and face_index: for Repeat Last and the panel of the last operation."""

    face_index: bpy.props.IntProperty(name="Face", description="The face that was clicked", min=0)
    level: bpy.props.IntProperty(
        name="Level",
        description="Notches of the wheel from the part that a click selects at any zoom; larger is positive")
    extend: bpy.props.BoolProperty(
        name="Extend", description="Add the part to the selection instead of replacing it", options={"SKIP_SAVE"})
    deselect: bpy.props.BoolProperty(
        name="Deselect", description="Remove the part from the selection", options={"SKIP_SAVE"})
    snap: bpy.props.BoolProperty(
        name="Snap Border", description="Move the border of the part into nearby creases", options={"SKIP_SAVE"})
    tool: bpy.props.BoolProperty(
        name="From the Toolbar", description="The next click starts with the next part, and other keys go to Blender",
        options={"SKIP_SAVE", "HIDDEN"})

    # ---- Implemented by operators

    picker = None  # one of face_picker
    commands = ()  # keys.COMMANDS that the status bar shows after a pick
    confirm_events = frozenset()  # more events that confirm, without Shift and Ctrl

    def start_picker(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Set the picker for this start with the mouse. Return whether there is anything to pick from, or report."""
        return True

    def create_target(self, context: bpy.types.Context, snapshot: MeshSnapshot) -> PreviewTarget | Selections:
        """Return a new target for a pick from the object of this snapshot: with the methods of PreviewTarget."""
        return PreviewTarget(snapshot.obj)

    def on_miss(self, context: bpy.types.Context) -> set[str]:
        """Handle a click of the tool that misses all meshes."""
        return {"CANCELLED"}

    def _commit(self, context: bpy.types.Context) -> set[str]:
        """Apply the confirmed part, which the target shows, and return the operator's result."""
        return self._apply(context, self._find_object(context), self.faces, self.state)

    def _apply(self, context: bpy.types.Context, obj: bpy.types.Object, faces: np.ndarray,
               picked: states.PickedPart) -> set[str]:
        """Apply faces without a target, and return the operator's result."""
        raise NotImplementedError

    n_started = 0  # number of picks started with the mouse, by all operators
    state, target, object_name = states.WaitingForClick(), None, ""
    step_buttons, is_wheel_active = None, True
    view_size = 0.0  # at the clicked face, see picking.measure_view()

    # ---- Without a window

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = next(iter(self.picker.find_objects(context)), None)
        if not obj:
            raise Refused("Select a mesh object, in Edit Mode or Object Mode.")
        if reason := read_only_reason(obj):
            self.report({"ERROR"}, reason)
            return {"CANCELLED"}
        snapshot = MeshSnapshot(obj)
        hierarchy = build_and_wait(self, context, snapshot)
        if not hierarchy:
            return {"CANCELLED"}
        try:
            picked = self._with_groups(context, obj, states.pick_face(hierarchy, self.face_index, self.level))
        except PartwheelError as error:
            raise Refused("Face {number} can't be picked: {reason}", number=self.face_index, reason=error) from error
        picked = picked.at_stop(picked.start + self.level)
        result = self._apply(context, obj, borders.get_part_faces(snapshot, hierarchy, picked.node, self.snap), picked)
        picks.remember(snapshot, picked.face, picked.node, self.snap)
        picks.record_selection(snapshot)
        return result

    # ---- With the mouse: from nothing to a part

    def on_start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not self.start_picker(context, event):
            return {"CANCELLED"}
        PartPicker.n_started += 1
        self.start_number = PartPicker.n_started
        self.scroll, self.drag = keys.NotchCounter(), None
        self.click_area = ClickArea(context, event, self.tool)
        if self.tool and (event.is_tablet or preferences().show_steps):
            self.step_buttons = StepButtons(event.mouse_x, event.mouse_y)
        objects = self.picker.find_objects(context)
        if not objects:
            self.report({"WARNING"}, rpt_("This 3D view does not show the mesh that is being edited."))
            return {"CANCELLED"}
        context.view_layer.update()  # so that Blender reports all changes
        self.state = states.Preparing(event.type, event.value, event.mouse_x, event.mouse_y)
        if not prepare_next_slice(objects):
            return self._finish_start(context)
        # Prepare in slices, so that the window doesn't block.
        self._slices = self._exit_stack.enter_context(contextlib.ExitStack())
        self._add_timer(context, 0, self._slices)
        return {"RUNNING_MODAL"}

    def _on_preparing(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Prepare one more slice; when a key or button is pressed, all remaining ones."""
        objects, is_released = self.picker.find_objects(context), event.value == "RELEASE"
        is_idle = is_released or event.type in keys.SYSTEM | keys.MOVES
        if is_released and event.type == self.state.type:
            self.state = replace(self.state, value=event.value)
        while prepare_next_slice(objects):
            if is_idle:
                return {"RUNNING_MODAL"}
        self._slices.close()
        answer = self._finish_start(context)
        return answer if is_idle or answer != {"RUNNING_MODAL"} else self._call_on_event(context, event)

    def _finish_start(self, context: bpy.types.Context) -> set[str]:
        """All data of the meshes is prepared: handle the event that started the operator."""
        event, self.state = self.state, states.WaitingForClick()
        if hit := self._find_face(context, event):
            return self._pick_face(context, event, MeshSnapshot(hit.obj, trust_reports=True), hit.face)
        if self.tool:
            return self.on_miss(context)
        snapshot = MeshSnapshot(self.picker.find_objects(context)[0], trust_reports=True)
        if self._find_hierarchy(snapshot) is None:
            return self._start_build(context, snapshot, None)
        return self._wait_for_click(context, iface_("Click a face of the mesh"))

    def _find_face(self, context: bpy.types.Context, event: bpy.types.Event) -> picking.FaceHit | None:
        """Return the face under the mouse, or None. Report one that modifiers have generated."""
        hit = self.picker.find_face(context, event)
        if hit and hit.face == NO_FACE:
            self.report({"INFO"}, rpt_("The face there was generated by the modifiers of {name} and belongs to no face of "
                                       "its mesh.").format(name=hit.obj.name))
            return None
        self.view_size = hit.view_size if hit else self.view_size
        return hit

    @staticmethod
    def _find_hierarchy(snapshot: MeshSnapshot) -> Hierarchy | None:
        """Return the hierarchy of the mesh; None without one, or while a new one is built."""
        return None if builds.is_being_built(snapshot) else registry.get_hierarchy(snapshot)

    def _pick_face(self, context: bpy.types.Context, event: bpy.types.Event, snapshot: MeshSnapshot,
                   face: int) -> set[str]:
        self.hierarchy = self._find_hierarchy(snapshot)
        if self.hierarchy is None:
            # Remember the face: the user may turn the view during the build.
            return self._start_build(context, snapshot, face)
        picked = states.pick_face(self.hierarchy, face, view=self.view_size)
        if event.type == "LEFTMOUSE" and event.value == "PRESS":
            self.drag = event.mouse_y, picked.index
        return self._start_holding(context, snapshot, picked)

    def _start_holding(self, context: bpy.types.Context, snapshot: MeshSnapshot, picked: states.PickedPart) -> set[str]:
        self.object_name, self.shown_part = snapshot.obj.name_full, None
        self.target = self.create_target(context, snapshot)
        self._add_draw_handler(pick_display.draw)
        self._exit_stack.callback(pick_display.clear)
        if self.step_buttons:
            self._add_draw_handler(self.step_buttons.draw, "POST_PIXEL")
        return self._show(context, picked)

    def _start_build(self, context: bpy.types.Context, snapshot: MeshSnapshot, face: int | None) -> set[str]:
        building = start_build(self, snapshot)
        if not building:
            return {"CANCELLED"}
        self.object_name = snapshot.obj.name_full
        return self._wait_for_build(context, building, functools.partial(self._pick_built_face, face))

    def _pick_built_face(self, face: int | None, context: bpy.types.Context, hierarchy: Hierarchy | None) -> set[str]:
        self.hierarchy = hierarchy
        if not self.hierarchy or self.start_number < PartPicker.n_started:  # a later click replaces this one
            return {"CANCELLED"}
        obj = self._find_object(context)
        if obj is None or context.area is None:
            self.report({"INFO"}, rpt_("The parts are found. Start {operator} again to pick them.").format(
                operator=get_operator_label(self)))
            return {"CANCELLED"}
        if face is not None:
            picked = states.pick_face(self.hierarchy, face, view=self.view_size)
            return self._start_holding(context, MeshSnapshot(obj), picked)
        return self._wait_for_click(context, iface_("Click a face of the mesh"))

    def _find_object(self, context: bpy.types.Context) -> bpy.types.Object | None:
        """Return the object that the part belongs to, if it can still be picked from."""
        return next((obj for obj in self.picker.find_objects(context) if obj.name_full == self.object_name), None)

    def _wait_for_click(self, context: bpy.types.Context, header: str) -> set[str]:
        self._show_status(context, header, keys.WAITING)
        return {"RUNNING_MODAL"}

    # ---- With a part, or waiting for one

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if isinstance(self.state, states.Preparing):
            return self._on_preparing(context, event)
        if self.target and registry.find_hierarchy(self._find_object(context).data) is not self.hierarchy:
            self.report({"WARNING"}, rpt_("Partwheel stopped: the parts were found again. Pick one of them."))
            return {"CANCELLED"}
        if self.target:
            pick_display.update_frame(self._find_object(context))
        if event.type in keys.SYSTEM:
            return {"PASS_THROUGH"}
        is_holding = isinstance(self.state, states.PickedPart)
        if event.type in keys.MOVES:
            return self._on_drag(context, event)
        is_over_view = picking.find_view_under_mouse(context, event) is not None
        is_plain = not (event.alt or event.oskey or event.ctrl and not (self.deselect or event.type == "LEFTMOUSE"))
        is_at_click = is_holding and self.click_area.contains(context, event)
        if event.type == "TRACKPADPAN" and is_at_click and is_plain and not event.shift:
            notches = self.scroll.add_pixels(event.mouse_y - event.mouse_prev_y)
            return self._show(context, self.state.turn(notches))
        is_wheel = event.type in {"WHEELUPMOUSE", "WHEELDOWNMOUSE"}
        if event.type in keys.NAVIGATE.events or (is_wheel and not (is_at_click if is_holding else is_over_view)) or (
                not is_plain and (event.type in keys.WHEEL_STEPS or event.type in keys.BUTTONS)):
            return {"PASS_THROUGH"}
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self.drag = None
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:  # Blender may report a quick second press as a double click
            return {"RUNNING_MODAL"}
        if event.type in keys.CANCEL.events:
            return {"CANCELLED"}
        if is_holding:
            return self._key_while_holding(context, event, is_over_view)
        return self._key_while_waiting(context, event)

    def _key_while_waiting(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "LEFTMOUSE":
            hit = self._find_face(context, event)
            if not hit:
                return self._wait_for_click(context, iface_("There is no face there"))
            self.extend, self.deselect = self.extend or bool(event.shift), self.deselect or bool(event.ctrl)
            return self._pick_face(context, event, MeshSnapshot(hit.obj), hit.face)
        return {"RUNNING_MODAL"}

    def _key_while_holding(self, context: bpy.types.Context, event: bpy.types.Event, is_over_view: bool) -> set[str]:
        step = self.step_buttons.step_at(event) if self.step_buttons and event.type == "LEFTMOUSE" else 0
        if step:
            return self._show(context, self.state.turn(step))
        if event.type in keys.WHEEL_STEPS:
            return self._show(context, self.state.turn(keys.WHEEL_STEPS[event.type]))
        if event.type in keys.DIGITS and not self.tool:
            return self._show(context, self.state.with_digit(keys.DIGITS[event.type]))
        if event.type in keys.ERASE.events and not self.tool:
            return self._show(context, self.state.without_digit())
        if event.type in keys.SNAP_BORDER.events and event.shift and event.ctrl:
            self.snap = not self.snap
            self._set_tool_snap(context)
            return self._show(context, self.state)
        if (event.type in keys.CONFIRM.events or event.type == "LEFTMOUSE" and is_over_view and not self.tool
                or event.type in self.confirm_events and not (event.shift or event.ctrl)):
            return self.on_confirm(context)
        if event.type in keys.MODIFIERS or (event.type == "LEFTMOUSE" and not self.tool):
            return {"RUNNING_MODAL"}
        # Other keys keep their meaning, including the commands on parts. A click picks the next part, by the tool's keymap.
        return self.on_confirm(context) | {"PASS_THROUGH"}

    def _on_drag(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Resize the part while the mouse, or a pen, moves up or down with the button pressed."""
        if self.drag and isinstance(self.state, states.PickedPart):
            begin, index = self.drag
            index += int((event.mouse_y - begin) / keys.DRAG_STEP)
            if index != self.state.index:
                return self._show(context, self.state.at_stop(index))
        if self.tool and self.target and self.is_wheel_active != self.click_area.contains(context, event):
            self.is_wheel_active = not self.is_wheel_active
            return self._show_state(context, self.state)
        return {"RUNNING_MODAL"}

    def _show(self, context: bpy.types.Context, state: states.PickedPart) -> set[str]:
        """Change to a state with a picked part and select the part."""
        obj = self._find_object(context)
        self.state = state = self._with_groups(context, obj, state)
        if (state.index, self.snap) != self.shown_part:
            self.shown_part = state.index, self.snap
            snapshot = MeshSnapshot(obj)
            self.faces = borders.get_part_faces(snapshot, self.hierarchy, state.node, self.snap)
            # Reads the mesh, so before it changes.
            parts = None if bpy.app.background else get_view_cache(snapshot).get_part_triangles(snapshot)
            if parts:
                pick_display.read_groups(obj, state)
            self.target.select(obj, self.faces, state.face, self.extend, self.deselect, state.group)
            if parts:
                pick_display.show(obj, parts, state, self.faces if self.snap else None,
                                  self.target.selected_before(obj) if self.extend else None)
        return self._show_state(context, state)

    def _with_groups(self, context: bpy.types.Context, obj: bpy.types.Object,
                     state: states.PickedPart) -> states.PickedPart:
        """Return the state with the groups above the root, if the wheel is at the root and they are not known yet."""
        if not state.needs_groups:
            return state
        groups = find_object_groups(obj, self.picker.find_group_candidates(context))
        return state.with_groups(tuple(frozenset(member.name_full for member in group) for group in groups))

    def _show_state(self, context: bpy.types.Context, state: states.PickedPart) -> set[str]:
        share = self.hierarchy.area[state.node] / self.hierarchy.area[-1]
        number = state.typed + "_" if state.typed else state.index + 1
        row = (keys.PICKED if not self.tool else keys.TOOL_PICKED if self.is_wheel_active else
               keys.TOOL_PICKED_AWAY)
        text = iface_("Part {number} of {count}, {faces:,} faces, {share} of the area").format(
            number=number, count=state.count, faces=len(self.faces), share=format_percent(share))
        if state.group:
            text = iface_("Part {number} of {count}, {objects} whole objects").format(
                number=number, count=state.count, objects=len(state.group))
        self._show_status(context, ", ".join([text] + [iface_("border in creases")] * self.snap),
                          row + self.commands + (keys.ENDS[1:] if self.tool else keys.ENDS))
        return {"RUNNING_MODAL"}

    def _set_tool_snap(self, context: bpy.types.Context) -> None:
        """Copy snap to the tool, for its next clicks and its header."""
        tool = self.tool and context.workspace.tools.from_space_view3d_mode(context.mode)
        if tool and tool.idname == "partwheel.select":
            tool.operator_properties(self.bl_idname).snap = self.snap

    # ---- Ends

    def on_confirm(self, context: bpy.types.Context) -> set[str]:
        obj = self._find_object(context)
        # For the panel of the last operation, and Repeat Last.
        self.face_index, self.level = self.state.face, self.state.level
        snapshot = MeshSnapshot(obj)
        picks.remember(snapshot, self.state.face, self.state.node, self.snap)
        answer = self._commit(context)
        picks.record_selection(snapshot)
        return answer

    def on_cancel(self, context: bpy.types.Context) -> None:
        if self.target and self.can_continue(context):
            self.target.restore()

    def can_continue(self, context: bpy.types.Context) -> bool:
        if not self.target:
            return bool(self.picker.find_objects(context))
        return self._find_object(context) is not None and self.target.is_valid()
