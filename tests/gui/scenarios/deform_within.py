"""Shift G while a part is held: it moves within its border, in proportion to the distance from it; Esc, then a click."""
import numpy

from scenarios.deform import inner


def play(stage):
    yield from stage.open("hand")
    before = stage.coordinates()
    for way in ("ESC", "LEFTMOUSE"):
        _, stops, start = yield from stage.pick(0.05, 0.55, above=2)
        stage.mouse.wheel(2)
        part = stops[start + 2]
        yield from stage.selected(part, "after two notches")
        x, y = stage.mouse.x, stage.mouse.y
        stage.mouse.key("G", shift=True)
        yield from stage.settle()
        stage.mouse.move(x - 20, y + 10)
        stage.mouse.move(x - 60, y + 30)
        yield from stage.until("the part moves", lambda: (stage.coordinates() != before).any())
        if way == "ESC":
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
