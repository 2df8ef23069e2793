# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands for a part in a submenu of the Mesh and context menus (F3 also finds it as segment, region and island), in a
pie menu, whose shortcut the user sets in the preferences, and in the menus of Object, Sculpt and the paint modes."""

from collections.abc import Callable

import bpy

from ..mesh import labels
from ..preferences import PIE
from .panel import draw_operators


class VIEW3D_MT_partwheel_part(bpy.types.Menu):
    bl_label = "Part (Segment, Region, Island)"

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_context = "INVOKE_REGION_WIN"
        for group in (("mesh.partwheel_select", "mesh.partwheel_similar", "mesh.partwheel_mirrored"),
                      ("mesh.partwheel_remember",),
                      ("mesh.partwheel_move", "mesh.partwheel_deform"),
                      ("mesh.partwheel_copy", "mesh.partwheel_remove", "mesh.partwheel_convex_part",
                       "mesh.partwheel_swap"),
                      ("mesh.partwheel_parts", "mesh.partwheel_split", "mesh.partwheel_convex")):
            draw_operators(layout, *group)
            layout.separator()
        layout.menu("VIEW3D_MT_partwheel_parts_from")


class VIEW3D_MT_partwheel_parts_from(bpy.types.Menu):
    """Divide the model by what it has already: materials, face sets, vertex groups, an attribute, loose parts"""

    bl_label = "Parts From"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.operator_context = "INVOKE_REGION_WIN"
        obj = context.active_object
        sources = labels.list_sources(obj) if obj and obj.type == "MESH" else ()  # Blender's menu search asks without a mesh, too
        for source, attribute in (("AUTOMATIC", ""), *sources):
            name = attribute or labels.SOURCES.get(source, ("Automatic",))[0]
            entry = self.layout.operator("mesh.partwheel_parts", text=name, translate=not attribute)
            entry.source, entry.attribute = source, attribute


class PieMenu(bpy.types.Menu):
    bl_idname = PIE
    bl_label = "Part"

    def draw(self, _context: bpy.types.Context) -> None:
        pie = self.layout.menu_pie()
        pie.operator_context = "INVOKE_REGION_WIN"
        draw_operators(pie, "mesh.partwheel_mirrored", "mesh.partwheel_similar", "mesh.partwheel_deform",  # west, east, south
                       "mesh.partwheel_select", "mesh.partwheel_remember", "mesh.partwheel_move",  # north, northwest, northeast
                       "mesh.partwheel_remove", "mesh.partwheel_copy")  # southwest, southeast


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
