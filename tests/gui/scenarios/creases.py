"""Borders in creases: Shift Ctrl E snaps that of the held part and back, the tool goes on so, and copies are made
so."""
import bpy
import numpy


def play(stage):
    yield from stage.open("homer")
    model, package, arrays = stage.object, stage.package(), stage.part("mesh.arrays")
    creases = package.Creases(*arrays.read_surface(arrays.update_mesh(model)))

    def snapped(faces):
        inside = numpy.zeros(len(stage.wheels.triangles), bool)
        inside[list(faces)] = True
        return frozenset(numpy.flatnonzero(creases.snap(inside)).tolist())

    stage.use_tool()
    tool = bpy.context.workspace.tools.from_space_view3d_mode("EDIT_MESH")
    stops, start = yield from stage.take(stage.spot(0.95, 0.6, above=3), "its own border", notches=2)
    stage.check(snapped(stops[start + 2]) != stops[start + 2], "snapping changes this part")
    yield from stage.screenshot("0-own")
    stage.mouse.key("E", shift=True, ctrl=True)
    yield from stage.selected(snapped(stops[start + 2]), "after Shift Ctrl E")
    stage.check(tool.operator_properties("mesh.partwheel_select").snap, "the header of the tool says so")
    yield from stage.screenshot("1-snapped")
    stage.mouse.wheel(1)
    yield from stage.selected(snapped(stops[start + 3]), "after one more notch")
    stage.mouse.wheel(-1)
    stage.mouse.key("RET")
    yield from stage.selected(snapped(stops[start + 2]), "after Enter")
    yield from stage.ended()

    x, y, face = stage.spot(0.6, 0.05, above=2)
    other_stops, begin = stage.wheels.stops(face)
    stage.mouse.move(x - 3, y)
    stage.mouse.move(x, y)
    yield from stage.until("hover shows the snapped part", lambda: stage.part("pick.hover").hover.target is not None and
                           frozenset(stage.part("pick.hover").hover.target[3].tolist()) == snapped(other_stops[begin]))
    stage.mouse.click(shift=True)
    both = snapped(stops[start + 2]) | snapped(other_stops[begin])
    yield from stage.selected(both, "the next click is snapped too")
    stage.mouse.key("E", shift=True, ctrl=True)
    yield from stage.selected(snapped(stops[start + 2]) | other_stops[begin], "after Shift Ctrl E again")
    stage.check(not tool.operator_properties("mesh.partwheel_select").snap, "the header of the tool says so")
    stage.mouse.key("C", shift=True, ctrl=True)
    yield from stage.until("there is a copy", lambda: len(bpy.data.objects) == 2)
    yield from stage.until("Object Mode is there", lambda: bpy.context.mode == "OBJECT")
    copy = next(copy for copy in bpy.data.objects if copy != model)
    stage.check("partwheel_cap" in copy.data.attributes, "it is closed by caps")
    yield from stage.screenshot("2-copied")
    yield from stage.settle()

