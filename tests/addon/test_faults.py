# SPDX-License-Identifier: GPL-3.0-or-later
"""An exception in any step of any modal operator: afterwards all is as it was before it began, and nothing of it is
left.

A profile function raises where the operators' modules call one of the add-on's functions for the n-th time in a step,
so the place is not one that the operator knows of. """

import contextlib
import inspect
import io
import sys
import types
from pathlib import Path

import bmesh
import bpy
import common
import numpy as np
from common import only_in, package, part, read_off, snapshot, until
from solid_case import SolidTest
from test_modal import FakeContext, event, prepared, show, view
from test_swap import limb

OURS = {"_start_modal", "_run_guarded", "invoke", "modal", "cancel"}  # the guard itself


class Fault(Exception):
    """Not one that anything in the add-on knows."""


class Calls:
    """While it is entered, calls of the add-on's functions from its operators are listed by name. fault: a number or a
    name, of the one at which a Fault is raised."""

    def __init__(self, fault=None):
        self.names, self.fault, self.raised = [], fault, False

    def __enter__(self):
        addon = sys.modules[common.MODULE]
        classes = [each for name in addon.MODULES for each in addon.find_classes(part(name))]
        self.callers = {sys.modules[base.__module__].__file__ for cls in classes if issubclass(cls, bpy.types.Operator)
                        for base in cls.__mro__ if base.__module__.startswith(f"{common.MODULE}.")}
        self.called = tuple(str(Path(module.__file__).parent) for module in (addon, package()))
        sys.setprofile(self._called)
        return self

    def __exit__(self, *_):
        sys.setprofile(None)

    def _called(self, frame, what, _):
        code = frame.f_code
        # Not where a generator goes on: what is raised there comes before its own "finally".
        if what != "call" or not (frame.f_back.f_code.co_filename in self.callers
                                  and code.co_filename.startswith(self.called)):
            return
        if code.co_flags & inspect.CO_GENERATOR or code.co_name in OURS or code.co_name.startswith("<"):
            return
        self.names.append(code.co_name)
        if self.fault in (len(self.names) - 1, code.co_name):
            self.raised = True
            raise Fault(code.co_name)


def operator(cls, options, draws):
    """An object with the methods of an operator's class, and its properties."""
    category, name = cls.bl_idname.split(".")
    own = {key: value for key, value in vars(cls).items() if not key.startswith("__") and key != "bl_rna"}
    tool = type(cls.__name__, tuple(base for base in cls.__bases__ if base is not bpy.types.Operator), own)()
    for prop in getattr(getattr(bpy.ops, category), name).get_rna_type().properties:
        if prop.type not in {"POINTER", "COLLECTION"}:
            setattr(tool, prop.identifier, prop.default_array[:] if getattr(prop, "is_array", False) else prop.default)
    vars(tool).update(options)
    tool.handles, tool.reports, tool.properties = [], [], types.SimpleNamespace(is_property_set=options.__contains__)
    tool.report = lambda kind, message: tool.reports.append((kind, message))
    drawing = tool._guard_drawing
    tool._guard_drawing = lambda function: draws.append(drawing(function)) or draws[-1]
    return tool


@only_in("newest")
class Faults(SolidTest):
    def everything(self):
        """All that an operator could leave behind."""
        bpy.context.view_layer.update()
        handlers = {name: len(each) for name in dir(bpy.app.handlers)
                    for each in [getattr(bpy.app.handlers, name)] if isinstance(each, list)}
        counts = {name: len(collection) for name in dir(bpy.data)
                  for collection in [getattr(bpy.data, name)] if isinstance(collection, bpy.types.bpy_prop_collection)}
        objects = {obj.name: (obj.data.name, obj.mode, obj.select_get(), obj.hide_viewport, obj.hide_get(),
                              list(obj.keys()), tuple(map(tuple, obj.matrix_world))) for obj in bpy.data.objects}
        meshes = {}
        for mesh in bpy.data.meshes:
            bm = bmesh.from_edit_mesh(mesh) if mesh.is_editmode else None
            verts = bm.verts if bm else mesh.vertices
            faces = bm.faces if bm else mesh.polygons
            meshes[mesh.name] = (mesh.users, np.array([vertex.co for vertex in verts]).tobytes(),
                                 bytes(face.select for face in faces))
        return dict(handlers=handlers, counts=counts, objects=objects, meshes=meshes, mode=bpy.context.mode,
                    active=bpy.context.view_layer.objects.active.name, running=list(part("parts.builds")._builds))

    def compare(self, now, before, where):
        for name, value in before.items():
            self.assertEqual(str(now[name])[:2000], str(value)[:2000], f"{name} {where}")
            self.assertTrue(now[name] == value, f"{name} {where}")

    def begin(self, cls, options):
        self.draws.clear()
        tool, context = operator(cls, options, self.draws), FakeContext()
        context.area.spaces, context.area.tag_redraw = view()[1].spaces, list
        context.window = types.SimpleNamespace(
            cursor_modal_set=self.cursor.append, cursor_modal_restore=self.cursor.clear,
            **{name: getattr(context.window, name) for name in ("screen", "width", "height", "x", "y")})
        return tool, context

    def is_over(self, context, where):
        self.assertEqual((context.status or [None])[-1], None, where)
        self.assertEqual((context.header or [None])[-1], None, where)
        self.assertEqual((context.timers, self.cursor), ([], []), where)

    def throw_everywhere(self, cls, steps, done="_end", **options):
        """steps: functions (tool, context) -> answer, the first of which begins, and the last ends. done: the last
        function of that one that may fail: then all is done."""
        self.cursor, self.draws = [], []
        before = self.everything()
        counts = []
        tool, context = self.begin(cls, options)
        for step in steps:
            with contextlib.redirect_stderr(io.StringIO()), Calls(done if step is steps[-1] else None) as calls:
                answer = step(tool, context)
            self.assertEqual("CANCELLED" in answer, step is steps[-1], tool.reports)
            counts.append(calls.names.index(done) + 1 if step is steps[-1] else len(calls.names))
        self.compare(self.everything(), before, "after it was canceled")
        self.is_over(context, "after it was canceled")
        faults = 0
        for last, step in enumerate(steps):
            for fault in sorted({0, 1, 3, counts[last] // 2, counts[last] - 1} & set(range(counts[last]))):
                tool, context = self.begin(cls, options)
                for earlier in steps[:last]:
                    self.assertIn(next(iter(earlier(tool, context))), {"RUNNING_MODAL", "PASS_THROUGH"})
                with contextlib.redirect_stderr(io.StringIO()) as log, Calls(fault) as calls:
                    answer = step(tool, context)
                where = f"after call {fault} ({calls.names[-1:]}) of step {last} of {cls.__name__}"
                if not calls.raised or "RUNNING_MODAL" in answer:
                    tool.cancel(context)
                else:
                    faults += 1
                    self.assertEqual(answer, {"CANCELLED"}, where)
                    self.assertIn("Traceback", log.getvalue(), where)
                    self.assertIn({"ERROR"}, [kind for kind, _ in tool.reports], where)
                self.compare(self.everything(), before, where)
                self.is_over(context, where)
        print(f"{cls.__name__}: {faults} faults in {len(steps)} steps")
        self.assertGreater(faults, 2 * len(steps))

    def sends(self, *arguments, **modifiers):
        return lambda tool, context: tool.modal(context, event(*arguments, **modifiers))

    def begins(self, *arguments, **modifiers):
        return lambda tool, context: prepared(tool, context, tool.invoke(context, event(*arguments, **modifiers)))

    def ready(self, tool, context):
        """The tick at which what was done in the background is done."""
        until(lambda: not tool.session.task or tool.session.task.done())
        return tool.modal(context, event("TIMER"))

    def test_select(self):
        obj = self.add(*read_off("hand"))
        part("api").build(obj)
        show(obj)
        self.edit(obj)
        _, _, region, region_view = view()
        cls = part("pick.select").MESH_OT_partwheel_select
        for kind in (("RET",), ("ESC",), ("A",)):
            self.throw_everywhere(cls, [self.begins("W", ctrl=True), self.sends("WHEELUPMOUSE"),
                                        self.sends("MOUSEMOVE", value="NOTHING"), self.sends("TIMER"),
                                        self.sends("E", shift=True, ctrl=True), self.sends("TWO"), self.sends(*kind)])

    def test_pick_in_object_mode(self):
        obj = self.add(*read_off("hand"))
        part("api").build(obj)
        show(obj)
        for polygon in obj.data.polygons:
            polygon.select = polygon.index < 100
        cls = part("pick.objects").OBJECT_OT_partwheel_pick
        for kind in (("RET",), ("ESC",)):
            self.throw_everywhere(cls, [self.begins("LEFTMOUSE"), self.sends("WHEELUPMOUSE"), self.sends(*kind)],
                                  tool=True, extend=True)

    def pick_limb(self):
        """Picks a limb of a new object in Edit Mode."""
        obj = self.add(*read_off("hand"))
        hierarchy = part("api").build(obj)
        show(obj)
        self.edit(obj)
        node = limb(obj, hierarchy, 0, 1)
        part("parts.picks").remember(snapshot(obj), int(hierarchy.faces(node)[0]), node, False)

    def test_deform(self):
        self.pick_limb()
        cls = part("deform.operator").MESH_OT_partwheel_deform
        for method in ("RIGID", "PROPORTIONAL", "JOINT"):
            self.throw_everywhere(
                cls, [self.begins("D"), self.ready, self.sends("G"), self.sends("MOUSEMOVE", (200, 150), "NOTHING"),
                      self.ready, self.sends("LEFTMOUSE", (220, 170)), self.sends("WHEELUPMOUSE"), self.sends("ESC")],
                method=method)

    def test_place(self):
        target = self.add(*read_off("hand"), "target")
        show(target)
        self.add(*common.BOX, "thing")
        cls = part("compose.place").OBJECT_OT_partwheel_place
        for key in ("RET", "ESC"):
            self.throw_everywhere(cls, [self.begins("A"), self.sends("MOUSEMOVE", value="NOTHING"),
                                        self.sends("WHEELUPMOUSE"), self.sends("PAGE_UP"), self.sends("TIMER"),
                                        self.sends(key)])

    def test_swap(self):
        giver, _ = self.built("dragknob")
        model, hierarchy = self.built("hand")
        cls = part("compose.swap").MESH_OT_partwheel_swap
        node = limb(model, hierarchy, 0, 1)
        bpy.ops.object.mode_set(mode="EDIT")
        self.throw_everywhere(cls, [self.begins("A"), self.sends("WHEELUPMOUSE"), self.sends("M"), self.sends("TIMER"),
                                    self.sends("RET")], done="bound_modifier_messages", node=node, build=False)

    def test_build(self):
        obj = self.add(*read_off("hand"))
        part("parts.files").on_load()
        self.assertEqual(obj.mode, "OBJECT")
        cls = part("pick.build").MESH_OT_partwheel_build
        self.throw_everywhere(cls, [self.begins("A"), self.sends("TIMER"), self.sends("ESC")])

    def test_drawing(self):
        """A draw handler that fails ends the operator at its next event, and fails no second time."""
        self.pick_limb()
        before, self.cursor, self.draws = self.everything(), [], []
        tool, context = self.begin(part("deform.operator").MESH_OT_partwheel_deform, {})
        for step in (self.begins("D"), self.sends("G"), self.sends("MOUSEMOVE", (200, 150), "NOTHING")):
            self.assertEqual(step(tool, context), {"RUNNING_MODAL"})
        tool.session.finish(context.edit_object)
        failed = []
        tool._draw = lambda: failed.append(1) or self.fail("while drawing")
        draw = tool._guard_drawing(tool._draw)
        draw(), draw()
        self.assertEqual(failed, [1])
        with contextlib.redirect_stderr(io.StringIO()) as log:
            self.assertEqual(self.sends("MOUSEMOVE", value="NOTHING")(tool, context), {"CANCELLED"})
        self.assertIn("while drawing", log.getvalue())
        self.compare(self.everything(), before, "after drawing failed")
        self.is_over(context, "after drawing failed")
