# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_deform: a picked part follows a handle that is dragged, turned and scaled; all beyond it stays."""

import contextlib
import math
import traceback
from dataclasses import dataclass, field

import bmesh
import bpy
import numpy as np
from bpy_extras.view3d_utils import (
    location_3d_to_region_2d, region_2d_to_location_3d, region_2d_to_origin_3d, region_2d_to_vector_3d,
)
from mathutils import Matrix, Vector
from mathutils.geometry import intersect_line_line, intersect_line_plane

from .. import borders, handle_gizmo, handle_points, keys, session
from ..background import Background
from ..core import PartwheelError
from ..core.joint import REACH
from ..deforming import METHODS, Pen, Refused, Region
from ..picking import FaceTree, view_of, view_under
from ..ui import status

TICK = 0.03  # seconds
NOTCH = 1.25  # what a notch of the wheel makes of the handle's size
STEP_DEGREES, STEP_SCALE = 5.0, 0.1  # what Ctrl snaps to
GRAZING = 0.1  # cosine: a line seen so much from its end, a plane so much from its edge, gives no place under the mouse
DIGITS = {**keys.DIGITS, **{f"NUMPAD_{digit}": str(digit) for digit in range(10)}, "PERIOD": ".", "NUMPAD_PERIOD": "."}
PATIENCE = 0.05  # seconds that Blender waits for what is done in the background, before it goes on meanwhile
NO_PART = "Pick a part with Select Part by Wheel first."


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


@dataclass
class Stage:
    """One movement of the handle that is under way."""

    kind: str  # G, R or S
    start: tuple  # the mouse then, in pixels of the region
    base: np.ndarray  # the handle's matrix then
    pivot: Vector  # the handle's center then, in the world
    dragging: bool  # ends when the button is released
    axis: int = None  # along or about which alone; of frame's columns
    plane: bool = False  # along all but that
    local: bool = False
    frame: Matrix = field(default_factory=lambda: Matrix.Identity(3))  # the world's axes, or the object's if local
    typed: str = ""
    turned: float = 0.0  # so far, in radians: full turns count
    angle: float = None  # of the mouse about the pivot, when last looked at

    def constrain(self, axis, plane, matrix_world):
        """As Blender's transforms: the key of an axis takes the world's, pressed again the object's own, then none."""
        again = (self.axis, self.plane) == (axis, plane)
        if again and self.local:
            axis, plane = None, False
        self.axis, self.plane, self.local = axis, plane, again and not self.local
        self.frame = matrix_world.to_3x3().normalized() if self.local else Matrix.Identity(3)

    def free(self):
        """Of the frame's axes those along which there is movement."""
        return [k for k in range(3) if self.axis is None or (k == self.axis) != self.plane]

    def told(self):
        if self.axis is None:
            return ""
        which = "local" if self.local else "global"
        return f" {'in' if self.plane else 'along'} {which} {''.join('XYZ'[k] for k in self.free())}"


class MESH_OT_partwheel_deform(bpy.types.Operator):
    """Drag a handle of the part that was picked last: the part follows like a soft body, all beyond it stays"""

    bl_idname = "mesh.partwheel_deform"
    bl_label = "Deform Part"
    bl_options = {"REGISTER", "UNDO"}

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
        if context.mode != "EDIT_MESH" or obj is None:
            return False
        if session.state(obj.data)[0] not in {session.State.FITS, session.State.MOVED}:
            cls.poll_message_set(NO_PART)
            return False
        return True

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
        except (Refused, PartwheelError) as error:
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
        if self.node < 0:
            picked = session.picked(obj)
            if not picked:
                raise Refused(NO_PART)
            self.node = picked.node
            if not self.properties.is_property_set("snap"):
                self.snap = picked.snap
        hierarchy = session.hierarchy(obj)
        if not hierarchy or self.node >= len(hierarchy.parent):
            raise Refused(f"There is no part {self.node}. {NO_PART}")
        return borders.faces(obj, hierarchy, self.node, self.snap)

    # ---- With the mouse --------------------------------------------------------------------------------------------

    def invoke(self, context, event):
        if context.window is None or context.area is None or context.area.type != "VIEW_3D":
            self.report({"ERROR"}, "Parts are deformed in a 3D view: start this with the mouse over one.")
            return {"CANCELLED"}
        obj = context.edit_object
        try:
            with _waiting(context):
                self.faces = self._faces(obj)
                self.regions = [self._region(obj, self.faces)]
                picked = session.picked(obj)
                self.placed = [self._handle_of(obj, picked and picked.face)]
                self.task, self.confirmed, self.behind, self.settling = None, False, False, False
                self._hold()
        except (Refused, PartwheelError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.pen = None
        self.object_name, self.stage, self.turns = obj.name_full, None, []
        self.counts = len(obj.data.vertices), len(obj.data.polygons)
        self.changed, self.recompute, self.told = False, False, None
        self.timer = context.window_manager.event_timer_add(TICK, window=context.window)
        self.drawing = bpy.types.SpaceView3D.draw_handler_add(self._draw, (), "WINDOW", "POST_VIEW")
        if self.start != "NONE":
            self._begin(context, event, self.start)
        self._tell(context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    @property
    def region(self):
        """What deforms now: of the last turn."""
        return self.regions[-1]

    def modal(self, context, event):
        """One step; whatever goes wrong in it, the mesh is put back and the tool ends, with a report."""
        try:
            return self._handle(context, event)
        except PartwheelError as error:  # faces too thin, for instance
            self.report({"ERROR"}, str(error))
            return self._cancelled(context)
        except Exception as error:  # any: a tool that dies in the middle leaves the mesh half deformed
            traceback.print_exc()
            self.report({"ERROR"}, f"Partwheel stopped: {error}. The full report is in the system console.")
            return self._cancelled(context)

    def cancel(self, context):
        """Blender itself ends the tool: the window closes or another file opens."""
        self._cancelled(context)

    def _handle(self, context, event):
        if not self._still_there(context):
            self.report({"WARNING"}, "Partwheel stopped: the mesh is no longer being edited as it was.")
            self._end(context)
            return {"CANCELLED"}
        if event.type in keys.CANCEL.events and event.value == "PRESS":
            return self._cancelled(context)
        if event.type == "TIMER":
            return self._tick(context)
        passed = keys.NAVIGATE.events | keys.SYSTEM
        if event.type in (passed - set(DIGITS) if self.stage else passed):
            return {"PASS_THROUGH"}
        if self.confirmed:
            return {"RUNNING_MODAL"}
        if self.stage:
            return self._in_stage(context, event)
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
                self._begin(context, event, kind, dragging=True, axis=axis)
                self._tell(context)
                return {"RUNNING_MODAL"}
            vertex = self._vertex_under(context, event)
            if vertex is None:
                return self._confirmed(context)
            if self.method == "RIGID":
                self._place(context, vertex, event.shift)
            self._begin(context, event, "R" if self.method == "JOINT" else "G", dragging=True)
        elif event.type in {"G", "R", "S"}:
            self._begin(context, event, event.type)
        elif event.type in keys.RECOMPUTE.events:
            self.recompute = True
            return self._confirmed(context)
        elif event.type in keys.HANDLE_SIZE.events:
            self._resize(context, event.type == "WHEELUPMOUSE")
        self._tell(context)
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

    def _begin(self, context, event, kind, dragging=False, axis=None):
        self.stage = None
        region, view = self._view(context)
        start = event.mouse_x - region.x, event.mouse_y - region.y
        self.stage = Stage(kind, start, self.placed[-1].matrix, self._pivot(context.edit_object), dragging, axis)
        self._turn(region, view, start)

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

    def _in_stage(self, context, event):
        stage = self.stage
        if event.type == "INBETWEEN_MOUSEMOVE":  # there is a later one: not worth a step, but full turns count
            region, view = self._view(context)
            self._turn(region, view, (event.mouse_x - region.x, event.mouse_y - region.y))
            return {"RUNNING_MODAL"}
        if event.type in {"MOUSEMOVE", "LEFT_CTRL", "RIGHT_CTRL"}:
            self._follow(context, event)
            return {"RUNNING_MODAL"}
        if stage.dragging and (event.type, event.value) == ("LEFTMOUSE", "RELEASE"):
            self._follow(context, event)
            self.stage = None
            self._tell(context)
            return {"RUNNING_MODAL"}
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return {"RUNNING_MODAL"}
        if event.type in keys.CONFIRM.events or event.type == "LEFTMOUSE":
            self._follow(context, event)
            self.stage = None
            if self.start != "NONE":  # it was started for this movement
                return self._confirmed(context)
        elif event.type in {"G", "R", "S"}:
            self._begin(context, event, event.type)
        elif event.type in {"X", "Y", "Z"}:
            stage.constrain("XYZ".index(event.type), event.shift, context.edit_object.matrix_world)
            self._follow(context, event)
        elif event.type in DIGITS:
            stage.typed += DIGITS[event.type]
            self._follow(context, event)
        elif event.type in {"MINUS", "NUMPAD_MINUS"}:
            stage.typed = stage.typed[1:] if stage.typed.startswith("-") else "-" + stage.typed
            self._follow(context, event)
        elif event.type == "BACK_SPACE":
            stage.typed = stage.typed[:-1]
            self._follow(context, event)
        self._tell(context)
        return {"RUNNING_MODAL"}

    def _follow(self, context, event):
        """The handle goes where the mouse, or the number typed, says; the part follows."""
        region, view = self._view(context)
        mouse = event.mouse_x - region.x, event.mouse_y - region.y
        self._turn(region, view, mouse)
        world = {"G": self._moved, "R": self._rotated, "S": self._scaled}[self.stage.kind](region, view, mouse,
                                                                                          event.ctrl)
        to_world = context.edit_object.matrix_world
        local = np.array(to_world.inverted_safe() @ world @ to_world)
        matrix = local @ self.stage.base
        if (matrix == self.placed[-1].matrix).all():
            return
        last = self.placed[-1]
        self.placed = [*self.placed[:-1], Handle(last.vertex, last.radius, matrix)]
        self.behind = True
        if self._ready(context) and self.behind:
            self._shape_follows(context)
        self._tell(context)

    def _shape_follows(self, context):
        self.behind = False
        try:
            self.shape.follow([handle.matrix for handle in self.placed])
        except PartwheelError as error:  # a number typed that leads nowhere
            self.report({"WARNING"}, str(error))
            return
        self.settling = True
        self._show(context)

    def _typed(self):
        try:
            return float(self.stage.typed)
        except ValueError:  # nothing yet, or only a sign
            return None

    def _moved(self, region, view, mouse, snap):
        stage = self.stage
        typed = self._typed()
        if typed is not None:
            return Matrix.Translation(typed * stage.frame.col[stage.free()[0]])
        now, before = (self._under(region, view, point) for point in (mouse, stage.start))
        inverse = stage.frame.transposed()
        shift = inverse @ (now - before)
        shift = Vector(shift[k] if k in stage.free() else 0 for k in range(3))
        if snap:
            # A step that shows: the power of ten next to some 20 pixels.
            pixels = (region_2d_to_location_3d(region, view, (stage.start[0] + 20, stage.start[1]), stage.pivot)
                      - region_2d_to_location_3d(region, view, stage.start, stage.pivot)).length
            step = 10 ** round(math.log10(max(pixels, 1e-12)))
            shift = Vector(step * round(value / step) for value in shift)
        return Matrix.Translation(stage.frame @ shift)

    def _under(self, region, view, point):
        """The place under a pixel of the region: on the line or in the plane through the pivot that the movement keeps
        to, unless that is seen too much from its end or its edge; else as far away as the pivot."""
        stage = self.stage
        place = region_2d_to_location_3d(region, view, point, stage.pivot)
        if stage.axis is None:
            return place
        direction, axis = region_2d_to_vector_3d(region, view, point), stage.frame.col[stage.axis]
        slant = abs(direction.normalized().dot(axis))
        if stage.plane and slant > GRAZING:
            return intersect_line_plane(place, place + direction, stage.pivot, axis)
        if not stage.plane and slant < math.sqrt(1 - GRAZING * GRAZING):
            return intersect_line_line(stage.pivot, stage.pivot + axis, place, place + direction)[0]
        return place

    def _turn(self, region, view, mouse):
        """Keeps count of how far the mouse went about the pivot."""
        center = location_3d_to_region_2d(region, view, self.stage.pivot) or Vector(self.stage.start)
        x, y = mouse[0] - center[0], mouse[1] - center[1]
        if math.hypot(x, y) < 1:
            return
        angle = math.atan2(y, x)
        if self.stage.angle is not None:
            self.stage.turned += (angle - self.stage.angle + math.pi) % (2 * math.pi) - math.pi
        self.stage.angle = angle

    def _rotated(self, _region, view, _mouse, snap):
        stage, typed = self.stage, self._typed()
        towards_user = view.view_matrix.inverted().to_3x3().col[2]
        axis = towards_user if stage.axis is None else stage.frame.col[stage.axis].copy()
        angle = stage.turned if axis.dot(towards_user) >= 0 else -stage.turned
        if typed is not None:
            angle = math.radians(typed)
        elif snap:
            angle = math.radians(STEP_DEGREES * round(math.degrees(angle) / STEP_DEGREES))
        return _about(stage.pivot, Matrix.Rotation(angle, 4, axis))

    def _scaled(self, region, view, mouse, snap):
        stage, typed = self.stage, self._typed()
        center = location_3d_to_region_2d(region, view, stage.pivot) or Vector(stage.start)
        factor = ((Vector(mouse) - center).length / max((Vector(stage.start) - center).length, 1))
        if typed is not None:
            factor = typed
        elif snap:
            factor = STEP_SCALE * round(factor / STEP_SCALE)
        scale = Matrix.Diagonal([factor if k in stage.free() else 1 for k in range(3)])
        return _about(stage.pivot, (stage.frame @ scale @ stage.frame.transposed()).to_4x4())

    # ---- What is seen

    def _tick(self, context):
        """While the mouse rests the part goes on towards its shape of rest."""
        if not self._ready(context):
            self._tell(context)
            return {"PASS_THROUGH"}
        if self.confirmed:
            return self._confirmed(context)
        if self.settling:
            self.settling = self.shape.go_on()
            self._show(context, done=not self.settling)
        self._tell(context)
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
        obj = bpy.data.objects.get(self.object_name)
        if obj is None:
            return
        if self.method == "RIGID":
            handle_points.draw(obj.matrix_world, [self.shown[patch] for patch in self.patches])
        elif self.method == "JOINT":
            bending = self.region.free.copy()
            bending[self.region.limb] = False
            handle_points.draw(obj.matrix_world, [self.shown[bending]])
        if not self.stage:
            handle_gizmo.draw(self._pivot(obj), bpy.context.region, bpy.context.region_data)

    def _tell(self, context):
        stage = self.stage
        count = len(self.patches[-1])
        what = {"RIGID": f"Handle of {count} {'vertex' if count == 1 else 'vertices'}", "PROPORTIONAL": "The Part",
                "JOINT": f"Joint of {self.reach:.2g} radii"}[self.method]
        if stage:
            what = {"G": "Move", "R": "Rotate", "S": "Scale"}[stage.kind] + stage.told()
            if stage.typed:
                what += f": {stage.typed}"
        if self.task:
            what += ": getting ready" if not self.confirmed else ": settling"
        shown = stage is not None, what
        if shown != self.told:  # both bars are drawn anew each time
            self.told = shown
            context.workspace.status_text_set(status.drawer(keys.MOVING if stage else keys.DEFORMING))
            context.area.header_text_set(f"Partwheel: {what}")

    # ---- The end

    def _confirmed(self, context):
        """Ends, once the part has its shape of rest."""
        self.confirmed = True
        if not self._ready(context, PATIENCE):
            self._tell(context)
            return {"RUNNING_MODAL"}
        if not self.changed:
            self._end(context)
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
        self._end(context)
        if self.recompute and bpy.ops.mesh.partwheel_build.poll():
            bpy.ops.mesh.partwheel_build("INVOKE_DEFAULT")
        return {"FINISHED"}

    def _cancelled(self, context):
        try:
            if self.changed and self._still_there(context):
                _restored(context.edit_object, self.regions)
        finally:
            self._end(context)
        return {"CANCELLED"}

    def _still_there(self, context):
        obj = context.edit_object
        if obj is None or obj.name_full != self.object_name:
            return False
        bm = bmesh.from_edit_mesh(obj.data)
        return (len(bm.verts), len(bm.faces)) == self.counts

    def _end(self, context):
        if self.task:
            self.task.abandon()
            self.task = None
        if self.timer:
            context.window_manager.event_timer_remove(self.timer)
            bpy.types.SpaceView3D.draw_handler_remove(self.drawing, "WINDOW")
            self.timer = None
        if context.workspace:
            context.workspace.status_text_set(None)
        if context.area:
            context.area.header_text_set(None)
            context.area.tag_redraw()


def _restored(obj, regions):
    """Puts the mesh back to before the first of these, made one after the other."""
    for region in reversed(regions):
        Pen(obj, region).restore(obj)


@contextlib.contextmanager
def _waiting(context):
    """What takes a while has Blender's cursor for it."""
    context.window.cursor_modal_set("WAIT")
    try:
        yield
    finally:
        context.window.cursor_modal_restore()


def _about(pivot, matrix):
    return Matrix.Translation(pivot) @ matrix @ Matrix.Translation(-pivot)
