# SPDX-License-Identifier: GPL-3.0-or-later
"""The way of the wheel about the part that was picked last: each stop, its faces, its share of the area, its longest
side. A click on one takes it."""

import math

import bpy

from ..parts import picks
from ..pick import states
from ..words.say import format_percent
from . import measure

SMALLEST = 0.25  # share of the width that the smallest part's bar takes


def rows(pick):
    """[(number from 1, node, faces, share of the area, bar 0..1)] of a picks.Pick, growing."""
    hierarchy = pick.hierarchy
    picked = states.pick_face(hierarchy, pick.face)
    counts = [len(hierarchy.faces(node)) for node in picked.stops]
    low, high = math.log(counts[0]), math.log(max(counts[-1], counts[0] + 1))
    return [(number, node, count, hierarchy.area[node] / hierarchy.area[-1], (math.log(count) - low) / (high - low))
            for number, (node, count) in enumerate(zip(picked.stops, counts), 1)]


class VIEW3D_PT_partwheel_path(bpy.types.Panel):
    bl_label = "Path of the Part"
    bl_category = "Partwheel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_parent_id = "VIEW3D_PT_partwheel"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.mode == "EDIT_MESH" and picks.get_pick_for_poll(context.edit_object) is not None

    def draw(self, context):
        draw_path(self.layout, context)


class MESH_OT_partwheel_path(picks.NeedsPick, bpy.types.Operator):
    """Show the parts that the wheel goes through, from the smallest to the whole, and click one to take it"""

    bl_idname = "mesh.partwheel_path"
    bl_label = "Path of the Part"
    bl_options = {"INTERNAL"}

    def invoke(self, context, _event):
        return context.window_manager.invoke_popup(self, width=380)

    def draw(self, context):
        draw_path(self.layout, context)

    def execute(self, _context):
        return {"FINISHED"}


def draw_path(layout, context):
    obj = context.edit_object
    pick = picks.get_pick_for_poll(obj)
    if not pick:
        return
    start = states.pick_face(pick.hierarchy, pick.face).start
    column = layout.column(align=True)
    column.operator_context = "EXEC_DEFAULT"
    for number, node, count, share, bar in reversed(rows(pick)):
        split = column.split(factor=0.62, align=True)
        left = split.split(factor=SMALLEST + (1 - SMALLEST) * bar, align=True)
        button = left.operator("mesh.partwheel_select", text=f"{count:,}", depress=node == pick.node)
        button.face_index, button.level, button.snap = pick.face, number - 1 - start, pick.snap
        left.label(text="")
        right = split.row()
        right.label(text=format_percent(share))
        right.label(text=measure.sides(context, obj, pick.hierarchy, node)[0])


CLASSES = (VIEW3D_PT_partwheel_path, MESH_OT_partwheel_path)
