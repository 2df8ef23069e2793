# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_deform: a picked part follows a handle that is dragged, turned and scaled; all beyond it stays."""

from dataclasses import dataclass, field

import bmesh
import bpy
import numpy as np
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d
from mathutils import Matrix, Vector

from ..mesh import objects
from ..mesh.refusing import Refused, can
from ..parts import picks, registry
from ..pick import borders
from ..view import keys
from . import handle_gizmo, handle_points
from ..view.background import Background
from partwheel import Error, PartwheelError
from partwheel.joint import REACH
from .deforming import METHODS, Pen, Region
from .movement import DIGITS, Movement
from ..view.picking import FaceTree, view_of, view_under
from ..view.in_view import InView, waiting

TICK = 0.03  # seconds
NOTCH = 1.25  # what a notch of the wheel makes of the handle's size
PATIENCE = 0.05  # seconds that Blender waits for what is done in the background, before it goes on meanwhile


class PARTWHEEL_PG_handle(bpy.types.PropertyGroup):
    """A handle: a vertex and how far around it the surface belongs to it; and where it went."""

    vertex: bpy.props.IntProperty(name="Vertex", min=0)
    radius: bpy.props.FloatProperty(name="Radius", min=0)
    turn: bpy.props.IntProperty(name="Turn", min=0)  # handles of one turn act together, one turn after the other
    matrix: bpy.props.FloatVectorProperty(name="Matrix", size=16, default=tuple(np.eye(4).ravel()))


@dataclass
class Handle:
    vertex: int  # of the mesh
    radius: float
    matrix: np.ndarray = field(default_factory=lambda: np.eye(4))  # in the object's space


class MESH_OT_partwheel_deform(InView, bpy.types.Operator):
    """Drag a handle of the part that was picked last: the part follows like a soft body, all beyond it stays"""

    bl_idname = "mesh.partwheel_deform"
    bl_label = "Deform Part"
    bl_options = {"REGISTER", "UNDO"}
    task, changed = None, False  # what goes on in the background; whether anything was moved

    node: bpy.props.IntProperty(
        name="Part", description="Node of the hierarchy; -1: the part that was picked last", default=-1, min=-1,
        options={"SKIP_SAVE"},
    )
    method: bpy.props.EnumProperty(
        name="Method",
        items=[("RIGID", "As Rigid as Possible", "The part follows the handle and keeps its details"),
               ("PROPORTIONAL", "Proportional", "The part moves as a whole, less and less towards its border"),
               ("JOINT", "At the Joint", "The part keeps its shape and turns about its border; what is near that, on "
                                         "either side, bends")],
        default="RIGID", options={"SKIP_SAVE"},
    )
    rings: bpy.props.IntProperty(
        name="Rings", description="So many rings of faces around the part deform with it, for a softer join",
        default=0, min=0, soft_max=10, options={"SKIP_SAVE"},
    )
    reach: bpy.props.FloatProperty(
        name="Joint", description="How far from the part's border it bends, in radii of the border",
        default=REACH, min=0.1, soft_max=10, options={"SKIP_SAVE"},
    )
    snap: bpy.props.BoolProperty(
        name="Snap Border", description="Deform the part as far as the creases near its border, not as far as its own "
        "border; a part that was picked so is", default=False, options={"SKIP_SAVE"},
    )
    handles: bpy.props.CollectionProperty(type=PARTWHEEL_PG_handle, options={"HIDDEN", "SKIP_SAVE"})
    start: bpy.props.EnumProperty(
        name="Start", description="The movement to start with",
        items=[("NONE", "None", ""), ("G", "Move", ""), ("R", "Rotate", ""), ("S", "Scale", "")],
        default="NONE", options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context):
        obj = context.edit_object
        return (can(cls, context.mode == "EDIT_MESH" and obj, "Parts are deformed in Edit Mode of a mesh")
                and can(cls, registry.state(obj.data)[0] in registry.USABLE, picks.NO_PICK))

    def draw(self, _context):
        self.layout.prop(self, "method")
        self.layout.prop(self, "reach" if self.method == "JOINT" else "rings")
        self.layout.prop(self, "snap")

    # ---- Without a window ------------------------------------------------------------------------------------------

    def execute(self, context):
        """The part goes where handles say, at once."""
        obj = context.edit_object
        regions = []
        try:
            faces = self._faces(obj)
            if not self.handles:
                raise Refused("There is no handle: drag one in the 3D view.")
            if max(each.vertex for each in self.handles) >= len(obj.data.vertices):
                raise Refused("A handle is a vertex that the mesh doesn't have.")
            for turn in sorted({each.turn for each in self.handles}):
                regions.append(self._region(obj, faces))
                handles = [each for each in self.handles if each.turn == turn]
                shape = METHODS[self.method](regions[-1], self._patches(regions[-1], handles))
                shape.jump([np.array(each.matrix).reshape(4, 4) for each in handles])
                Pen(obj, regions[-1]).write(obj, shape.points())
        except Error as error:  # faces too thin, for instance
            _restored(obj, regions)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _region(self, obj, faces):
        """Raises Refused."""
        reach = self.reach if self.method == "JOINT" else None
        return Region(obj, faces, self.rings, obj.data.use_mirror_x, reach)

    def _patches(self, region, handles):
        """The region's vertices of each handle. Raises Refused."""
        if self.method == "JOINT":
            return [region.limb]
        return [region.patch(region.nearest_free(handle.vertex), handle.radius) for handle in handles]

    def _faces(self, obj):
        """The part's faces. Raises Refused."""
        hierarchy, node = picks.chosen(obj, self.node)
        if self.node < 0 and not self.properties.is_property_set("snap"):
            self.snap = picks.picked(obj).snap
        self.node = node
        return borders.faces(obj, hierarchy, self.node, self.snap)

    # ---- With the mouse --------------------------------------------------------------------------------------------

    def _begin(self, context, event):
        obj = context.edit_object
        self._at_end.callback(lambda: self.task and self.task.abandon())
        with waiting(context):
            self.faces = self._faces(obj)
            self.regions = [self._region(obj, self.faces)]
            picked = picks.picked(obj)
            self.placed = [self._handle_of(obj, picked and picked.face)]
            self.confirmed, self.behind, self.settling, self.recompute = False, False, False, False
            self._hold()
        self.pen = None
        self.object_name, self.turns = obj.name_full, []
        self.movement, self.base = None, None  # that is under way; the last handle's matrix when it began
        self.counts = len(obj.data.vertices), len(obj.data.polygons)
        self._tick_every(context, TICK)
        self._draw_with(self._draw)
        if self.start != "NONE":
            self._begin_movement(context, event, self.start)
        self._tell_state(context)
        return {"RUNNING_MODAL"}

    @property
    def region(self):
        """What deforms now: of the last turn."""
        return self.regions[-1]

    def _handle(self, context, event):
        if event.type in keys.CANCEL.events and event.value == "PRESS":
            return {"CANCELLED"}
        if event.type == "TIMER":
            return self._tick(context)
        passed = keys.NAVIGATE.events | keys.SYSTEM
        if event.type in (passed - set(DIGITS) if self.movement else passed):
            return {"PASS_THROUGH"}
        if self.confirmed:
            return {"RUNNING_MODAL"}
        if self.movement:
            return self._during(context, event)
        return self._between(context, event)

    # ---- Between two movements

    def _between(self, context, event):
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return {"RUNNING_MODAL"}
        if event.type in keys.CONFIRM.events:
            return self._confirmed(context)
        if event.type == "LEFTMOUSE":
            if not view_under(context.window, event.mouse_x, event.mouse_y):
                return {"PASS_THROUGH"}
            region, view = self._view(context)
            mouse = event.mouse_x - region.x, event.mouse_y - region.y
            grabbed = handle_gizmo.under(self._pivot(context.edit_object), region, view, mouse)
            if grabbed:
                kind, axis = grabbed
                self._begin_movement(context, event, kind, dragging=True, axis=axis)
                self._tell_state(context)
                return {"RUNNING_MODAL"}
            vertex = self._vertex_under(context, event)
            if vertex is None:
                return self._confirmed(context)
            if self.method == "RIGID":
                self._place(context, vertex, event.shift)
            self._begin_movement(context, event, "R" if self.method == "JOINT" else "G", dragging=True)
        elif event.type in {"G", "R", "S"}:
            self._begin_movement(context, event, event.type)
        elif event.type in keys.RECOMPUTE.events:
            self.recompute = True
            return self._confirmed(context)
        elif event.type in keys.HANDLE_SIZE.events:
            self._resize(context, event.type == "WHEELUPMOUSE")
        self._tell_state(context)
        return {"RUNNING_MODAL"}

    def _vertex_under(self, context, event):
        """The vertex of the part under the mouse, or None."""
        _, region, view = view_under(context.window, event.mouse_x, event.mouse_y)
        point = event.mouse_x - region.x, event.mouse_y - region.y
        obj = context.edit_object
        hit = FaceTree(obj).under(obj.matrix_world, region, view, point)
        if not hit or hit[0] not in self.faces:
            return None
        face, distance = hit
        place = region_2d_to_origin_3d(region, view, point) + distance * region_2d_to_vector_3d(region, view, point)
        local = np.array(obj.matrix_world.inverted_safe() @ place)
        corners = list(obj.data.polygons[face].vertices)
        inside = np.searchsorted(self.region.vertices, corners)
        return corners[np.linalg.norm(self.shown[inside] - local, axis=1).argmin()]

    def _handle_of(self, obj, face):
        """The handle to begin with: at the face that was clicked, or else the part's farthest point from its border."""
        if self.method == "JOINT":
            return Handle(int(self.region.vertices[self.region.free][0]), 0.0)
        corners = obj.data.polygons[face].vertices if face is not None else ()
        known = [vertex for vertex in corners if vertex in self.region.vertices]
        if known:
            index = self.region.nearest_free(known[0])
        else:
            away = METHODS["PROPORTIONAL"](self.region).weight
            index = np.where(self.region.free, away, -1).argmax()
        return Handle(int(self.region.vertices[index]), self.region.usual_radius(index))

    def _place(self, context, vertex, one_more):
        """Takes the handle to a vertex, unless it is in the handle already. The ones before stay where they were put if
        there is to be one more; else the shape so far is the new rest."""
        vertex = int(self.region.vertices[self.region.nearest_free(vertex)])
        if vertex in self.region.vertices[self.patches[-1]] and not one_more:
            return
        radius, before = self.placed[-1].radius, (self.placed, self.regions, self.turns)
        if one_more:
            self.placed = [*self.placed, Handle(vertex, radius)]
        else:
            if any((handle.matrix != np.eye(4)).any() for handle in self.placed):
                self.turns = [*self.turns, self.placed]
                self._finish_task(context)  # or the shape so far is not what it will be
                self.regions = [*self.regions, self._region(context.edit_object, self.faces)]
            self.placed = [Handle(vertex, radius)]
        self._try(*before)

    def _resize(self, context, larger):
        factor = NOTCH if larger else 1 / NOTCH
        before = self.placed, self.regions, self.turns
        if self.method == "JOINT":
            self._resize_joint(context, factor)
        elif self.method == "RIGID":
            last = self.placed[-1]
            self.placed = [*self.placed[:-1], Handle(last.vertex, last.radius * factor, last.matrix)]
            self._try(*before)

    def _resize_joint(self, context, factor):
        """Another region bends: from where all was before."""
        obj, reach = context.edit_object, self.reach
        if self.changed:
            self._pen(obj).restore(obj)
        self.reach = reach * factor
        try:
            self.regions = [self._region(obj, self.faces)]
            self._hold()
        except Refused as reason:
            self.reach = reach
            self.regions = [self._region(obj, self.faces)]
            self._hold()
            self.report({"WARNING"}, str(reason))

    def _try(self, placed, regions, turns):
        """Holds the part by the new handles; if that can't be, all is as it was before, and why is reported."""
        try:
            self._hold()
        except Refused as reason:
            self.placed, self.regions, self.turns = placed, regions, turns
            self._hold()
            self.report({"WARNING"}, str(reason))

    def _hold(self):
        """Makes ready what follows the handles, and brings it to where they are. For 100,000 vertices that takes a
        second: in the background. Raises Refused."""
        patches = self._patches(self.region, self.placed)
        shape = METHODS[self.method](self.region, patches)
        self.patches, self.shape = patches, shape
        matrices = [handle.matrix for handle in self.placed]
        self.shown, self.behind = self.region.rest, False
        self._start(lambda stop: shape.jump(matrices, stop))

    # ---- In the background

    def _start(self, function):
        if self.task:
            self.task.abandon()
        self.task = Background(function)

    def _ready(self, context, seconds=0):
        """Whether nothing is done in the background any more, so that the shape may be asked; what was is shown."""
        if self.task:
            if self.task.running(seconds):
                return False
            self._finish_task(context)
        return True

    def _finish_task(self, context):
        """Waits for it, if need be."""
        if not self.task:
            return
        while self.task.running(1):
            pass
        task, self.task = self.task, None
        task.finish()
        if self.changed or any((handle.matrix != np.eye(4)).any() for handle in self.placed):
            self._show(context, done=True)
        if self.behind:
            self._shape_follows(context)

    # ---- During a movement

    def _begin_movement(self, context, event, kind, dragging=False, axis=None):
        self.movement = Movement(kind, self._pivot(context.edit_object), dragging, axis)
        self.base = self.placed[-1].matrix
        self._track(context, event)

    def _view(self, context):
        """(region, RegionView3D) that the tool was started in, also where it was started from a panel of that view."""
        region = context.region
        if region.type != "WINDOW":
            region = next(each for each in context.area.regions if each.type == "WINDOW")
        return region, view_of(context.area, region)

    def _pivot(self, obj):
        """The last handle's center, or the whole part's, or the joint's, in the world."""
        if self.method == "JOINT":
            return obj.matrix_world @ Matrix(self.placed[-1].matrix) @ Vector(self.region.center)
        chosen = self.shown[self.patches[-1] if self.method == "RIGID" else self.region.free]
        return obj.matrix_world @ Vector(chosen.mean(axis=0))

    def _during(self, context, event):
        movement = self.movement
        if event.type == "INBETWEEN_MOUSEMOVE":  # there is a later one: not worth a step
            self._track(context, event)
            return {"RUNNING_MODAL"}
        if event.type in keys.MOVES | keys.STEPS.events | keys.FINE.events:
            self._follow(context, event)
            return {"RUNNING_MODAL"}
        if movement.dragging and (event.type, event.value) == ("LEFTMOUSE", "RELEASE"):
            self._follow(context, event)
            self.movement = None
            self._tell_state(context)
            return {"RUNNING_MODAL"}
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return {"RUNNING_MODAL"}
        if event.type in keys.CONFIRM.events or event.type == "LEFTMOUSE":
            self._follow(context, event)
            self.movement = None
            if self.start != "NONE":  # it was started for this movement
                return self._confirmed(context)
        elif event.type in {"G", "R", "S"}:
            self._begin_movement(context, event, event.type)
        elif event.type in {"X", "Y", "Z"}:
            movement.constrain("XYZ".index(event.type), event.shift, context.edit_object.matrix_world)
            self._follow(context, event)
        elif movement.type(event.type):
            self._follow(context, event)
        self._tell_state(context)
        return {"RUNNING_MODAL"}

    def _track(self, context, event):
        """(region, RegionView3D) in which the movement was told where the mouse is."""
        region, view = self._view(context)
        self.movement.track(region, view, (event.mouse_x - region.x, event.mouse_y - region.y), event.shift)
        return region, view

    def _follow(self, context, event):
        """The handle goes where the mouse, or the number typed, says; the part follows."""
        region, view = self._track(context, event)
        world = self.movement.matrix(region, view, event.ctrl)
        to_world = context.edit_object.matrix_world
        matrix = np.array(to_world.inverted_safe() @ world @ to_world) @ self.base
        if (matrix == self.placed[-1].matrix).all():
            return
        last = self.placed[-1]
        self.placed = [*self.placed[:-1], Handle(last.vertex, last.radius, matrix)]
        self.behind = True
        if self._ready(context) and self.behind:
            self._shape_follows(context)
        self._tell_state(context)

    def _shape_follows(self, context):
        self.behind = False
        try:
            self.shape.follow([handle.matrix for handle in self.placed])
        except PartwheelError as error:  # a number typed that leads nowhere
            self.report({"WARNING"}, str(error))
            return
        self.settling = True
        self._show(context)

    # ---- What is seen

    def _tick(self, context):
        """While the mouse rests the part goes on towards its shape of rest."""
        if not self._ready(context):
            self._tell_state(context)
            return {"PASS_THROUGH"}
        if self.confirmed:
            return self._confirmed(context)
        if self.settling:
            self.settling = self.shape.go_on()
            self._show(context, done=not self.settling)
        self._tell_state(context)
        return {"PASS_THROUGH"}

    def _show(self, context, done=False):
        """done: with all that belongs to it, not only what is seen while it moves."""
        self.changed = True
        self.shown = self.shape.points()
        pen = self._pen(context.edit_object)
        (pen.write if done else pen.draft)(context.edit_object, self.shown)
        context.area.tag_redraw()

    def _pen(self, obj):
        if self.pen is None or self.pen.region is not self.region:
            self.pen = Pen(obj, self.region)
        return self.pen

    def _draw(self):
        obj = objects.named(self.object_name)
        if obj is None:
            return
        if self.method == "RIGID":
            handle_points.draw(obj.matrix_world, [self.shown[patch] for patch in self.patches])
        elif self.method == "JOINT":
            bending = self.region.free.copy()
            bending[self.region.limb] = False
            handle_points.draw(obj.matrix_world, [self.shown[bending]])
        if not self.movement:
            handle_gizmo.draw(self._pivot(obj), bpy.context.region, bpy.context.region_data)

    def _tell_state(self, context):
        count = len(self.patches[-1])
        what = {"RIGID": f"Handle of {count} {'vertex' if count == 1 else 'vertices'}", "PROPORTIONAL": "The Part",
                "JOINT": f"Joint of {self.reach:.2g} radii"}[self.method]
        if self.movement:
            what = self.movement.told()
        if self.task:
            what += ": getting ready" if not self.confirmed else ": settling"
        self._tell(context, what, keys.MOVING if self.movement else keys.DEFORMING)

    # ---- The end

    def _confirmed(self, context):
        """Ends, once the part has its shape of rest."""
        self.confirmed = True
        if not self._ready(context, PATIENCE):
            self._tell_state(context)
            return {"RUNNING_MODAL"}
        if not self.changed:
            return {"CANCELLED"}
        if self.settling:
            self.settling = False
            self._start(self.shape.settle)
            return self._confirmed(context)
        self.handles.clear()
        for turn, placed in enumerate([*self.turns, self.placed]):
            for handle in placed:
                each = self.handles.add()
                each.turn, each.vertex, each.radius = turn, handle.vertex, handle.radius
                each.matrix = handle.matrix.ravel()
        if self.recompute and bpy.ops.mesh.partwheel_build.poll():
            bpy.ops.mesh.partwheel_build("INVOKE_DEFAULT")
        return {"FINISHED"}

    def _take_back(self, context):
        if self.changed and self._still_there(context):
            _restored(context.edit_object, self.regions)

    def _still_there(self, context):
        obj = context.edit_object
        if obj is None or obj.name_full != self.object_name:
            return False
        bm = bmesh.from_edit_mesh(obj.data)
        return (len(bm.verts), len(bm.faces)) == self.counts


def _restored(obj, regions):
    """Puts the mesh back to before the first of these, made one after the other."""
    for region in reversed(regions):
        Pen(obj, region).restore(obj)


CLASSES = (PARTWHEEL_PG_handle, MESH_OT_partwheel_deform)
