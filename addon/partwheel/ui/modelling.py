# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels for modeling with parts: copy, remove, split, convex parts; swap, place, unite; deform."""

import bpy

from ..cut import hull_checks
from .panel import Subpanel, draw_operators


class VIEW3D_PT_partwheel_copy(Subpanel, bpy.types.Panel):
    bl_label = "Parts as Solids"

    def draw(self, context: bpy.types.Context) -> None:
        draw_operators(self.layout.column(align=True), "mesh.partwheel_copy", "mesh.partwheel_remove", "mesh.partwheel_split",
                       "mesh.partwheel_convex", "mesh.partwheel_convex_part")
        column = self.layout.column(align=True)
        column.operator_context = "INVOKE_REGION_WIN"
        column.operator("mesh.partwheel_swap")
        if context.mode == "OBJECT":
            draw_operators(column, "object.partwheel_place", "object.partwheel_unite")
        column.operator("mesh.partwheel_loose")
        if context.active_object:
            hull_checks.draw(context, self.layout, context.active_object)


class VIEW3D_PT_partwheel_deform(Subpanel, bpy.types.Panel):
    bl_label = "Deform"
    bl_options = {"DEFAULT_CLOSED"}  # the panel above fits into a small window only then

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "EDIT_MESH"

    def draw(self, _context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.operator_context = "INVOKE_REGION_WIN"
        column.operator("mesh.partwheel_deform", text="Drag a Handle")
        column.operator("mesh.partwheel_deform", text="Turn at the Joint").method = "JOINT"
        column.label(text="Within the part, proportionally:")
        row = column.row(align=True)
        row.operator_context = "INVOKE_REGION_WIN"
        for key, label in (("G", "Move"), ("R", "Rotate"), ("S", "Scale")):
            button = row.operator("mesh.partwheel_deform", text=label)
            button.method, button.start = "PROPORTIONAL", key
