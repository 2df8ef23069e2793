# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own shaders for points and lines of some width. On Metal and Vulkan there is no other way to one."""

import gpu


def points(size):
    """The shader, bound, for points of so many pixels; its colour is still to be set."""
    try:
        shader = gpu.shader.from_builtin("POINT_UNIFORM_COLOR")
    except ValueError:  # Blender before 4.5, where all is drawn by OpenGL
        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        shader.bind()
        gpu.state.point_size_set(size)
        return shader
    shader.bind()
    shader.uniform_float("size", size)
    return shader


def lines(width):
    """The same for lines, which all Blenders have."""
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    return shader
