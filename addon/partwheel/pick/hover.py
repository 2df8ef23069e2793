# SPDX-License-Identifier: GPL-3.0-or-later
"""The part that a click would take, drawn while the mouse moves over the model and the tool is active.

A gizmo, as in Blender's own tools that show what is under the mouse: Blender asks it at every move of the mouse and
draws it in every 3D view, for as long as the tool is active and no longer. It never takes an event.
"""

import bpy

from .. import trouble
from ..mesh import arrays, kept
from ..view import overlay, picking
from . import borders, states
from .prepared import current, lacking, prepared


class Hover:
    """What the mouse is over: an object's full name, its overlay.Parts, a node, and the faces of it where its border is
    snapped, else None; or None."""

    def __init__(self):
        self.what, self._written, self._later = None, {}, None

    def move(self, context, point):
        """The mouse is at a point of the context's region. Redraws if that changes what is shown.

        After an edit it takes two steps: Blender writing its edits back into the meshes is more than half of it all, and
        what is to be seen of the mouse meanwhile would come late."""
        shown = [each for each in context.objects_in_mode_unique_data
                 if each.type == "MESH" and each.visible_get(viewport=context.space_data)]
        waiting = lacking(shown)
        if waiting and waiting != self._written:
            for each in waiting:
                arrays.up_to_date(each)
            self._written = lacking(waiting)
            self._go_on(context, point)
            return
        with arrays.one_reading():
            for each in waiting:
                arrays.written_back(each)
            found = self._found(context, shown, point)
        self._written = {}
        if found is not self.what:
            self.what = found
            overlay.redraw()

    def _go_on(self, context, point):
        """The second step follows once Blender has seen to what else there is."""
        window, area, region = context.window, context.area, context.region

        def move():
            there = (window in list(bpy.context.window_manager.windows) and area in list(window.screen.areas)
                     and region in list(area.regions))
            if there and bpy.context.mode == "EDIT_MESH":
                with bpy.context.temp_override(window=window, area=area, region=region):
                    self.move(bpy.context, point)

        self.stop()
        self._later = move
        bpy.app.timers.register(move, first_interval=0)

    def stop(self):
        if self._later and bpy.app.timers.is_registered(self._later):
            bpy.app.timers.unregister(self._later)
        self._later = None

    def _found(self, context, shown, point):
        view = context.region, context.region_data, point
        obj, face = picking.nearest(shown, lambda each: prepared(each).tree(each), *view)
        parts = prepared(obj).parts(obj) if obj else None
        if not parts:
            return None
        node, snap = states.pick(parts.hierarchy, face).node, snaps(context)
        if self.what and self.what[:3] == (obj.name_full, parts, node) and snap == (self.what[3] is not None):
            return self.what
        return obj.name_full, parts, node, borders.faces(obj, parts.hierarchy, node, True) if snap else None

    def draw(self, context):
        if not self.what or overlay.shown.on:
            return
        name, parts, node, snapped = self.what
        obj = kept.named(name)
        if obj and obj.mode == "EDIT" and overlay.visible(context, obj) and current(obj, parts):
            overlay.draw_hover(context, obj, parts, node, snapped)


def snaps(context):
    """Whether the tool is set to snap borders."""
    tool = context.workspace.tools.from_space_view3d_mode(context.mode)
    return bool(tool and tool.operator_properties("mesh.partwheel_select").snap)


hover = Hover()


class VIEW3D_GT_partwheel_hover(bpy.types.Gizmo):
    bl_idname = "VIEW3D_GT_partwheel_hover"

    def test_select(self, context, location):
        hover.move(context, location)
        return -1

    def draw(self, context):
        hover.draw(context)


class VIEW3D_GGT_partwheel_hover(bpy.types.GizmoGroup):
    bl_idname = "VIEW3D_GGT_partwheel_hover"
    bl_label = "Part under the Mouse"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"3D"}

    @classmethod
    def poll(cls, context):
        return context.mode == "EDIT_MESH" and not trouble.of_library()

    def setup(self, _context):
        self.gizmos.new(VIEW3D_GT_partwheel_hover.bl_idname)


CLASSES = (VIEW3D_GT_partwheel_hover, VIEW3D_GGT_partwheel_hover)


def unregister():
    hover.what = None
    hover.stop()
