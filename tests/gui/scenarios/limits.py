"""The wheel stops at the smallest part and the whole object; many notches at once all count; keys turn it too."""


def play(stage):
    yield from stage.open("hand")
    stage.part("mesh.selection").DESELECT_ALL_COST = 0  # as with large meshes, much is deselected at once
    _, stops, start = yield from stage.pick(0.5, 0.9)
    last = len(stops) - 1
    stage.mouse.wheel(last - start)
    yield from stage.selected(stops[last], "after as many notches as lead to the top")
    stage.check(stops[last] == frozenset(range(len(stage.wheels.triangles))), "the top is the whole object")
    stage.mouse.wheel(2)
    yield from stage.selected(stops[last], "after two notches beyond the top")
    stage.mouse.wheel(-1)
    yield from stage.selected(stops[last - 1], "one notch down from the top")
    stage.mouse.wheel(-last - 3)
    yield from stage.selected(stops[0], "after many notches down")
    stage.mouse.wheel(1)
    yield from stage.selected(stops[1], "one notch up from the bottom")
    for key, stop in (("PAGE_UP", 2), ("NUMPAD_PLUS", 3), ("PAGE_DOWN", 2), ("NUMPAD_MINUS", 1)):
        stage.mouse.key(key)
        yield from stage.selected(stops[stop], f"after {key}")
    stage.mouse.key("ESC")
    yield from stage.ended()
    yield from stage.selected(set(), "after Esc")
