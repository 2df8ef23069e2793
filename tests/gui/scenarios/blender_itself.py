"""Blender's own selecting and zooming without the add-on's: if this fails, it's the harness or the machine."""


def play(stage):
    yield from stage.open("hand")
    x, y, face = stage.spot(0.5, 0.5)
    stage.mouse.move(x, y)
    stage.mouse.click()
    yield from stage.selected({face}, "after Blender's own click")

    x, y, other = stage.spot(0.5, 0.3)
    stage.check(other != face, "another place shows another face")
    stage.mouse.move(x, y)
    stage.mouse.click(shift=True)
    yield from stage.selected({face, other}, "after Shift and click")

    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected({face}, "after Ctrl Z")

    stage.mouse.move(*stage.empty_spot())
    stage.mouse.click()
    yield from stage.selected(set(), "after a click on nothing")

    before = stage.view_3d.view_distance
    stage.mouse.wheel(3)
    yield from stage.until("the wheel zooms in", lambda: stage.view_3d.view_distance < before)
    yield from stage.screenshot("end")
