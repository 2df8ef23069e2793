# SPDX-License-Identifier: GPL-3.0-or-later
"""What the status bar shows while a part is picked: the keys that count now, with Blender's icons where it has them."""

import bpy

from .. import keys

# Some versions have more icons of keys than others.
ICONS = set(bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys())
WHEEL = "MOUSE_MMB_SCROLL"


def drawer(row, hand_offs=()):
    """A function for WorkSpace.status_text_set(): these keys.Key, and what hands the part on."""
    def draw(header, _context):
        layout = header.layout
        for key in row:
            if key is keys.LARGER and WHEEL in ICONS:
                layout.label(text="", icon=WHEEL)
            for icon in key.icons[:-1]:
                layout.label(text="", icon=icon)
            text = f"{key.names}: {key.label}" if key.names else key.label
            layout.label(text=text, icon=key.icons[-1] if key.icons else "NONE")
        for each in hand_offs:
            if each.shift:
                layout.label(text="", icon="EVENT_SHIFT")
            layout.label(text=each.label, icon=f"EVENT_{each.key}")
    return draw
