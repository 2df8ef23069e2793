"""The part's own commands: after Copy and Remove by their keys there is the panel of the last operation, with Snap
Border; adjusting it does the operation anew, and one undo step takes it back. By the tool, and by the modal
operator."""
import bpy


def opened(stage, name):
    """A picture with that panel opened by a click; it stays so."""
    region = next(region for region in stage.area.regions if region.type == "HUD")
    yield from stage.until("the panel is drawn", lambda: region.height > 1)
    if region.height < 60:
        stage.mouse.move(region.x + 15, region.y + region.height // 2)
        stage.mouse.click()
        yield from stage.until("it is open", lambda: region.height > 60)
    yield from stage.screenshot(name)


def held(stage, by_tool):
    if by_tool:
        stage.use_tool()
        yield from stage.take(stage.spot(0.95, 0.6, above=3), "to be used", notches=2)
    else:
        yield from stage.pick(0.95, 0.6, above=3)
        stage.mouse.wheel(2)
        yield from stage.settle()


def play(stage):
    yield from stage.open("homer")
    yield from held(stage, by_tool=True)
    part = stage.selection()
    stage.mouse.key("C", shift=True, ctrl=True)
    yield from stage.until("there is a copy", lambda: len(bpy.data.objects) == 2)
    yield from stage.settle()
    stage.check(stage.last.bl_idname == "MESH_OT_partwheel_copy" and hasattr(stage.last.properties, "snap"),
                "there is its panel")
    yield from opened(stage, "copied")
    snapped = len(stage.object.data.polygons)
    yield from stage.adjusted(snap=not stage.last.properties.snap)
    stage.check(len(bpy.data.objects) == 2 and stage.object.name == "homer part", "there is still one copy")
    n_faces = len(stage.object.data.polygons)
    stage.check(n_faces != snapped, f"its border is another ({n_faces} faces, {snapped} with it snapped)")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step takes the copy away, and is back in Edit Mode",
                           lambda: len(bpy.data.objects) == 1 and stage.object.mode == "EDIT")
    yield from stage.selected(part, "there")

    yield from stage.open("homer")
    yield from held(stage, by_tool=False)
    whole = len(stage.coordinates())
    stage.mouse.key("X", shift=True, ctrl=True)
    yield from stage.until("the part is gone", lambda: len(stage.coordinates()) < whole)
    yield from stage.settle()
    stage.check(stage.last.bl_idname == "MESH_OT_partwheel_remove" and hasattr(stage.last.properties, "snap"),
                "there is its panel")
    yield from opened(stage, "removed")
    snapped = len(stage.coordinates())
    yield from stage.adjusted(snap=not stage.last.properties.snap)
    stage.check(stage.object.mode == "EDIT" and len(stage.coordinates()) not in (whole, snapped),
                f"adjusted, its border is another ({len(stage.coordinates())} vertices left, {snapped})")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step brings it back", lambda: len(stage.coordinates()) == whole)
