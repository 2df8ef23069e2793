# SPDX-License-Identifier: GPL-3.0-or-later
"""Partwheel for Blender: select a meaningful part of a mesh with one click and a turn of the mouse wheel.
"""

import sys
from pathlib import Path

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

if "register" in globals():
    # An update was installed over this: Blender before 4.2 reloads this file alone, so the others are forgotten here.
    for name in [name for name in sys.modules if name.startswith((f"{__name__}.", "partwheel.")) or name == "partwheel"]:
        del sys.modules[name]
        globals().pop(name[len(__name__) + 1:], None)
if PACKAGES.is_dir() and str(PACKAGES) not in sys.path:
    sys.path.insert(0, str(PACKAGES))


def register():
    from . import command, operators, preferences, prepared, previews, session, tools, ui

    preferences.register()
    session.register()
    prepared.register()
    previews.register()
    operators.register()
    ui.register()
    tools.register()
    command.register()


def unregister():
    from . import command, operators, overlay, preferences, prepared, previews, session, tools, ui

    command.unregister()
    tools.unregister()
    ui.unregister()
    operators.unregister()
    overlay.unregister()
    previews.unregister()
    prepared.unregister()
    session.unregister()
    preferences.unregister()
