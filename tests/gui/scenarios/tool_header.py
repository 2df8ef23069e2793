"""The tool's header says that the parts are still to be found; not any longer once they are, in the background or by a click."""
import bpy
import numpy

from scenarios.modes import hover
from view import picture


def play(stage):
    for is_clicked in (False, True):
        yield from stage.open("hand", build=False)
        with stage.override():
            bpy.ops.object.mode_set(mode="OBJECT")
            bpy.ops.ed.undo_push(message="Object Mode")
        stage.use_tool()
        x, y, _ = stage.spot(0.5, 0.9, above=2)
        yield from hover(stage, x, y)
        yield from stage.screenshot("before")
        before = header(stage)
        if is_clicked:
            stage.mouse.click()
            yield from stage.until("a click picks", lambda: stage.overlay_faces() is not None)
            stage.mouse.key("RET")
        else:
            with stage.override():
                bpy.ops.mesh.partwheel_build("INVOKE_DEFAULT")
        yield from stage.until("the parts are found", lambda: not stage.has_builds() and stage.registry.find_hierarchy(
            stage.object.data))
        yield from stage.settle()
        after = header(stage)
        stage.check((after != before).any(), "the header has changed at once")
        yield from stage.wait_for_redraw()
        stage.check((header(stage) == after).all(), "drawing it once more changes nothing")
        if not is_clicked:
            with stage.override():
                bpy.ops.mesh.partwheel_clear()
            yield from stage.settle()
            stage.check((header(stage) == before).all(), "without parts it says so again")


def header(stage):
    """The pixels of the tool's header on the screen, without drawing it."""
    region = next(region for region in stage.area.regions if region.type == "TOOL_HEADER")
    pixels = picture(stage._picture("header"))
    return numpy.round(pixels[region.y:region.y + region.height, region.x:region.x + region.width // 2], 2)
