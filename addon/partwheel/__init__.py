# SPDX-License-Identifier: GPL-3.0-or-later
"""Partwheel for Blender: select a meaningful part of a mesh with one click and a turn of the mouse wheel."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
import importlib
import sys
from pathlib import Path

import bpy

# For Blender 3.4 to 4.1. Later ones read blender_manifest.toml; both say the same, and a test compares them.
bl_info = {
    "name": "Partwheel",
    "author": "Partwheel contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Edit Mode > Select > Select Part by Wheel (Shift Ctrl W)",
    "description": "Select meaningful parts of a mesh with one click and the mouse wheel",
    "category": "Mesh",
}

PACKAGES = Path(__file__).parent / "packages"  # with the Python package partwheel, where no wheel brings it

# An update may have been installed over what is loaded. Blender before 4.2 then reloads this file alone, later ones
# forget the add-on's modules but not the package's: all are forgotten here.
ours = f"{__name__}.", "partwheel."
for name in [name for name in sys.modules if f"{name}.".startswith(ours) and name != __name__]:
    del sys.modules[name]
    globals().pop(name[len(__name__) + 1:], None)
if PACKAGES.is_dir() and str(PACKAGES) not in sys.path:
    sys.path.insert(0, str(PACKAGES))


# What Blender is told of, in this order: a module's CLASSES, its HANDLERS (by name), then its register().
MODULES = (
    "words.catalogues", "preferences", "parts.changes", "parts.picks", "parts.files", "view.previews", "view.overlay",
    "pick.build", "pick.select", "pick.objects", "pick.paint", "related.similar_parts", "related.select", "related.recall",
    "related.gather", "solid.copy_part", "cut.parts_to", "cut.convex_parts", "compose.place", "compose.unite",
    "compose.swap", "deform.operator", "deform.proportional",
    "ui.panel", "ui.named_parts", "ui.path", "ui.modelling", "ui.menu", "ui.part_menus", "ui.keymap", "ui.on_import",
    "pick.hover", "pick.tool", "api", "command",
)


def register() -> None:
    for module in _modules():
        for each in getattr(module, "CLASSES", ()):
            bpy.utils.register_class(each)
        for handlers, function in _handlers(module):
            handlers.append(function)
        if hasattr(module, "register"):
            module.register()


def unregister() -> None:
    for module in reversed(_modules()):
        for handlers, function in _handlers(module):
            handlers.remove(function)
        if hasattr(module, "unregister"):
            module.unregister()
        for each in reversed(getattr(module, "CLASSES", ())):
            bpy.utils.unregister_class(each)


def _handlers(module: ModuleType) -> list[tuple[list, Callable]]:
    """[(a list of Blender's, the function for it)]; of newer lists none where this Blender hasn't got them."""
    return [(getattr(bpy.app.handlers, name), function) for name, function in getattr(module, "HANDLERS", {}).items()
            if hasattr(bpy.app.handlers, name)]


def _modules() -> list[ModuleType]:
    return [importlib.import_module(f".{name}", __name__) for name in MODULES]
