"""The entry at the end of the Select menu starts the operator."""
import bpy


def play(stage):
    yield from stage.open("hand")
    x, y, face = stage.spot(0.5, 0.5, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    yield from stage.settle()
    with stage.override():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_select_edit_mesh")
    yield from stage.settle()
    stage.mouse.key("END")
    yield from stage.screenshot("open")
    stage.mouse.key("RET")
    yield from stage.selected(stops[start], "after the menu's last entry")
    stage.mouse.wheel(1)
    yield from stage.selected(stops[start + 1], "after a notch up")
    stage.mouse.key("RET")
    yield from stage.ended()
    yield from stage.selected(stops[start + 1], "after Enter")
