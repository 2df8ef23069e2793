# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_deform: a picked part follows a handle that is dragged, turned and scaled; all beyond it stays."""

import bpy
import numpy as np

from partwheel import Error
from partwheel.joint import REACH
from ..mesh import mesh_identity
from ..mesh.errors import Refused
from ..mesh.poll import check_poll
from ..parts import picks, registry
from ..pick import borders
from ..view import keys
from ..view.in_view import InView, show_wait_cursor
from ..view.picking import find_view_under_mouse, get_region_view
from ..words.say import iface_
from . import gizmo
from .held import Handle, Held, deform
from .movement import DIGITS, Movement

TICK = 0.03  # seconds
NOTCH = 1.25  # what a notch of the wheel makes of the handle's size
PATIENCE = 0.05  # seconds that Blender waits for what is done in the background, before it goes on meanwhile


class PARTWHEEL_PG_handle(bpy.types.PropertyGroup):
    """A handle: a vertex and how far around it the surface belongs to it; and where it went."""

    vertex: bpy.props.IntProperty(name="Vertex", min=0)
    radius: bpy.props.FloatProperty(name="Radius", min=0)
    turn: bpy.props.IntProperty(name="Turn", min=0)  # handles of one turn act together, one turn after the other
    matrix: bpy.props.FloatVectorProperty(name="Matrix", size=16, default=tuple(np.eye(4).ravel()))


class MESH_OT_partwheel_deform(InView, bpy.types.Operator):
    """Drag a handle of the part that was picked last: the part follows like a soft body, all beyond it stays"""

    bl_idname = "mesh.partwheel_deform"
    bl_label = "Deform Part"
    bl_options = {"REGISTER", "UNDO"}
    held = None

    node: bpy.props.IntProperty(
        name="Part", description="The part's number; -1: the part that was picked last", default=-1, min=-1,
        options={"SKIP_SAVE"})
    method: bpy.props.EnumProperty(
        name="Method", description="How the part follows the handle",
        items=[("RIGID", "As Rigid as Possible", "The part follows the handle and keeps its details"),
               ("PROPORTIONAL", "Proportional", "The part moves as a whole, less and less towards its border"),
               ("JOINT", "At the Joint", "The part keeps its shape and turns about its border; what is near that, on "
                                         "either side, bends")],
        default="RIGID", options={"SKIP_SAVE"},
    )
    rings: bpy.props.IntProperty(
        name="Rings", description="So many rings of faces around the part deform with it, for a softer join", default=0,
        min=0, soft_max=10, options={"SKIP_SAVE"})
    reach: bpy.props.FloatProperty(
        name="Joint", description="How far from the part's border it bends, in radii of the border", default=REACH,
        min=0.1, soft_max=10, options={"SKIP_SAVE"})
    snap: bpy.props.BoolProperty(
        name="Snap Border", description="Deform the part as far as the creases near its border, not as far as its own "
        "border; a part that was picked so is", default=False, options={"SKIP_SAVE"})
    handles: bpy.props.CollectionProperty(type=PARTWHEEL_PG_handle, options={"HIDDEN", "SKIP_SAVE"})
    start: bpy.props.EnumProperty(
        name="Start", description="The movement to start with",
        items=[("NONE", "None", ""), ("G", "Move", ""), ("R", "Rotate", ""), ("S", "Scale", "")],
        default="NONE", options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context):
        obj = context.edit_object
        return (check_poll(cls, context.mode == "EDIT_MESH" and obj, "Parts are deformed in Edit Mode of a mesh.")
                and check_poll(cls, registry.get_state(obj.data)[0] in registry.USABLE, picks.NO_PICK))

    def draw(self, _context):
        self.layout.prop(self, "method")
        self.layout.prop(self, "reach" if self.method == "JOINT" else "rings")
        self.layout.prop(self, "snap")

    # ---- Without a window ------------------------------------------------------------------------------------------

    def execute(self, context):
        """The part goes where handles say, at once."""
        obj = context.edit_object
        try:
            faces = self._faces(obj)
            if not self.handles:
                raise Refused("There is no handle: drag one in the 3D view.")
            if max(each.vertex for each in self.handles) >= len(obj.data.vertices):
                raise Refused("A handle is a vertex that the mesh doesn't have.")
            turns = [[Handle(each.vertex, each.radius, np.array(each.matrix).reshape(4, 4)) for each in self.handles
                      if each.turn == turn] for turn in sorted({each.turn for each in self.handles})]
            deform(obj, faces, self.method, self.rings, self.reach, turns)
        except Error as error:  # faces too thin, for instance
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _faces(self, obj):
        """The part's faces. Raises Refused."""
        hierarchy, node = picks.resolve_node(obj, self.node)
        if self.node < 0 and not self.properties.is_property_set("snap"):
            self.snap = picks.get_pick(obj).snap
        self.node = node
        return borders.get_part_faces(obj, hierarchy, self.node, self.snap)

    # ---- With the mouse --------------------------------------------------------------------------------------------

    def on_start(self, context, event):
        obj = context.edit_object
        with show_wait_cursor(context):
            faces, picked = self._faces(obj), picks.get_pick(obj)
            self.held = Held(obj, faces, self.method, self.rings, self.reach, picked and picked.face)
        self._exit_stack.callback(self.held.abandon)
        self.confirmed = self.recompute = False
        self.movement, self.base = None, None  # that is under way; the last handle's matrix when it began
        self._add_timer(context, TICK)
        self._add_draw_handler(self._draw)
        if self.start != "NONE":
            self._begin_movement(context, event, self.start)
        self._tell_state(context)
        return {"RUNNING_MODAL"}

    def on_event(self, context, event):
        if event.type in keys.CANCEL.events and event.value == "PRESS":
            return {"CANCELLED"}
        passed = keys.NAVIGATE.events | keys.SYSTEM
        if event.type != "TIMER" and event.type in (passed - set(DIGITS) if self.movement else passed):
            return {"PASS_THROUGH"}
        step = self._tick if event.type == "TIMER" else self._during if self.movement else self._between
        answer = None
        try:
            if event.type == "TIMER" or not self.confirmed:
                answer = step(context, event)
        except Refused as reason:
            self.report({"WARNING"}, str(reason))
        if not answer or "RUNNING_MODAL" in answer:
            self._tell_state(context)
        return answer or {"PASS_THROUGH" if event.type == "TIMER" else "RUNNING_MODAL"}

    # Steps: each gives an answer, or None to go on.

    def _between(self, context, event):
        """Between two movements."""
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return None
        if event.type == "LEFTMOUSE":
            return self._clicked(context, event)
        self.recompute = event.type in keys.RECOMPUTE.events
        if self.recompute or event.type in keys.CONFIRM.events:
            return self.on_confirm(context)
        if event.type in keys.TRANSFORM.events:
            self._begin_movement(context, event, event.type)
        elif event.type in keys.HANDLE_SIZE.events:
            self.held.resize(context.edit_object, NOTCH if event.type == "WHEELUPMOUSE" else 1 / NOTCH)
        return None

    def _clicked(self, context, event):
        view, obj = find_view_under_mouse(context, event), context.edit_object
        if not view:
            return {"PASS_THROUGH"}
        grabbed = gizmo.under(self.held.pivot(obj), *self._view(context, event))
        if grabbed:
            kind, axis = grabbed
            self._begin_movement(context, event, kind, dragging=True, axis=axis)
            return None
        vertex = self.held.vertex_under(obj, *view[1:])
        if vertex is None:
            return self.on_confirm(context)
        if self.method == "RIGID":
            self.held.place(obj, vertex, event.shift)
        self._begin_movement(context, event, "R" if self.method == "JOINT" else "G", dragging=True)
        return None

    def _during(self, context, event):
        """During a movement."""
        movement, obj = self.movement, context.edit_object
        if event.type == "INBETWEEN_MOUSEMOVE":  # there is a later one: not worth a step
            self._track(context, event)
        elif event.type in keys.MOVES | keys.SNAP_STEPS.events | keys.PRECISE.events:
            self._follow(context, event)
        elif movement.dragging and (event.type, event.value) == ("LEFTMOUSE", "RELEASE"):
            self.movement = None
            self._follow(context, event, movement)
        elif event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return None
        elif event.type in keys.DONE.events:
            self.movement = None
            self._follow(context, event, movement)
            if self.start != "NONE":  # it was started for this movement
                return self.on_confirm(context)
        elif event.type in keys.TRANSFORM.events:
            self._begin_movement(context, event, event.type)
        elif event.type in keys.AXIS.events:
            movement.constrain("XYZ".index(event.type), event.shift, obj.matrix_world)
            self._follow(context, event)
        elif movement.type(event.type):
            self._follow(context, event)
        return None

    def _tick(self, context, _event):
        """While the mouse rests."""
        if self.held.ready(context.edit_object):
            if self.confirmed:
                return self.on_confirm(context)
            self.held.go_on(context.edit_object)
        return None

    # ---- A movement

    def _begin_movement(self, context, event, kind, dragging=False, axis=None):
        self.movement = Movement(kind, self.held.pivot(context.edit_object), dragging, axis)
        self.base = self.held.matrix
        self._track(context, event)

    def _view(self, context, event):
        """(region, RegionView3D, mouse in that region) that the tool was started in, also where it was started from a
        panel of that view."""
        region = context.region
        if region.type != "WINDOW":
            region = next(each for each in context.area.regions if each.type == "WINDOW")
        return region, get_region_view(context.area, region), (event.mouse_x - region.x, event.mouse_y - region.y)

    def _track(self, context, event):
        """The movement is told where the mouse is."""
        self.movement.track(*self._view(context, event), event.shift)

    def _follow(self, context, event, movement=None):
        """The handle goes where the mouse, or the number typed, says; the part follows."""
        movement, view, obj = movement or self.movement, self._view(context, event), context.edit_object
        movement.track(*view, event.shift)
        world = movement.matrix(*view[:2], event.ctrl)
        self.held.move(obj, np.array(obj.matrix_world.inverted_safe() @ world @ obj.matrix_world) @ self.base)

    # ---- What is seen

    def _draw(self):
        obj = mesh_identity.find_object(self.held.name)
        if obj is None:
            return
        self.held.draw(obj)
        if not self.movement:
            gizmo.draw(self.held.pivot(obj), bpy.context.region, bpy.context.region_data)

    def _tell_state(self, context):
        what = self.movement.told() if self.movement else self.held.told()
        if self.held.task:
            what = (iface_("{state}: settling") if self.confirmed else iface_("{state}: getting ready")).format(state=what)
        self._show_status(context, what, keys.MOVING if self.movement else keys.DEFORMING)

    # ---- The end

    def on_confirm(self, context):
        """Ends, once the part has its shape of rest."""
        self.confirmed = True
        if not self.held.settled(context.edit_object, PATIENCE):
            return {"RUNNING_MODAL"}
        if not self.held.changed:
            return {"CANCELLED"}
        self.reach = self.held.reach
        self.handles.clear()
        for turn, placed in enumerate([*self.held.turns, self.held.placed]):
            for handle in placed:
                each = self.handles.add()
                each.turn, each.vertex, each.radius = turn, handle.vertex, handle.radius
                each.matrix = handle.matrix.ravel()
        if self.recompute and bpy.ops.mesh.partwheel_build.poll():
            bpy.ops.mesh.partwheel_build("INVOKE_DEFAULT")
        return {"FINISHED"}

    def on_cancel(self, context):
        if self.held and self.can_continue(context):
            self.held.restore(context.edit_object)

    def can_continue(self, context):
        return self.held.fits(context.edit_object)


CLASSES = (PARTWHEEL_PG_handle, MESH_OT_partwheel_deform)
