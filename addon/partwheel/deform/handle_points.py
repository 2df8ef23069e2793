# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertices of deformation handles, drawn over the 3D view."""

import gpu
from gpu_extras.batch import batch_for_shader

from ..view import shaders

COLOURS = (1.0, 0.85, 0.3, 0.8), (1.0, 0.35, 0.05, 1.0)  # of handles that stay, of the one that the mouse moves
SIZE = 5.0  # pixels


def draw(matrix_world, handles):
    """handles: (n,3) points of each in the object's space; the last is the one that moves. To be called by a draw
    handler, POST_VIEW."""
    shader = shaders.points(SIZE)
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(matrix_world)
        for index, points in enumerate(handles):
            shader.uniform_float("color", COLOURS[index == len(handles) - 1])
            batch_for_shader(shader, "POINTS", {"pos": points.tolist()}).draw(shader)
    gpu.state.blend_set("NONE")
