# SPDX-License-Identifier: GPL-3.0-or-later
"""The status bar of modal operators: current keys, with Blender's icons if available, or the progress of a build."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import bpy

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
    has keys for. Modifiers shared by consecutive entries are shown once.
    """
    def draw(header, _context):
        before = []
        for icons, text in filter(None, map(_key_label, row)):
            shared, before = before if icons[:-1] == before else [], icons[:-1]
            _draw_entry(header.layout, icons[len(shared):], text)
    return draw


def _key_label(key: keys.Key | keys.Command) -> tuple[list[str], str] | None:
    """Return (icons, text), or None."""
    if isinstance(key, keys.Key):
        return list(key.icons), f"{iface_(key.names)}: {iface_(key.label)}" if key.names else iface_(key.label)
    item = _find_keymap_item(key)
    if item and f"EVENT_{item.type}" in ICONS:
        modifiers = [f"EVENT_{name.upper()}" for name in ("shift", "ctrl", "alt") if getattr(item, name)]
        return [*modifiers, f"EVENT_{item.type}"], iface_(key.label)
    return item and ([], f"{item.to_string()}: {iface_(key.label)}")


def _draw_entry(layout: bpy.types.UILayout, icons: list[str], text: str) -> None:
    for icon in icons[:-1]:
        layout.label(text="", icon=icon)
    layout.label(text=text, icon=icons[-1] if icons else "NONE")


def _find_keymap_item(command: keys.Command) -> bpy.types.KeyMapItem | None:
    """Return the KeyMapItem that starts a keys.Command as the user has configured it, or None."""
    configuration = bpy.context.window_manager.keyconfigs.user
    keymap = configuration and configuration.keymaps.get("Mesh")
    return next((item for item in (keymap.keymap_items if keymap else ()) if item.active
                 and item.idname == command.operator
                 and all(getattr(item.properties, name) == value for name, value in command.options.items())), None)
