"""A mesh with a hole is refused with a named error, even if it had a hierarchy before; the selection stays."""
import bmesh


def play(stage):
    yield from stage.open("hand")
    bm = bmesh.from_edit_mesh(stage.object.data)
    bm.faces.ensure_lookup_table()
    bmesh.ops.delete(bm, geom=[bm.faces[10]], context="FACES_ONLY")
    bmesh.update_edit_mesh(stage.object.data)
    stage.select([3])
    stage.check("(open)" not in stage.reports(), "no such error before")

    x, y, _ = stage.spot(0.5, 0.9)
    stage.mouse.move(x, y)
    stage.shortcut("mesh.partwheel_select")
    yield from stage.until("the error is reported", lambda: "(open)" in stage.reports())
    yield from stage.screenshot("error")
    stage.mouse.move(*stage.empty_spot())
    yield from stage.ended()
    yield from stage.selected({3}, "after the error")
