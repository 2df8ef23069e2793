"""While the parts are being built Blender goes on: the view turns, undo works, Edit Mode is left, another mesh is picked
from; then comes the pick. Workers are held at their beginning until all that has happened.
"""
import bmesh
import bpy

from scenarios.wheel_at_click import counted


def play(stage):
    gate = stage.hold_workers()
    yield from stage.open("bear", build=False)

    def begin(place, above=1):
        """Starts the tool over a face: (face, stops, start)."""
        x, y, face = stage.spot(*place, above=above)
        stage.mouse.move(x, y)
        stage.shortcut("mesh.partwheel_select")
        yield from stage.until("a build has begun", stage.has_builds)
        return face, *stage.wheels.stops(face)

    stage.select([3])
    earlier = stage.selection()
    stage.select([700, 5])
    _, stops, start = yield from begin((0.5, 0.8))
    before = stage.view_state()
    stage.mouse.key("Z", ctrl=True)
    stage.mouse.key("NUMPAD_3")
    yield from stage.until("the view turns", lambda: stage.view_state() != before)
    yield from stage.until("the selection is undone", lambda: stage.selection() == earlier)
    stage.check(stage.has_builds(), "the build is still under way")
    yield from stage.screenshot("turned")
    gate.open()
    yield from stage.selected(stops[start], "once built, though the view has turned and an undo has come between")
    stage.mouse.wheel(1)
    yield from stage.selected(stops[start + 1], "after a notch up")
    stage.mouse.key("ESC")
    yield from stage.ended()
    yield from stage.selected(earlier, "after Esc")
    gate.close()

    yield from stage.open("bear", build=False)
    stage.select([3])
    yield from begin((0.5, 0.8))
    stage.mouse.key("ESC")
    yield from stage.until("Esc ends the build", lambda: not stage.has_builds())
    stage.check("Canceled" in stage.reports(), "that is reported")
    stage.mouse.move(*stage.empty_spot())
    yield from stage.ended()
    yield from stage.selected({3}, "after Esc")

    yield from begin((0.5, 0.8))
    stage.mouse.key("TAB")
    yield from stage.until("Edit Mode is left", lambda: stage.object.mode == "OBJECT")
    gate.open()
    yield from stage.until("the build ends", lambda: not stage.has_builds())
    stage.check(stage.registry.get_state(stage.object.data)[0] == stage.registry.State.FITS, "the parts are kept")
    stage.check("The parts are found" in stage.reports(), "that is reported")
    stage.mouse.key("TAB")
    yield from stage.until("Edit Mode is back", lambda: stage.object.mode == "EDIT")
    yield from stage.selected({3}, "after all that")
    gate.close()

    yield from stage.open("bear", build=False)
    yield from begin((0.5, 0.8))
    bm = bmesh.from_edit_mesh(stage.object.data)
    bm.faces.ensure_lookup_table()
    bmesh.ops.poke(bm, faces=[bm.faces[0]])
    bmesh.update_edit_mesh(stage.object.data)
    gate.open()
    yield from stage.until("a build for another mesh is left aside", lambda: not stage.has_builds())
    stage.check("was edited while" in stage.reports(), "that is reported")
    stage.check(stage.registry.get_hierarchy(stage.snapshot(stage.object)) is None, "nothing is kept for a mesh that has changed")

    yield from escape_and_the_answer_at_once(stage, gate, begin)
    yield from another_mesh(stage, gate)
    yield from press_while_preparing(stage, gate)
    gate.remove()


def escape_and_the_answer_at_once(stage, gate, begin):
    """Esc is pressed when the parts are found, but Blender has not had the time to ask the worker: Esc wins."""
    gate.close()
    yield from stage.open("bear", build=False)
    stage.select([3])
    yield from begin((0.5, 0.8))
    build, = stage.builds._builds.values()
    gate.open()
    while not build.job.wait(1):  # Blender itself is held up
        pass
    stage.mouse.key("ESC")
    yield from stage.settle()
    stage.check(not stage.has_builds(), "nothing is being built")
    yield from stage.selected({3}, "after Esc and the answer, whichever was first")
    yield from stage.ended()


def another_mesh(stage, gate):
    """A click of the tool picks from a mesh that has its parts, and is not Blender's own select."""
    yield from stage.open("hand")
    gate.close()
    model = stage.object
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.mesh.primitive_torus_add(location=(100, 0, 0))
        torus = stage.object
        bpy.ops.mesh.partwheel_build("INVOKE_DEFAULT")
        stage.window.view_layer.objects.active = model
        bpy.ops.object.mode_set(mode="EDIT")
    yield from stage.until("a build has begun", stage.has_builds)
    stage.use_tool()
    stops, start = yield from stage.take(stage.spot(0.5, 0.9, above=1), "while another mesh's parts are being found")
    gate.open()
    yield from stage.until("these are found", lambda: not stage.has_builds())
    stage.check(stage.registry.find_hierarchy(torus.data) is not None, "the parts are kept")
    yield from stage.selected(stops[start + 1], "the pick is as it was")
    stage.mouse.wheel(-1)
    yield from stage.selected(stops[start], "and goes on")
    stage.mouse.key("RET")
    yield from stage.ended()


def press_while_preparing(stage, gate):
    """A click or key that ends the preparation of a mesh goes to the build that starts then: Esc cancels it; a click is
    Blender's own, starts no other build, and the part is still the one under the mouse at the start."""
    with stage.override():
        bpy.ops.wm.tool_set_by_id(name="builtin.select_box")
    events, requests = hold_preparation(stage), counted(stage.part("pick.build"), "BuildMonitor")
    for press in ("click", "ESC"):
        gate.close()
        yield from stage.open("bear", build=False)
        x, y, face = stage.spot(0.5, 0.8, above=1)
        stops, start = stage.wheels.stops(face)
        other_x, other_y, other = stage.spot(0.5, 0.2)
        requests.clear()
        stage.mouse.move(x, y)
        events.clear()
        stage.shortcut("mesh.partwheel_select")
        yield from stage.until("the mesh is being prepared", lambda: "TIMER" in events)
        stage.check(not stage.has_builds(), "no build has started")
        if press == "ESC":
            stage.mouse.key("ESC")
            yield from stage.until("Esc is seen", lambda: "ESC" in events)
            yield from stage.settle()
            stage.check(not stage.has_builds(), "Esc ends the build that it started")
            yield from stage.selected((), "after Esc")
        else:
            stage.mouse.move(other_x, other_y)
            stage.mouse.click()
            yield from stage.selected({other}, "the click is Blender's own")
            gate.open()
            yield from stage.selected(stops[start], "of the face under the mouse at the start")
            stage.mouse.key("ESC")
            yield from stage.selected({other}, "after Esc")
        yield from stage.ended()
        stage.check(len(requests) == 1, lambda: f"one build is requested ({press}: {len(requests)})")


def hold_preparation(stage):
    """Operators prepare meshes only when a key or button is pressed. Returns a list of the events' types meanwhile."""
    pick, events = stage.part("pick.pick"), []
    on_preparing, prepare_next_slice = pick.PartPicker._on_preparing, pick.prepare_next_slice

    def watched(self, context, event):
        events.append(event.type)
        return on_preparing(self, context, event)

    pick.PartPicker._on_preparing = watched
    pick.prepare_next_slice = lambda objects: not {"LEFTMOUSE", "ESC"} & set(events) or prepare_next_slice(objects)
    return events
