# SPDX-License-Identifier: GPL-3.0-or-later
"""A deformation session: the handles of a part, the shape that follows them, and its work in the background."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
import threading

import bpy
import numpy as np
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d
from mathutils import Matrix, Vector

from partwheel import Error, PartwheelError
from ..mesh import Refused, arrays, element_counts, is_running, start_thread
from ..view import overlay
from ..view.picking import FaceRayCaster
from ..view.visible_surface import compute_visible_surface
from ..translations.lookup import iface_
from . import gizmo
from .methods import METHODS
from .vertex_writer import VertexWriter, restore_regions
from .region import Region


@dataclass
class DeformHandle:
    """A handle of the part: the surface within a radius of a vertex, and where it moves."""

    vertex: int  # of the mesh
    radius: float
    matrix: np.ndarray = field(default_factory=lambda: np.eye(4))  # in the object's space


def create_region(obj: bpy.types.Object, faces: np.ndarray, method: str, rings: int, reach: float) -> Region:
    """The Region of these faces for a method. Raises Refused."""
    return Region(obj, faces, rings, obj.data.use_mirror_x, reach if method == "JOINT" else None)


def handle_patches(region: Region, method: str, handles: list[DeformHandle]) -> list[np.ndarray]:
    """The region's vertices of each handle. Raises Refused."""
    if method == "JOINT":
        return [region.limb]
    return [region.patch(region.nearest_free(handle.vertex), handle.radius) for handle in handles]


def deform(obj: bpy.types.Object, faces: np.ndarray, method: str, rings: int, reach: float,
           turns: list[list[DeformHandle]]) -> None:
    """Deforms the part at once. turns: lists of handles; those of one list act together, the lists one after the
    other. Raises Refused or PartwheelError; then everything is as it was."""
    regions = []
    try:
        for handles in turns:
            regions.append(create_region(obj, faces, method, rings, reach))
            shape = METHODS[method](regions[-1], handle_patches(regions[-1], method, handles))
            shape.solve([handle.matrix for handle in handles])
            VertexWriter(obj, regions[-1]).write(obj, shape.points())
    except Error:
        restore_regions(obj, regions)
        raise


class DeformSession:
    """The part of an object in Edit Mode that these faces form, while a tool runs.

    It keeps no references to Blender's data, except in a VertexWriter; every method gets the object. Methods that
    change handles raise Refused if the part can't follow, and revert the change."""

    def __init__(self, obj: bpy.types.Object, faces: np.ndarray, method: str, rings: int, reach: float,
                 face: int | None) -> None:
        """face: the clicked face, or None."""
        self.name, self.counts = obj.name_full, element_counts(obj.data)
        self.faces, self.method, self.rings, self.reach = faces, method, rings, reach
        self.task = self._writer = None  # the background task; the writer of the current region
        self.has_changed = self.is_settling = False  # whether any vertex moved; whether the shape is not yet at rest
        self.turns = []  # handles of earlier shapes, each of which became the rest shape of the next
        self.regions = [create_region(obj, faces, method, rings, reach)]  # of each earlier shape and of the current one
        self.handles = [self._initial_handle(obj, face)]  # the current handles
        self._prepare_shape()

    @property
    def region(self) -> Region:
        return self.regions[-1]

    @property
    def matrix(self) -> np.ndarray:
        """The matrix (4, 4) of the active handle, the last one."""
        return self.handles[-1].matrix

    def fits(self, obj: bpy.types.Object | None) -> bool:
        """Whether this is still the object, with as many elements."""
        return obj is not None and obj.name_full == self.name and element_counts(obj.data) == self.counts

    def restore(self, obj: bpy.types.Object) -> None:
        if self.has_changed:
            restore_regions(obj, self.regions)

    def _initial_handle(self, obj: bpy.types.Object, face: int | None) -> DeformHandle:
        """A handle at the clicked face, else at the vertex farthest from the part's border."""
        if self.method == "JOINT":
            return DeformHandle(int(self.region.vertices[self.region.free][0]), 0.0)
        corners = obj.data.polygons[face].vertices if face is not None else ()
        in_region = [vertex for vertex in corners if self.region.indices([vertex])[0] >= 0]
        if in_region:
            index = self.region.nearest_free(in_region[0])
        else:
            distance_weight = METHODS["PROPORTIONAL"](self.region).weight
            index = np.where(self.region.free, distance_weight, -1).argmax()
        return DeformHandle(int(self.region.vertices[index]), self.region.default_radius(index))

    # ---- Handles

    def place_handle(self, obj: bpy.types.Object, vertex: int, add: bool) -> None:
        """Moves the active handle to a vertex, unless its patch contains it. add: a new handle; the others stay where
        they are. Without add, the current shape becomes the new rest shape."""
        vertex = int(self.region.vertices[self.region.nearest_free(vertex)])
        if vertex in self.region.vertices[self.patches[-1]] and not add:
            return
        with self._rebuild_or_revert():
            handle = DeformHandle(vertex, self.handles[-1].radius)
            if not add and self._has_moved_handles():
                self.turns = [*self.turns, self.handles]
                self.finish(obj)  # so that the current shape is complete
                self.regions = [*self.regions, create_region(obj, self.faces, self.method, self.rings, self.reach)]
            self.handles = [*self.handles, handle] if add else [handle]

    def resize_handle(self, obj: bpy.types.Object, factor: float) -> None:
        """Scales the active handle's radius, or the joint's reach: then another region bends, from the start."""
        if self.method == "RIGID":
            with self._rebuild_or_revert():
                self.handles = [*self.handles[:-1], replace(self.handles[-1], radius=self.handles[-1].radius * factor)]
        elif self.method == "JOINT":
            if self.has_changed:
                self._current_writer(obj).restore(obj)
            with self._rebuild_or_revert():
                self.reach = self.reach * factor
                self.regions = [create_region(obj, self.faces, self.method, self.rings, self.reach)]

    def move_handle(self, obj: bpy.types.Object, matrix: np.ndarray) -> None:
        """Moves the active handle to matrix (4, 4), in the object's space. The part follows as soon as it can."""
        if (matrix == self.matrix).all():
            return
        self.handles = [*self.handles[:-1], replace(self.handles[-1], matrix=matrix)]
        self.is_outdated = True
        if self.is_ready(obj) and self.is_outdated:
            self._update_shape(obj)

    def _has_moved_handles(self) -> bool:
        return any((handle.matrix != np.eye(4)).any() for handle in self.handles)

    @contextmanager
    def _rebuild_or_revert(self) -> Iterator[None]:
        """Prepares the shape for handles that change in the block; reverts them if that is impossible."""
        saved = self.handles, self.regions, self.turns, self.reach
        try:
            yield
            self._prepare_shape()
        except Refused:
            self.handles, self.regions, self.turns, self.reach = saved
            self._prepare_shape()
            raise

    def _prepare_shape(self) -> None:
        """Prepares the shape and moves it to the handles, in the background: a second for 100,000 vertices."""
        self.patches = handle_patches(self.region, self.method, self.handles)
        self.shape = shape = METHODS[self.method](self.region, self.patches)
        matrices = [handle.matrix for handle in self.handles]
        self.points, self.is_outdated = self.region.rest, False  # current vertices; whether handles moved since
        self._run_in_background(lambda stop: shape.solve(matrices, stop))

    # ---- The shape follows, partly in the background

    def _run_in_background(self, function: Callable) -> None:
        self.abandon()
        self._stop = stop = threading.Event()
        self.task = start_thread(lambda: function(stop))

    def abandon(self) -> None:
        """Stops the background task, whose result is obsolete."""
        if self.task:
            self._stop.set()

    def is_ready(self, obj: bpy.types.Object, seconds: float = 0) -> bool:
        """Whether no background task uses the shape. Writes the result of one that has ended."""
        if self.task and is_running(self.task, seconds):
            return False
        self.finish(obj)
        return True

    def finish(self, obj: bpy.types.Object) -> None:
        """Waits for the background task and writes its result."""
        if not self.task:
            return
        task, self.task = self.task, None
        task.result()
        if self.has_changed or self._has_moved_handles():
            self._write_points(obj, is_final=True)
        if self.is_outdated:
            self._update_shape(obj)

    def relax(self, obj: bpy.types.Object) -> None:
        """While the mouse rests: a few iterations towards the rest shape."""
        if self.is_settling:
            self.is_settling = self.shape.relax()
            self._write_points(obj, is_final=not self.is_settling)

    def settle_within(self, obj: bpy.types.Object, seconds: float) -> bool:
        """Whether the part reaches its rest shape within this many seconds. If not, it continues in the background."""
        if not self.is_ready(obj, seconds):
            return False
        if not (self.has_changed and self.is_settling):
            return True
        self.is_settling = False
        self._run_in_background(self.shape.settle)
        return self.settle_within(obj, seconds)

    def _update_shape(self, obj: bpy.types.Object) -> None:
        self.is_outdated = False
        try:
            self.shape.follow([handle.matrix for handle in self.handles])
        except PartwheelError as error:  # a typed number without a solution
            raise Refused(str(error)) from error
        self.is_settling = True
        self._write_points(obj)

    def _write_points(self, obj: bpy.types.Object, is_final: bool = False) -> None:
        """Writes the shape to the mesh; is_final: with all derived data, not only what is drawn."""
        self.has_changed = True
        self.points = self.shape.points()
        writer = self._current_writer(obj)
        (writer.write if is_final else writer.write_draft)(obj, self.points)
        overlay.redraw_views()

    def _current_writer(self, obj: bpy.types.Object) -> VertexWriter:
        if self._writer is None or self._writer.region is not self.region:
            self._writer = VertexWriter(obj, self.region)
        return self._writer

    # ---- In the view

    def pivot(self, obj: bpy.types.Object) -> Vector:
        """In the world, the center of the active handle, of the whole part, or of the joint."""
        if self.method == "JOINT":
            return obj.matrix_world @ Matrix(self.matrix) @ Vector(self.region.center)
        vertices = self.points[self.patches[-1] if self.method == "RIGID" else self.region.free]
        return obj.matrix_world @ Vector(vertices.mean(axis=0))

    def vertex_under(self, obj: bpy.types.Object, region: bpy.types.Region, view: bpy.types.RegionView3D,
                     point: tuple[float, float]) -> int | None:
        """The part's vertex nearest to what the view shows at a point of its region, or None."""
        arrays.update_mesh(obj)
        hit = FaceRayCaster(compute_visible_surface(obj)).cast(obj, obj.matrix_world, region, view, point)
        if not hit or hit.face not in self.faces:
            return None
        hit_point = region_2d_to_origin_3d(region, view, point) + hit.distance * region_2d_to_vector_3d(region, view, point)
        local_point = np.array(obj.matrix_world.inverted_safe() @ hit_point)
        corners = list(obj.data.polygons[hit.face].vertices)
        return corners[np.linalg.norm(self.points[self.region.indices(corners)] - local_point, axis=1).argmin()]

    def draw(self, obj: bpy.types.Object) -> None:
        """Draws the handles, or the vertices that bend."""
        if self.method == "RIGID":
            gizmo.draw_points(obj.matrix_world, [self.points[patch] for patch in self.patches])
        elif self.method == "JOINT":
            bending = self.region.free.copy()
            bending[self.region.limb] = False
            gizmo.draw_points(obj.matrix_world, [self.points[bending]])

    def status_text(self) -> str:
        """What is active, for the status bar."""
        count = len(self.patches[-1])
        handle_text = iface_("Handle of one vertex") if count == 1 else iface_("Handle of {count:,} vertices")
        texts = {"RIGID": handle_text, "PROPORTIONAL": iface_("The whole part"),
                 "JOINT": iface_("Joint of {reach:.1f} radii")}
        return texts[self.method].format(count=count, reach=self.reach)
