# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in the Select menu of a mesh in Edit Mode, and the hand-off of a selected part to Blender's own tools."""

import bpy


def draw_handoffs(layout):
    move = layout.operator("transform.translate", text="Move Part Proportionally")
    move.use_proportional_edit = True
    move.use_proportional_connected = True
    layout.operator("mesh.duplicate_move", text="Duplicate Part")


def draw_select(self, _context):
    self.layout.separator()
    self.layout.operator_context = "INVOKE_REGION_WIN"
    self.layout.operator("mesh.partwheel_select")


def register():
    bpy.types.VIEW3D_MT_select_edit_mesh.append(draw_select)


def unregister():
    bpy.types.VIEW3D_MT_select_edit_mesh.remove(draw_select)
