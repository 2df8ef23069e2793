# SPDX-License-Identifier: GPL-3.0-or-later
"""Two buttons beside a click, larger and smaller, for pens and other devices without a wheel."""

from __future__ import annotations

from itertools import pairwise
from math import cos, hypot, pi, sin

import bpy
import gpu
from gpu_extras.batch import batch_for_shader

RADIUS, OFFSET = 15, 44  # of a button, and of its center from the click, in pixels at resolution scale 1
BUTTON_COLOR, SIGN_COLOR = (0.12, 0.12, 0.12, 0.8), (0.95, 0.95, 0.95, 1.0)
CIRCLE_CORNERS = 24


def get_ui_scale() -> float:
    """Return Blender's resolution scale, which is 0 without a window."""
    return bpy.context.preferences.system.ui_scale or 1.0


class StepButtons:
    """The button "larger" above the height of the click, "smaller" below. x, y: of the click in the window."""

    def __init__(self, x: float, y: float) -> None:
        scale = get_ui_scale()
        self._radius = RADIUS * scale
        self._middles = {sign: (x + OFFSET * scale, y + sign * 1.2 * self._radius) for sign in (1, -1)}

    def step_at(self, event: bpy.types.Event) -> int:
        """Return 1 over the button "larger", -1 over "smaller", else 0."""
        return next((sign for sign, (x, y) in self._middles.items()
                     if hypot(event.mouse_x - x, event.mouse_y - y) <= self._radius), 0)

    def draw(self) -> None:
        """Draw in pixels of the context's region."""
        region = bpy.context.region
        before = gpu.state.blend_get()
        gpu.state.blend_set("ALPHA")
        for sign, (x, y) in self._middles.items():
            _draw_triangles(_circle_triangles(x - region.x, y - region.y, self._radius), BUTTON_COLOR)
            _draw_triangles(_bar_triangles(x - region.x, y - region.y, self._radius / 2, self._radius / 8), SIGN_COLOR)
            if sign > 0:
                _draw_triangles(_bar_triangles(x - region.x, y - region.y, self._radius / 8, self._radius / 2),
                                SIGN_COLOR)
        gpu.state.blend_set(before)


def _circle_triangles(x: float, y: float, radius: float) -> list[tuple[float, float]]:
    angles = [2 * pi * k / CIRCLE_CORNERS for k in range(CIRCLE_CORNERS + 1)]
    rim = [(x + radius * cos(angle), y + radius * sin(angle)) for angle in angles]
    return [corner for a, b in pairwise(rim) for corner in ((x, y), a, b)]


def _bar_triangles(x: float, y: float, wide: float, high: float) -> list[tuple[float, float]]:
    a, b, c, d = (x - wide, y - high), (x + wide, y - high), (x + wide, y + high), (x - wide, y + high)
    return [a, b, c, a, c, d]


def _draw_triangles(corners: list[tuple[float, float]], color: tuple) -> None:
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", color)
    batch_for_shader(shader, "TRIS", {"pos": [(*corner, 0.0) for corner in corners]}).draw(shader)
