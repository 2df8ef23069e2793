"""In the vertex and edge select modes a part is its faces' vertices, or edges, and no others."""


def play(stage):
    for mode in ("VERT", "EDGE"):
        yield from stage.open("hand", mode)
        x, y, face = stage.spot(0.5, 0.9, above=2)
        stops, start = stage.wheels.stops(face)
        stage.mouse.move(x, y)
        stage.shortcut("mesh.partwheel_select")
        yield from stage.selected(stops[start], "after the start")
        stage.mouse.wheel(2)
        yield from stage.selected(stops[start + 2], "after two notches up")
        stage.mouse.wheel(-1)
        yield from stage.selected(stops[start + 1], "after one notch down")
        yield from stage.screenshot(mode.lower())
        stage.mouse.key("RET")
        yield from stage.ended()
        yield from stage.selected(stops[start + 1], "after Enter")
