# SPDX-License-Identifier: GPL-3.0-or-later
"""A part that is held by handles: where these are, what follows them, and what of that is done in the background."""

from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import numpy as np
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d
from mathutils import Matrix, Vector

from partwheel import Error, PartwheelError
from ..mesh.mesh_identity import element_counts
from ..mesh.errors import Refused
from ..view import overlay
from ..view.background import BackgroundTask
from ..view.picking import FaceRayCaster
from ..words.say import iface_
from . import gizmo
from .methods import METHODS
from .pen import Pen, restore
from .region import Region


@dataclass
class Handle:
    vertex: int  # of the mesh
    radius: float
    matrix: np.ndarray = field(default_factory=lambda: np.eye(4))  # in the object's space


def region_of(obj, faces, method, rings, reach):
    """Raises Refused."""
    return Region(obj, faces, rings, obj.data.use_mirror_x, reach if method == "JOINT" else None)


def patches_of(region, method, handles):
    """The region's vertices of each handle. Raises Refused."""
    if method == "JOINT":
        return [region.limb]
    return [region.patch(region.nearest_free(handle.vertex), handle.radius) for handle in handles]


def deform(obj, faces, method, rings, reach, turns):
    """All at once, without a mouse. turns: lists of Handles that act together, one after the other. Raises Refused or
    PartwheelError; then all is as it was."""
    regions = []
    try:
        for handles in turns:
            regions.append(region_of(obj, faces, method, rings, reach))
            shape = METHODS[method](regions[-1], patches_of(regions[-1], method, handles))
            shape.jump([handle.matrix for handle in handles])
            Pen(obj, regions[-1]).write(obj, shape.points())
    except Error:
        restore(obj, regions)
        raise


class Held:
    """The part of an object in Edit Mode that these faces make, while a tool runs. No reference to Blender's data is
    kept, but for a Pen's; the object is handed to every method. Those that change where handles are raise Refused if
    the part can't follow, and all of it is as before."""

    def __init__(self, obj, faces, method, rings, reach, face):
        """face: the one that was clicked, or None."""
        self.name, self.counts = obj.name_full, element_counts(obj.data)
        self.faces, self.method, self.rings, self.reach = faces, method, rings, reach
        self.task = self._pen = None  # what goes on in the background; what puts the vertices
        self.changed = self.settling = False  # whether anything was moved; whether there is a shape of rest to go on to
        self.turns = []  # the handles before, of shapes that became the rest of the next
        self.regions = [region_of(obj, faces, method, rings, reach)]  # of each of these, and of now
        self.placed = [self._first(obj, face)]  # the Handles of now
        self._hold()

    @property
    def region(self):
        """What deforms now."""
        return self.regions[-1]

    @property
    def matrix(self):
        """Of the last handle, the one that moves."""
        return self.placed[-1].matrix

    def fits(self, obj):
        """Whether the object is still the one, and its mesh has the elements that it had."""
        return obj is not None and obj.name_full == self.name and element_counts(obj.data) == self.counts

    def restore(self, obj):
        """Everything as it was in the beginning."""
        if self.changed:
            restore(obj, self.regions)

    def _first(self, obj, face):
        """The handle to begin with: at the face that was clicked, or else the part's farthest point from its border."""
        if self.method == "JOINT":
            return Handle(int(self.region.vertices[self.region.free][0]), 0.0)
        corners = obj.data.polygons[face].vertices if face is not None else ()
        known = [vertex for vertex in corners if self.region.indices([vertex])[0] >= 0]
        if known:
            index = self.region.nearest_free(known[0])
        else:
            away = METHODS["PROPORTIONAL"](self.region).weight
            index = np.where(self.region.free, away, -1).argmax()
        return Handle(int(self.region.vertices[index]), self.region.usual_radius(index))

    # ---- Handles

    def place(self, obj, vertex, one_more):
        """Takes the handle to a vertex, unless it is in the handle already. The ones before stay where they were put if
        there is to be one more; else the shape so far is the new rest."""
        vertex = int(self.region.vertices[self.region.nearest_free(vertex)])
        if vertex in self.region.vertices[self.patches[-1]] and not one_more:
            return
        with self._held_anew():
            handle = Handle(vertex, self.placed[-1].radius)
            if not one_more and self._moved():
                self.turns = [*self.turns, self.placed]
                self.finish(obj)  # or the shape so far is not what it will be
                self.regions = [*self.regions, region_of(obj, self.faces, self.method, self.rings, self.reach)]
            self.placed = [*self.placed, handle] if one_more else [handle]

    def resize(self, obj, factor):
        """The last handle; or the joint: then another region bends, from where all was before."""
        if self.method == "RIGID":
            with self._held_anew():
                self.placed = [*self.placed[:-1], replace(self.placed[-1], radius=self.placed[-1].radius * factor)]
        elif self.method == "JOINT":
            if self.changed:
                self._put(obj).restore(obj)
            with self._held_anew():
                self.reach = self.reach * factor
                self.regions = [region_of(obj, self.faces, self.method, self.rings, self.reach)]

    def move(self, obj, matrix):
        """The last handle goes to matrix (4,4), in the object's space; the part follows, as soon as it can."""
        if (matrix == self.matrix).all():
            return
        self.placed = [*self.placed[:-1], replace(self.placed[-1], matrix=matrix)]
        self.behind = True
        if self.ready(obj) and self.behind:
            self._follow(obj)

    def _moved(self):
        return any((handle.matrix != np.eye(4)).any() for handle in self.placed)

    @contextmanager
    def _held_anew(self):
        """By handles that are changed within; if that can't be, all is as it was before."""
        before = self.placed, self.regions, self.turns, self.reach
        try:
            yield
            self._hold()
        except Refused:
            self.placed, self.regions, self.turns, self.reach = before
            self._hold()
            raise

    def _hold(self):
        """Makes ready what follows the handles, and brings it to where they are. For 100,000 vertices that takes a
        second: in the background."""
        self.patches = patches_of(self.region, self.method, self.placed)
        self.shape = shape = METHODS[self.method](self.region, self.patches)
        matrices = [handle.matrix for handle in self.placed]
        self.shown, self.behind = self.region.rest, False  # where the vertices are; whether handles went on since
        self._start(lambda stop: shape.jump(matrices, stop))

    # ---- The shape follows, partly in the background

    def _start(self, function):
        self.abandon()
        self.task = BackgroundTask(function)

    def abandon(self):
        """What is done in the background is of no use any more."""
        if self.task:
            self.task.abandon()

    def ready(self, obj, seconds=0):
        """Whether nothing is done in the background any more, so that the shape may be asked; what was is shown."""
        if self.task and self.task.running(seconds):
            return False
        self.finish(obj)
        return True

    def finish(self, obj):
        """Waits for what is done in the background, if need be."""
        if not self.task:
            return
        task, self.task = self.task, None
        task.finish()
        if self.changed or self._moved():
            self._show(obj, done=True)
        if self.behind:
            self._follow(obj)

    def go_on(self, obj):
        """While the mouse rests: a little further towards the shape of rest."""
        if self.settling:
            self.settling = self.shape.go_on()
            self._show(obj, done=not self.settling)

    def settled(self, obj, seconds):
        """Whether the part has its shape of rest after at most so many seconds. If not, it gets there by and by."""
        if not self.ready(obj, seconds):
            return False
        if not (self.changed and self.settling):
            return True
        self.settling = False
        self._start(self.shape.settle)
        return self.settled(obj, seconds)

    def _follow(self, obj):
        self.behind = False
        try:
            self.shape.follow([handle.matrix for handle in self.placed])
        except PartwheelError as error:  # a number typed that leads nowhere
            raise Refused(str(error)) from error
        self.settling = True
        self._show(obj)

    def _show(self, obj, done=False):
        """done: with all that belongs to it, not only what is seen while it moves."""
        self.changed = True
        self.shown = self.shape.points()
        pen = self._put(obj)
        (pen.write if done else pen.draft)(obj, self.shown)
        overlay.redraw_views()

    def _put(self, obj):
        if self._pen is None or self._pen.region is not self.region:
            self._pen = Pen(obj, self.region)
        return self._pen

    # ---- In the view

    def pivot(self, obj):
        """The last handle's center, or the whole part's, or the joint's, in the world."""
        if self.method == "JOINT":
            return obj.matrix_world @ Matrix(self.matrix) @ Vector(self.region.center)
        chosen = self.shown[self.patches[-1] if self.method == "RIGID" else self.region.free]
        return obj.matrix_world @ Vector(chosen.mean(axis=0))

    def vertex_under(self, obj, region, view, point):
        """The vertex of the part that a view's region shows at a point of it, or None."""
        hit = FaceRayCaster(obj).under(obj.matrix_world, region, view, point)
        if not hit or hit[0] not in self.faces:
            return None
        face, distance = hit
        place = region_2d_to_origin_3d(region, view, point) + distance * region_2d_to_vector_3d(region, view, point)
        local = np.array(obj.matrix_world.inverted_safe() @ place)
        corners = list(obj.data.polygons[face].vertices)
        return corners[np.linalg.norm(self.shown[self.region.indices(corners)] - local, axis=1).argmin()]

    def draw(self, obj):
        """The handles, or what bends."""
        if self.method == "RIGID":
            gizmo.draw_points(obj.matrix_world, [self.shown[patch] for patch in self.patches])
        elif self.method == "JOINT":
            bending = self.region.free.copy()
            bending[self.region.limb] = False
            gizmo.draw_points(obj.matrix_world, [self.shown[bending]])

    def told(self):
        """What is held, in words."""
        count = len(self.patches[-1])
        one = iface_("Handle of one vertex") if count == 1 else iface_("Handle of {count:,} vertices")
        return {"RIGID": one, "PROPORTIONAL": iface_("The whole part"), "JOINT": iface_("Joint of {reach:.1f} radii")}[
            self.method].format(count=count, reach=self.reach)
