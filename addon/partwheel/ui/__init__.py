# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the operators are found: panel, menu, shortcut."""

from . import copy_panel, deform_panel, keymap, menu, panel


def register():
    panel.register()
    copy_panel.register()
    deform_panel.register()
    menu.register()
    keymap.register()


def unregister():
    keymap.unregister()
    menu.unregister()
    deform_panel.unregister()
    copy_panel.unregister()
    panel.unregister()
