"""Other ways than the wheel: arrows, typed numbers, a trackpad's scroll, a drag up and down as with a pen."""

PIXELS = 30  # of a trackpad's scroll that make a notch
DRAG = 24  # of a drag
DIGITS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")


def play(stage):
    yield from stage.open("homer")
    stage.use_tool()
    x, y, face = stage.spot(0.95, 0.6, above=4)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    stage.mouse.click()
    yield from stage.selected(stops[start], "after the click")
    for key, stop in (("UP_ARROW", start + 1), ("UP_ARROW", start + 2), ("DOWN_ARROW", start + 1)):
        stage.mouse.key(key)
        yield from stage.selected(stops[stop], f"after {key}")
    view = stage.view_state()
    stage.mouse.scroll(2 * PIXELS + 5)
    yield from stage.selected(stops[start + 3], "after a scroll of two notches")
    stage.mouse.scroll(-PIXELS)
    yield from stage.selected(stops[start + 3], "a scroll's rest counts")
    stage.mouse.scroll(-PIXELS)
    yield from stage.selected(stops[start + 2], "after a scroll back")
    stage.check(stage.view_state() == view, "the view has not moved meanwhile")
    stage.mouse.key("RET")
    yield from stage.ended()

    stage.select(())
    _, many, _ = yield from stage.pick(0.27, 0.33, more_than=9)  # by its key, where digits are not Blender's
    two, few = len(many) // 10, len(many) % 10
    stage.mouse.key(DIGITS[two])
    yield from stage.selected(many[two - 1], "after the first digit")
    stage.mouse.key(DIGITS[few])
    yield from stage.selected(many[-1], "after the second, of the number of the last part")
    stage.mouse.key("BACK_SPACE")
    yield from stage.selected(many[two - 1], "with that digit taken back")
    stage.mouse.key("RET")
    yield from stage.ended()

    stage.select(())
    stage.mouse.move(x, y)
    stage.mouse.press("LEFTMOUSE")
    yield from stage.selected(stops[start], "as soon as the button is down")
    for notches in (1, 3, 2):
        stage.mouse.move(x + 5, y + notches * DRAG)
        yield from stage.selected(stops[start + notches], f"dragged up by {notches}")
    yield from stage.screenshot("dragged")
    stage.mouse.release("LEFTMOUSE")
    stage.mouse.move(x, y + 5 * DRAG)
    yield from stage.settle()
    yield from stage.selected(stops[start + 2], "with the button up again a move changes nothing")
    stage.mouse.key("ESC")
    yield from stage.ended()
    yield from stage.selected((), "after Esc")
