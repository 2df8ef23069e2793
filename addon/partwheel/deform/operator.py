# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_deform: the picked part follows a handle that the user moves; the rest of the mesh stays."""

import bpy
import numpy as np

from partwheel.joint import REACH
from ..mesh import MeshSnapshot, Refused, check_poll, find_object, report_errors
from ..parts import picks, registry
from ..pick import borders
from ..view import keys
from ..view.in_view import InView, show_wait_cursor
from ..view.picking import find_view_under_mouse, get_region_view
from ..translations.lookup import iface_
from . import gizmo
from .movement import DIGIT_KEYS, Movement
from .session import DeformHandle, DeformSession, deform

TIMER_STEP = 0.03  # seconds
RESIZE_FACTOR = 1.25  # factor of the handle's size per notch
MAX_WAIT = 0.05  # seconds to wait for the background task before Blender handles other events


class PARTWHEEL_PG_handle(bpy.types.PropertyGroup):
    """A handle: the surface within a radius of a vertex, and where it goes."""

    vertex: bpy.props.IntProperty(name="Vertex", min=0)
    radius: bpy.props.FloatProperty(name="Radius", min=0)
    turn: bpy.props.IntProperty(name="Turn", min=0)  # handles of one turn act together; turns follow one another
    matrix: bpy.props.FloatVectorProperty(name="Matrix", size=16, default=tuple(np.eye(4).ravel()))


class MESH_OT_partwheel_deform(InView, bpy.types.Operator):
    """Drag a handle of the last picked part: the part follows like a soft body, and the rest of the mesh stays in place"""

    bl_idname = "mesh.partwheel_deform"
    bl_label = "Deform Part"
    session = None

    node: bpy.props.IntProperty(
        name="Part", description="Number of the part; -1: the last pick", default=-1, min=-1,
        options={"SKIP_SAVE"})
    method: bpy.props.EnumProperty(
        name="Method", description="How the part follows the handle",
        items=[("RIGID", "As Rigid as Possible", "The part follows the handle and keeps its details"),
               ("PROPORTIONAL", "Proportional", "The part moves as a whole, less toward its border"),
               ("JOINT", "At the Joint", "The part keeps its shape and turns at its border; the mesh near the "
                                         "border bends")],
        default="RIGID", options={"SKIP_SAVE"})
    rings: bpy.props.IntProperty(
        name="Rings", description="Rings of faces around the part that deform with it, for a softer transition",
        min=0, soft_max=10, options={"SKIP_SAVE"})
    reach: bpy.props.FloatProperty(
        name="Joint", description="Distance from the border within which the mesh bends, in radii of the border",
        default=REACH, min=0.1, soft_max=10, options={"SKIP_SAVE"})
    snap: bpy.props.BoolProperty(
        name="Snap Border", description="Deform the part up to the creases near its border instead of its own "
                                        "border; on for picks with a snapped border", options={"SKIP_SAVE"})
    handles: bpy.props.CollectionProperty(type=PARTWHEEL_PG_handle, options={"HIDDEN", "SKIP_SAVE"})
    start: bpy.props.EnumProperty(
        name="Start", description="The movement to start with",
        items=[("NONE", "None", ""), ("G", "Move", ""), ("R", "Rotate", ""), ("S", "Scale", "")],
        default="NONE", options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.edit_object
        return (check_poll(cls, context.mode == "EDIT_MESH" and obj, "Deform parts in Edit Mode of a mesh.")
                and check_poll(cls, registry.get_state(obj.data)[0] in registry.USABLE, picks.NO_PICK))

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.prop(self, "method")
        self.layout.prop(self, "reach" if self.method == "JOINT" else "rings")
        self.layout.prop(self, "snap")

    # ---- Without a window

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        """Moves the handles of the property to their matrices, at once."""
        obj = context.edit_object
        faces = self._faces(MeshSnapshot(obj))
        if not self.handles:
            raise Refused("There is no handle: drag one in the 3D view.")
        if max(item.vertex for item in self.handles) >= len(obj.data.vertices):
            raise Refused("The mesh doesn't have the vertex of a handle.")
        turns = [[DeformHandle(item.vertex, item.radius, np.array(item.matrix).reshape(4, 4))
                  for item in self.handles if item.turn == turn] for turn in sorted({item.turn for item in self.handles})]
        deform(obj, faces, self.method, self.rings, self.reach, turns)
        return {"FINISHED"}

    def _faces(self, snapshot: MeshSnapshot) -> np.ndarray:
        """The part's faces. Raises Refused."""
        hierarchy, node = picks.resolve_node(snapshot, self.node)
        if self.node < 0 and not self.properties.is_property_set("snap"):
            self.snap = picks.get_pick(snapshot).snap
        self.node = node
        return borders.get_part_faces(snapshot, hierarchy, self.node, self.snap)

    # ---- With the mouse

    def on_start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        obj = context.edit_object
        with show_wait_cursor(context):
            snapshot = MeshSnapshot(obj)
            faces, pick = self._faces(snapshot), picks.get_pick(snapshot)
            self.session = DeformSession(obj, faces, self.method, self.rings, self.reach, pick and pick.face)
        self._exit_stack.callback(self.session.abandon)
        self.is_confirmed = self.recompute = False
        self.movement, self.base = None, None  # the current movement; the active handle's matrix when it started
        self._add_timer(context, TIMER_STEP)
        self._add_draw_handler(self._draw)
        if self.start != "NONE":
            self._begin_movement(context, event, self.start)
        self._show_state(context)
        return {"RUNNING_MODAL"}

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in keys.CANCEL.events and event.value == "PRESS":
            return {"CANCELLED"}
        handled = {"TIMER", *(DIGIT_KEYS if self.movement else ())}
        if event.type in (keys.NAVIGATE.events | keys.SYSTEM) - handled:
            return {"PASS_THROUGH"}
        result, is_timer = None, event.type == "TIMER"
        step = self._on_timer if is_timer else self._handle_movement if self.movement else self._handle_idle
        try:
            if is_timer or not self.is_confirmed:
                result = step(context, event)
        except Refused as reason:
            self.report({"WARNING"}, str(reason))
        if not result or "RUNNING_MODAL" in result:
            self._show_state(context)
        return result or {"PASS_THROUGH" if is_timer else "RUNNING_MODAL"}

    # Steps: each returns the result of modal(), or None to go on.

    def _handle_idle(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str] | None:
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return None
        if event.type == "LEFTMOUSE":
            return self._on_click(context, event)
        self.recompute = event.type in keys.RECOMPUTE.events
        if self.recompute or event.type in keys.CONFIRM.events:
            return self.on_confirm(context)
        if event.type in keys.TRANSFORM.events:
            self._begin_movement(context, event, event.type)
        elif event.type in keys.HANDLE_SIZE.events:
            factor = RESIZE_FACTOR if event.type == "WHEELUPMOUSE" else 1 / RESIZE_FACTOR
            self.session.resize_handle(context.edit_object, factor)
        return None

    def _on_click(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str] | None:
        view, obj = find_view_under_mouse(context, event), context.edit_object
        if not view:
            return {"PASS_THROUGH"}
        hit = gizmo.hit_test(self.session.pivot(obj), *self._view(context, event))
        if hit:
            kind, axis = hit
            self._begin_movement(context, event, kind, dragging=True, axis=axis)
            return None
        vertex = self.session.vertex_under(obj, *view[1:])
        if vertex is None:
            return self.on_confirm(context)
        if self.method == "RIGID":
            self.session.place_handle(obj, vertex, event.shift)
        self._begin_movement(context, event, "R" if self.method == "JOINT" else "G", dragging=True)
        return None

    def _handle_movement(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str] | None:
        movement, obj = self.movement, context.edit_object
        if event.type == "INBETWEEN_MOUSEMOVE":  # a later one follows
            self._track(context, event)
        elif event.type in keys.MOVES | keys.SNAP_STEPS.events | keys.PRECISE.events:
            self._move_handle(context, event)
        elif movement.dragging and (event.type, event.value) == ("LEFTMOUSE", "RELEASE"):
            self.movement = None
            self._move_handle(context, event, movement)
        elif event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return None
        elif event.type in keys.DONE.events:
            self.movement = None
            self._move_handle(context, event, movement)
            if self.start != "NONE":  # the operator was started for this movement only
                return self.on_confirm(context)
        elif event.type in keys.TRANSFORM.events:
            self._begin_movement(context, event, event.type)
        elif event.type in keys.AXIS.events:
            movement.constrain("XYZ".index(event.type), event.shift, obj.matrix_world)
            self._move_handle(context, event)
        elif movement.type_key(event.type):
            self._move_handle(context, event)
        return None

    def _on_timer(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str] | None:
        """While the mouse rests, the shape relaxes."""
        if self.session.is_ready(context.edit_object):
            if self.is_confirmed:
                return self.on_confirm(context)
            self.session.relax(context.edit_object)
        return None

    # ---- A movement

    def _begin_movement(self, context: bpy.types.Context, event: bpy.types.Event, kind: str, dragging: bool = False,
                        axis: int | None = None) -> None:
        self.movement = Movement(kind, self.session.pivot(context.edit_object), dragging, axis)
        self.base = self.session.matrix
        self._track(context, event)

    def _view(self, context: bpy.types.Context,
              event: bpy.types.Event) -> tuple[bpy.types.Region, bpy.types.RegionView3D, tuple[int, int]]:
        """(region, RegionView3D, mouse in the region) of the view that the tool was started in, or its panels."""
        region = context.region
        if region.type != "WINDOW":
            region = next(candidate for candidate in context.area.regions if candidate.type == "WINDOW")
        return region, get_region_view(context.area, region), (event.mouse_x - region.x, event.mouse_y - region.y)

    def _track(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        self.movement.track(*self._view(context, event), event.shift)

    def _move_handle(self, context: bpy.types.Context, event: bpy.types.Event,
                     movement: Movement | None = None) -> None:
        """Moves the active handle to where the mouse or the typed number says; the part follows."""
        movement, obj = movement or self.movement, context.edit_object
        movement.track(*self._view(context, event), event.shift)
        world = movement.matrix(event.ctrl)
        self.session.move_handle(obj, np.array(obj.matrix_world.inverted_safe() @ world @ obj.matrix_world) @ self.base)

    # ---- Drawing

    def _draw(self) -> None:
        obj = find_object(self.session.name)
        if obj is None:
            return
        self.session.draw(obj)
        if not self.movement:
            gizmo.draw_gizmo(self.session.pivot(obj), bpy.context.region, bpy.context.region_data)

    def _show_state(self, context: bpy.types.Context) -> None:
        state = self.movement.status_text() if self.movement else self.session.status_text()
        if self.session.task:
            text = iface_("{state}: settling") if self.is_confirmed else iface_("{state}: getting ready")
            state = text.format(state=state)
        self._show_status(context, state, keys.MOVING if self.movement else keys.DEFORMING)

    # ---- The end

    def on_confirm(self, context: bpy.types.Context) -> set[str]:
        """Ends once the part has its rest shape."""
        self.is_confirmed = True
        if not self.session.settle_within(context.edit_object, MAX_WAIT):
            return {"RUNNING_MODAL"}
        if not self.session.has_changed:
            return {"CANCELLED"}
        self.reach = self.session.reach
        self.handles.clear()
        for turn, stage_handles in enumerate([*self.session.turns, self.session.handles]):
            for handle in stage_handles:
                item = self.handles.add()
                item.turn, item.vertex, item.radius = turn, handle.vertex, handle.radius
                item.matrix = handle.matrix.ravel()
        if self.recompute and bpy.ops.mesh.partwheel_build.poll():
            bpy.ops.mesh.partwheel_build("INVOKE_DEFAULT")
        return {"FINISHED"}

    def on_cancel(self, context: bpy.types.Context) -> None:
        if self.session and self.can_continue(context):
            self.session.restore(context.edit_object)

    def can_continue(self, context: bpy.types.Context) -> bool:
        return self.session.fits(context.edit_object)
