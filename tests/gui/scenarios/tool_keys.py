"""In the tool Blender's keys mean what they mean in Blender, while a part is held: 2 is for edges, G moves the part
alone, C selects by a circle, X opens Delete; the part's own commands are shown in the status bar."""
import bpy
import numpy


def play(stage):
    yield from stage.open("hand")
    stage.use_tool()
    spot = stage.spot(0.25, 0.84)
    settings = stage.window.scene.tool_settings
    before = stage.coordinates()

    stops, start = yield from stage.take(spot, "edges")
    part = stops[start + 1]
    stage.bar_fits((yield from stage.screenshot("0-held")))
    stage.mouse.key("TWO")
    yield from stage.until("2 is for edges", lambda: tuple(settings.mesh_select_mode) == (False, True, False))
    yield from stage.selected(part, "in that mode")
    yield from stage.ended()
    stage.mouse.key("THREE")
    yield from stage.until("3 is for faces", lambda: tuple(settings.mesh_select_mode) == (False, False, True))

    yield from stage.take(spot, "moved")
    stage.mouse.key("G")
    yield from stage.settle()
    stage.mouse.move(spot[0] - 20, spot[1] + 10)
    stage.mouse.move(spot[0] - 60, spot[1] + 30)
    yield from stage.until("G moves", lambda: (stage.coordinates() != before).any())
    stage.mouse.click()
    yield from stage.settle()
    moved = set(numpy.flatnonzero((stage.coordinates() != before).any(axis=1)).tolist())
    stage.check(moved == stage.elements(part, "verts"), f"all of the part, and no more ({len(moved)} vertices)")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step", lambda: (stage.coordinates() == before).all())

    stage.select(())
    yield from stage.take(spot, "the circle")
    stage.mouse.key("C")
    yield from stage.settle()
    stage.check(stage.object.mode == "EDIT" and len(bpy.data.objects) == 1, "C copies nothing")
    x, y, face = stage.spot(0.5, 0.1)
    stage.mouse.move(x, y)
    stage.mouse.click()
    yield from stage.until("C selects by a circle", lambda: face in stage.selection() and part <= stage.selection())
    stage.mouse.key("ESC")
    yield from stage.settle()

    stage.select(())
    yield from stage.take(spot, "deleted")
    stage.mouse.key("X")
    yield from stage.settle()
    stage.check(len(stage.coordinates()) == len(before), "X removes nothing by itself")
    yield from stage.screenshot("1-delete")
    stage.mouse.key("F")  # the menu's letter for Faces
    yield from stage.until("Blender's menu deletes the faces",
                           lambda: len(stage.coordinates()) < len(before) and not stage.selection())
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected(part, "after Ctrl Z")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected((), "after a second Ctrl Z")
