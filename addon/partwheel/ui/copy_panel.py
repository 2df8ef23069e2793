# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the panel for modelling with parts: copy, remove, split; swap, place, unite."""

import bpy


class VIEW3D_PT_partwheel_copy(bpy.types.Panel):
    bl_label = "Parts as Solids"
    bl_parent_id = "VIEW3D_PT_partwheel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        column = self.layout.column(align=True)
        column.operator("mesh.partwheel_copy")
        column.operator("mesh.partwheel_remove")
        column.operator("mesh.partwheel_split")
        column = self.layout.column(align=True)
        column.operator_context = "INVOKE_REGION_WIN"
        column.operator("mesh.partwheel_swap")
        if context.mode == "OBJECT":
            column.operator("object.partwheel_place")
            column.operator("object.partwheel_unite")


CLASSES = (VIEW3D_PT_partwheel_copy,)
