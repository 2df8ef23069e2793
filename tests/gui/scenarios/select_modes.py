"""In the vertex and edge select modes a part is its faces' vertices, or edges, and no others."""


def play(stage):
    for mode in ("VERT", "EDGE"):
        yield from stage.open("hand", mode)
        x, y, face = stage.spot(0.5, 0.9)
        stops, start = stage.wheels.stops(face)
        stage.mouse.move(x, y)
        stage.shortcut("mesh.partwheel_select")
        yield from is_selected(stage, mode, stops[start], "after the start")
        stage.mouse.wheel(2)
        yield from is_selected(stage, mode, stops[start + 2], "after two notches up")
        stage.mouse.wheel(-1)
        yield from is_selected(stage, mode, stops[start + 1], "after one notch down")
        yield from stage.screenshot(mode.lower())
        stage.mouse.key("RET")
        yield from stage.ended()
        yield from is_selected(stage, mode, stops[start + 1], "after Enter")


def is_selected(stage, mode, part, when):
    mesh = stage.object.data
    if mode == "VERT":
        vertices = {int(v) for face in part for v in stage.wheels.triangles[face]}
        yield from stage.selected(vertices, when, "verts")
    else:
        sides = {frozenset((int(a), int(b))) for face in part
                 for a, b in zip(stage.wheels.triangles[face], stage.wheels.triangles[face][[1, 2, 0]])}
        yield from stage.selected({edge.index for edge in mesh.edges if frozenset(edge.vertices) in sides}, when,
                                  "edges")
