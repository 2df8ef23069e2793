"""The main job: a part is picked, grown and shrunk with the wheel, confirmed with a click, undone, redone."""
from view import picture


def play(stage):
    yield from stage.open("homer")
    _, _, foot = stage.spot(0.6, 0.05)
    stage.select({foot})

    x, y, face = stage.spot(0.95, 0.6, above=3)  # at Homer's left hand
    stops, start = stage.wheels.stops(face)
    view = stage.view_state()
    stage.mouse.move(x, y)
    stage.shortcut("mesh.partwheel_select")
    yield from stage.selected(stops[start], "after the start")
    yield from stage.screenshot("0-start")
    for notch in (1, 2, 3):
        stage.mouse.wheel(1)
        yield from stage.selected(stops[start + notch], f"after notch {notch} up")
    yield from stage.screenshot("1-three-up")
    for notch in (1, 2):
        stage.mouse.wheel(-1)
        yield from stage.selected(stops[start + 3 - notch], f"after notch {notch} down")
    part = stops[start + 1]
    stage.check(stage.view_state() == view, "the wheel has not zoomed meanwhile")
    path = yield from stage.screenshot("2-two-down")
    check_picture(stage, picture(path), part, stops[start + 2])

    stage.mouse.click()
    yield from stage.ended()
    yield from stage.selected(part, "after the click that confirms")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected({foot}, "after one Ctrl Z")
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.selected(part, "after one Shift Ctrl Z")


def check_picture(stage, pixels, part, larger):
    """The selected faces that can be seen are drawn in the color of a selection, the others are not. (What the next
    notch would add has a tint of its own.)"""
    view = stage.view

    def redness(faces):
        faces = sorted(faces)
        centers = view.visible_centers(faces[::len(faces) // 200 + 1]).round().astype(int)
        stage.check(len(centers) > 30, "enough faces can be seen")
        colors = pixels[centers[:, 1], centers[:, 0]]
        return (colors[:, 0] - colors[:, 2]).mean()

    rest = set(range(len(stage.wheels.triangles))) - larger
    stage.check(redness(part) > 0.15, "the part is shown as selected")
    stage.check(abs(redness(rest)) < 0.05, "nothing else is shown as selected")
