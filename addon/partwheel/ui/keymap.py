# SPDX-License-Identifier: GPL-3.0-or-later
"""The shortcut: Shift Ctrl W (W for wheel) over a mesh in Edit Mode, which all keymaps of Blender 3.4 to 5.2 leave free
there. Ctrl W is Save in the one of Blender 2.7."""

import bpy

_items = []


def register():
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration is None:  # Blender without windows has none
        return
    keymap = configuration.keymaps.new(name="Mesh", space_type="EMPTY")
    _items.append((keymap, keymap.keymap_items.new("mesh.partwheel_select", "W", "PRESS", shift=True, ctrl=True)))


def unregister():
    for keymap, item in _items:
        keymap.keymap_items.remove(item)
    _items.clear()
