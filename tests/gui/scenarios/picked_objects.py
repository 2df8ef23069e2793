"""What is done with a part in Object Mode starts from the one that the tool highlights: Copy takes it, after undo the one
before; Parts to... begins with it; Tab has it selected; beside the model nothing is picked. Of two objects the one that
was clicked becomes active."""
import bpy
from scenarios.modes import hover


def play(stage):
    yield from stage.open("hand")
    model = stage.object
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.mesh.primitive_cube_add(size=0.2, location=(0, 0, 9))  # another object, active by now
        bpy.ops.ed.undo_push(message="Cube")
    stage.use_tool()
    cube = stage.object
    stage.window.view_layer.objects.active = model
    x, y, face = stage.spot(0.5, 0.9, above=2)
    x2, y2, other = stage.spot(0.1, 0.7, above=2)
    stage.window.view_layer.objects.active = cube
    stops, start = stage.wheels.stops(face)
    other_stops, begin = stage.wheels.stops(other)
    picks, highlight = stage.part("parts.picks"), stage.part("pick.hover").highlight
    model = lambda: bpy.data.objects["hand"]

    def click(x, y):
        yield from hover(stage, x, y)
        yield from stage.settle()
        stage.mouse.click()
        stage.mouse.key("RET")
        yield from stage.settle()

    def lit(faces, when):
        yield from stage.until(f"{when}, the part is highlighted",
                               lambda: highlight.is_showing(model()) and set(highlight.target[2].tolist()) == set(faces))

    yield from click(x, y)
    yield from lit(stops[start], "after a click")
    stage.check(stage.object == model() and model().select_get(), "the object is the active one")
    yield from stage.screenshot("0-picked")
    yield from click(x2, y2)
    yield from lit(other_stops[begin], "after a second click")
    node = picks.get_pick(stage.snapshot(model())).node
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("Ctrl Z goes back", lambda: picks.get_pick(stage.snapshot(model())).face == face)
    yield from hover(stage, x, y)
    yield from lit(stops[start], "after Ctrl Z")
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.until("and Shift Ctrl Z on", lambda: picks.get_pick(stage.snapshot(model())).node == node)
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("and back", lambda: picks.get_pick(stage.snapshot(model())).face == face)
    yield from hover(stage, x, y)
    yield from lit(stops[start], "after all that")

    stage.mouse.move(x, y)
    with stage.override():
        bpy.ops.mesh.partwheel_parts("INVOKE_DEFAULT")
    yield from stage.screenshot("1-parts-to")
    stage.bar_fits((yield from stage.screenshot("1-parts-to")))
    stage.mouse.key("ESC")
    yield from stage.settle()
    yield from hover(stage, x, y)
    yield from lit(stops[start], "after Parts to... and Esc")

    before = set(bpy.data.objects.keys())
    with stage.override():
        bpy.ops.mesh.partwheel_copy(snap=False)
        bpy.ops.ed.undo_push(message="Copy")
    new = set(bpy.data.objects.keys()) - before
    solid = bpy.data.objects[new.pop()].data
    mesh = model().data
    corners = {tuple(round(c, 4) for c in mesh.vertices[v].co) for f in stops[start] for v in mesh.polygons[f].vertices}
    places = {tuple(round(c, 4) for c in vertex.co) for vertex in solid.vertices}
    stage.check(corners <= places and len(places) < 1.6 * len(corners),
                f"Copy takes what is highlighted ({len(corners - places)} of {len(corners)} missing, {len(places)})")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step", lambda: set(bpy.data.objects.keys()) == before)

    stage.mouse.move(x, y)
    stage.mouse.key("TAB")
    yield from stage.until("Edit Mode is entered", lambda: stage.object.mode == "EDIT")
    yield from stage.selected(stops[start], "in Edit Mode")
    stage.mouse.key("TAB")
    yield from stage.until("Object Mode is there", lambda: stage.object.mode == "OBJECT")
    yield from click(*stage.empty_spot())
    yield from stage.until("beside it nothing is picked", lambda: picks.get_pick(stage.snapshot(model())) is None)
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("which is an undo step", lambda: picks.get_pick(stage.snapshot(model())).face == face)
