"""Modifiers that are shown on the cage: what is seen there is picked, also after a modifier has changed."""
import math

import bpy
import numpy


def play(stage):
    yield from stage.open("hand")
    stage.use_tool()
    model, positions = stage.object, stage.wheels.vertices
    bend = model.modifiers.new("bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.deform_axis, bend.show_in_editmode = "BEND", "Y", True
    for angle, on_cage in ((1.2, True), (-1.0, True), (-1.0, False)):
        bend.angle, bend.show_on_cage = angle, on_cage
        yield from stage.wait_for_redraw()
        stage.wheels.vertices = shown(model) if on_cage else positions
        farthest = numpy.abs(stage.wheels.vertices - positions).max()
        stage.check(not on_cage or farthest > 0.05 * numpy.ptp(positions), "the modifier moves a good deal")
        place = "on the cage" if on_cage else "beside it"
        yield from take(stage, f"bent by {math.degrees(angle):.0f} degrees, {place}")
    model.modifiers.remove(bend)

    mirror = model.modifiers.new("mirror", "MIRROR")
    mirror.show_in_editmode = mirror.show_on_cage = True
    smooth = model.modifiers.new("smooth", "SUBSURF")
    smooth.show_in_editmode = smooth.show_on_cage = True
    yield from stage.wait_for_redraw()
    stage.wheels.vertices = shown(model)
    yield from take(stage, "mirrored and subdivided on the cage")


def shown(model):
    """(V,3) where the modifiers put the mesh's own vertices, which come first in their result."""
    mesh = model.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return numpy.array([vertex.co for vertex in mesh.vertices][:len(model.data.vertices)])


def take(stage, when):
    stops, start = yield from stage.take(stage.spot(0.5, 0.9, above=1), when, notches=0)
    cache = stage.part("pick.view_cache").get_view_cache(stage.snapshot(stage.object))
    stage.mouse.wheel(1)
    yield from stage.selected(stops[start + 1], f"after a notch ({when})")
    stage.check(stage.part("pick.view_cache").get_view_cache(stage.snapshot(stage.object)) is cache, f"a notch makes nothing anew ({when})")
    yield from stage.screenshot("-".join(when.replace(",", "").split()))
    stage.mouse.key("ESC")
    yield from stage.ended()
