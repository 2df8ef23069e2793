"""Shift Ctrl P: the held part moves within its border, in proportion to the distance from it; Esc, then a click."""
import numpy

from scenarios.deform import inner


def play(stage):
    yield from stage.open("hand")
    before = stage.coordinates()
    for ending in ("ESC", "LEFTMOUSE"):
        _, stops, start = yield from stage.pick(0.05, 0.55, above=2)
        index = max(index for index, part in enumerate(stops) if len(part) < 0.4 * len(stage.wheels.triangles))
        stage.mouse.wheel(index - start)
        part = stops[index]
        yield from stage.selected(part, f"at stop {index}")
        x, y = stage.mouse.x, stage.mouse.y
        stage.mouse.key("P", shift=True, ctrl=True)
        yield from stage.settle()
        stage.mouse.move(x - 20, y + 10)
        stage.mouse.move(x - 60, y + 30)
        yield from stage.until("the part moves", lambda: (stage.coordinates() != before).any())
        if ending == "ESC":
            stage.mouse.key("ESC")
            yield from stage.until("Esc puts it back", lambda: (stage.coordinates() == before).all())
        else:
            yield from stage.screenshot("moving")
            stage.mouse.click()
        yield from stage.ended()
    moved = (stage.coordinates() != before).any(axis=1)
    free = inner(stage, part)
    stage.check(not numpy.delete(moved, free).any(), "nothing beyond the part has moved")
    stage.check(moved[free].mean() > 0.9, "the part has moved")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one Ctrl Z takes it back", lambda: (stage.coordinates() == before).all())

    # What can't be deformed is refused with a sentence, and stays selected.
    stage.select(())
    _, stops, start = yield from stage.pick(0.05, 0.55)
    stage.mouse.wheel(len(stops) - 1 - start)
    yield from stage.selected(stops[-1], "at the last stop")
    stage.mouse.key("P", shift=True, ctrl=True)
    yield from stage.until("why the whole mesh is not deformed is reported", lambda: "loose piece" in stage.reports())
    yield from stage.selected(stops[-1], "afterwards")
    stage.check((stage.coordinates() == before).all(), "nothing has moved")
