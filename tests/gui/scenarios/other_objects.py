"""Objects of other kinds: mirrored in one axis and in all, and with a shape key that is edited."""
import bpy
from mathutils import Matrix


def play(stage):
    yield from stage.open("hand")
    stage.use_tool()
    model = stage.object
    bpy.context.view_layer.update()
    for name, scale in (("mirrored", (-1, 1, 1, 1)), ("all negative", (-1, -1, -1, 1))):
        before = model.matrix_world.copy()
        model.matrix_world = before @ Matrix.Diagonal(scale)
        yield from stage.wait_for_redraw()
        yield from pick(stage, name)
        model.matrix_world = before

    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        model.shape_key_add(name="Basis")
        key = model.shape_key_add(name="moved")
        for point in key.data:
            point.co.x += 0.4 * model.dimensions.x / model.scale.x
        model.active_shape_key_index = 1
        key.value = 1
        bpy.ops.object.mode_set(mode="EDIT")
    stage.wheels.vertices[:, 0] += 0.4 * model.dimensions.x / model.scale.x
    yield from stage.wait_for_redraw()
    yield from pick(stage, "shape key", picture=True)
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        model.shape_key_clear()
        bpy.ops.object.mode_set(mode="EDIT")


def pick(stage, name, picture=False):
    """A click on a place takes what is seen there."""
    yield from stage.take(stage.spot(0.5, 0.9, above=1), name)
    if picture:
        yield from stage.screenshot(name.replace(" ", "-"))
    stage.mouse.key("ESC")
    yield from stage.selected((), f"after Esc ({name})")
