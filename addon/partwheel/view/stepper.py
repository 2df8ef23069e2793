# SPDX-License-Identifier: GPL-3.0-or-later
"""Two buttons beside a click, "larger" and "smaller", for pens and other devices without a wheel."""

from itertools import pairwise
from math import cos, hypot, pi, sin

import bpy
import gpu
from gpu_extras.batch import batch_for_shader

RADIUS, OFFSET = 15, 44  # a button's radius, and its distance to the right of the click, in pixels at UI scale 1
BUTTON_COLOR, SIGN_COLOR = (0.12, 0.12, 0.12, 0.8), (0.95, 0.95, 0.95, 1.0)
CIRCLE_CORNERS = 24


def get_ui_scale() -> float:
    """Return Blender's UI scale, or 1 without a window."""
    return bpy.context.preferences.system.ui_scale or 1.0


class StepButtons:
    """Round buttons to the right of a click: "larger" above, "smaller" below. x, y: the click, in window pixels."""

    def __init__(self, x: float, y: float) -> None:
        scale = get_ui_scale()
        self._radius = RADIUS * scale
        self._centers = {sign: (x + OFFSET * scale, y + sign * 1.2 * self._radius) for sign in (1, -1)}

    def step_at(self, event: bpy.types.Event) -> int:
        """Return 1 if the mouse is over the button "larger", -1 if over "smaller", else 0."""
        return next((sign for sign, (x, y) in self._centers.items()
                     if hypot(event.mouse_x - x, event.mouse_y - y) <= self._radius), 0)

    def draw(self) -> None:
        region = bpy.context.region
        former_blend = gpu.state.blend_get()
        gpu.state.blend_set("ALPHA")
        for sign, (x, y) in self._centers.items():
            _draw_triangles(_circle_triangles(x - region.x, y - region.y, self._radius), BUTTON_COLOR)
            _draw_triangles(_bar_triangles(x - region.x, y - region.y, self._radius / 2, self._radius / 8), SIGN_COLOR)
            if sign > 0:
                _draw_triangles(_bar_triangles(x - region.x, y - region.y, self._radius / 8, self._radius / 2),
                                SIGN_COLOR)
        gpu.state.blend_set(former_blend)


def _circle_triangles(x: float, y: float, radius: float) -> list[tuple[float, float]]:
    angles = [2 * pi * k / CIRCLE_CORNERS for k in range(CIRCLE_CORNERS + 1)]
    rim = [(x + radius * cos(angle), y + radius * sin(angle)) for angle in angles]
    return [corner for a, b in pairwise(rim) for corner in ((x, y), a, b)]


def _bar_triangles(x: float, y: float, half_width: float, half_height: float) -> list[tuple[float, float]]:
    left, right, bottom, top = x - half_width, x + half_width, y - half_height, y + half_height
    return [(left, bottom), (right, bottom), (right, top), (left, bottom), (right, top), (left, top)]


def _draw_triangles(corners: list[tuple[float, float]], color: tuple) -> None:
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", color)
    batch_for_shader(shader, "TRIS", {"pos": [(*corner, 0.0) for corner in corners]}).draw(shader)
