# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the operators are found: panel, menu, shortcut."""

from . import keymap, menu, panel


def register():
    panel.register()
    menu.register()
    keymap.register()


def unregister():
    keymap.unregister()
    menu.unregister()
    panel.unregister()
