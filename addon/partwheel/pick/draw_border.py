# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders that the user draws over the surface: edges of the mesh that no part crosses, stored in an edge attribute."""

from collections.abc import Callable, Sequence
import heapq
import itertools
import math

import bmesh
from bmesh.types import BMesh, BMVert
import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

from ..mesh import NeedsEditMode, check_poll, find_object, get_mesh_state
from ..mesh.marks import DRAWN_BORDER
from ..view import keys, overlay, picking
from ..view.in_view import InView
from ..view.visible_surface import NO_FACE
from ..translations.lookup import iface_, rpt_
from .face_picker import EditModePicker

SECTION_LENGTH = 30  # pixels of the path's end that still follow the mouse
SNAP_DISTANCE = 15  # pixels from an end of the stroke to a border that it joins
CREASE_WEIGHT, BORDER_WEIGHT = 2.0, 4.0  # cost of an edge: length / (1 + these, by radians^2 of bend, on a drawn border)
MAX_VISITED = 20_000  # limit of vertices in a search: beyond it the mouse is on another shell, or far away
ERASED_SHARE = 0.75  # a stroke with this share of its edges on drawn borders erases them

CoincidentVertices = dict[tuple, list[BMVert]]


def find_coincident_vertices(bm: BMesh) -> CoincidentVertices:
    """Return the vertices of open edges at each position that several have: importers split vertices at seams."""
    places: CoincidentVertices = {}
    for vertex in bm.verts:
        if vertex.is_boundary:
            places.setdefault(vertex.co[:], []).append(vertex)
    return {place: vertices for place, vertices in places.items() if len(vertices) > 1}


def find_path(bm: BMesh, start: BMVert, is_end: Callable[[BMVert], bool], coincident: CoincidentVertices,
              is_allowed: Callable[[BMVert], bool] = lambda _: True) -> list[int] | None:
    """Return the vertices after start of the cheapest path to an end, which prefers creases and drawn borders; None without one.
    A step may lead to a coincident vertex."""
    layer = bm.edges.layers.int.get(DRAWN_BORDER)
    costs, previous, number = {start: 0.0}, {}, itertools.count()
    queue = [(0.0, next(number), start)]
    while queue:
        cost, _, vertex = heapq.heappop(queue)
        if is_end(vertex):
            path = []
            while vertex != start:
                path.append(vertex.index)
                vertex = previous[vertex]
            return path[::-1]
        if cost > costs[vertex]:
            continue
        if len(costs) > MAX_VISITED:
            break
        steps = [(cost, other) for other in coincident.get(vertex.co[:], ())]
        for edge in vertex.link_edges:
            weight = 1 + CREASE_WEIGHT * edge.calc_face_angle(0.0) ** 2 + BORDER_WEIGHT * bool(layer and edge[layer])
            if not edge.hide:
                steps.append((cost + edge.calc_length() / weight, edge.other_vert(vertex)))
        for total, neighbor in steps:
            if total < costs.get(neighbor, math.inf) and is_allowed(neighbor):
                costs[neighbor], previous[neighbor] = total, vertex
                heapq.heappush(queue, (total, next(number), neighbor))
    return None


def remove_spurs(path: Sequence[int]) -> list[int]:
    """Return a path of vertices without edges that it goes there and back, also at the start of a closed one."""
    result: list[int] = []
    for vertex in path:
        if result[-2:-1] == [vertex]:
            result.pop()
        else:
            result.append(vertex)
    while len(result) > 2 and result[0] == result[-1] and result[1] == result[-2]:
        result = result[1:-1]
    return result


def apply_stroke(obj: bpy.types.Object, path: Sequence[int]) -> bool:
    """Mark the edges along a stroke, a path of vertices, or erase the border that most of it follows. Return whether parts may
    differ now: not after an open border."""
    bm = _get_edited(obj)
    layer = bm.edges.layers.int.get(DRAWN_BORDER) or bm.edges.layers.int.new(DRAWN_BORDER)
    bm.verts.ensure_lookup_table()
    pairs = (bm.edges.get((bm.verts[a], bm.verts[b])) for a, b in zip(path, path[1:]))
    edges = [edge for edge in pairs if edge]  # there is none between coincident vertices
    is_erasing = sum(edge[layer] for edge in edges) >= ERASED_SHARE * len(edges)
    for edge in edges:
        edge[layer] = not is_erasing
    bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)
    is_open = any(sum(edge[layer] for edge in bm.verts[end].link_edges) == 1 and not bm.verts[end].is_boundary
                  for end in (path[0], path[-1]))
    return is_erasing or not is_open


def _get_edited(obj: bpy.types.Object) -> BMesh:
    return bmesh.from_edit_mesh(obj.data)


def draw_borders(context: bpy.types.Context, obj: bpy.types.Object) -> None:
    """Draw the borders of an object in Edit Mode; they are read once after each change."""
    state = get_mesh_state(obj.data)
    if state.border_lines[0] != state.geometry_revision:
        state.border_lines = state.geometry_revision, overlay.create_lines(_read_ends(obj))
    if state.border_lines[1] and overlay.is_visible(context, obj):
        overlay.draw_lines(context, obj, state.border_lines[1])


def _read_ends(obj: bpy.types.Object) -> list:
    """Return the places of both ends of each drawn edge. Fast without any: a BMesh takes long for large meshes."""
    if DRAWN_BORDER not in obj.data.attributes:
        return []
    bm = _get_edited(obj)
    layer = bm.edges.layers.int[DRAWN_BORDER]
    return [[vertex.co[:] for vertex in edge.verts] for edge in bm.edges if edge[layer]]


class MESH_OT_partwheel_border(NeedsEditMode, InView, bpy.types.Operator):
    """Draw a border over the surface, along edges: no part crosses it. Draw over a border to erase it"""

    bl_idname = "mesh.partwheel_border"
    bl_label = "Draw Border"
    bl_options = {"UNDO"}

    def on_start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.object_name, self.path, self.section, self.pixel = "", [], [], None
        self.is_drawing = event.type == "LEFTMOUSE"  # otherwise a menu has started it
        self._add_draw_handler(self._draw)
        self._show_status(context, iface_("Draw around a part, along the edges of the mesh"), keys.DRAWING_BORDER)
        return self._follow(context, event) if self.is_drawing else {"RUNNING_MODAL"}

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in keys.SYSTEM or not self.is_drawing and event.type in keys.NAVIGATE.events:
            return {"PASS_THROUGH"}
        if event.type in keys.CANCEL.events and event.value == "PRESS":
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE" and event.value == "RELEASE" and self.is_drawing:
            return self._finish(context)
        self.is_drawing = self.is_drawing or event.type == "LEFTMOUSE" and event.value == "PRESS"
        follows = self.is_drawing and event.type in keys.MOVES | {"LEFTMOUSE"}
        return self._follow(context, event) if follows else {"RUNNING_MODAL"}

    def can_continue(self, context: bpy.types.Context) -> bool:
        obj = find_object(self.object_name) if self.object_name else context.edit_object
        return obj is not None and obj.mode == "EDIT"

    def _follow(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Continue the path to the vertex under the mouse."""
        hit = EditModePicker().find_face(context, event)
        if not hit or hit.face == NO_FACE or self.object_name not in ("", hit.obj.name_full):
            return {"RUNNING_MODAL"}
        # Kept: without a reference, each call creates the BMesh again, which takes long for large meshes; see Selection.
        self.edited = bm = _get_edited(hit.obj)
        _, *self.view, pixel = picking.find_view_under_mouse(context, event)
        bm.verts.ensure_lookup_table()
        bm.faces.ensure_lookup_table()
        self.object_name, self.pixel = hit.obj.name_full, Vector(pixel)
        vertex = min(bm.faces[hit.face].verts, key=lambda vertex: self._distance(hit.obj, vertex))
        if not self.path:
            bm.verts.index_update()
            self.coincident = find_coincident_vertices(bm)
            self.anchor = self.pixel
            self.path = [*reversed(self._find_end(hit.obj, bm, vertex) or []), vertex.index]
            return {"RUNNING_MODAL"}
        section = find_path(bm, bm.verts[self.path[-1]], lambda other: other == vertex, self.coincident)
        self.section = self.section if section is None else section  # None: on another shell
        if (self.pixel - self.anchor).length > SECTION_LENGTH:
            self.path, self.section, self.anchor = self.path + self.section, [], self.pixel
        overlay.redraw_views()
        return {"RUNNING_MODAL"}

    def _distance(self, obj: bpy.types.Object, vertex: BMVert) -> float:
        """Return the distance of a vertex from the mouse in pixels."""
        place = location_3d_to_region_2d(*self.view, obj.matrix_world @ vertex.co)
        return (place - self.pixel).length if place else math.inf

    def _find_end(self, obj: bpy.types.Object, bm: BMesh, vertex: BMVert) -> list[int] | None:
        """Return the path to a border, or to the start of the stroke, if one is near; else None."""
        layer, start = bm.edges.layers.int.get(DRAWN_BORDER), self.path[0] if self.path else -1
        return find_path(bm, vertex,
                         lambda other: other.index == start or bool(layer) and any(edge[layer] for edge in other.link_edges),
                         self.coincident, lambda other: self._distance(obj, other) < SNAP_DISTANCE)

    def _finish(self, context: bpy.types.Context) -> set[str]:
        obj, path = find_object(self.object_name), self.path + self.section
        if path:
            bm = _get_edited(obj)
            bm.verts.ensure_lookup_table()
            path = remove_spurs(path + (self._find_end(obj, bm, bm.verts[path[-1]]) or []))
        if len(path) < 2:
            return {"CANCELLED"}
        if apply_stroke(obj, path):
            _find_parts(context, obj)
        else:
            self.report({"INFO"}, rpt_("The border is open, so it divides nothing yet. Continue it at its end."))
        return {"FINISHED"}

    def _draw(self) -> None:
        obj, path = find_object(self.object_name), self.path + self.section
        if obj and len(path) > 1:
            bm = _get_edited(obj)
            bm.verts.ensure_lookup_table()
            places = [bm.verts[index].co[:] for index in path]
            overlay.draw_lines(bpy.context, obj, overlay.create_lines(list(zip(places, places[1:]))))


class MESH_OT_partwheel_clear_borders(NeedsEditMode, bpy.types.Operator):
    """Remove all borders that were drawn on the mesh"""

    bl_idname = "mesh.partwheel_clear_borders"
    bl_label = "Clear Drawn Borders"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and check_poll(
            cls, DRAWN_BORDER in context.edit_object.data.attributes, "There are no drawn borders on the active mesh.")

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.edit_object
        layer_list = _get_edited(obj).edges.layers.int
        layer_list.remove(layer_list[DRAWN_BORDER])
        bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)
        if not bpy.app.background:
            _find_parts(context, obj)
        return {"FINISHED"}


def _find_parts(context: bpy.types.Context, obj: bpy.types.Object) -> None:
    """Find the parts in the background."""
    with context.temp_override(active_object=obj):
        bpy.ops.mesh.partwheel_find("INVOKE_DEFAULT")
