"""Adjust Last Operation: another level after confirming replaces the part, still as one undo step."""


def play(stage):
    yield from stage.open("hand")
    stage.part("mesh.selection").DESELECT_ALL_COST = 0  # as with large meshes, much is deselected at once
    stage.select([3])
    face, stops, start = yield from stage.pick(0.5, 0.9, above=2)
    stage.mouse.wheel(1)
    stage.mouse.key("RET")
    yield from stage.selected(stops[start + 1], "after a notch up and Enter")

    for level in (2, -1):
        last = stage.last
        stage.check(last.bl_idname == "MESH_OT_partwheel_select" and last.properties.face_index == face,
                    "the last operation is the pick of that face")
        yield from stage.adjusted(level=level)
        yield from stage.selected(stops[start + level], f"with level {level}")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected({3}, "after one Ctrl Z")
