"""In Object Mode a part is picked with nothing changed, and Enter, Tab or any command enters Edit Mode with it;
Sculpt Mode makes a face set of one, Weight Paint a vertex group."""
import bpy


def play(stage):
    yield from stage.open("hand")
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)

    def mode(name):
        with stage.override():
            bpy.ops.object.mode_set(mode=name)

    def started(operator, **arguments):
        with stage.override():
            operator("INVOKE_DEFAULT", **arguments)

    stage.mouse.move(x, y)
    stage.mouse.key("TAB")
    yield from stage.until("Object Mode is there", lambda: stage.object.mode == "OBJECT")
    yield from stage.wait_for_redraw()
    before = faces_selected(stage)
    for end in ("ESC", "RIGHTMOUSE"):
        started(bpy.ops.object.partwheel_select)
        yield from stage.until("the part is shown in Object Mode", lambda: stage.drawn_things() == 1)
        stage.mouse.wheel(1)
        yield from stage.settle()
        stage.check(shown_faces(stage) == set(stops[start + 1]), "what is shown is the part after a notch")
        stage.check(stage.object.mode == "OBJECT" and faces_selected(stage) == before, "nothing has changed")
        yield from stage.screenshot("object")
        stage.mouse.key(end)
        yield from stage.until(f"{end} ends it", lambda: stage.drawn_things() == 0)
        stage.check(stage.object.mode == "OBJECT" and faces_selected(stage) == before, f"after {end} neither")
    for end in ("RET", "TAB"):
        started(bpy.ops.object.partwheel_select)
        yield from stage.until("the part is shown once more", lambda: stage.drawn_things() == 1)
        stage.mouse.wheel(1)
        yield from stage.settle()
        stage.mouse.key(end)
        yield from stage.until("Edit Mode is entered", lambda: stage.object.mode == "EDIT")
        yield from stage.selected(stops[start + 1], f"by {end}")
        yield from stage.ended()
        if end == "RET":
            stage.mouse.key("Z", ctrl=True)
            yield from stage.selected((), "after one Ctrl Z, still in Edit Mode")
            stage.mouse.key("Z", ctrl=True)
            yield from stage.until("a second leaves Edit Mode", lambda: stage.object.mode == "OBJECT")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected((), "after one Ctrl Z, still in Edit Mode")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("a second leaves Edit Mode", lambda: stage.object.mode == "OBJECT")

    mode("SCULPT")
    yield from stage.wait_for_redraw()
    started(bpy.ops.mesh.partwheel_paint, write="FACE_SET")
    yield from stage.until("the part is shown", lambda: stage.drawn_things() == 1)
    stage.mouse.wheel(1)
    yield from stage.settle()
    yield from stage.screenshot("sculpt")
    stage.mouse.key("RET")
    yield from stage.until("Enter ends it", lambda: stage.drawn_things() == 0)
    sets = [value.value for value in stage.object.data.attributes[".sculpt_face_set"].data]
    first = min(stops[start + 1])
    stage.check({index for index, value in enumerate(sets) if value == sets[first]} == set(stops[start + 1]),
                "exactly the part is a face set")
    stage.check(stage.object.mode == "SCULPT", "Sculpt Mode goes on")
    yield from stage.screenshot("face-set")
    started(bpy.ops.mesh.partwheel_paint, write="MASK")
    yield from stage.until("the part is shown again", lambda: stage.drawn_things() == 1)
    stage.mouse.key("ESC")
    yield from stage.until("Esc ends it", lambda: stage.drawn_things() == 0)

    mode("WEIGHT_PAINT")
    yield from stage.wait_for_redraw()
    started(bpy.ops.mesh.partwheel_paint)
    yield from stage.until("the part is shown in Weight Paint", lambda: stage.drawn_things() == 1)
    stage.mouse.click()
    yield from stage.until("a click confirms", lambda: stage.drawn_things() == 0)
    painted = {vertex.index for vertex in stage.object.data.vertices for group in vertex.groups if group.weight == 1}
    stage.check(painted == stage.elements(stops[start], "verts"), "exactly the part has the weight")
    yield from stage.screenshot("weights")
    started(bpy.ops.mesh.partwheel_paint, write="PAINT_MASK")
    yield from stage.until("the part is shown once more", lambda: stage.drawn_things() == 1)
    stage.mouse.key("RET")
    yield from stage.until("Enter confirms", lambda: stage.drawn_things() == 0)
    mesh = stage.object.data
    stage.check(mesh.use_paint_mask, "the paint mask is on")
    stage.check({face.index for face in mesh.polygons if face.select} == set(stops[start]), "it is exactly the part")


def shown_faces(stage):
    """Those of the part that the overlay draws."""
    _, parts, node, *_ = stage.part("view.overlay").pick_overlay._target
    return set(parts.hierarchy.faces(node).tolist())


def faces_selected(stage):
    """Outside Edit Mode."""
    return [polygon.select for polygon in stage.object.data.polygons]
