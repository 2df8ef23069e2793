"""Opens a model of the demo for scripts/demo --open: activates the tool and draws a hint where to click.

Run as: blender MODEL.blend --python open.py
The hint disappears when a part is selected.
"""

from math import cos, pi, sin

import blf
import bpy
import gpu
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader

HINT = "Point here: click, then turn the wheel"
COLOR = (1.0, 0.55, 0.1, 1.0)
RADIUS, SEGMENTS = 18, 48  # of the ring, in pixels
drawing = []


def view():
    """The window, area and region of the largest 3D view, for temp_override()."""
    window = bpy.context.window_manager.windows[0]
    area = max((area for area in window.screen.areas if area.type == "VIEW_3D"), key=lambda area: area.width * area.height)
    return {"window": window, "area": area, "region": next(region for region in area.regions if region.type == "WINDOW")}


def choose_tool():
    """Activates the tool; runs when the window exists."""
    with bpy.context.temp_override(**view()):
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.wm.tool_set_by_id(name="partwheel.select")
    drawing.append(bpy.types.SpaceView3D.draw_handler_add(draw_hint, (), "WINDOW", "POST_PIXEL"))
    view()["area"].tag_redraw()


def draw_hint():
    context = bpy.context
    if context.mode != "EDIT_MESH" or not drawing:
        return
    if context.object.data.total_face_sel:
        bpy.types.SpaceView3D.draw_handler_remove(drawing.pop(), "WINDOW")
        return
    middle = location_3d_to_region_2d(context.region, context.region_data, context.object["partwheel_demo"])
    if middle is None:
        return
    scale = context.preferences.system.ui_scale
    angles = (2 * pi * number / SEGMENTS for number in range(SEGMENTS + 1))
    ring = [(middle.x + RADIUS * scale * cos(angle), middle.y + RADIUS * scale * sin(angle)) for angle in angles]
    shader = gpu.shader.from_builtin("2D_UNIFORM_COLOR" if bpy.app.version < (4, 0, 0) else "UNIFORM_COLOR")
    gpu.state.line_width_set(3)
    shader.uniform_float("color", COLOR)
    batch_for_shader(shader, "LINE_STRIP", {"pos": ring}).draw(shader)
    gpu.state.line_width_set(1)
    blf.size(0, 18 * scale)
    blf.color(0, *COLOR)
    blf.position(0, middle.x - blf.dimensions(0, HINT)[0] / 2, middle.y + 1.5 * RADIUS * scale, 0)
    blf.draw(0, HINT)


bpy.app.timers.register(choose_tool, first_interval=0.1)
