"""In the quad view the part is picked in the quarter that the mouse is over."""
import bpy


def play(stage):
    yield from stage.open("hand")
    with stage.override():
        bpy.ops.screen.region_quadview()
    yield from stage.wait_for_redraw()
    first = stage.spot(0.5, 0.9, quarter=0)
    other_spots = (stage.spot(x, 0.6, quarter=3) for x in (0.1, 0.3, 0.5, 0.7, 0.9))
    second = next(other for other in other_spots if part(stage, other) != part(stage, first))
    for quarter, spot in ((0, first), (3, second)):
        stage.mouse.move(*spot[:2])
        stage.shortcut("mesh.partwheel_select")
        yield from stage.selected(part(stage, spot), f"after the start in quarter {quarter}")
        stage.mouse.key("RET")
        yield from stage.settle()
        yield from stage.screenshot(f"{quarter}")


def part(stage, spot):
    """What a click there takes."""
    stops, start = stage.wheels.stops(spot[2])
    return stops[start]
