# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawing and hit testing of deformation handles: their vertices, and the gizmo of the active handle with arrows to
move, boxes to scale and rings to turn it. Blender sends no events to its own gizmos while an operator runs. Points
and lines use Blender's shaders, the only way to set a width on Metal and Vulkan."""

import math

import bpy
import gpu
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_location_3d
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix, Vector

# Pixels of an unscaled interface
ARROW_RANGE = 62, 90  # start and end of an arrow
BOX_DISTANCE = 50
RING_RADIUS = 105
HIT_DISTANCE = 8
HEAD_SIZE, HALF_BOX = 6, 4  # arrow head, half a box's side
LINE_WIDTH = 2.5
POINT_SIZE = 5.0

HANDLE_COLORS = (1.0, 0.85, 0.3, 0.8), (1.0, 0.35, 0.05, 1.0)  # of inactive handles, of the active one
RING_SIDES = 48
MAX_ARROW_COSINE = 0.95  # cosine of the angle to the view axis: above, no arrow and box
MIN_RING_COSINE = 0.25  # the same: below, no ring


def _shapes(pivot: Vector, region: bpy.types.Region,
            view: bpy.types.RegionView3D) -> list[tuple[str, int, list[Vector]]]:
    """[(kind G, R or S, axis 0 to 2, points of a polyline in the world)] of the gizmo at pivot."""
    center = location_3d_to_region_2d(region, view, pivot)
    if center is None:  # behind the viewer
        return []
    pixel = (region_2d_to_location_3d(region, view, (center.x + 100, center.y), pivot)
             - region_2d_to_location_3d(region, view, center, pivot)).length / 100
    pixel *= bpy.context.preferences.system.ui_scale
    shapes, view_axis = [], view.view_matrix.inverted_safe().to_3x3().col[2].normalized()
    for axis in range(3):
        along, first, second = (Vector(float(k == (axis + turn) % 3) for k in range(3)) for turn in range(3))
        if abs(along.dot(view_axis)) > MIN_RING_COSINE:
            angles = [2 * math.pi * side / RING_SIDES for side in range(RING_SIDES + 1)]
            shapes.append(("R", axis, [pivot + pixel * RING_RADIUS * (math.cos(a) * first + math.sin(a) * second)
                                       for a in angles]))
        if abs(along.dot(view_axis)) > MAX_ARROW_COSINE:
            continue
        start, end = (pivot + pixel * distance * along for distance in ARROW_RANGE)
        barbs = [end + pixel * HEAD_SIZE * (side - 1.5 * along) for side in (first, -first, second, -second)]
        shapes.append(("G", axis, [start, end, barbs[0], barbs[1], end, barbs[2], barbs[3], end]))
        corners = [pixel * HALF_BOX * (x * first + y * second) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))]
        faces = [pivot + pixel * (BOX_DISTANCE + z * HALF_BOX) * along for z in (-1, 1)]
        shapes.append(("S", axis, [face + corner for face in faces for corner in corners]))
    return shapes


def hit_test(pivot: Vector, region: bpy.types.Region, view: bpy.types.RegionView3D,
             mouse: tuple[float, float]) -> tuple[str, int] | None:
    """(kind, axis) of the gizmo's shape at a pixel of the region, or None."""
    distances = []
    for kind, axis, points in _shapes(pivot, region, view):
        pixels = [location_3d_to_region_2d(region, view, point) for point in points]
        distances += [(_distance(Vector(mouse), a, b), kind, axis) for a, b in zip(pixels, pixels[1:]) if a and b]
    nearest = min(distances, default=(math.inf,))
    return nearest[1:] if nearest[0] <= HIT_DISTANCE * bpy.context.preferences.system.ui_scale else None


def _distance(point: Vector, a: Vector, b: Vector) -> float:
    along = b - a
    fraction = min(max((point - a).dot(along) / along.length_squared, 0), 1) if along.length_squared else 0
    return (point - a - fraction * along).length


def draw_gizmo(pivot: Vector, region: bpy.types.Region, view: bpy.types.RegionView3D) -> None:
    """Draws the gizmo, in a draw handler of POST_VIEW."""
    theme = bpy.context.preferences.themes[0].user_interface
    colors = theme.axis_x, theme.axis_y, theme.axis_z
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", LINE_WIDTH)
    gpu.state.blend_set("ALPHA")
    for _, axis, points in _shapes(pivot, region, view):
        shader.uniform_float("color", (*colors[axis], 0.9))
        batch_for_shader(shader, "LINE_STRIP", {"pos": points}).draw(shader)
    gpu.state.blend_set("NONE")


def draw_points(matrix_world: Matrix, handles: list[np.ndarray]) -> None:
    """Draws handles in a POST_VIEW handler: points (n, 3) of each in the object's space; the last one is active."""
    shader = _bind_point_shader()
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(matrix_world)
        for index, points in enumerate(handles):
            shader.uniform_float("color", HANDLE_COLORS[index == len(handles) - 1])
            batch_for_shader(shader, "POINTS", {"pos": points.tolist()}).draw(shader)
    gpu.state.blend_set("NONE")


def _bind_point_shader() -> gpu.types.GPUShader:
    try:
        shader = gpu.shader.from_builtin("POINT_UNIFORM_COLOR")
    except ValueError:  # before Blender 4.5, which draws by OpenGL
        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        shader.bind()
        gpu.state.point_size_set(POINT_SIZE)
        return shader
    shader.bind()
    shader.uniform_float("size", POINT_SIZE)
    return shader
