# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands for a part as a menu (right click, Mesh; F3 also finds it as segment, region and island) and as a pie
menu, whose shortcut the user sets in the preferences."""

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
                       "mesh.partwheel_select", "mesh.partwheel_remember", "mesh.partwheel_move",  # north, its sides
                       "mesh.partwheel_remove", "mesh.partwheel_copy")  # south's


CLASSES = (VIEW3D_MT_partwheel_part, VIEW3D_MT_partwheel_parts_from, PieMenu)
