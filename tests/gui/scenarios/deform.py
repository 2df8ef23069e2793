"""The story of the paper's Figure 7: a click, the wheel, a drag of the handle, for nose, tail, head and legs."""
import bpy
import numpy

# What is dragged: where it is as shares of the model's extent, how many faces its part has at least, how far it goes as
# shares of the viewport's height.
STORY = [("nose", 0.02, 0.93, 300, -0.05, 0.10), ("tail", 0.95, 0.36, 300, -0.02, 0.15),
         ("head", 0.30, 0.99, 650, 0.08, 0.05), ("leg", 0.40, 0.01, 600, -0.10, 0.08)]


def inner(stage, part):
    """The vertices all of whose faces are in a part: what may move."""
    triangles = stage.wheels.triangles
    inside = numpy.zeros(len(triangles), bool)
    inside[list(part)] = True
    return numpy.setdiff1d(triangles[inside], triangles[~inside])


def held(stage, x, y, faces):
    """Picks a part of at least so many faces by click and wheel, and hands it on to the handle drag: (part, its first
    coordinates)."""
    _, stops, start = yield from stage.pick(x, y)
    index = next(index for index, part in enumerate(stops) if len(part) >= faces)
    stage.mouse.wheel(index - start)
    yield from stage.selected(stops[index], f"at stop {index}")
    before = stage.coordinates()
    stage.mouse.key("D", shift=True, ctrl=True)
    yield from stage.settle()
    return stops[index], before


def confirmed(stage):
    """Enter, and what is still to be done in the background."""
    stage.mouse.key("RET")
    bar = bpy.types.STATUSBAR_HT_header
    yield from stage.until("Deform has ended", lambda: bar.draw == getattr(bar, "_draw_orig", bar.draw))


def play(stage):
    yield from stage.open("dino")
    height = stage.view.region.height
    first = stage.coordinates()
    yield from stage.screenshot("0-before")
    allowed = numpy.zeros(len(first), bool)
    for number, (name, x, y, faces, dx, dy) in enumerate(STORY, 1):
        part, before = yield from held(stage, x, y, faces)
        free = inner(stage, part)
        allowed[free] = True
        yield from stage.drag("LEFTMOUSE", round(dx * height), round(dy * height))
        yield from stage.until(f"the {name} follows the mouse",
                               lambda: (stage.coordinates() != before)[free].any(axis=1).mean() > 0.9)
        yield from stage.screenshot(f"{number}-{name}")
        yield from confirmed(stage)
        after = stage.coordinates()
        moved = (after != before).any(axis=1)
        stage.check(not numpy.delete(moved, free).any(), f"nothing but the {name} has moved")
        stage.check(numpy.linalg.norm(after - before, axis=1).max() > 0.02, f"the {name} has moved far")
    stage.check((stage.coordinates() == first)[~allowed].all(), "nothing outside the parts has moved")
    stage.check(stage.registry.get_state(stage.object.data)[0].name == "MOVED", "the parts are still there, moved")
    yield from stage.ended()
