"""In the quad view the part is picked in the quarter that the mouse is over."""
import bpy


def play(stage):
    yield from stage.open("hand")
    with stage.override():
        bpy.ops.screen.region_quadview()
    yield from stage.drawn()
    picked = set()
    for quarter, place in ((0, (0.5, 0.9)), (3, (0.1, 0.6))):
        x, y, face = stage.spot(*place, quarter=quarter)
        stops, start = stage.wheels.stops(face)
        stage.mouse.move(x, y)
        stage.shortcut("mesh.partwheel_select")
        yield from stage.selected(stops[start], f"after the start in quarter {quarter}")
        stage.mouse.key("RET")
        yield from stage.settle()
        yield from stage.screenshot(f"{quarter}")
        picked.add(stops[start])
    stage.check(len(picked) == 2, "the two parts differ")
