"""Shift Ctrl J while a part is held: a leg turns at its joint and keeps its shape, what is near the joint bends; the
wheel makes the joint larger; Esc while all is being made ready, and later; typed numbers; one undo step; "Recompute"
one key away."""
import numpy

from scenarios.deform import confirmed, inner


def held(stage):
    _, stops, start = yield from stage.pick(0.40, 0.01, above=2)
    index = next(index for index, part in enumerate(stops) if len(part) >= 1000)
    stage.mouse.wheel(index - start)
    yield from stage.selected(stops[index], f"at stop {index}")
    before = stage.coordinates()
    stage.mouse.key("J", shift=True, ctrl=True)
    return stops[index], before


def edges(triangles):
    return numpy.unique(numpy.sort(numpy.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])),
                        axis=0)


def play(stage):
    yield from stage.open("dino")
    # Esc right behind the key, before anything can be ready.
    part, before = yield from held(stage)
    stage.mouse.key("ESC")
    yield from stage.ended()
    stage.check((stage.coordinates() == before).all(), "Esc at once changes nothing")

    # A drag turns it about the joint; the wheel makes the joint larger; Esc takes it back.
    part, before = yield from held(stage)
    yield from stage.drag("LEFTMOUSE", 60, 40)
    yield from stage.until("the leg turns", lambda: (stage.coordinates() != before).any())
    moved = (stage.coordinates() != before).any(axis=1).sum()
    stage.mouse.wheel(3)
    yield from stage.until("a larger joint moves more", lambda: (
        stage.coordinates() != before).any(axis=1).sum() > moved)
    stage.mouse.key("ESC")
    yield from stage.until("Esc puts it back", lambda: (stage.coordinates() == before).all())
    yield from stage.ended()
    stage.check((stage.coordinates() == before).all(), "and so it stays")

    # 40 degrees by number, confirmed at once.
    part, before = yield from held(stage)
    stage.mouse.key("R")
    stage.mouse.key("X")
    for key in ("FOUR", "ZERO"):
        stage.mouse.key(key)
    stage.mouse.key("RET")
    yield from confirmed(stage)
    yield from stage.ended()
    yield from stage.screenshot("turned")
    after = stage.coordinates()
    triangles = stage.wheels.triangles
    free = numpy.array(inner(stage, part))
    lines = edges(triangles)
    change = numpy.abs(numpy.linalg.norm(after[lines[:, 0]] - after[lines[:, 1]], axis=1)
                       / numpy.linalg.norm(before[lines[:, 0]] - before[lines[:, 1]], axis=1) - 1)
    within = numpy.isin(lines, free).all(axis=1)
    stage.check((change[within] < 1e-4).mean() > 0.3, f"the leg keeps its shape ({(change[within] < 1e-4).mean()})")
    stage.check(change.max() > 0.02, f"the joint bends ({change.max()})")
    stage.check(numpy.linalg.norm(after - before, axis=1)[free].max() > 0.05, "the leg went along")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one Ctrl Z takes it back", lambda: (stage.coordinates() == before).all())
