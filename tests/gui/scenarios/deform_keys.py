"""The handle turned, scaled and moved by keys: Esc takes all of it back, bit for bit; typed numbers; one undo step; Shift
moves it finely."""
import numpy

from scenarios.deform import confirmed, held


def play(stage):
    yield from stage.open("dino")
    # Esc, in the middle of a drag that turned and scaled too, takes all of it back, bit for bit.
    part, before = yield from held(stage, 0.16, 0.36, 700)
    x, y = stage.mouse.x, stage.mouse.y
    stage.mouse.key("R")
    yield from stage.settle()
    stage.mouse.move(x + 60, y + 40)
    yield from stage.until("R turns it", lambda: (stage.coordinates() != before).any())
    stage.mouse.key("RET")
    yield from stage.settle()
    stage.mouse.key("S")
    for key in ("TWO", "PERIOD", "FIVE"):
        stage.mouse.key(key)
    yield from stage.settle()
    turned = stage.coordinates()
    stage.mouse.wheel(2)
    yield from stage.settle()
    yield from stage.screenshot("scaled")
    stage.mouse.key("G")
    yield from stage.settle()
    stage.mouse.move(x - 40, y)
    yield from stage.until("G moves it", lambda: (stage.coordinates() != turned).any())
    stage.mouse.key("ESC")
    yield from stage.until("Esc puts it back", lambda: (stage.coordinates() == before).all())
    yield from stage.ended()
    stage.check((stage.coordinates() == before).all(), "and so it stays")

    # Typed numbers, along an axis: one undo step.
    part, before = yield from held(stage, 0.16, 0.36, 700)
    stage.mouse.key("G")
    stage.mouse.key("Z")
    for key in ("ZERO", "PERIOD", "THREE"):
        stage.mouse.key(key)
    yield from stage.until("the number moves it", lambda: (stage.coordinates() != before).any())
    stage.mouse.key("RET")
    yield from confirmed(stage)
    yield from stage.ended()
    after = stage.coordinates()
    matrix = numpy.array(stage.object.matrix_world)[:3, :3]
    shift = (after - before) @ matrix.T
    farthest = shift[numpy.linalg.norm(shift, axis=1).argmax()]
    stage.check(numpy.abs(farthest - [0, 0, 0.3]).max() < 0.02, f"the handle went 0.3 along Z ({farthest})")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one Ctrl Z takes it back", lambda: (stage.coordinates() == before).all())
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.until("Shift Ctrl Z does it again", lambda: (stage.coordinates() == after).all())

    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("undone once more", lambda: (stage.coordinates() == before).all())

    # Shift Z: in the plane across Z; Z twice: along the object's own. P ends it and finds the parts of the new shape.
    part, before = yield from held(stage, 0.16, 0.36, 700)
    x, y = stage.mouse.x, stage.mouse.y
    stage.mouse.key("G")
    stage.mouse.key("Z", shift=True)
    stage.mouse.move(x + 30, y + 20)
    yield from stage.until("it follows", lambda: (stage.coordinates() != before).any())
    stage.mouse.move(x + 60, y + 40)
    yield from stage.settle()
    stage.mouse.key("RET")
    yield from stage.settle()
    shift = (stage.coordinates() - before) @ matrix.T
    farthest = shift[numpy.linalg.norm(shift, axis=1).argmax()]
    length = numpy.linalg.norm(farthest)
    stage.check(abs(farthest[2]) < 0.05 * length > 0, f"the handle stayed in the plane ({farthest})")
    stage.mouse.key("ESC")
    yield from stage.until("Esc puts it back", lambda: (stage.coordinates() == before).all())
    yield from stage.ended()

    # Shift, held on the way: a tenth of it, and no jump where it is let go.
    directions = []
    for fine in (False, True):
        part, before = yield from held(stage, 0.16, 0.36, 700)
        x, y = stage.mouse.x, stage.mouse.y
        stage.mouse.key("G")
        stage.mouse.move(x + 20, y, shift=fine)
        stage.mouse.move(x + 60, y, shift=fine)
        stage.mouse.move(x + 60, y)
        yield from stage.until("it follows", lambda: (stage.coordinates() != before).any())
        yield from stage.settle()
        stage.mouse.key("RET")
        yield from stage.settle()
        directions.append(numpy.linalg.norm(stage.coordinates() - before, axis=1).max())
        stage.mouse.key("ESC")
        yield from stage.until("Esc puts it back", lambda: (stage.coordinates() == before).all())
        yield from stage.ended()
    stage.check(abs(directions[1] / directions[0] - 0.1) < 0.01, f"Shift makes a tenth of the way ({directions})")
    part, before = yield from held(stage, 0.16, 0.36, 700)
    for key in ("G", "Z", "Z", "ONE"):
        stage.mouse.key(key)
    yield from stage.until("the number moves it", lambda: (stage.coordinates() != before).any())
    stage.mouse.key("RET")
    yield from stage.settle()
    old = stage.registry.find_hierarchy(stage.object.data)
    stage.mouse.key("P")
    yield from stage.until("the parts are found anew",
                           lambda: stage.registry.find_hierarchy(stage.object.data) is not old)
    yield from stage.ended()
    shift = stage.coordinates() - before
    farthest = shift[numpy.linalg.norm(shift, axis=1).argmax()]
    axis = farthest / numpy.linalg.norm(farthest)
    stage.check(numpy.abs(axis - [0, 0, 1]).max() < 0.05, f"along the object's own Z ({axis})")
