# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in menus of Edit, Object, Sculpt and the paint modes, and the hand-off of a part to Blender's own tools."""

import bpy


def draw_handoffs(layout):
    layout.operator("mesh.partwheel_move")
    layout.operator("mesh.duplicate_move", text="Duplicate Part")


def draw_select(self, _context):
    self.layout.separator()
    self.layout.operator_context = "INVOKE_REGION_WIN"
    self.layout.operator("mesh.partwheel_select")


def draw_select_object(self, _context):
    self.layout.separator()
    self.layout.operator_context = "INVOKE_REGION_WIN"
    self.layout.operator("object.partwheel_select")


def _entry(text, write):
    """A function that draws an entry which makes a part this."""
    def draw(self, _context):
        self.layout.separator()
        self.layout.operator_context = "INVOKE_REGION_WIN"
        self.layout.operator("mesh.partwheel_paint", text=text).write = write
    return draw


def draw_part_mesh(self, _context):
    self.layout.separator()
    self.layout.operator_context = "INVOKE_REGION_WIN"
    for operator in ("mesh.partwheel_deform", "mesh.partwheel_copy", "mesh.partwheel_remove", "mesh.partwheel_split",
                     "mesh.partwheel_swap"):
        self.layout.operator(operator)


def draw_solids_object(self, _context):
    self.layout.separator()
    self.layout.operator_context = "INVOKE_REGION_WIN"
    for operator in ("mesh.partwheel_split", "mesh.partwheel_swap", "object.partwheel_place", "object.partwheel_unite"):
        self.layout.operator(operator)


ENTRIES = (
    ("VIEW3D_MT_edit_mesh", draw_part_mesh),
    ("VIEW3D_MT_object", draw_solids_object),
    ("VIEW3D_MT_select_edit_mesh", draw_select),
    ("VIEW3D_MT_select_object", draw_select_object),
    ("VIEW3D_MT_face_sets", _entry("Face Set from Part by Wheel", "FACE_SET")),
    ("VIEW3D_MT_mask", _entry("Mask from Part by Wheel", "MASK")),
    ("VIEW3D_MT_paint_weight", _entry("Vertex Group from Part by Wheel", "VERTEX_GROUP")),
    ("VIEW3D_MT_paint_vertex", _entry("Paint Mask from Part by Wheel", "PAINT_MASK")),
)


def register():
    for menu, draw in ENTRIES:
        getattr(bpy.types, menu).append(draw)


def unregister():
    for menu, draw in ENTRIES:
        getattr(bpy.types, menu).remove(draw)
