"""In Object Mode, Shift click adds a part: while its wheel turns both are shown, Esc goes back to the first as its wheel left
it, and Enter keeps both. What the next notch would add is tinted but for what is picked already: its color would hide that."""
import bpy
from scenarios.modes import hover


def play(stage):
    yield from stage.open("hand")
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.ed.undo_push(message="Object Mode")
    stage.use_tool()
    x, y, face = stage.spot(0.5, 0.9, above=2)
    x2, y2, other = stage.spot(0.1, 0.7, above=2)
    (stops, start), (other_stops, other_start) = stage.wheels.stops(face), stage.wheels.stops(other)
    first, second = stops[start + 1], other_stops[other_start]
    stage.check(not first >= second and not second >= first, "neither has the other")
    highlight, display = stage.part("pick.hover").highlight, stage.part("pick.display").pick_display

    def lit():
        return frozenset(highlight.target[2].tolist()) if highlight.is_showing(stage.object) else frozenset()

    def selected():
        return frozenset(polygon.index for polygon in stage.object.data.polygons if polygon.select)

    def add(last_key):
        yield from hover(stage, x, y)
        yield from stage.settle()
        stage.mouse.click()
        yield from stage.until("a click picks", lambda: stage.overlay_faces() == stops[start])
        stage.mouse.wheel(1)
        yield from stage.until("the wheel takes more", lambda: stage.overlay_faces() == first)
        yield from hover(stage, x2, y2)
        yield from stage.settle()
        stage.mouse.click(shift=True)
        yield from stage.until("Shift click picks another", lambda: stage.overlay_faces() == second)
        yield from stage.screenshot(f"{last_key}-added")
        stage.check(lit() | second == first | second, lambda: f"the first is shown too ({len(lit())} of {len(first)})")
        *_, added_to = display._target
        stage.check(frozenset(added_to.tolist()) == first, "the overlay knows what it is added to")
        stage.mouse.key(last_key)
        yield from stage.until("that ends it", lambda: stage.overlay_faces() is None)
        yield from stage.screenshot(f"{last_key}-ended")

    yield from add("ESC")
    stage.check(selected() == first, lambda: f"Esc keeps the first as it was ({len(selected())} of {len(first)})")
    stage.check(lit() == first, lambda: f"and shows it ({len(lit())} of {len(first)})")
    yield from add("RET")
    stage.check(selected() == lit() == first | second, "Enter keeps both, and shows them")
