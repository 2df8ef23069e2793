# SPDX-License-Identifier: GPL-3.0-or-later
"""What the status bar shows while a modal operator runs: the keys that count now, with Blender's icons if it has them,
or how far a build is."""

from itertools import groupby

import bpy

from .. import keys

# Some versions have more icons of keys than others.
ICONS = set(bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys())
WHEEL = "MOUSE_MMB_SCROLL"


class Line:
    """What one operator says in the status bar. Of several the one is heard that began last: the keys for the part that
    is held, say, and not how far the build for another mesh is."""

    lines = []

    def __init__(self):
        self._said = None

    def say(self, context, said):
        """said: a text or a drawer()."""
        self._said = said
        if self not in Line.lines:
            Line.lines.append(self)
        if self is Line.lines[-1]:
            context.workspace.status_text_set(said)

    def end(self, context):
        if self in Line.lines:
            Line.lines.remove(self)
            if context.workspace:
                context.workspace.status_text_set(Line.lines[-1]._said if Line.lines else None)


def drawer(row, hand_offs=()):
    """A function for WorkSpace.status_text_set(): these keys.Key, and what hands the part on."""
    def draw(header, _context):
        for key in row:
            icons = (WHEEL, *key.icons) if key is keys.LARGER and WHEEL in ICONS else key.icons
            _entry(header.layout, icons, f"{key.names}: {key.label}" if key.names else key.label)
        for (shift, label), some in groupby(hand_offs, key=lambda each: (each.shift, each.group or each.label)):
            _entry(header.layout, ["EVENT_SHIFT"] * shift + [f"EVENT_{each.key}" for each in some], label)
    return draw


def _entry(layout, icons, text):
    for icon in icons[:-1]:
        layout.label(text="", icon=icon)
    layout.label(text=text, icon=icons[-1] if icons else "NONE")
