"""Half a minute with the tool, in the pictures that scripts/tour puts together: hover, click, wheel, Shift."""

ARM, FOOT = (0.95, 0.6), (0.6, 0.05)


def play(stage):
    yield from stage.open("figure")
    stage.use_tool()
    x, y, face = stage.spot(*ARM, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x - 3, y)
    stage.mouse.move(x, y)
    yield from stage.until("hover shows the part of a click", lambda: stage.hovered() == stops[start])
    yield from stage.screenshot("0-point")
    stage.mouse.click()
    yield from stage.selected(stops[start], "after the click")
    yield from stage.screenshot("1-click")
    stage.mouse.wheel(-2)
    yield from stage.selected(stops[start - 2], "after two notches down")
    yield from stage.screenshot("2-wheel")
    x, y, face = stage.spot(*FOOT, above=1)
    other_stops, begin = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    stage.mouse.click(shift=True)
    yield from stage.selected(stops[start - 2] | other_stops[begin], "after a click with Shift")
    yield from stage.screenshot("3-shift")
    stage.mouse.key("RET")
    yield from stage.ended()
