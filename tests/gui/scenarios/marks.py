"""A figure whose surface is one piece, with a texture: shirt, face, hair, legs and hand are one click each, if
no part crosses borders of colors."""
import types

import bmesh
import bpy
import numpy
from mathutils import Matrix, Quaternion
from painted_figure import PLACES, connected_patch, create_figure
from scenarios.knight import SIDES, find_spot, measure
from scenarios.modes import hover
from view import View

SAME = 0.85  # overlap by area; at the border the texture crosses faces


def play(stage):
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    with stage.override():
        obj = create_figure()
        stage.part("preferences").preferences().use_marks = {"COLORS"}
        stage.part("preferences").preferences().hard_marks = {"COLORS"}
        bpy.ops.mesh.partwheel_build()
        bpy.ops.object.mode_set(mode="EDIT")
        stage.window.scene.tool_settings.mesh_select_mode = (False, False, True)
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.ed.undo_push(message="Edit Mode")
    stage.area.spaces.active.shading.color_type = "TEXTURE"
    stage.view_3d.view_location, stage.view_3d.view_distance = (0, 0, 2.0), 9
    yield from stage.sidebar()
    stage.use_tool()
    vertices, triangles, owners, _, area = measure(bmesh.from_edit_mesh(obj.data))
    wanted = {name: connected_patch(obj, name) for name in PLACES}
    overlaps = {}
    for name, faces in wanted.items():
        stage.view_3d.view_rotation = Quaternion(SIDES["behind" if name == "hair" else "front"])
        yield from stage.wait_for_redraw()
        yield from stage.settle()
        view = View(stage.area, types.SimpleNamespace(matrix_world=Matrix()), vertices, triangles)
        yield from hover(stage, *find_spot(view, view.centers(), faces[owners]))
        yield from stage.settle()
        stage.mouse.click()
        yield from stage.until("something is selected", lambda: stage.selection())
        chosen = numpy.zeros(len(faces), bool)
        chosen[list(stage.selection())] = True
        overlaps[name] = round(area[chosen & faces].sum() / area[chosen | faces].sum(), 2)
        yield from stage.screenshot(name)
        stage.mouse.key("ESC")
        yield from stage.until("Esc clears", lambda: not stage.selection())
    yield from stage.screenshot("options")
    stage.check(min(overlaps.values()) >= SAME, f"one click each, but {overlaps}")
