"""What the tool costs in four modes, on 10,000, 89,000 and a million faces: the longest step of a first hover and of a first
click after an edit, hover, click, notch, Enter: the table of docs/benchmarks.md. Only measures: for scripts/bench_latency.

Processor time of the add-on's own steps in Blender's main thread, as in latency.py. A click that hands over to Blender's own
entering of a mode (Sculpt Mode is left and entered again for a mask) has that in it.
"""
import statistics

import bmesh

from scenarios.latency import Clock, points, watch_batches
from scenarios.modes import enter

MODES = ("OBJECT", "EDIT", "SCULPT", "WEIGHT_PAINT")
MODELS = ("homer", "elephant", "million")
GOAL = 0.033
COLUMNS = "first hover", "hover", "first click", "click", "notch", "largest notch", "Enter"
NOTCHES = 4  # up, and down again


def play(stage):
    print("latency | faces | mode | " + " | ".join(COLUMNS) + " |\nlatency |" + " --- |" * (2 + len(COLUMNS)), flush=True)
    misses, clocks = [], Clocks(stage)
    for model in MODELS:
        yield from stage.open(model)
        faces = len(stage.object.data.polygons)
        for mode in MODES:
            measured = yield from in_mode(stage, clocks, mode)
            cells = [f"{1000 * value:.1f}" for value in measured.values()]
            print(f"latency | {faces:,} | {mode.title().replace('_', ' ')} | " + " | ".join(cells) + " |", flush=True)
            misses += [f"{faces:,} {mode} {name}" for name, value in measured.items() if value > GOAL]
    stage.check(faces > 1_000_000, "all were played")
    print(f"latency: above {1000 * GOAL:.0f} ms: {', '.join(misses) or 'none'}")


class Clocks:
    """Of all that runs in the main thread. take(name, ...): the seconds of these since the last forget() or take()."""

    def __init__(self, stage):
        picker, hover = stage.part("pick.pick").PartPicker, stage.part("pick.hover")
        overlay = stage.part("view.overlay")
        self._clocks = {"begin": Clock(picker, "_call_on_start"), "handle": Clock(picker, "on_event"),
                        "move": Clock(hover.Hover, "move"), "make": Clock(stage.part("pick.view_cache"), "_prepare_in_timer"),
                        "draw": Clock(overlay, "draw_picked_part"), "software": watch_batches(overlay.PartTriangles)}

    def take(self, *names):
        return [seconds for name in names for seconds in self._clocks[name].take()]

    def forget(self):
        self.take(*self._clocks)


def in_mode(stage, clocks, mode):
    """{column: seconds}"""
    yield from enter(stage, mode)
    spots = points(stage, 4)

    yield from edited(stage, clocks)
    stage.mouse.move(*spots[0])
    yield from stage.settle()
    stage.mouse.move(spots[0][0] + 1, spots[0][1])
    yield from stage.until(f"hover has found a part in {mode}", lambda: stage.hovered() is not None)
    first_hover = max(clocks.take("move", "make"))
    hovers = []
    for spot in spots:
        stage.mouse.move(*spot)
        yield from stage.settle()
        hovers += clocks.take("move")

    clicks, notches, ends = [], [], []
    for number, spot in enumerate(spots):
        stage.mouse.move(*spot)
        yield from stage.settle()
        if number == 0:
            yield from edited(stage, clocks)
            stage.mouse.move(spot[0] + 1, spot[1])
            yield from stage.until(f"hover is ready in {mode}", lambda: ready(stage))
        clocks.forget()
        stage.mouse.click()
        yield from stage.until(f"a part is held in {mode}", lambda: stage.drawn_things() == 1)
        clicks.append(max(clocks.take("begin", "handle")))
        for step in (1,) * NOTCHES + (-1,) * NOTCHES:
            clocks.forget()
            stage.mouse.wheel(step)
            yield from stage.settle()
            software_time = clocks.take("software")
            if software_time:  # not at the end of the path
                notches.append(sum(clocks.take("handle", "draw")) - sum(software_time))
        clocks.forget()
        stage.mouse.key("RET")
        yield from stage.until(f"it is taken in {mode}", lambda: stage.drawn_things() == 0)
        yield from stage.settle()
        ends.append(sum(clocks.take("handle")))
    return dict(zip(COLUMNS, (first_hover, statistics.median(hovers), clicks[0], statistics.median(clicks[1:]),
                              statistics.median(notches), max(notches), statistics.median(ends))))


def ready(stage):
    target = stage.part("pick.hover").hover.target
    return target is not None and stage.part("pick.view_cache").is_current(stage.object, target[1])


def edited(stage, clocks):
    """Blender tells of an edit of the mesh, and the mouse rests."""
    mesh = stage.object.data
    if mesh.is_editmode:
        bmesh.update_edit_mesh(mesh)
    else:
        mesh.update_tag()
    yield from stage.wait_for_redraw()
    clocks.forget()
