"""Esc ends Convex Parts while the hulls are computed, and leaves all as it was. The computations are held until then, so the
operator can't have waited for them."""
import threading

import bpy

from scenarios.computing import Held
from scenarios.panel_solids import CONVEX, TITLE
from scenarios.parts_to import ended, everything, mode, undone


def play(stage):
    yield from stage.open("hand")
    yield from mode(stage, "OBJECT")
    with Held(stage) as held:
        yield from escape(stage, held)


def escape(stage, held):
    model = stage.object
    sidebar = yield from stage.sidebar()
    names, before, threads = {obj.name for obj in bpy.data.objects}, everything(model), threading.active_count()

    def started():
        yield from stage.settle()
        stage.mouse.move(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - TITLE - CONVEX)
        yield from stage.settle()
        stage.mouse.click()
        yield from stage.until("it computes", lambda: held.count)
        yield from stage.settle()

    yield from started()
    stage.mouse.key("ESC")
    yield from stage.until("Esc ends it, while it still computes", lambda: "Canceled" in stage.reports())
    held.open()
    yield from stage.until("the computation stops by itself", lambda: held.canceled() == 1)
    stage.check(held.computations[0].keywords["context"].progress()[0] == 0, "at its first check")
    yield from stage.until("its thread has ended", lambda: threading.active_count() == threads)
    stage.check({obj.name for obj in bpy.data.objects} == names and everything(model) == before, "nothing has changed")
    stage.mouse.move(*stage.empty_spot())
    yield from ended(stage)
    held.close()
    yield from started()
    held.open()
    yield from stage.until("the next time there are hulls", lambda: len(model.children) > 8)
    stage.mouse.move(*stage.empty_spot())
    yield from ended(stage)
    yield from stage.screenshot("hulls")
    yield from undone(stage)
    yield from stage.until("one undo step removes them", lambda: {obj.name for obj in bpy.data.objects} == names)
