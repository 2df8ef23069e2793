"""How closely one looks says what a click means. Homer seen whole: his arm; his hand: the hand, or the finger that is clicked;
his finger: the finger."""
import numpy
from mathutils import Vector
from scenarios.knight import find_spot
from scenarios.modes import hover

FINGERTIP = 90
FILL = 0.4  # share of the viewport that what one looks at takes


def play(stage):
    yield from stage.open("homer")
    stage.part("preferences").preferences().use_view = True
    stage.use_tool()
    stops, _ = stage.wheels.stops(FINGERTIP)
    finger, hand, arm = stops[2:5]
    fingers = [part for face in sorted(hand) for part in stage.wheels.stops(face)[0] if 0.1 < len(part) / len(hand) < 0.2]
    palm = hand.difference(*fingers)
    yield from stage.screenshot("whole")
    for place in finger, palm:
        yield from click(stage, place, lambda part: part == arm, f"of the whole model, at {len(place)} faces")
    yield from look_at(stage, hand)
    yield from click(stage, palm, lambda part: palm <= part <= hand, "of the hand, at the palm")
    yield from click(stage, finger, lambda part: part in (finger, hand), "of the hand, at the finger")
    yield from look_at(stage, hand, 0.7)
    yield from click(stage, palm, lambda part: len(part) >= len(hand) / 2, "of the hand, which fills it, at the palm")
    yield from look_at(stage, finger)
    yield from click(stage, finger, lambda part: part == finger, "of the finger")


def look_at(stage, faces, fill=FILL):
    """Moves the view so that these faces take this share of it."""
    rows = sorted(faces)
    places = stage.wheels.vertices[stage.wheels.triangles[rows]].reshape(-1, 3)
    stage.view_3d.view_location = stage.object.matrix_world @ Vector((places.min(axis=0) + places.max(axis=0)) / 2)
    for _ in range(3):  # perspective
        yield from stage.wait_for_redraw()
        view = stage.view
        extent = numpy.ptp(view.centers()[rows], axis=0) / [view.region.width, view.region.height]
        stage.view_3d.view_distance *= extent.max() / fill
    yield from stage.wait_for_redraw()


def click(stage, place, is_right, what):
    """Hovers and clicks in the middle of some faces: both mean the same part, and the right one."""
    view = stage.view
    is_place = numpy.zeros(len(stage.wheels.triangles), bool)
    is_place[sorted(place)] = True
    yield from hover(stage, *find_spot(view, view.centers(), is_place))
    yield from stage.until("hovering shows a part", stage.hovered)
    previewed = stage.hovered()
    stage.mouse.click()
    yield from stage.until("something is selected", lambda: stage.selection())
    selected = frozenset(stage.selection())
    yield from stage.screenshot(what.replace(",", "").replace(" ", "-"))
    stage.check(is_right(selected), f"a click in a view {what} takes the right part, but {len(selected)} faces")
    stage.check(previewed == selected, f"hovering shows what a click takes, in a view {what}")
    stage.mouse.key("ESC")
    yield from stage.until("Esc clears", lambda: not stage.selection())
