"""In the vertex and edge select modes a part is its faces' vertices, or edges, and no others."""


def play(stage):
    for mode in ("VERT", "EDGE"):
        yield from stage.open("hand", mode)
        _, stops, start = yield from stage.pick(0.5, 0.9, above=2)
        stage.mouse.wheel(2)
        yield from stage.selected(stops[start + 2], "after two notches up")
        stage.mouse.wheel(-1)
        yield from stage.selected(stops[start + 1], "after one notch down")
        yield from stage.screenshot(mode.lower())
        stage.mouse.key("RET")
        yield from stage.ended()
        yield from stage.selected(stops[start + 1], "after Enter")
