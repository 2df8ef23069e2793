"""50,000 faces: the window goes on drawing while a worker builds, Esc ends that at once, a saved file opens ready. What
that costs is measured by the scenario latency."""
import os

import bpy


def alive(process):
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def play(stage):
    x, y, stops, start = yield from close_to(stage, "armadillo")
    stage.select([3])
    stage.mouse.move(x, y)
    gate = stage.hold_workers()
    stage.shortcut("mesh.partwheel_select")
    yield from stage.until("a build has begun", stage.has_builds)
    build, = stage.builds._builds.values()
    for _ in range(5):
        yield from stage.wait_for_redraw()
    stage.check(build.poll() is not None, "the window is drawn ten times while the build goes on")
    yield from stage.screenshot("building")
    process = build.job._process.pid
    stage.check(alive(process), "there is a worker, which does not listen")
    stage.mouse.key("ESC")
    yield from stage.settle()
    stage.check(not alive(process), "once Esc has been handled the worker is gone")
    stage.check(not stage.has_builds(), "the tool has ended")
    yield from stage.selected({3}, "after Esc")

    gate.open()
    stage.shortcut("mesh.partwheel_select")
    yield from stage.selected(stops[start], "once built")
    gate.remove()
    yield from stage.screenshot("built")
    stage.mouse.key("RET")
    yield from stage.settle()
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    for expected, path in (yield from saved(stage)).items():
        hierarchy = reopened(stage, path)
        stage.check((hierarchy is not None) == expected, "the parts are there if they were saved")
        stage.check(not stage.has_builds(), "nothing is built for that")
        yield from stage.settle()
        stage.check(not bpy.data.is_dirty, "a file just opened counts as saved")


def close_to(stage, name):
    """The model without its parts, seen from so close that a face is large enough to be clicked safely: (x, y, stops,
    start) of one."""
    yield from stage.open(name, build=False)
    stage.view_3d.view_perspective = "ORTHO"  # so that nothing is behind the eye
    stage.view_3d.view_distance /= 8
    yield from stage.wait_for_redraw()
    x, y, face = stage.spot(0.5, 0.5, above=1)
    return x, y, *stage.wheels.stops(face)


def saved(stage):
    """{whether with its parts: path of the file}"""
    addon = next(addon for addon in bpy.context.preferences.addons if "partwheel" in addon.module)
    paths = {}
    for expected in (True, False):
        addon.preferences.save_with_file = expected
        paths[expected] = str(stage.file(f"large-{expected}.blend"))
        bpy.ops.wm.save_as_mainfile(filepath=paths[expected])
        yield from stage.settle()
        stage.check(not bpy.data.is_dirty, "a file just saved counts as saved")
    stage.check(os.path.getsize(paths[True]) > os.path.getsize(paths[False]), "the parts are in the one that is larger")
    return paths


def reopened(stage, path):
    """Opens the file: the Hierarchy of its mesh, or None."""
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    return stage.registry.get_hierarchy(stage.snapshot(stage.object))
