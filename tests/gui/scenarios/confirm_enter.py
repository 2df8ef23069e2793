"""Enter and the numpad's Enter confirm, each as one undo step. The first use builds the hierarchy."""


def play(stage):
    yield from stage.open("hand", build=False)
    parts = [frozenset()]
    for key, place in (("RET", (0.5, 0.9)), ("NUMPAD_ENTER", (0.05, 0.55))):
        _, stops, start = yield from stage.pick(*place, above=1)
        stage.mouse.wheel(1)
        yield from stage.selected(stops[start + 1], "after a notch up")
        stage.mouse.key(key)
        yield from stage.ended()
        yield from stage.selected(stops[start + 1], f"after {key}")
        parts.append(stops[start + 1])
    stage.check(parts[1] != parts[2], "the two parts differ")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected(parts[1], "after one Ctrl Z")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected(parts[0], "after two Ctrl Z")
