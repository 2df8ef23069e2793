# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the operators are found: panel, menu, shortcut."""

from . import copy_panel, deform_panel, keymap, menu, panel, path


def register():
    panel.register()
    path.register()
    copy_panel.register()
    deform_panel.register()
    menu.register()
    keymap.register()


def unregister():
    keymap.unregister()
    menu.unregister()
    deform_panel.unregister()
    copy_panel.unregister()
    path.unregister()
    panel.unregister()
