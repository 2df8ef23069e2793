"""Esc and right click restore the selection exactly as it was, in every select mode, and leave no undo step."""


def play(stage):
    yield from once(stage, "FACE", "ESC")
    yield from once(stage, "FACE", "RIGHTMOUSE")
    yield from once(stage, "VERT", "ESC")
    yield from once(stage, "EDGE", "RIGHTMOUSE")


def once(stage, mode, ending):
    yield from stage.open("hand", mode)
    kind = stage.kind()
    stage.select([3], kind)
    earlier = stage.whole_selection()
    stage.select([700, 5], kind)
    former = stage.whole_selection()
    stage.check(former != earlier and former["active"] is not None, "there is a selection with an active element")

    _, stops, start = yield from stage.pick(0.5, 0.9, above=2)
    stage.mouse.wheel(2)
    yield from stage.selected(stops[start + 2], "after two notches up")
    if ending == "ESC":
        stage.mouse.key(ending)
    else:
        stage.mouse.click(ending)
    yield from stage.until(lambda: f"{ending} restores {former} ({mode}, now {stage.whole_selection()})",
                           lambda: stage.whole_selection() == former)
    yield from stage.ended()
    stage.check(stage.whole_selection() == former, f"the selection stays as it was after {ending} ({mode})")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until(f"one Ctrl Z after {ending} undoes what was before ({mode})",
                           lambda: stage.whole_selection() == earlier)
