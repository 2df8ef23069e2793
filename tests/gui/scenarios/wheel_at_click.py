"""After a click with the tool the wheel is ours while the mouse is where it clicked, and zooms elsewhere; no Enter is
needed. With the preference it is ours until Enter. Two buttons beside the click do without a wheel. Right after an edit
a click makes what it needs slice by slice, and nothing that follows is lost."""
import bmesh

STEP = 44, 18  # from the click to the middle of the button for larger parts


def play(stage):
    yield from stage.open("homer")
    stage.use_tool()
    settings = stage.part("preferences").preferences()
    x, y, face = stage.spot(0.95, 0.6, above=4)
    stops, start = stage.wheels.stops(face)
    yield from stage.take((x, y, face), "at the click", 2)
    distance = stage.view_3d.view_distance
    stage.mouse.move(x + 12, y - 12)
    stage.mouse.wheel(-1)
    yield from stage.selected(stops[start + 1], "after a notch of a hand that shook")
    stage.check(stage.view_3d.view_distance == distance, "which does not zoom")
    yield from stage.screenshot("0-at-click")

    stage.mouse.move(x - 150, y - 60)
    yield from stage.screenshot("1-elsewhere")
    stage.mouse.wheel(2)
    yield from stage.until("elsewhere it zooms", lambda: stage.view_3d.view_distance < distance)
    yield from stage.selected(stops[start + 1], "and leaves the part alone")
    zoomed = stage.view_3d.view_distance
    stage.mouse.move(x, y)
    stage.mouse.wheel(-1)
    yield from stage.until("in another view it zooms there too", lambda: stage.view_3d.view_distance > zoomed)
    stage.mouse.key("PAGE_UP")
    yield from stage.selected(stops[start + 2], "keys go on with the part")
    view = stage.view_state()
    stage.mouse.scroll(65)
    yield from stage.until("a trackpad's scroll moves the view", lambda: stage.view_state() != view)
    yield from stage.selected(stops[start + 2], "and leaves the part alone")
    stage.mouse.move(x - 100, y)
    stage.mouse.key("RET")
    yield from stage.ended()
    yield from stage.selected(stops[start + 2], "after Enter")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected((), "after one Ctrl Z")

    settings.show_steps = True
    x, y, face = stage.spot(0.95, 0.6, above=4)
    stops, start = stage.wheels.stops(face)
    yield from stage.take((x, y, face), "with buttons", 0)
    yield from stage.screenshot("2-buttons")
    for sign, index in ((1, start + 1), (1, start + 2), (-1, start + 1)):
        stage.mouse.move(x + STEP[0], y + sign * STEP[1])
        stage.mouse.click()
        yield from stage.selected(stops[index], f"after a click on a button ({sign})")
    stage.mouse.key("ESC")
    yield from stage.selected((), "after Esc")
    yield from stage.ended()
    settings.show_steps = False

    settings.wheel = "HELD"
    x, y, face = stage.spot(0.95, 0.6, above=4)
    stops, start = stage.wheels.stops(face)
    yield from stage.take((x, y, face), "held", 0)
    distance = stage.view_3d.view_distance
    stage.mouse.move(x - 150, y - 60)
    stage.mouse.wheel(1)
    yield from stage.selected(stops[start + 1], "elsewhere, with the preference")
    stage.check(stage.view_3d.view_distance == distance, "which does not zoom")
    stage.mouse.key("RET")
    yield from stage.ended()
    settings.wheel = "NEAR"
    yield from after_an_edit(stage)


def after_an_edit(stage):
    stage.select(())
    x, y, face = stage.spot(0.95, 0.6, above=4)
    stops, start = stage.wheels.stops(face)
    slices = counted(stage.part("pick.pick").PartPicker, "_on_preparing")
    stage.mouse.move(x, y)
    yield from stage.until("the mouse rests over a part", lambda: stage.hovered() is not None)
    for notches, then in ((0, ()), (2, ()), (1, ("UP_ARROW",)), (0, ("ESC",))):
        slices.clear()
        bmesh.update_edit_mesh(stage.object.data)
        stage.mouse.click()
        for notch in range(notches):
            stage.mouse.wheel(1)
        for key in then:
            stage.mouse.key(key)
        yield from stage.until("it is made meanwhile", lambda: slices)
        if "ESC" not in then:
            yield from stage.selected(stops[start + notches + len(then)], f"after an edit, {notches} notches and {then}")
            stage.mouse.key("ESC")
        yield from stage.selected((), "after Esc")
        yield from stage.ended()


def counted(owner, name):
    """A list that grows with every call."""
    calls, inner = [], getattr(owner, name)

    def call(*arguments):
        calls.append(name)
        return inner(*arguments)

    setattr(owner, name, call)
    return calls
