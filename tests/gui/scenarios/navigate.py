"""Middle mouse (also with Shift and Ctrl) navigates while the operator runs; the wheel still selects afterwards."""


def play(stage):
    yield from stage.open("hand")
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    stage.shortcut("mesh.partwheel_select")
    yield from stage.selected(stops[start], "after the start")

    at = start
    for action, drag, modifiers in (("orbits", (80, 30), {}), ("pans", (40, -60), {"shift": True}),
                                  ("zooms", (0, -40), {"ctrl": True})):
        before = stage.view_state()
        stage.mouse.move(x, y)
        yield from stage.settle()
        yield from stage.drag("MIDDLEMOUSE", *drag, **modifiers)
        yield from stage.until(f"middle mouse {action}", lambda: stage.view_state() != before)
        if action == "zooms":
            stage.check(stage.view_state()[1] != before[1], "the distance has changed")
        stage.check(stage.selection() == stops[at], f"the selection is as it was while middle mouse {action}")
        moved = stage.view_state()
        at += 1 if at == start else -1
        stage.mouse.wheel(1 if at > start else -1)
        yield from stage.selected(stops[at], f"after a notch, after middle mouse {action}")
        stage.check(stage.view_state() == moved, "the wheel selects and does not zoom")
    yield from stage.screenshot("end")

    stage.mouse.key("RET")
    yield from stage.ended()
    yield from stage.selected(stops[at], "after Enter")
