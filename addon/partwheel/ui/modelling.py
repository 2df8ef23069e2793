# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels for modeling with parts: copy, remove, split, convex parts; swap, place, unite; deform."""

import bpy

from ..cut import hull_checks


class _Panel:
    bl_category = "Partwheel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_parent_id = "VIEW3D_PT_partwheel"


class VIEW3D_PT_partwheel_copy(_Panel, bpy.types.Panel):
    bl_label = "Parts as Solids"

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column(align=True)
        column.operator("mesh.partwheel_copy")
        column.operator("mesh.partwheel_remove")
        column.operator("mesh.partwheel_split")
        column.operator("mesh.partwheel_convex")
        column.operator("mesh.partwheel_convex_part")
        column = self.layout.column(align=True)
        column.operator_context = "INVOKE_REGION_WIN"
        column.operator("mesh.partwheel_swap")
        if context.mode == "OBJECT":
            column.operator("object.partwheel_place")
            column.operator("object.partwheel_unite")
        column.operator("mesh.partwheel_loose")
        if context.active_object:
            hull_checks.draw(context, self.layout, context.active_object)


class VIEW3D_PT_partwheel_deform(_Panel, bpy.types.Panel):
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


CLASSES = (VIEW3D_PT_partwheel_copy, VIEW3D_PT_partwheel_deform)
