"""A mesh with a hole is mended in memory and picked from; what is left of it, a sheet, as a thin solid."""
import bmesh


def play(stage):
    yield from stage.open("hand")
    bm = bmesh.from_edit_mesh(stage.object.data)
    bm.faces.ensure_lookup_table()
    bmesh.ops.delete(bm, geom=[bm.faces[10]], context="FACES_ONLY")
    bmesh.update_edit_mesh(stage.object.data)
    stage.select([3])
    x, y, _ = stage.spot(0.5, 0.9)
    stage.mouse.move(x, y)
    stage.shortcut("mesh.partwheel_select")
    yield from stage.until("a part of several faces is selected", lambda: len(stage.selection()) > 1)
    stage.mouse.wheel(40)
    whole = len(stage.wheels.triangles) - 1
    yield from stage.until("the wheel reaches the whole", lambda: len(stage.selection()) == whole)
    yield from stage.screenshot("mended")
    stage.mouse.key("ESC")
    yield from stage.ended()
    yield from stage.selected({3}, "after Esc")

    bm = bmesh.from_edit_mesh(stage.object.data)
    bm.faces.ensure_lookup_table()
    middle = bm.faces[stage.spot(0.5, 0.9)[2]]  # under the mouse
    kept = {middle, *(face for edge in middle.edges for face in edge.link_faces)}
    bmesh.ops.delete(bm, geom=[face for face in bm.faces if face not in kept], context="FACES")
    bmesh.update_edit_mesh(stage.object.data)
    stage.select([])
    stage.shortcut("mesh.partwheel_select")
    yield from stage.until("a part of the sheet is selected", lambda: stage.selection())
    yield from stage.screenshot("sheet")
    stage.mouse.key("ESC")
    yield from stage.ended()
    yield from stage.selected(set(), "after Esc")
