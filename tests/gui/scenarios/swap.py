"""A part exchanged for a compatible one: a figure's arm for one of the bear's limbs, chosen with the wheel among those
that are offered. Meanwhile the object itself is hidden and untouched, also in a file saved then. Esc brings everything
back to the last bit; a click swaps, as one undo step."""
import bpy
import numpy
from mathutils import Matrix, Quaternion, Vector

from compose import activate, choose, closed, picked_up_to, places, volume
from stage import VIEWS


def play(stage):
    yield from stage.open("figure")
    yield from stage.until("Edit Mode", lambda: stage.object.mode == "EDIT")
    figure = stage.object
    yield from giver(stage)
    yield from picked_up_to(stage, 0.02, 0.62, 0.06)
    stage.mouse.key("RET")
    yield from stage.settle()
    picked = stage.selection()
    stage.view_3d.view_location += stage.view_3d.view_rotation @ Vector((0.85, 0, 0))  # both are in the picture
    stage.view_3d.view_distance *= 1.25
    yield from stage.wait_for_redraw()
    yield from stage.screenshot("1-picked")

    before = scene()
    yield from begun(stage, figure)
    stage.check(figure.hide_viewport and (places(figure), figure.data.name) == before[1]["figure"][:2],
                "the figure is hidden, and untouched")
    saved = str(stage.file("meanwhile.blend"))
    with stage.override():
        bpy.ops.wm.save_as_mainfile(filepath=saved, copy=True)
    with bpy.data.libraries.load(saved) as (saved_data, _):
        stage.check((set(saved_data.objects), set(saved_data.meshes)) == ({"figure", "bear"}, {"figure", "bear"}),
                    f"a file saved meanwhile has nothing of it ({saved_data.objects}, {saved_data.meshes})")
    stage.check(not figure.hide_viewport, "nor that anything was hidden")
    stage.mouse.move(stage.mouse.x + 3, stage.mouse.y)
    yield from stage.until("and then it goes on", lambda: len(bpy.data.objects) == 4)
    first = shown()
    yield from stage.screenshot("2-first")
    stage.mouse.wheel(1)
    yield from stage.until("the wheel offers another one", lambda: shown() != first)
    second = shown()
    matrix = bpy.data.objects[second].matrix_world.copy()
    stage.mouse.wheel(2, shift=True)
    yield from stage.until("Shift turns it", lambda: bpy.data.objects[second].matrix_world != matrix)
    stage.mouse.key("M")
    yield from stage.until("M mirrors it", lambda: bpy.data.objects[second].matrix_world.is_negative)
    stage.mouse.wheel(-1)
    yield from stage.until("the wheel goes back to the first", lambda: shown() == first)
    stage.mouse.key("ESC")
    yield from stage.until("Esc is Edit Mode again", lambda: figure.mode == "EDIT")
    stage.check(stage.selection() == picked, "with the part selected")
    stage.check(scene() == before, "and everything is as it was")
    yield from stage.ended()

    whole, count = volume(figure), len(figure.data.polygons)
    yield from begun(stage, figure)
    stage.mouse.click()
    yield from stage.until("a click swaps", lambda: len(bpy.data.objects) == 2 and figure.mode == "OBJECT" and
                           len(bpy.data.objects["figure"].data.polygons) != count)
    yield from stage.until("its parts are found", lambda: not stage.has_builds())
    stage.check(closed(figure) and volume(figure) != whole, "the result is closed")
    stage.check({mesh.name for mesh in bpy.data.meshes} == before[0], "nothing else is left")
    yield from stage.screenshot("3-swapped")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step brings the arm back", lambda: len(bpy.data.objects["figure"].data.polygons)
                           == count and abs(volume(bpy.data.objects["figure"]) - whole) < 1e-6 * whole)


def giver(stage):
    """The bear beside the figure, as large, seen from the front, with its parts."""
    model, figure = numpy.load(stage.file("bear.npz")), stage.object
    mesh = bpy.data.meshes.new("bear")
    mesh.from_pydata(model["vertices"], [], model["triangles"].tolist())
    bear = bpy.data.objects.new("bear", mesh)
    stage.window.scene.collection.objects.link(bear)
    low, high = model["vertices"].min(axis=0), model["vertices"].max(axis=0)
    view = stage.view_3d.view_rotation
    turn = view @ Quaternion(VIEWS["bear"]).inverted()
    bear.matrix_world = (Matrix.Translation(stage.view_3d.view_location + view @ Vector((1.9, 0, 0)))
                         @ turn.to_matrix().to_4x4() @ Matrix.Scale(2 / (high - low).max(), 4)
                         @ Matrix.Translation(-(low + high) / 2))
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    activate(stage, bear)
    with stage.override():
        bpy.ops.mesh.partwheel_build()
    activate(stage, figure)
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")
    yield from stage.wait_for_redraw()
    return bear


def begun(stage, figure):
    """The entry of the menu of parts above the four for the whole model, with the mouse in the view."""
    yield from choose(stage, "VIEW3D_MT_partwheel_part", 4)
    yield from stage.until("a part stands in", lambda: len(bpy.data.objects) == 4)


def shown():
    """The name of the part that can be seen."""
    return next(obj.name for obj in bpy.data.objects if obj.name.startswith("bear ") and not obj.hide_viewport)


def scene():
    """All that the tool could have changed."""
    return ({mesh.name for mesh in bpy.data.meshes},
            {obj.name: (places(obj), obj.data.name, obj.select_get(), obj.hide_viewport, tuple(obj.matrix_world.col[3]))
             for obj in bpy.data.objects})
