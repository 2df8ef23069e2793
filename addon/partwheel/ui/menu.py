# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in the menus of Edit, Object, Sculpt and the paint modes. The Mesh and context menus have a submenu: part_menus.py."""

from collections.abc import Callable

import bpy


def _create_draw_function(*operators: str, write: str | None = None, **label: str) -> Callable:
    """A function that draws these operators in a menu. write: what mesh.partwheel_paint writes a part to."""
    def draw(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
        self.layout.separator()
        self.layout.operator_context = "INVOKE_REGION_WIN"
        for operator in operators:
            entry = self.layout.operator(operator, **label)
            if write:
                entry.write = write
    return draw


def _draw_submenu(self: bpy.types.Menu, _context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu("VIEW3D_MT_partwheel_part")


ENTRIES = (
    ("VIEW3D_MT_edit_mesh_context_menu", _draw_submenu),
    ("VIEW3D_MT_edit_mesh", _draw_submenu),
    ("VIEW3D_MT_sculpt", _create_draw_function("mesh.partwheel_parts")),
    ("VIEW3D_MT_object", _create_draw_function("mesh.partwheel_loose", "mesh.partwheel_copy", "mesh.partwheel_parts",
                                               "mesh.partwheel_split", "mesh.partwheel_convex", "mesh.partwheel_swap",
                                               "object.partwheel_place", "object.partwheel_unite")),
    ("VIEW3D_MT_edit_mesh_clean", _create_draw_function("mesh.partwheel_loose")),
    ("VIEW3D_MT_select_edit_mesh", _create_draw_function("mesh.partwheel_box", "mesh.partwheel_select",
                                                        "mesh.partwheel_border", "mesh.partwheel_clear_borders")),
    ("VIEW3D_MT_edit_mesh_select_similar", _create_draw_function("mesh.partwheel_similar", "mesh.partwheel_mirrored")),
    ("VIEW3D_MT_select_object", _create_draw_function("object.partwheel_select")),
    *((f"VIEW3D_MT_{menu}", _create_draw_function("mesh.partwheel_paint", write=write, text=text))
      for menu, write, text in (("face_sets", "FACE_SET", "Face Set from Part by Wheel"),
                                ("mask", "MASK", "Mask from Part by Wheel"),
                                ("paint_weight", "VERTEX_GROUP", "Vertex Group from Part by Wheel"),
                                ("paint_vertex", "PAINT_MASK", "Paint Mask from Part by Wheel"))),
)


def register() -> None:
    for menu, draw in ENTRIES:
        getattr(bpy.types, menu).append(draw)


def unregister() -> None:
    for menu, draw in ENTRIES:
        getattr(bpy.types, menu).remove(draw)
