"""The steps of docs/recipes/scan.md, with real events: a scan is imported, gets a UV map in parts, and paint on one ear."""
import bpy
import numpy

from compose import pixel
from mathutils import Euler, Vector
from scenarios.modes import hover, painted_on
from scenarios.recipe_character import parts_shown

EARS = Vector((0.37, -0.33, 1.1)), Vector((-0.37, -0.33, 1.1))


def play(stage):
    # Step 1
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    path = stage.file("dog.obj")
    stage.package("examples").dog().save(path)
    with stage.override():
        bpy.ops.wm.obj_import(filepath=str(path))
        bpy.ops.ed.undo_push(message="Import")
    model = stage.object
    middle = sum((model.matrix_world @ Vector(corner) for corner in model.bound_box), Vector()) / 8
    top = max((model.matrix_world @ vertex.co).z for vertex in model.data.vertices)
    stage.check(not model.data.uv_layers and top > 1.2, "a scan that stands, without a UV map")
    look_at(stage, middle)
    states, end_recording = stage.record_cuts()
    yield from stage.sidebar()
    yield from stage.wait_for_redraw()

    # Steps 2 and 3
    yield from parts_shown(stage, states)
    count = len(states[-1].cut)
    yield from stage.screenshot("1-parts")
    stage.mouse.move(*pixel(stage, middle))
    stage.mouse.wheel(1)
    yield from stage.until("the wheel makes more parts", lambda: len(states[-1].cut) == count + 1)
    stage.mouse.wheel(-1)
    yield from stage.until("and fewer", lambda: len(states[-1].cut) == count)
    for key in ("O", "U", "RET"):
        stage.mouse.key(key)
    yield from stage.until("there is a UV map", lambda: model.data.uv_layers and model.mode == "OBJECT")
    yield from stage.settle()
    stage.check(len(bpy.data.objects) == 1 and any(edge.use_seam for edge in model.data.edges), "seams, and no objects")
    uvs = numpy.empty(2 * len(model.data.loops), numpy.float32)
    model.data.uv_layers.active.data.foreach_get("uv", uvs)
    stage.check(uvs.min() > -1e-3 and uvs.max() < 1.001 and uvs.std() > 0.1, "in the unit square")
    end_recording()
    yield from workspace(stage, "UV Editing", middle)
    stage.mouse.key("A")
    yield from stage.until("the islands are seen", lambda: len(stage.selection()) == len(model.data.polygons))
    yield from stage.screenshot("2-islands")

    # Steps 4 to 6
    yield from workspace(stage, "Texture Paint", middle)
    stage.check(model.mode == "TEXTURE_PAINT", "Texture Paint Mode")
    with stage.override():
        bpy.ops.paint.add_texture_paint_slot(type="BASE_COLOR", color=(0.5, 0.5, 0.5, 1), width=256, height=256)
    stage.use_tool()
    image, = model.data.materials[0].texture_paint_images
    yield from stage.wait_for_redraw()
    ear, other = (pixel(stage, place) for place in EARS)
    yield from hover(stage, *ear)
    yield from stage.until("hover shows a part", lambda: stage.hovered())
    first = stage.hovered()
    stage.mouse.click()
    yield from stage.until("a click picks it", lambda: stage.overlay_faces() == first)
    stage.mouse.wheel(1)
    yield from stage.until("the wheel takes more", lambda: first < stage.overlay_faces())
    stage.mouse.wheel(-1)
    yield from stage.until("and less", lambda: stage.overlay_faces() == first)
    stage.mouse.key("RET")
    yield from stage.until("only the ear can be painted", lambda: painted_on(stage) == first)
    yield from hover(stage, *other)
    yield from stage.until("hover shows the other", lambda: stage.hovered() and not stage.hovered() & first)
    second = stage.hovered()
    stage.mouse.click(shift=True)
    stage.mouse.key("RET")
    yield from stage.until("Shift adds it", lambda: painted_on(stage) == first | second)
    yield from stage.screenshot("3-mask")
    with stage.override():
        bpy.ops.wm.tool_set_by_id(name="builtin_brush.Draw")
    stage.window.scene.tool_settings.image_paint.brush.color = 0.8, 0.15, 0.05
    before = pixels(image)
    yield from stage.drag("LEFTMOUSE", ear[0] - other[0], ear[1] - other[1])
    yield from stage.until("there is paint", lambda: (pixels(image) != before).any())
    stage.check((pixels(image) != before).mean() < 0.2, "on the ears only")
    yield from stage.screenshot("4-painted")
    stage.use_tool()
    stage.mouse.move(*pixel(stage, (-1, 0, 1.9)))
    yield from stage.settle()
    stage.mouse.click()
    yield from stage.until("a click beside the model ends the mask", lambda: not painted_on(stage))


def workspace(stage, name, middle):
    """Goes to a workspace, with the mouse over the model."""
    stage.window.workspace = bpy.data.workspaces[name]
    yield from stage.settle()
    look_at(stage, middle)
    yield from stage.wait_for_redraw()
    stage.mouse.move(*pixel(stage, middle))
    yield from stage.settle()


def look_at(stage, middle):
    stage.tidy()
    stage.view_3d.view_rotation = Euler((1.3, 0, 0.4)).to_quaternion()
    stage.view_3d.view_location, stage.view_3d.view_distance = middle, 3.4


def pixels(image):
    values = numpy.empty(len(image.pixels), numpy.float32)
    image.pixels.foreach_get(values)
    return values
