# SPDX-License-Identifier: GPL-3.0-or-later
"""The status bar of modal operators: current keys, with Blender's icons if available, or the progress of a build."""

from collections.abc import Callable, Sequence

import bpy

from ..preferences import find_keymap_items
from ..translations.lookup import iface_
from . import keys

# Versions differ in which key icons they have.
ICONS = set(bpy.types.UILayout.bl_rna.functions["label"].parameters["icon"].enum_items.keys())


class StatusLine:
    """The status text of one operator. If several are shown, the one of the operator that started last is visible."""

    stack = []
    _content = None

    def show(self, context: bpy.types.Context, content: str | Callable) -> None:
        """content: a text, or a function from make_drawer()."""
        self._content = content
        if self not in StatusLine.stack:
            StatusLine.stack.append(self)
        if self is StatusLine.stack[-1]:
            context.workspace.status_text_set(content)

    def remove(self, context: bpy.types.Context) -> None:
        if self in StatusLine.stack:
            StatusLine.stack.remove(self)
            if context.workspace:
                context.workspace.status_text_set(StatusLine.stack[-1]._content if StatusLine.stack else None)


def make_drawer(row: Sequence[keys.Key | keys.Command]) -> Callable:
    """Return a function for WorkSpace.status_text_set() that shows these keys.Key, and those keys.Command that the user
    has keys for. Modifiers shared by consecutive entries are shown once."""
    def draw(header, _context):
        before = []
        for icons, text in filter(None, map(_key_label, row)):
            shared, before = before if icons[:-1] == before else [], icons[:-1]
            icons = icons[len(shared):]
            for icon in icons[:-1]:
                header.layout.label(text="", icon=icon)
            header.layout.label(text=text, icon=icons[-1] if icons else "NONE")
    return draw


def _key_label(key: keys.Key | keys.Command) -> tuple[list[str], str] | None:
    """Return (icons, text), or None."""
    if isinstance(key, keys.Key):
        return list(key.icons), f"{iface_(key.names)}: {iface_(key.label)}" if key.names else iface_(key.label)
    item = next((item for item in find_keymap_items(key.operator, key.options) if item.active), None)
    if item and f"EVENT_{item.type}" in ICONS:
        modifiers = [f"EVENT_{name.upper()}" for name in ("shift", "ctrl", "alt") if getattr(item, name)]
        return [*modifiers, f"EVENT_{item.type}"], iface_(key.label)
    return item and ([], f"{item.to_string()}: {iface_(key.label)}")
