"""The toolbar's tool in Sculpt Mode, Weight Paint, Vertex Paint and Object Mode: hover, click, wheel, Shift, Ctrl, Enter
and Esc mean what they mean in Edit Mode; each pick is one undo step, and a click beside the model clears."""
import bpy


def play(stage):
    yield from stage.open("hand")
    for name, read, kind in (("OBJECT", chosen, "faces"), ("SCULPT", masked, "verts"),
                             ("VERTEX_PAINT", painted_on, "faces")):
        yield from in_mode(stage, name, read, kind)
    yield from weights(stage)
    yield from enter(stage, "SCULPT")
    yield from stroked(stage, *stage.spot(0.5, 0.9, above=2)[:2])


def stroked(stage, x, y):
    """Where a stroke has moved the surface it is looked at again, once."""
    revision = lambda mesh: stage.part("mesh.mesh_state").get_mesh_state(mesh).revision
    before = revision(stage.object.data)
    yield from stage.wait_for_redraw()
    stage.check(revision(stage.object.data) == before, "looking tells of no change")
    with stage.override():
        bpy.ops.wm.tool_set_by_id(name="builtin.brush" if bpy.app.version >= (4, 3) else "builtin_brush.Draw")
    stage.mouse.move(x, y)
    stage.mouse.press("LEFTMOUSE")
    for step in range(5):
        stage.mouse.move(x + 8 * step, y)
        yield from stage.settle()
    stage.mouse.release("LEFTMOUSE")
    yield from stage.until("a stroke does", lambda: revision(stage.object.data) != before)
    yield from stage.settle()
    before = revision(stage.object.data)
    stage.use_tool()
    yield from hover(stage, x, y)
    yield from stage.until("hover shows a part", lambda: stage.hovered() is not None)
    yield from stage.screenshot("stroked")
    stage.check(revision(stage.object.data) == before, "looking again does not")


def enter(stage, name):
    with stage.override():
        bpy.ops.object.mode_set(mode=name)
        bpy.ops.ed.undo_push(message=name)
    stage.use_tool()
    yield from stage.wait_for_redraw()


def hover(stage, x, y):
    """Twice: the first time what is needed is made, as soon as Blender is ready for it."""
    for aside in (6, 3):
        stage.mouse.move(x - aside, y)
        yield from stage.settle()
    stage.mouse.move(x, y)


def in_mode(stage, name, read, kind):
    """read(stage): what has become of the parts so far, as elements of this kind."""
    yield from enter(stage, name)
    x, y, face = stage.spot(0.5, 0.9, above=2)
    x2, y2, other = stage.spot(0.1, 0.7, above=2)
    stops, start = stage.wheels.stops(face)
    other_stops, begin = stage.wheels.stops(other)

    first, larger, second = (stage.elements(faces, kind) for faces in (stops[start], stops[start + 1], other_stops[begin]))

    def becomes(expected, when):
        yield from stage.until(lambda: f"{name}: {when} ({len(read(stage))} of {len(expected)} {kind})",
                               lambda: read(stage) == frozenset(expected))
        stage.check(stage.object.mode == name, f"{name} goes on")

    def click(x, y, **session_module):
        stage.mouse.move(x - 3, y)
        stage.mouse.move(x, y)
        yield from stage.settle()
        stage.mouse.click(**session_module)
        yield from stage.settle()

    def shown(faces, when):
        yield from stage.until(f"{name}: the part is shown {when}", lambda: stage.overlay_faces() == frozenset(faces))

    yield from hover(stage, x, y)
    yield from stage.until(f"{name}: hover shows the part of a click", lambda: stage.hovered() == stops[start])
    yield from stage.screenshot(f"{name}-0-hover")
    before = read(stage)
    stage.mouse.click()
    yield from shown(stops[start], "after a click")
    stage.mouse.wheel(1)
    yield from shown(stops[start + 1], "after a notch")
    yield from stage.screenshot(f"{name}-1-held")
    stage.mouse.key("ESC")
    yield from becomes(before, "Esc restores")
    stage.check(stage.overlay_faces() is None, f"{name}: Esc ends it")

    yield from click(x, y)
    stage.mouse.wheel(1)
    yield from shown(stops[start + 1], "after a notch")
    stage.mouse.key("RET")
    yield from becomes(larger, "Enter takes the part")
    yield from click(x2, y2, shift=True)
    yield from shown(other_stops[begin], "after a click with Shift")
    yield from stage.screenshot(f"{name}-2-shift")
    stage.mouse.key("RET")
    yield from becomes(larger | second, "Shift adds")
    yield from stage.screenshot(f"{name}-3-two")
    yield from click(x, y, ctrl=True)
    stage.mouse.key("RET")
    yield from becomes((larger | second) - first, "Ctrl takes away")
    stage.mouse.key("Z", ctrl=True)
    yield from becomes(larger | second, "one Ctrl Z")
    stage.mouse.key("Z", ctrl=True)
    yield from becomes(larger, "two")
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from becomes(larger | second, "Shift Ctrl Z")
    yield from click(*stage.empty_spot())
    yield from becomes((), "a click beside the model")
    stage.mouse.key("Z", ctrl=True)
    yield from becomes(larger | second, "which is one undo step")
    yield from stage.screenshot(f"{name}-4-undone")


def masked(stage):
    with stage.override():
        bpy.ops.ed.flush_edits()
    mesh = stage.object.data
    if bpy.app.version >= (4, 1):
        layer = mesh.attributes.get(".sculpt_mask")
    else:
        layer = next(iter(mesh.vertex_paint_masks), None)
    values = [weight.value for weight in layer.data] if layer else [0] * len(mesh.vertices)
    return frozenset(index for index, value in enumerate(values) if value == 1)


def chosen(stage):
    return frozenset(face.index for face in stage.object.data.polygons if face.select)


def painted_on(stage):
    return chosen(stage) if stage.object.data.use_paint_mask else frozenset()


def weights(stage):
    """Each click makes a vertex group of its own; Shift adds to it, Ctrl takes away."""
    yield from enter(stage, "WEIGHT_PAINT")
    x, y, face = stage.spot(0.5, 0.9, above=2)
    stops, start = stage.wheels.stops(face)
    yield from hover(stage, x, y)
    yield from stage.until("hover shows the part of a click", lambda: stage.hovered() == stops[start])
    yield from stage.screenshot("WEIGHT-0-hover")

    def groups():
        return [frozenset(v.index for v in stage.object.data.vertices for group in v.groups
                          if group.group == index and group.weight == 1) for index in range(len(stage.object.vertex_groups))]

    stage.mouse.click()
    stage.mouse.wheel(1)
    yield from stage.until("the part is shown", lambda: stage.overlay_faces() == stops[start + 1])
    yield from stage.screenshot("WEIGHT-1-held")
    stage.mouse.key("RET")
    hand = stage.elements(stops[start + 1], "verts")
    yield from stage.until("it is a group", lambda: groups() == [hand])
    yield from stage.screenshot("WEIGHT-2-group")
    x, y, face = stage.spot(0.1, 0.7)
    other_stops, begin = stage.wheels.stops(face)
    other = stage.elements(other_stops[begin], "verts")
    stage.mouse.move(x, y)
    stage.mouse.click(shift=True)
    stage.mouse.key("RET")
    yield from stage.until("Shift adds to it", lambda: groups() == [hand | other])
    stage.mouse.click(ctrl=True)
    stage.mouse.key("RET")
    yield from stage.until("Ctrl takes away from it", lambda: groups() == [hand - other])
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one Ctrl Z", lambda: groups() == [hand | other])
