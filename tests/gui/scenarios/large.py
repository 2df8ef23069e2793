"""200,000 faces: the window goes on drawing while a worker builds, Esc ends that at once, a saved file opens ready."""
import os
import time

import bpy

AT_ONCE = 0.5  # seconds from Esc to the worker's end
REOPENING = 0.3  # seconds that opening may take more with the parts than without, these being ready
LONG = 150  # seconds that anything with so many faces may take on a machine under load


def alive(process):
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def play(stage):
    yield from stage.open("large", build=False)
    session = stage.session
    # Close, or no face would be large enough to be clicked safely; and so that nothing is behind the eye.
    stage.view_3d.view_perspective = "ORTHO"
    stage.view_3d.view_distance /= 8
    yield from stage.drawn()
    x, y, face = stage.spot(0.5, 0.5, above=1)
    stops, start = stage.wheels.stops(face)
    stage.select([3])
    stage.mouse.move(x, y)
    yield from stage.drawn()
    first, began = stage.draws, time.monotonic()
    while stage.draws < first + 5:
        yield from stage.drawn()
    alone = (time.monotonic() - began) / (stage.draws - first)

    stage.shortcut("mesh.partwheel_select")
    yield from stage.until("a build has begun", session.running)
    job = session._running.job
    yield from stage.until("it gets on", lambda: job.poll()[0] > 0.05, LONG)
    first, began = stage.draws, time.monotonic()
    while stage.draws < first + 10:
        yield from stage.drawn()
        stage.check(job.poll() is not None, "the window is drawn ten times while the build goes on")
    building = (time.monotonic() - began) / (stage.draws - first)
    print(f"a redraw takes {alone:.3f} s alone, {building:.3f} s during a build")
    stage.check(building < 3 * alone + 0.1, "drawing is not slowed down much by a build")
    yield from stage.screenshot("building")
    began = time.monotonic()
    stage.mouse.key("ESC")
    yield from stage.until("the worker is gone", lambda: not alive(job.process_id))
    seconds = time.monotonic() - began
    print(f"Esc ended the worker within {seconds:.3f} s")
    stage.check(seconds < AT_ONCE, f"Esc ends the worker within {AT_ONCE} s")
    yield from stage.until("the tool has ended", lambda: not session.running())
    yield from stage.selected({3}, "after Esc")

    stage.shortcut("mesh.partwheel_select")
    yield from stage.selected(stops[start], "once built", LONG)
    yield from stage.screenshot("built")
    stage.mouse.key("RET")
    yield from stage.settle()
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    yield from reopen(stage)


def reopen(stage):
    """Opens the file with and without the parts in turn, and has them ready in the first case."""
    session = stage.session
    addon = next(addon for addon in bpy.context.preferences.addons if addon.module.endswith("partwheel"))
    paths = {}
    for wanted in (True, False):
        addon.preferences.save_with_file = wanted
        paths[wanted] = str(stage.file(f"large-{wanted}.blend"))
        bpy.ops.wm.save_as_mainfile(filepath=paths[wanted])
        yield from stage.settle()
        stage.check(not bpy.data.is_dirty, "a file just saved counts as saved")
    size = {wanted: os.path.getsize(path) for wanted, path in paths.items()}
    seconds = {True: [], False: []}
    for wanted in (False, True) * 4:
        began = time.process_time()  # not what others on the machine take
        bpy.ops.wm.open_mainfile(filepath=paths[wanted], load_ui=False)
        hierarchy = session.hierarchy(stage.object)
        seconds[wanted].append(time.process_time() - began)
        stage.check((hierarchy is not None) == wanted, "the parts are there if they were saved")
        yield from stage.settle()
        stage.check(not bpy.data.is_dirty, "a file just opened counts as saved")
    with_them, without = (min(seconds[wanted]) for wanted in (True, False))  # the least disturbed
    print(f"opening: {with_them:.3f} s with the parts ready, {without:.3f} s without; {size[True] / 1e6:.1f} MB, "
          f"{size[False] / 1e6:.1f} MB")
    stage.check(with_them - without < REOPENING, f"opening takes {with_them - without:.3f} s more with the parts")
