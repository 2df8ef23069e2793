"""While the parts are being built Blender goes on: the view turns, undo works, Edit Mode is left; then comes the pick.
"""
import bmesh


def play(stage):
    yield from stage.open("bear", build=False)
    session = stage.session

    def begin(place, above=1):
        """Starts the tool over a face: (face, stops, start)."""
        x, y, face = stage.spot(*place, above=above)
        stage.mouse.move(x, y)
        stage.shortcut("mesh.partwheel_select")
        yield from stage.until("a build has begun", session.running)
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
    stage.check(session.running(), "the build is still under way")
    yield from stage.screenshot("turned")
    yield from stage.selected(stops[start], "once built, though the view has turned and an undo has come between")
    stage.mouse.wheel(1)
    yield from stage.selected(stops[start + 1], "after a notch up")
    stage.mouse.key("ESC")
    yield from stage.ended()
    yield from stage.selected(earlier, "after Esc")

    yield from stage.open("bear", build=False)
    stage.select([3])
    yield from begin((0.5, 0.8))
    stage.mouse.key("ESC")
    yield from stage.until("Esc ends the build", lambda: not session.running())
    stage.check("Cancelled" in stage.reports(), "that is reported")
    stage.mouse.move(*stage.empty_spot())
    yield from stage.ended()
    yield from stage.selected({3}, "after Esc")

    yield from begin((0.5, 0.8))
    stage.mouse.key("TAB")
    yield from stage.until("Edit Mode is left", lambda: stage.object.mode == "OBJECT")
    yield from stage.until("the build ends", lambda: not session.running())
    stage.check(session.state(stage.object.data)[0] == session.State.FITS, "the parts are kept")
    stage.check("The parts are built" in stage.reports(), "that is reported")
    stage.mouse.key("TAB")
    yield from stage.until("Edit Mode is back", lambda: stage.object.mode == "EDIT")
    yield from stage.selected({3}, "after all that")

    yield from stage.open("bear", build=False)
    yield from begin((0.5, 0.8))
    bm = bmesh.from_edit_mesh(stage.object.data)
    bm.faces.ensure_lookup_table()
    bmesh.ops.poke(bm, faces=[bm.faces[0]])
    bmesh.update_edit_mesh(stage.object.data)
    yield from stage.until("a build for another mesh is left aside", lambda: not session.running())
    stage.check("was edited while" in stage.reports(), "that is reported")
    stage.check(session.hierarchy(stage.object) is None, "nothing is kept for a mesh that has changed")
