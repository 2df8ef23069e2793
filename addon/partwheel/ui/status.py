# SPDX-License-Identifier: GPL-3.0-or-later
"""What the status bar shows while a modal operator runs: the keys that count now, with Blender's icons if it has them."""

import bpy

from .. import keys
from . import keymap

# Some versions have more icons of keys than others.
ICONS = set(bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys())
WHEEL = "MOUSE_MMB_SCROLL"


def drawer(row, commands=()):
    """A function for WorkSpace.status_text_set(): these keys.Key, and the keys.Command that the user has keys for."""
    def draw(header, _context):
        for key in row:
            icons = (WHEEL, *key.icons) if key is keys.LARGER and WHEEL in ICONS else key.icons
            _entry(header.layout, icons, f"{key.names}: {key.label}" if key.names else key.label)
        for command in commands:
            item = keymap.item(command)
            held = item and [f"EVENT_{name.upper()}" for name in ("shift", "ctrl", "alt") if getattr(item, name)]
            if item and f"EVENT_{item.type}" in ICONS:
                _entry(header.layout, [*held, f"EVENT_{item.type}"], command.label)
            elif item:
                _entry(header.layout, [], f"{item.to_string()}: {command.label}")
    return draw


def _entry(layout, icons, text):
    for icon in icons[:-1]:
        layout.label(text="", icon=icon)
    layout.label(text=text, icon=icons[-1] if icons else "NONE")
