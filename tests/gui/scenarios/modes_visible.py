"""The tool in Sculpt Mode on a multires modifier's levels, whose mask Python can't write: the part gets dark, and with a
click beside the model it is not any more. With dynamic topology the tool says why it does nothing."""
import bpy
import numpy
from scenarios.modes import enter, stroked
from view import picture


def play(stage):
    yield from stage.open("hand")
    model = stage.object
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        multires = model.modifiers.new("multires", "MULTIRES")
        bpy.ops.object.multires_subdivide(modifier="multires")
    evaluated = model.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    stage.wheels.vertices = numpy.array([vertex.co for vertex in evaluated.vertices][:len(model.data.vertices)])
    multires.levels, multires.sculpt_levels = 0, 1
    yield from enter(stage, "SCULPT")
    x, y, face = stage.spot(0.5, 0.9, above=2)
    x2, y2, other = stage.spot(0.1, 0.7, above=2)
    stops, start = stage.wheels.stops(face)
    other_stops, begin = stage.wheels.stops(other)
    empty = stage.empty_spot()
    stage.mouse.move(*empty)
    before = picture((yield from stage.screenshot("0-before")))

    def dark(expected, when):
        """Exactly these parts are, by pixels that show the middle of one of their faces."""
        stage.mouse.move(*empty)
        yield from stage.wait_for_redraw()
        after = picture((yield from stage.screenshot(when.replace(" ", "-"))))
        darker = (before - after)[..., :3].mean(axis=2) > 0.05
        part, rest = (stage.view.visible_centers(sorted(faces)[::len(faces) // 100 + 1]).round().astype(int) for faces in
                      (expected, set(range(len(stage.wheels.triangles))) - expected))
        inside, outside = (darker[p[:, 1], p[:, 0]].mean() if len(p) else 0 for p in (part, rest))
        stage.check((inside > 0.85 or not expected) and outside < 0.05, f"{when}: {inside:.2f} of the part, {outside:.2f} of the rest")

    def click(x, y, **session_module):
        stage.mouse.move(x - 3, y)
        stage.mouse.move(x, y)
        yield from stage.settle()
        stage.mouse.click(**session_module)
        stage.mouse.key("RET")
        yield from stage.until("the part is not held any more", lambda: stage.overlay_faces() is None)

    yield from click(x, y)
    yield from dark(stops[start], "1 a click")
    yield from click(x2, y2, shift=True)
    yield from dark(stops[start] | other_stops[begin], "2 with Shift")
    yield from click(x, y, ctrl=True)
    yield from dark(other_stops[begin], "3 with Ctrl")
    stage.mouse.key("Z", ctrl=True)
    yield from dark(stops[start] | other_stops[begin], "4 after Ctrl Z")
    hidden = numpy.empty(len(stage.object.data.polygons), bool)
    stage.object.data.polygons.foreach_get("hide", hidden)
    stage.check(not hidden.any(), "nothing is hidden")
    yield from click(*empty)
    yield from dark(frozenset(), "5 beside the model")

    yield from stroked(stage, x, y)
    stage.mouse.move(*empty)
    yield from stage.until("hover is beside the model", lambda: stage.hovered() is None)

    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        stage.object.modifiers.clear()
        bpy.ops.object.mode_set(mode="SCULPT")
        bpy.ops.sculpt.dynamic_topology_toggle()
    stage.use_tool()
    yield from stage.wait_for_redraw()
    stage.mouse.move(x, y)
    stage.mouse.click()
    yield from stage.settle()
    stage.check(stage.overlay_faces() is None and stage.hovered() is None, "with dynamic topology nothing is picked")
    yield from stage.screenshot("6-dynamic")
    with stage.override():
        bpy.ops.sculpt.dynamic_topology_toggle()
