# SPDX-License-Identifier: GPL-3.0-or-later
"""Partwheel for Blender: select a meaningful part of a mesh with one click and a turn of the mouse wheel."""

from collections.abc import Callable
from types import ModuleType
import importlib
import sys
from pathlib import Path

import bpy

# For Blender 3.4 to 4.1. Later versions read blender_manifest.toml; a test compares both.
bl_info = {
    "name": "Partwheel",
    "author": "Partwheel contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Edit Mode > Select > Select Part by Wheel (Shift Ctrl W)",
    "description": "Select meaningful parts of a mesh with one click and the mouse wheel",
    "category": "Mesh",
}

PACKAGES = Path(__file__).parent / "packages"  # contains the Python package partwheel, in the legacy add-on

# An update may replace loaded modules. Blender before 4.2 reloads only this file; later versions unload the add-on's
# modules, but not the package's. So unload all here.
own_prefixes = f"{__name__}.", "partwheel."
for name in [name for name in sys.modules if f"{name}.".startswith(own_prefixes) and name != __name__]:
    del sys.modules[name]
    globals().pop(name[len(__name__) + 1:], None)
if PACKAGES.is_dir() and str(PACKAGES) not in sys.path:
    sys.path.insert(0, str(PACKAGES))


# Modules to register, in this order: first a module's classes for Blender, then its HANDLERS (by name), then its register().
MODULES = (
    "translations.lookup", "preferences", "parts.changes", "parts.files", "view.previews", "view.layers",
    "pick.build", "pick.select", "pick.objects", "pick.paint", "pick.draw_border",
    "related.similar_parts", "related.select", "related.recall", "related.gather", "solid.copy_part", "solid.loose_bits",
    "cut.parts_to", "cut.split", "cut.convex_parts", "compose.place", "compose.unite", "compose.swap",
    "deform.operator", "deform.proportional",
    "ui.panel", "ui.named_parts", "ui.path", "ui.modelling", "ui.menu", "ui.keymap", "ui.on_import", "ui.tour",
    "pick.hover", "pick.tool", "api", "command",
)


def register() -> None:
    for module in _modules():
        for cls in find_classes(module):
            bpy.utils.register_class(cls)
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
        for cls in reversed(find_classes(module)):
            bpy.utils.unregister_class(cls)


def find_classes(module: ModuleType) -> list[type]:
    """Return the operators, panels and other classes for Blender that a module defines, in their order."""
    return [cls for cls in vars(module).values() if isinstance(cls, type) and cls.__module__ == module.__name__
            and issubclass(cls, bpy.types.bpy_struct)]


def _handlers(module: ModuleType) -> list[tuple[list, Callable]]:
    """Return [(list of Blender's handlers, function)]; without lists that this version of Blender lacks."""
    return [(getattr(bpy.app.handlers, name), function) for name, function in getattr(module, "HANDLERS", {}).items()
            if hasattr(bpy.app.handlers, name)]


def _modules() -> list[ModuleType]:
    return [importlib.import_module(f".{name}", __name__) for name in MODULES]
