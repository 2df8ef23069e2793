# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the part that a click would pick, while the tool is active; in Object Mode also the picked faces, which Blender
doesn't show there.

It is a gizmo, like the previews of Blender's own tools: Blender calls it at every mouse move and draws it in every 3D
view while the tool is active. It never handles an event."""

import bpy
import numpy as np

from .. import library_error
from ..mesh import MeshSnapshot, arrays, find_object
from ..parts import picks, registry
from ..view import overlay, picking
from ..view.visible_surface import NO_FACE
from . import borders, states
from .display import pick_display
from .draw_border import draw_borders
from .view_cache import (ViewCache, cast_ray, find_nearest_face, get_ready_cache, get_view_cache, is_at_rest, is_current,
                         prepare_next_slice, stop_timers)

HOVER_STATES = *registry.USABLE, registry.State.UNOPENED

# Mode of the context -> operator of the tool.
OPERATORS = {
    "EDIT_MESH": "mesh.partwheel_select", "OBJECT": "object.partwheel_pick", "SCULPT": "mesh.partwheel_paint",
    "PAINT_WEIGHT": "mesh.partwheel_paint", "PAINT_VERTEX": "mesh.partwheel_paint",
    "PAINT_TEXTURE": "mesh.partwheel_paint",
}


class Hover:
    """The part under the mouse.

    target: (full name of the object, its overlay.PartTriangles, node, faces if borders are snapped, else None), or
    None."""

    def __init__(self) -> None:
        self.target, self._timer, self._is_waiting = None, None, False

    def move(self, context: bpy.types.Context, point: tuple) -> None:
        """Update the target for the mouse at a point of the context's region, and redraw if it changes. After an edit,
        the data is prepared in slices, one per call; mouse moves would be handled late otherwise."""
        if not is_at_rest():
            self._set_target(None)
            return
        if prepare_next_slice(_find_edited_objects(context)):
            self._schedule_move(context, point)
            return
        self._is_waiting = False
        target = self._find_target(context, point)
        highlight.update(context)
        if self._is_waiting:
            self._schedule_move(context, point)
        self._set_target(target)

    def _set_target(self, target: tuple | None) -> None:
        if target is not self.target:
            self.target = target
            overlay.redraw_views()

    def _schedule_move(self, context: bpy.types.Context, point: tuple) -> None:
        """Continue in a timer, after Blender has handled other events."""
        window, area, region = context.window, context.area, context.region

        def move():
            is_open = (window in list(bpy.context.window_manager.windows) and area in list(window.screen.areas)
                     and region in list(area.regions))
            if is_open and bpy.context.mode in OPERATORS:
                with bpy.context.temp_override(window=window, area=area, region=region):
                    self.move(bpy.context, point)

        self.stop()
        self._timer = move
        bpy.app.timers.register(move, first_interval=0)

    def stop(self) -> None:
        if self._timer and bpy.app.timers.is_registered(self._timer):
            bpy.app.timers.unregister(self._timer)
        self._timer = None

    def _find_target(self, context: bpy.types.Context, point: tuple) -> tuple | None:
        hit = self._find_face(context, context.region, context.region_data, point)
        if not hit or hit.face == NO_FACE:
            return None
        name, snapshot = hit.obj.name_full, MeshSnapshot(hit.obj, trust_reports=True)
        parts = get_view_cache(snapshot).get_part_triangles(snapshot)
        if not parts:
            return None
        node = states.pick_face(parts.hierarchy, hit.face, view=hit.view_size).node
        tool = context.workspace.tools.from_space_view3d_mode(context.mode)
        snap = bool(tool and tool.operator_properties(OPERATORS[context.mode]).snap)
        if self.target and self.target[:3] == (name, parts, node) and snap == (self.target[3] is not None):
            return self.target
        return name, parts, node, borders.get_part_faces(snapshot, parts.hierarchy, node, True) if snap else None

    def _find_face(self, context: bpy.types.Context, *view: object) -> picking.FaceHit | None:
        """Return the face under the mouse; None where there are no faces to pick."""
        if context.mode == "OBJECT":
            hit = picking.find_surface_under(context, context.area, *view)
            if not hit or hit.obj.type != "MESH" or registry.get_state(hit.obj.data)[0] not in HOVER_STATES:
                return None
            cache = self._get_ready_cache(hit.obj)
            return cache and cast_ray(cache, hit, *view)
        ready = [obj for obj in _find_edited_objects(context) if self._get_ready_cache(obj)]
        return find_nearest_face(ready, *view)

    def _get_ready_cache(self, obj: bpy.types.Object) -> ViewCache | None:
        cache = get_ready_cache(MeshSnapshot(obj, trust_reports=True))
        self._is_waiting = self._is_waiting or cache is None
        return cache

    def draw(self, context: bpy.types.Context) -> None:
        obj = None if pick_display.is_shown else _find_drawable(context, self.target)
        if obj:
            overlay.draw_hover(context, obj, *self.target[1:])


def _find_edited_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Return the mesh objects of the context's mode that are visible in its view."""
    edited = context.objects_in_mode_unique_data if context.mode == "EDIT_MESH" else [context.active_object]
    return [obj for obj in edited if obj and obj.type == "MESH" and obj.visible_get(viewport=context.space_data)]


class Highlight:
    """The selected faces of the active object, highlighted in Object Mode after a pick."""

    def __init__(self) -> None:
        self.target = None  # (full name of the object, its overlay.PartTriangles, faces), or None
        self.version = 0  # of the faces, which names their batch

    def update(self, context: bpy.types.Context) -> None:
        """Update to the current selection."""
        obj = context.active_object
        if context.mode != "OBJECT" or obj is None or obj.type != "MESH" or not picks.get_pick_for_poll(obj):
            self.target = None
            return
        if get_ready_cache(MeshSnapshot(obj, trust_reports=True)) and not self._is_target_current(obj):
            self.show_selected(obj)

    def is_showing(self, obj: bpy.types.Object) -> bool:
        """Return whether this object is highlighted."""
        return self._is_target_current(obj) and len(self.target[2]) > 0

    def _is_target_current(self, obj: bpy.types.Object) -> bool:
        return bool(self.target and self.target[0] == obj.name_full and is_current(obj, self.target[1]))

    def show_selected(self, obj: bpy.types.Object) -> None:
        self.show(obj, np.flatnonzero(arrays.read(obj.data.polygons, "select", bool)))

    def show(self, obj: bpy.types.Object, faces: np.ndarray) -> None:
        snapshot = MeshSnapshot(obj)
        parts = get_view_cache(snapshot).get_part_triangles(snapshot)
        self.target, self.version = (obj.name_full, parts, faces), self.version + 1
        overlay.redraw_views()

    def draw(self, context: bpy.types.Context) -> None:
        obj = _find_drawable(context, self.target) if context.mode == "OBJECT" else None
        if obj and len(self.target[2]):
            overlay.draw_triangles(context, obj, self.target[1].face_batch(("chosen", self.version), self.target[2]))


def _find_drawable(context: bpy.types.Context, target: tuple | None) -> bpy.types.Object | None:
    """Return the object of a target (full name, PartTriangles, ...), if its parts are current and this view shows it."""
    obj = find_object(target[0]) if target else None
    return obj if obj and overlay.is_visible(context, obj) and is_current(obj, target[1]) else None


hover, highlight = Hover(), Highlight()


class VIEW3D_GT_partwheel_hover(bpy.types.Gizmo):
    bl_idname = "VIEW3D_GT_partwheel_hover"

    def test_select(self, context: bpy.types.Context, location: tuple) -> int:
        hover.move(context, location)
        return -1

    def draw(self, context: bpy.types.Context) -> None:
        highlight.draw(context)
        hover.draw(context)
        if context.mode == "EDIT_MESH":
            for obj in _find_edited_objects(context):
                draw_borders(context, obj)


class VIEW3D_GGT_partwheel_hover(bpy.types.GizmoGroup):
    bl_idname = "VIEW3D_GGT_partwheel_hover"
    bl_label = "Part under the Mouse"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.active_object
        return (context.mode in OPERATORS and not library_error.find_library_error()
                and not (context.mode == "SCULPT" and obj.use_dynamic_topology_sculpting))

    def setup(self, _context: bpy.types.Context) -> None:
        self.gizmos.new(VIEW3D_GT_partwheel_hover.bl_idname)


def unregister() -> None:
    hover.target = highlight.target = None
    hover.stop()
    pick_display.clear()
    stop_timers()
