"""One click on a finger, then notch by notch to the whole body: the story of the paper's Figure 6, in pictures."""


def play(stage):
    yield from stage.open("homer")
    _, stops, start = yield from stage.pick(0.97, 0.62)
    finger = next(index for index, part in enumerate(stops) if len(part) >= 0.004 * len(stage.wheels.triangles))
    stage.mouse.wheel(finger - start)
    for index in range(finger, len(stops)):
        yield from stage.selected(stops[index], f"at stop {index}")
        yield from stage.screenshot(f"{index - finger}-{len(stops[index])}-faces")
        stage.mouse.wheel(1)
    stage.mouse.key("RET")
    yield from stage.ended()
    yield from stage.selected(stops[-1], "after Enter")
