"""The industry compatible keymap: the key, the tool and the wheel work, Alt and the mouse buttons navigate."""
import pathlib

import bpy


def play(stage):
    preset = next(path for folder in bpy.utils.preset_paths("keyconfig")
                  for path in pathlib.Path(folder).glob("Industry_Compatible.py"))
    bpy.ops.preferences.keyconfig_activate(filepath=str(preset))
    yield from stage.open("hand")
    for name, keymap in bpy.data.window_managers[0].keyconfigs.user.keymaps.items():
        other_keys = [item.idname for item in keymap.keymap_items if item.type == "W" and item.ctrl and item.shift
                  and not item.alt and item.active and not item.idname.startswith("mesh.partwheel")]
        stage.check(not other_keys or name not in {"Mesh", "3D View", "Window", "Screen", "3D View Generic"},
                    f"Shift Ctrl W is free in {name}: {other_keys}")

    face, stops, start = yield from stage.pick(0.5, 0.9, above=2)
    at, x, y = start, stage.mouse.x, stage.mouse.y
    for action, button, drag in (("orbits", "LEFTMOUSE", (80, 30)), ("pans", "MIDDLEMOUSE", (40, -60)),
                               ("zooms", "RIGHTMOUSE", (30, -40))):
        before = stage.view_state()
        stage.mouse.move(x, y)
        yield from stage.settle()
        yield from stage.drag(button, *drag, alt=True)
        yield from stage.until(f"Alt and {button} {action}", lambda: stage.view_state() != before)
        stage.check(stage.selection() == stops[at], f"the selection is as it was while Alt and {button} {action}")
        moved, at = stage.view_state(), start + 1 if at == start else start
        stage.mouse.wheel(1 if at > start else -1)
        yield from stage.selected(stops[at], f"after a notch, after Alt and {button}")
        stage.check(stage.view_state() == moved, "the wheel selects and does not zoom")
    stage.bar_fits((yield from stage.screenshot("held")))
    stage.mouse.click("RIGHTMOUSE")
    yield from stage.selected((), "after right click")
    yield from stage.ended()

    yield from stage.open("hand")
    stage.use_tool()
    yield from stage.take(stage.spot(0.5, 0.9, above=2), "by the tool", 2)
    stage.mouse.key("RET")
    yield from stage.ended()
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected((), "after Ctrl Z")
