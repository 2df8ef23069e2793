# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the wheel resizes the picked part."""

from math import hypot

import bpy

from ..preferences import preferences
from ..view import picking
from ..view.stepper import get_ui_scale

NEAR = 30  # pixels at resolution scale 1 that the mouse may move while the wheel turns


class ClickArea:
    """Around the click of the tool, as long as the view does not change; else all 3D views."""

    def __init__(self, context: bpy.types.Context, event: bpy.types.Event, is_tool: bool) -> None:
        view = picking.find_view_under_mouse(context, event) if is_tool and preferences().wheel == "NEAR" else None
        self._click = view and (event.mouse_x, event.mouse_y, view[2].perspective_matrix.copy())

    def contains(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Return whether the wheel resizes the part where the mouse is."""
        view = picking.find_view_under_mouse(context, event)
        if not (view and self._click):
            return view is not None
        x, y, matrix = self._click
        return (hypot(event.mouse_x - x, event.mouse_y - y) <= NEAR * get_ui_scale()
                and view[2].perspective_matrix == matrix)
