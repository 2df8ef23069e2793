# SPDX-License-Identifier: GPL-3.0-or-later
"""Shortcuts in Edit Mode: Shift Ctrl W (W for wheel) over a mesh, and commands for the picked part. All keymaps of
Blender 3.4 to 5.2 leave them unassigned there; Ctrl W is Save in the keymap of Blender 2.7. The pie menu has none until the user
sets one."""

import bpy

from ..preferences import PIE
from ..view import keys

_items = []


def register() -> None:
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration is None:  # None without windows
        return
    keymap = configuration.keymaps.new(name="Mesh", space_type="EMPTY")
    _items.append((keymap, keymap.keymap_items.new("mesh.partwheel_select", "W", "PRESS", shift=True, ctrl=True)))
    for command in keys.COMMANDS:
        item = keymap.keymap_items.new(command.operator, command.key, "PRESS", shift=True, ctrl=True)
        for name, value in command.options.items():
            setattr(item.properties, name, value)
        _items.append((keymap, item))
    pie = keymap.keymap_items.new("wm.call_menu_pie", "NONE", "PRESS")
    pie.properties.name = PIE
    _items.append((keymap, pie))


def unregister() -> None:
    for keymap, item in _items:
        keymap.keymap_items.remove(item)
    _items.clear()
