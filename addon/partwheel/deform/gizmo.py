# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen of deformation handles: their vertices, and the gizmo of the one that moves: arrows along the axes move
it, boxes scale it, rings turn it. Drawn and looked up by ourselves: Blender gives its own gizmos no events while an
operator runs. Points and lines are by Blender's shaders: on Metal and Vulkan there is no other way to some width.
"""

import math

import bpy
import gpu
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_location_3d
from gpu_extras.batch import batch_for_shader
from mathutils import Vector

# In pixels of an unscaled interface: where an arrow begins and ends, where a box is, how large a ring, how near counts.
ARROW, BOX, RING, NEAR = (62, 90), 50, 105, 8
HEAD, HALF_BOX = 6, 4
LINE_WIDTH = 2.5
COLOURS = (1.0, 0.85, 0.3, 0.8), (1.0, 0.35, 0.05, 1.0)  # of handles that stay, of the one that the mouse moves
SIZE = 5.0  # of a point
SIDES = 48  # of a ring
STEEP, FLAT = 0.95, 0.25  # cosines: no arrow and box that points so much at the eye, no ring seen so much from its side


def _shapes(pivot, region, view):
    """[(kind G, R or S, axis 0 to 2, points of a line in the world)]."""
    middle = location_3d_to_region_2d(region, view, pivot)
    if middle is None:  # behind the eye
        return []
    pixel = (region_2d_to_location_3d(region, view, (middle.x + 100, middle.y), pivot)
             - region_2d_to_location_3d(region, view, middle, pivot)).length / 100
    pixel *= bpy.context.preferences.system.ui_scale
    shapes, towards_user = [], view.view_matrix.inverted_safe().to_3x3().col[2].normalized()
    for axis in range(3):
        along, one, other = (Vector(float(k == (axis + turn) % 3) for k in range(3)) for turn in range(3))
        if abs(along.dot(towards_user)) > FLAT:
            angles = [2 * math.pi * side / SIDES for side in range(SIDES + 1)]
            shapes.append(("R", axis, [pivot + pixel * RING * (math.cos(a) * one + math.sin(a) * other)
                                       for a in angles]))
        if abs(along.dot(towards_user)) > STEEP:
            continue
        start, end = (pivot + pixel * distance * along for distance in ARROW)
        barbs = [end + pixel * HEAD * (side - 1.5 * along) for side in (one, -one, other, -other)]
        shapes.append(("G", axis, [start, end, barbs[0], barbs[1], end, barbs[2], barbs[3], end]))
        corners = [pixel * HALF_BOX * (x * one + y * other) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))]
        faces = [pivot + pixel * (BOX + z * HALF_BOX) * along for z in (-1, 1)]
        shapes.append(("S", axis, [face + corner for face in faces for corner in corners]))
    return shapes


def under(pivot, region, view, mouse):
    """(kind, axis) of what is at a pixel of the region, or None."""
    found = []
    for kind, axis, points in _shapes(pivot, region, view):
        flat = [location_3d_to_region_2d(region, view, point) for point in points]
        found += [(_distance(Vector(mouse), a, b), kind, axis) for a, b in zip(flat, flat[1:]) if a and b]
    nearest = min(found, default=(math.inf,))
    return nearest[1:] if nearest[0] <= NEAR * bpy.context.preferences.system.ui_scale else None


def _distance(point, a, b):
    """From a segment, in the plane."""
    along = b - a
    share = min(max((point - a).dot(along) / along.length_squared, 0), 1) if along.length_squared else 0
    return (point - a - share * along).length


def draw(pivot, region, view):
    """The gizmo. To be called by a draw handler, POST_VIEW."""
    theme = bpy.context.preferences.themes[0].user_interface
    colours = theme.axis_x, theme.axis_y, theme.axis_z
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", LINE_WIDTH)
    gpu.state.blend_set("ALPHA")
    for _, axis, points in _shapes(pivot, region, view):
        shader.uniform_float("color", (*colours[axis], 0.9))
        batch_for_shader(shader, "LINE_STRIP", {"pos": points}).draw(shader)
    gpu.state.blend_set("NONE")


def draw_points(matrix_world, handles):
    """The same of handles: (n,3) points of each in the object's space; the last is the one that moves."""
    shader = _of_points()
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(matrix_world)
        for index, points in enumerate(handles):
            shader.uniform_float("color", COLOURS[index == len(handles) - 1])
            batch_for_shader(shader, "POINTS", {"pos": points.tolist()}).draw(shader)
    gpu.state.blend_set("NONE")


def _of_points():
    """The shader, bound."""
    try:
        shader = gpu.shader.from_builtin("POINT_UNIFORM_COLOR")
    except ValueError:  # Blender before 4.5, where all is drawn by OpenGL
        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        shader.bind()
        gpu.state.point_size_set(SIZE)
        return shader
    shader.bind()
    shader.uniform_float("size", SIZE)
    return shader
