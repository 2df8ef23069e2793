# SPDX-License-Identifier: GPL-3.0-or-later
"""The toolbar's tools, and what they show under the mouse before a click."""

from . import hover, select


def register():
    hover.register()
    select.register()


def unregister():
    select.unregister()
    hover.unregister()
