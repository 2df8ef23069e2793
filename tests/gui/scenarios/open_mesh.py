"""A mesh with a hole is mended in memory and picked from; one without area is refused by name, even if it had parts before."""
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
    kept = bm.faces[0]
    bmesh.ops.delete(bm, geom=[face for face in bm.faces if face != kept], context="FACES")
    line = kept.verts[0].co.copy()
    for number, vertex in enumerate(kept.verts):
        vertex.co = line + number * 0.01 * stage.object.matrix_world.inverted().to_3x3().col[0]
    bmesh.update_edit_mesh(stage.object.data)
    stage.select([0])
    stage.check("no area" not in stage.reports(), "no such error before")
    stage.shortcut("mesh.partwheel_select")
    yield from stage.until("the error is reported", lambda: "no area" in stage.reports())
    yield from stage.screenshot("error")
    stage.mouse.key("ESC")  # it is shown until then
    stage.mouse.move(*stage.empty_spot())
    yield from stage.ended()
    yield from stage.selected({0}, "after the error")
