"""What a view leaves out is not picked: beyond a clipping region (Alt B), hidden faces, and outside the local view."""
import math

import bpy
from mathutils import Matrix, Quaternion


def play(stage):
    yield from clipped(stage)
    yield from hidden(stage)
    yield from local(stage)


def clipped(stage):
    """The model is cut in the middle; seen from the cut, the mouse reaches what is inside."""
    yield from stage.open("hand")
    stage.use_tool()
    stage.view_3d.view_perspective = "ORTHO"
    yield from stage.wait_for_redraw()
    centers = stage.view.centers()
    (left, bottom), (right, top) = ([int(v) for v in corner] for corner in (centers.min(axis=0), centers.max(axis=0)))
    stage.mouse.move(left - 20, bottom - 20)
    stage.mouse.key("B", alt=True)
    yield from stage.settle()
    yield from stage.drag("LEFTMOUSE", (left + right) // 2 - left + 20, top - bottom + 40)
    yield from stage.until("the view is clipped", lambda: stage.view_3d.use_clip_planes)
    stage.view_3d.view_rotation = stage.view_3d.view_rotation @ Quaternion((0, 1, 0), math.pi / 2)
    yield from stage.wait_for_redraw()
    view = stage.view
    whole = type(view)(stage.area, stage.object, stage.wheels.vertices, stage.wheels.triangles)
    whole._planes = whole._planes[:, :0]
    centers = view.centers()
    (x, y) = centers.mean(axis=0)

    def uncovered(face):
        stops, start = stage.wheels.stops(face)
        there = whole.face_at(*centers[face].round())
        return there not in stops[start] and len(stops) > start + 1

    yield from stage.take(view.spot(x, y, uncovered), "clipped")
    yield from stage.screenshot("0-clipped")
    stage.mouse.key("RET")
    yield from stage.ended()
    empty = next((int(cx), int(cy)) for cx, cy in centers[::7].round()
                 if view.face_around(int(cx), int(cy)) is None and view.face_at(cx, cy) is None
                 and whole.face_around(int(cx), int(cy), 2) is not None)
    stage.mouse.move(*empty)
    yield from stage.until("where all is clipped there is nothing to hover", lambda: stage.hovered() is None)
    stage.mouse.click()
    yield from stage.selected((), "a click there selects nothing")
    stage.mouse.key("B", alt=True)
    yield from stage.until("the view is whole again", lambda: not stage.view_3d.use_clip_planes)


def hidden(stage):
    """H hides a part; what was behind it is picked, and no part takes hidden faces along."""
    yield from stage.open("hand")
    stage.use_tool()
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    stage.mouse.click()
    yield from stage.selected(stops[start], "after a click")
    stage.mouse.key("H")
    yield from stage.until("the part is hidden", lambda: not stage.selection())
    gone = stops[start]
    visible = [face for face in range(len(stage.wheels.triangles)) if face not in gone]
    stage.wheels.triangles = stage.wheels.triangles[visible]
    view = stage.view
    centers = view.centers()
    x, y, row = view.spot(*(centers.min(axis=0) + (centers.max(axis=0) - centers.min(axis=0)) * [0.5, 0.8]))
    stops, start = stage.wheels.stops(visible[row])
    stage.mouse.move(x, y)
    stage.mouse.click()
    yield from stage.selected(stops[start] - gone, "after a click beside it")
    stage.mouse.wheel(len(stops))
    yield from stage.selected(stops[-1] - gone, "at the whole")
    yield from stage.screenshot("1-hidden")
    stage.mouse.key("ESC")
    yield from stage.ended()


def local(stage):
    """A box around the model is in front of it in the whole scene, and not there in the local view."""
    yield from stage.open("hand")
    model = stage.object
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    mesh = bpy.data.meshes.new("box")
    mesh.from_pydata([(x, y, z) for x in (-3, 3) for y in (-3, 3) for z in (-3, 3)], [],
                     [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    box = bpy.data.objects.new("box", mesh)
    stage.window.scene.collection.objects.link(box)
    box.matrix_world = Matrix.Translation(stage.view_3d.view_location)
    stage.view_3d.view_distance *= 2  # the eye is outside
    yield from stage.wait_for_redraw()
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stage.mouse.move(x, y)
    stage.mouse.key("NUMPAD_SLASH")
    yield from stage.until("the local view is there", lambda: stage.area.spaces.active.local_view is not None)
    with stage.override():
        bpy.ops.view3d.localview(frame_selected=False)  # the key has framed the model: once more, at the same place
        box.select_set(False)
        model.select_set(True)
        bpy.ops.view3d.localview(frame_selected=False)
        box.select_set(True)
    stage.mouse.key("TAB")
    yield from stage.until("Edit Mode is there", lambda: model.mode == "EDIT")
    yield from stage.wait_for_redraw()
    spot = stage.spot(0.5, 0.9, above=1)
    stage.use_tool()
    yield from stage.take(spot, "in the local view")
    yield from stage.screenshot("2-local")
    stage.mouse.key("ESC")
    yield from stage.ended()
    stage.mouse.key("TAB")
    yield from stage.until("Object Mode is there", lambda: model.mode == "OBJECT")
    with stage.override():
        bpy.ops.view3d.localview(frame_selected=False)
        box.select_set(True)
    stage.mouse.key("TAB")
    yield from stage.until("both are edited", lambda: box.mode == "EDIT" and model.mode == "EDIT")
    stage.view_3d.view_distance = 25  # Blender's versions differ in where they look from now
    yield from stage.wait_for_redraw()
    region = stage.view.region
    stage.mouse.move(region.x + region.width // 2, region.y + region.height // 2)
    stage.mouse.click()
    boxes = stage.registry
    yield from stage.until("the box has parts of its own", lambda: boxes.find_entry(box.data) is not None)
    yield from stage.until("the box is picked", lambda: box.data.total_face_sel > 0)
    stage.check(not stage.selection(), "the model behind it is not")
    yield from stage.screenshot("3-box")
    stage.mouse.key("RET")
    yield from stage.ended()
