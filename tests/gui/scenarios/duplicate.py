"""Shift D hands the part on to Blender's duplicate: a copy of the part, selected, that moves with the mouse."""
import numpy


def play(stage):
    yield from stage.open("hand")
    x, y, face = stage.spot(0.05, 0.55)
    stops, start = stage.wheels.stops(face)
    part = stops[start]
    before = stage.coordinates()
    faces = len(stage.wheels.triangles)

    stage.mouse.move(x, y)
    stage.shortcut("mesh.partwheel_select")
    yield from stage.selected(part, "after the start")
    stage.mouse.key("D", shift=True)
    yield from stage.settle()
    stage.mouse.move(x - 20, y + 10)
    stage.mouse.move(x - 120, y + 30)
    copy = frozenset(range(faces, faces + len(part)))
    yield from stage.until("the copy is selected", lambda: stage.selection() == copy)
    stage.mouse.click()
    yield from stage.ended()
    yield from stage.screenshot("end")

    moved = stage.coordinates()
    stage.check((moved[:len(before)] == before).all(), "the original is where it was")
    stage.check(len(moved) == len(before) + len(stage.elements(part, "verts")), "the copy has the part's vertices")
    inside = numpy.array(sorted(stage.elements(part, "verts")))
    shift = moved[len(before):].mean(axis=0) - before[inside].mean(axis=0)
    stage.check(numpy.linalg.norm(shift) > 0.01, "the copy has moved")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected(part, "after Ctrl Z")
    stage.check(len(stage.coordinates()) == len(before), "the copy is gone")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected((), "after a second Ctrl Z")
