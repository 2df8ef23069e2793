"""Several windows and 3D views: the tool works where the mouse is, shows its part in all; a closed window ends it
and takes back what was not confirmed."""
import bpy
from events import DRIVERS
from view import View


def play(stage):
    yield from stage.open("hand")
    model = stage.object
    with stage.override():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield from stage.wait_for_redraw()
    areas = [area for area in stage.window.screen.areas if area.type == "VIEW_3D"]
    stage.check(len(areas) == 2, "there are two 3D views")
    for area in areas:
        area.spaces.active.region_3d.view_distance *= 2
    other = max(areas, key=lambda area: area.x)
    yield from stage.wait_for_redraw()
    x, y, face = place(stage, other)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    stage.shortcut("mesh.partwheel_select")
    yield from stage.selected(stops[start], "after the start in the second view")
    distances = [area.spaces.active.region_3d.view_distance for area in areas]
    stage.mouse.wheel(1)
    yield from stage.selected(stops[start + 1], "after a notch there")
    x, y, _ = place(stage, min(areas, key=lambda area: area.x))
    stage.mouse.move(x, y)
    stage.mouse.wheel(-1)
    yield from stage.selected(stops[start], "after a notch over the first view")
    stage.check(distances == [area.spaces.active.region_3d.view_distance for area in areas], "neither has zoomed")
    yield from stage.screenshot("0-views")
    stage.mouse.key("RET")
    yield from stage.settle()
    stage.mouse.move(*place(stage, stage.area)[:2])
    yield from stage.ended()

    stage.select(())
    with stage.override():
        bpy.ops.wm.window_new()
    manager = bpy.data.window_managers[0]
    yield from stage.until("a second window is there", lambda: len(manager.windows) == 2)
    window = manager.windows[1]
    area = window.screen.areas[0]
    area.type = "VIEW_3D"
    region_3d, other_region_3d = area.spaces.active.region_3d, stage.view_3d
    region_3d.view_perspective, region_3d.view_rotation = "PERSP", other_region_3d.view_rotation
    region_3d.view_location, region_3d.view_distance = other_region_3d.view_location, other_region_3d.view_distance
    for _ in range(3):
        yield from stage.wait_for_redraw()
    mouse = DRIVERS["simulate"](window)
    for end in ("RET", "close"):
        stage.select(())
        x, y, face = place(stage, area)
        stops, start = stage.wheels.stops(face)
        mouse.move(x, y)
        mouse.key("W", shift=True, ctrl=True)
        yield from stage.selected(stops[start], "after the start in the second window")
        mouse.wheel(1)
        yield from stage.selected(stops[start + 1], "after a notch there")
        stage.check(stage.drawn_things() == 1, "the part is shown")
        if end == "RET":
            yield from stage.screenshot("1-windows")
            mouse.key("RET")
        else:
            with bpy.context.temp_override(window=window):
                bpy.ops.wm.window_close()
            yield from stage.until("the window is closed", lambda: len(manager.windows) == 1)
            yield from stage.selected((), "what was not confirmed is taken back")
        yield from stage.until(f"the tool is over ({end})", lambda: stage.drawn_things() == 0)
    stage.check(model.mode == "EDIT", "Edit Mode goes on")
    yield from stage.ended()


def place(stage, area):
    """A spot in this 3D view."""
    view = View(area, stage.object, stage.wheels.vertices, stage.wheels.triangles)
    low, high = view.centers().min(axis=0), view.centers().max(axis=0)
    return view.spot(*(low + (high - low) * [0.5, 0.9]), lambda face: len(stage.wheels.stops(face)[0]) >
                     stage.wheels.stops(face)[1] + 1)
