# SPDX-License-Identifier: GPL-3.0-or-later
"""The path of the picked part: each stop of the wheel, its faces, area and longest side. A click takes a stop."""

import math

import bpy

from ..parts import picks
from ..pick import states
from ..translations.lookup import format_percent
from .panel import Subpanel, format_box_sides

MIN_BAR_FRACTION = 0.25  # width of the smallest part's bar, as a fraction


def path_rows(pick: picks.Pick) -> list[tuple[int, int, int, float, float]]:
    """[(number from 1, node, face count, share of the area, bar length 0..1)] of a path, from the smallest part up."""
    hierarchy = pick.hierarchy
    path = states.pick_face(hierarchy, pick.face)
    counts = [len(hierarchy.faces(node)) for node in path.stops]
    low, high = math.log(counts[0]), math.log(max(counts[-1], counts[0] + 1))
    return [(number, node, count, hierarchy.area[node] / hierarchy.area[-1], (math.log(count) - low) / (high - low))
            for number, (node, count) in enumerate(zip(path.stops, counts), 1)]


class VIEW3D_PT_partwheel_path(Subpanel, bpy.types.Panel):
    bl_label = "Path of the Part"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "EDIT_MESH" and picks.get_pick_for_poll(context.edit_object) is not None

    def draw(self, context: bpy.types.Context) -> None:
        draw_path(self.layout, context)


class MESH_OT_partwheel_path(picks.NeedsPick, bpy.types.Operator):
    """Show the parts that the wheel goes through, from the smallest to the whole; click one to select it"""

    bl_idname = "mesh.partwheel_path"
    bl_label = "Path of the Part"
    bl_options = {"INTERNAL"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        return context.window_manager.invoke_popup(self, width=380)

    def draw(self, context: bpy.types.Context) -> None:
        draw_path(self.layout, context)

    def execute(self, _context: bpy.types.Context) -> set[str]:
        return {"FINISHED"}


def draw_path(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    obj = context.edit_object
    pick = picks.get_pick_for_poll(obj)
    if not pick:
        return
    start = states.pick_face(pick.hierarchy, pick.face).start
    column = layout.column(align=True)
    column.operator_context = "EXEC_DEFAULT"
    for number, node, count, share, bar in reversed(path_rows(pick)):
        split = column.split(factor=0.62, align=True)
        left = split.split(factor=MIN_BAR_FRACTION + (1 - MIN_BAR_FRACTION) * bar, align=True)
        button = left.operator("mesh.partwheel_select", text=f"{count:,}", depress=node == pick.node)
        button.face_index, button.level, button.snap = pick.face, number - 1 - start, pick.snap
        left.label(text="")
        right = split.row()
        right.label(text=format_percent(share))
        right.label(text=format_box_sides(context, obj, pick.hierarchy, node)[0])
