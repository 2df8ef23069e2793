"""While a command computes, the view still turns, nothing else happens, and Esc leaves all as it was: Parts to Seams and
Bones in Edit Mode. The computations are held until then."""
import threading

import bpy
import numpy
from scenarios.parts_to import ended, everything, mode


def play(stage):
    yield from stage.open("bear")
    stage.select([3])
    with Held(stage) as held:
        yield from seams_and_bones(stage, held)


def seams_and_bones(stage, held):
    model = stage.object
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    start, selected = everything(model), seams(model)
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")
    place = stage.spot(0.5, 0.5)

    def begun():
        stage.mouse.move(*place[:2])
        with stage.override():
            bpy.ops.mesh.partwheel_parts("INVOKE_DEFAULT", to={"SEAMS", "BONES"})
        yield from stage.settle()
        stage.mouse.key("RET")
        yield from stage.until("it computes", lambda: held.count)
        yield from stage.settle()

    held.close()
    yield from begun()
    yield from stage.screenshot("1-computing")
    before = stage.view_state()
    stage.mouse.key("NUMPAD_3")
    yield from stage.until("the view turns", lambda: stage.view_state() != before)
    for key in ("X", "TAB", "RET", "A"):
        stage.mouse.key(key)
    stage.mouse.key("Z", ctrl=True)
    yield from stage.settle()
    stage.check(model.mode == "EDIT" and stage.selection() == {3}, "keys do nothing meanwhile")
    stage.mouse.key("ESC")
    yield from stage.until("Esc ends it, while it still computes", lambda: "Canceled" in stage.reports())
    held.open()
    yield from stage.until("the computation stops by itself", lambda: held.canceled() == 1)
    yield from ended(stage)
    stage.check(stage.selection() == {3}, "the selection is as it was")
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    stage.check(everything(model) == start and (seams(model) == selected).all(), "nothing has changed")
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")

    yield from begun()
    yield from stage.until("the bones are there", lambda: model.find_armature() is not None)
    yield from ended(stage)
    stage.check(model.mode == "EDIT", "back in Edit Mode")
    yield from mode(stage, "OBJECT")
    stage.check(seams(model).any() and len(model.vertex_groups) > 3, "seams and weights, too")
    stage.check(len(bpy.data.objects) == 2, "and no other object")
    api = stage.package("api")
    found, groups = seams(model), len(model.vertex_groups)
    api.write(model, api.load_cut(model)[0], to={"SEAMS"})
    stage.check((seams(model) == found).all() and groups == len(api.load_cut(model)[1]), "as a script gets them")


class Held:
    """Computations wait between close() and open(), within a with statement."""

    def __init__(self, stage):
        self.module = stage.part("mesh.computation")
        self.start, self.gate = self.module.start_thread, threading.Event()
        self.close()

    def __enter__(self):
        self.module.start_thread = lambda compute: self.start(lambda: self._wait(compute))
        return self

    def _wait(self, compute):
        self.computations.append(compute)
        self.gate.wait()
        try:
            return compute()
        except Exception as error:
            self.errors.append(error)
            raise

    @property
    def count(self):
        return len(self.computations)

    def canceled(self):
        return sum(getattr(error, "name", None) == "canceled" for error in self.errors)

    def close(self):
        self.computations, self.errors = [], []
        self.gate.clear()

    def open(self):
        self.gate.set()

    def __exit__(self, *_):
        self.open()
        self.module.start_thread = self.start


def seams(obj):
    values = numpy.empty(len(obj.data.edges), bool)
    obj.data.edges.foreach_get("use_seam", values)
    return values
