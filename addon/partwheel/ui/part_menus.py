# SPDX-License-Identifier: GPL-3.0-or-later
"""What is done with a part, as a menu (right click, Mesh; by F3 found as segment, region and island too) and as a pie,
whose key is the user's choice: it has none until the preferences are given one."""

import bpy

from ..preferences import PIE

_keys = []


class VIEW3D_MT_partwheel_part(bpy.types.Menu):
    bl_label = "Part (Segment, Region, Island)"

    def draw(self, _context):
        layout = self.layout
        layout.operator_context = "INVOKE_REGION_WIN"
        for group in (("mesh.partwheel_select", "mesh.partwheel_similar", "mesh.partwheel_mirrored"),
                      ("mesh.partwheel_remember",),
                      ("mesh.partwheel_move", "mesh.partwheel_deform"),
                      ("mesh.partwheel_copy", "mesh.partwheel_remove", "mesh.partwheel_swap"),
                      ("mesh.partwheel_parts", "mesh.partwheel_split", "mesh.partwheel_convex")):
            for operator in group:
                layout.operator(operator)
            layout.separator()


class PieMenu(bpy.types.Menu):
    bl_idname = PIE
    bl_label = "Part"

    def draw(self, _context):
        pie = self.layout.menu_pie()
        pie.operator_context = "INVOKE_REGION_WIN"
        for operator in ("mesh.partwheel_mirrored", "mesh.partwheel_similar", "mesh.partwheel_deform",  # west, east, south
                         "mesh.partwheel_select", "mesh.partwheel_remember", "mesh.partwheel_move",  # north, its sides
                         "mesh.partwheel_remove", "mesh.partwheel_copy"):  # south's
            pie.operator(operator)


def _draw(self, _context):
    self.layout.separator()
    self.layout.menu("VIEW3D_MT_partwheel_part")


CLASSES = (VIEW3D_MT_partwheel_part, PieMenu)
MENUS = "VIEW3D_MT_edit_mesh_context_menu", "VIEW3D_MT_edit_mesh"


def register():
    for menu in MENUS:
        getattr(bpy.types, menu).append(_draw)
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration:  # Blender without windows has none
        keymap = configuration.keymaps.new(name="Mesh", space_type="EMPTY")
        item = keymap.keymap_items.new("wm.call_menu_pie", "NONE", "PRESS")
        item.properties.name = PIE
        _keys.append((keymap, item))


def unregister():
    for menu in MENUS:
        getattr(bpy.types, menu).remove(_draw)
    for keymap, item in _keys:
        keymap.keymap_items.remove(item)
    _keys.clear()
