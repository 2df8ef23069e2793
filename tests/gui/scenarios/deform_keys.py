"""The handle turned, scaled and moved by keys: Esc takes all of it back, bit for bit; typed numbers; one undo step."""
import numpy

from scenarios.deform import held


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
    yield from stage.settle()
    stage.mouse.key("RET")
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
