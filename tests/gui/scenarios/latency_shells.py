"""What a notch and a hover cost on 5,000 shells of ten faces, with the panels open. Only measures: for scripts/bench_latency.

Processor time as in latency.py, of all that the add-on does for an event: the event, what it draws in the view, its panels.
"""
import statistics

import bpy

from scenarios.latency import Clock, points, watch_batches

GOAL = 0.033
NOTCHES = 14  # up to the whole


def play(stage):
    yield from stage.open("shells")
    overlay, panel, path = stage.part("view.overlay"), stage.part("ui.panel"), stage.part("ui.path")
    open_panels(panel.VIEW3D_PT_partwheel_options, path.VIEW3D_PT_partwheel_path)
    clocks = [Clock(owner, name) for owner, name in (
        (stage.part("pick.pick").PartPicker, "on_event"), (stage.part("pick.hover").Hover, "move"),
        (overlay, "draw_picked_part"), (overlay, "draw_hover"), (panel, "_draw_summary"), (panel, "describe_fill"),
        (path, "draw_path"))]
    software = watch_batches(overlay.PartTriangles)
    yield from stage.sidebar()
    stage.use_tool()
    spots = points(stage)
    measured = {}

    def measure(name, action):
        """Adds what the add-on computes from this action until all is drawn."""
        yield from stage.wait_for_redraw()
        for clock in (software, *clocks):
            clock.take()
        action()
        yield from stage.settle()
        yield from stage.wait_for_redraw()
        measured.setdefault(name, []).append(sum(sum(clock.take()) for clock in clocks) - sum(software.take()))

    def turn(name):
        """Turns the wheel up to the whole and back."""
        for step in (1,) * NOTCHES + (-1,) * NOTCHES:
            yield from measure(name, lambda step=step: stage.mouse.wheel(step))

    stage.mouse.move(*spots[0])
    yield from stage.until("hover has found a part", lambda: stage.hovered() is not None)
    for x, y in spots:
        yield from measure("hover", lambda x=x, y=y: stage.mouse.move(x, y))
    stage.mouse.click()
    yield from stage.until("something is selected", lambda: stage.object.data.total_face_sel > 0)
    yield from turn("notch")
    yield from stage.screenshot("panels")
    stage.part("preferences").preferences().show_cut = True
    yield from turn("notch, every part in its color")
    stage.part("preferences").preferences().show_cut = False
    stage.mouse.key("E", shift=True, ctrl=True)
    yield from turn("notch, border in creases")
    stage.mouse.key("ESC")
    for x, y in spots:
        yield from measure("hover, border in creases", lambda x=x, y=y: stage.mouse.move(x, y))
    print("latency | 5,000 shells of 10 faces | milliseconds | goal |\nlatency | --- | --- | --- |")
    for name, seconds in measured.items():
        print(f"latency | {name}, median | {1000 * statistics.median(seconds):.1f} | |")
        print(f"latency | {name}, largest of {len(seconds)} | {1000 * max(seconds):.1f} | {1000 * GOAL:.0f} |")


def open_panels(*panels):
    for panel in panels:
        bpy.utils.unregister_class(panel)
        panel.bl_options = set()
        bpy.utils.register_class(panel)
