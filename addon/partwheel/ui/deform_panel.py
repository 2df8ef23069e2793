# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the panel that deforms the part picked last."""

import bpy


class VIEW3D_PT_partwheel_deform(bpy.types.Panel):
    bl_label = "Deform"
    bl_category = "Partwheel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_parent_id = "VIEW3D_PT_partwheel"
    bl_context = "mesh_edit"

    def draw(self, _context):
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


CLASSES = (VIEW3D_PT_partwheel_deform,)
