"""What a notch, a hover and a start cost of the add-on's own time, on 89,000 faces, and, on 208,000, how much a build
slows drawing down and opening a file takes more with the parts: the table of scripts/bench_latency. Only measures.

Processor time of Blender's main thread, which other programs don't interrupt meanwhile if we may ask for that. Tests have
no graphics card: what the drawing itself takes there, in software, is listed separately. It is no time of the add-on's: with a
card the call comes back at once.
"""
import contextlib
import itertools
import os
import statistics
import time

import bpy

from scenarios.large import close_to, reopened, saved

GOALS = {"notch, median": 0.016, "notch, 95 %": 0.033, "hover, median": 0.016, "start": 0.2,
         "notch, border in creases, median": 0.05, "opening a file with the parts ready, more than without": 0.3}
DRAWS = 10


@contextlib.contextmanager
def undisturbed():
    """This thread goes before all others for a moment, where the system allows it."""
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    try:
        yield
    finally:
        os.sched_setscheduler(0, *before)


class Clock:
    """Processor time that a function of the add-on takes, call by call."""

    def __init__(self, owner, name):
        self.seconds = []
        inner = getattr(owner, name)

        def timed(*arguments, **more):
            with undisturbed():
                start_time = time.thread_time()
                try:
                    return inner(*arguments, **more)
                finally:
                    self.seconds.append(time.thread_time() - start_time)

        setattr(owner, name, timed)

    def take(self):
        taken, self.seconds = self.seconds, []
        return taken


class Watched:
    """A batch whose drawing is timed."""

    def __init__(self, batch):
        self._batch = batch

    def draw(self, shader):
        self._batch.draw(shader)


def watch_batches(parts):
    """Has all that an overlay.PartTriangles draws timed by the Clock that this returns."""
    for name in ("slice_batch", "hull_batch", "cut_batch", "outline_batch"):
        def watched(*arguments, inner=getattr(parts, name)):
            result = inner(*arguments)
            return result and (result[0], Watched(result[1]))
        setattr(parts, name, watched)
    return Clock(Watched, "draw")


def points(stage, count=16):
    """So many pixels of the window with the model under them."""
    view = stage.view
    centers = view.centers().round().astype(int)
    near = (tuple(map(int, centers[face])) for face in range(0, len(centers), len(centers) // 60))
    return list(itertools.islice((point for point in near if view.face_at(*point) is not None), count))


def play(stage):
    yield from stage.open("elephant")
    picker, hover = stage.part("pick.pick").PartPicker, stage.part("pick.hover").Hover
    overlay = stage.part("view.overlay")
    handle, begin, moves = Clock(picker, "on_event"), Clock(picker, "_call_on_start"), Clock(hover, "move")
    draws, hover_draws, software = (
        Clock(overlay, "draw_picked_part"), Clock(overlay, "draw_hover"), watch_batches(overlay.PartTriangles))
    stage.use_tool()
    spots = points(stage)
    stage.part("mesh.mesh_state").get_mesh_state(stage.object.data).view_cache = None
    stage.mouse.move(*spots[0])
    yield from stage.until("hover has found a part", lambda: stage.hovered() is not None)
    first_hover = max(moves.take())
    for x, y in spots:
        stage.mouse.move(x, y)
        yield from stage.settle()
    hovers = moves.take()
    yield from stage.wait_for_redraw()
    hover_drawn = statistics.median(hover_draws.take()) - statistics.median(software.take())

    notches, snapped, drawing, starts = [], [], [], []
    for x, y in spots[::6]:
        stage.mouse.move(x, y)
        begin.take()
        stage.mouse.click()
        yield from stage.until("something is selected", lambda: stage.object.data.total_face_sel > 0)
        starts += begin.take()
        for step in (1,) * 6 + (-1,) * 7:
            for clock in (handle, draws, software):
                clock.take()
            before = stage.object.data.total_face_sel
            stage.mouse.wheel(step)
            yield from stage.settle()  # Blender draws before the timer's next tick
            if stage.object.data.total_face_sel != before:  # not at the end of the path
                drawing.append(sum(software.take()))
                notches.append(sum(handle.take()) + sum(draws.take()) - drawing[-1])
        stage.mouse.key("E", shift=True, ctrl=True)
        yield from stage.settle()
        handle.take()
        for step in (1,) * 6 + (-1,) * 6:
            stage.mouse.wheel(step)
            yield from stage.settle()
        snapped += handle.take()
        stage.mouse.key("E", shift=True, ctrl=True)
        stage.mouse.key("ESC")
        yield from stage.settle()
        stage.select(())
    stage.part("mesh.mesh_state").get_mesh_state(stage.object.data).view_cache = None
    for clock in (begin, handle):
        clock.take()
    stage.mouse.click()
    yield from stage.until("something is selected", lambda: stage.object.data.total_face_sel > 0)
    cold = max(begin.take() + handle.take())
    stage.mouse.key("ESC")
    yield from stage.settle()
    notches.sort()
    measured = {"notch, median": statistics.median(notches), "notch, 95 %": notches[int(0.95 * len(notches))],
                "hover, median": statistics.median(hovers) + hover_drawn, "start": max(starts),
                "notch, border in creases, median": statistics.median(snapped)}
    other_costs = {"largest notch": notches[-1], "first hover after an edit, its longer step": first_hover,
              "first start after an edit, its longest step": cold,
              "beside a notch, drawing in software, median": statistics.median(drawing)}
    print(f"latency | {len(stage.wheels.triangles):,} faces, {len(notches)} notches, {len(hovers)} hovers, {len(starts)} "
          "starts | milliseconds | goal |\nlatency | --- | --- | --- |")
    other_costs |= yield from at_208000_faces(stage)
    for name, value in (measured | other_costs).items():
        print(f"latency | {name} | {1000 * value:.1f} | {f'{1000 * GOALS[name]:.0f}' if name in GOALS else ''} |")


def at_208000_faces(stage):
    """{name: seconds}; and prints by how much a redraw takes longer during a build than before it, by the clock."""
    x, y, _, _ = yield from close_to(stage, "large")
    stage.mouse.move(x, y)

    def redraw():
        yield from stage.wait_for_redraw()
        start_time = time.monotonic()
        for _ in range(DRAWS):
            yield from stage.wait_for_redraw()
        return (time.monotonic() - start_time) / DRAWS

    alone = yield from redraw()
    stage.shortcut("mesh.partwheel_select")
    yield from stage.until("a build has begun", stage.has_builds)
    during = yield from redraw()
    whole = "" if stage.has_builds() else ", though it was over before"
    print(f"latency: a redraw during a build takes {during / alone:.1f} times as long as alone{whole}")
    yield from stage.until("the part is selected", lambda: stage.object.data.total_face_sel > 0)
    stage.mouse.key("RET")
    yield from stage.settle()
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    paths, seconds = (yield from saved(stage)), {True: [], False: []}
    for enabled in (False, True) * 4:
        start_time = time.process_time()
        reopened(stage, paths[enabled])
        seconds[enabled].append(time.process_time() - start_time)
        yield from stage.settle()
    return {"opening a file with the parts ready, more than without": min(seconds[True]) - min(seconds[False])}
