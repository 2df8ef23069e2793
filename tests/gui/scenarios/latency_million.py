"""What the tool costs on a million faces: from the first hover to the part that lights up (also on a character of 50,000
faces), a notch, a start, memory, in Edit, Sculpt and Object Mode, and beside that what Blender itself takes. Only measures:
for scripts/bench_latency.

Processor time as in latency.py. To that of hover and click the worker's is added; the window is not held up by it.
"""
import resource
import statistics
import time

import bpy

from scenarios.latency import Clock, points, watch_batches

FIRST = "first part lit in Edit Mode, from the first hover on"
GOALS = {"character": {FIRST: 1.5}, "million": {FIRST: 6.0, "longest step of the add-on meanwhile": 0.1,
         "notch in Sculpt Mode, median": 0.033, "notch in Object Mode, median": 0.033}}
NOTCHES = 5  # up, and down again


def play(stage):
    picker, hover = stage.part("pick.pick").PartPicker, stage.part("pick.hover").Hover
    overlay = stage.part("view.overlay")
    handle, begin, moves = Clock(picker, "on_event"), Clock(picker, "_call_on_start"), Clock(hover, "move")
    draws, software = Clock(overlay, "draw_picked_part"), watch_batches(overlay.PartTriangles)
    written = Clock(stage.part("mesh.arrays"), "update_mesh")
    clocks = handle, begin, moves, draws, software, written

    yield from stage.open("character", build=False)
    stage.use_tool()
    _, measured = yield from first_part(stage, handle, begin, moves, written)
    show(stage, "character", measured)
    stage.mouse.key("ESC")
    yield from stage.settle()

    yield from stage.open("million", build=False)
    faces = len(stage.wheels.triangles)
    mode_set = {name: seconds(lambda name=name: mode(stage, name)) for name in ("OBJECT", "EDIT")}
    spot, measured = yield from first_part(stage, handle, begin, moves, written)
    measured |= yield from notched(stage, "Edit Mode", handle, draws, software)
    stage.mouse.key("ESC")
    yield from stage.settle()

    mode(stage, "OBJECT")
    measured["entering Sculpt Mode, Blender's own"] = seconds(lambda: mode(stage, "SCULPT"))
    yield from stage.wait_for_redraw()
    stage.mouse.move(*spot)
    forget(clocks)
    with stage.override():
        bpy.ops.mesh.partwheel_paint("INVOKE_DEFAULT")
    yield from stage.until("a part is shown", lambda: stage.drawn_things() == 1)
    measured["start in Sculpt Mode"] = sum(begin.take())
    measured |= yield from notched(stage, "Sculpt Mode", handle, draws, software)
    stage.mouse.key("ESC")
    yield from stage.settle()

    mode(stage, "OBJECT")
    stage.mouse.move(*spot)
    yield from stage.settle()
    forget(clocks)
    with stage.override():
        bpy.ops.object.partwheel_select("INVOKE_DEFAULT")
    yield from stage.until("a part is shown", lambda: stage.drawn_things() == 1)
    measured["start in Object Mode"] = sum(begin.take())
    measured |= yield from notched(stage, "Object Mode", handle, draws, software)
    forget(clocks)
    stage.mouse.key("RET")
    yield from stage.until("Edit Mode is entered", lambda: stage.object.mode == "EDIT")
    yield from stage.settle()
    measured["Enter there, with Blender's entering Edit Mode"] = sum(handle.take())
    stage.check(0 < len(stage.selection()) < faces, "with the part selected")
    measured |= {f"entering {name.title()} Mode, Blender's own": each for name, each in mode_set.items()}
    show(stage, "million", measured)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"latency: Blender's memory at most {peak:.0f} MB")


def first_part(stage, handle, begin, moves, written):
    """(a pixel with the model under it, {name: seconds}) of hovering over a model without parts, a click, the build, and
    showing the part."""
    spot, = points(stage, 1)
    state = stage.part("mesh.mesh_state").get_mesh_state(stage.object.data)
    forget((handle, begin, moves, written))
    stage.mouse.move(*spot)
    yield from stage.until("hover is ready", lambda: state.view_cache and state.view_cache.is_complete)
    yield from stage.settle()
    hovers = moves.take()
    before, workers, wall = time.process_time(), children(), time.monotonic()
    stage.mouse.click()
    yield from stage.until("a part is lit", lambda: stage.drawn_things() == 1)
    wall = time.monotonic() - wall
    steps = [step for clock in (handle, begin, moves) for step in clock.take()]
    worker = children() - workers
    return spot, {
        FIRST: sum(hovers) + sum(steps) + worker, "of that hovering": sum(hovers), "of that the worker": worker,
        "longest step of the add-on meanwhile": max(hovers + steps),
        "Blender writing its edits back in these steps, all together": sum(written.take()),
        "the same by the clock of the wall, as busy as this machine is": wall,
        "Blender's own work meanwhile, drawing in software": time.process_time() - before - sum(steps)}


def show(stage, model, measured):
    """Prints the table of a model."""
    print(f"latency | {len(stage.wheels.triangles):,} faces, Blender {bpy.app.version_string} | milliseconds | goal |\n"
          "latency | --- | --- | --- |")
    for name, value in measured.items():
        goal = GOALS[model].get(name)
        print(f"latency | {name} | {1000 * value:.1f} | {f'{1000 * goal:.0f}' if goal else ''} |", flush=True)


def notched(stage, where, handle, draws, software):
    """{name: seconds} of notches up and down again."""
    whole, drawing = [], []
    for step in (1,) * NOTCHES + (-1,) * NOTCHES:
        forget((handle, draws, software))
        stage.mouse.wheel(step)
        yield from stage.settle()
        software_time = software.take()
        if software_time:  # not at the end of the path
            whole.append(sum(handle.take()) + sum(draws.take()) - sum(software_time))
            drawing.append(sum(software_time))
    return {f"notch in {where}, median": statistics.median(whole), f"notch in {where}, largest": max(whole),
            f"beside a notch in {where}, drawing in software, median": statistics.median(drawing)}


def forget(clocks):
    for clock in clocks:
        clock.take()


def seconds(action):
    """Processor time of Blender for it."""
    start_time = time.process_time()
    action()
    return time.process_time() - start_time


def children():
    """Processor time of all workers that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def mode(stage, name):
    with stage.override():
        bpy.ops.object.mode_set(mode=name)
