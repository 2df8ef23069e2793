# SPDX-License-Identifier: GPL-3.0-or-later
"""Steps and their computations: in which thread each runs, errors, cancellation; and no command changes anything before
its last computation has ended."""

import threading

import bpy
import numpy
from common import MeshTest, only_in, package, part, read_off, until


def in_thread(*, context):
    context.start_step(0.5)
    return threading.current_thread()


def failing(*, context):
    raise KeyError("found")


def waiting(event, *, context):
    event.wait()
    context.start_step(1)


class StepsTest(MeshTest):
    def steps(self, *functions):
        computation = part("mesh.computation").Computation
        threads = []
        for function, *arguments in functions:
            threads.append(threading.current_thread())
            threads.append((yield computation(function, *arguments)))
        return threads

    def test_steps_run_here_or_their_computations_in_a_thread(self):
        module, here = part("mesh.computation"), threading.current_thread()
        self.assertEqual(module.run_steps(self.steps((in_thread,), (in_thread,))), [here] * 4)
        background = module.BackgroundSteps(self.steps((in_thread,), (in_thread,)))
        until(lambda: background.poll() is None)
        one, first, two, second = background.result
        self.assertEqual([one, two], [here, here])
        self.assertNotIn(here, (first, second))

    def test_steps_without_a_computation_end_at_once(self):
        background = part("mesh.computation").BackgroundSteps(self.steps())
        self.assertIsNone(background.poll())
        self.assertEqual(background.result, [])

    def test_errors_reach_the_steps(self):
        module = part("mesh.computation")

        def caught():
            try:
                yield module.Computation(failing)
            except KeyError as error:
                return str(error)

        self.assertEqual(module.run_steps(caught()), "'found'")
        background = module.BackgroundSteps(caught())
        until(lambda: background.poll() is None)
        self.assertEqual(background.result, "'found'")
        background = module.BackgroundSteps(self.steps((failing,)))
        with self.assertRaises(KeyError):
            until(lambda: background.poll() is None)

    def test_cancel_ends_the_steps_and_stops_the_computation(self):
        module, event, ended = part("mesh.computation"), threading.Event(), []

        def steps():
            try:
                yield from self.steps((waiting, event), (in_thread,))
            finally:
                ended.append(True)

        background = module.BackgroundSteps(steps())
        task, context = background._task, background._computation.context
        self.assertEqual(background.poll(), 0)
        background.cancel()
        self.assertEqual((background.poll(), background.result, ended), (None, None, [True]))
        event.set()
        with self.assertRaisesRegex(package().PartwheelError, "canceled"):
            task.result()
        with self.assertRaisesRegex(package().PartwheelError, "canceled"):
            context.start_step(0)

    def test_progress_is_that_of_the_running_computation(self):
        module, event = part("mesh.computation"), threading.Event()

        def stepping(*, context):
            context.start_step(0.25)
            event.wait()

        background = module.BackgroundSteps(self.steps((stepping,)))
        until(lambda: background.poll() == 0.25)
        event.set()
        until(lambda: background.poll() is None)


@only_in("oldest", "newest")
class NothingChanges(MeshTest):
    """Until the last computation of a command has ended, so that Esc has nothing to undo."""

    def everything(self, obj):
        mesh, flags = part("mesh.arrays").update_mesh(obj), []
        for data, field in ((mesh.polygons, "select"), (mesh.edges, "select"), (mesh.edges, "use_seam")):
            flags.append(numpy.empty(len(data), bool))
            data.foreach_get(field, flags[-1])
        blocks = [sorted(block.name for block in getattr(bpy.data, kind)) for kind in part("mesh.datablocks").KINDS]
        return ([numpy.flatnonzero(flag).tolist() for flag in flags], blocks, obj.mode, sorted(mesh.keys()), sorted(mesh.attributes.keys()),
                [group.name for group in obj.vertex_groups], [layer.name for layer in mesh.uv_layers],
                [modifier.name for modifier in obj.modifiers], obj.parent, [o.name for o in bpy.context.selected_objects])

    def check(self, obj, steps):
        """Plays the steps and compares at each computation."""
        before, count = self.everything(obj), 0
        try:
            computation = next(steps)
            while True:
                for now, then in zip(self.everything(obj), before):
                    self.assertEqual(now, then)
                count += 1
                computation = steps.send(computation.run())
        except StopIteration as end:
            self.assertEqual(self.everything(obj), before)
            self.assertGreater(count, 0)
            return end.value

    def test_while_results_are_planned(self):
        api, writing = part("api"), part("cut.writing")
        obj = self.add(*read_off("elephant"))
        cut = api.cut(obj)
        obj.data.uv_layers.new(name="mine")
        for mode in ("OBJECT", "EDIT", "SCULPT"):
            bpy.ops.object.mode_set(mode=mode)
            plan = self.check(obj, writing.plan_write(obj, cut, {"SEAMS", "BONES", "OBJECTS"}, {}, True))
            seams = plan.seams
            if mode == "OBJECT":
                first = seams
            self.assertTrue((seams.edges == first.edges).all())
            numpy.testing.assert_allclose(seams.uvs, first.uvs, atol=1e-5)
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(len(api.write(obj, cut, {"SEAMS"}, unwrap=True).names), len(cut))

    def test_while_hulls_are_computed(self):
        obj = self.add(*read_off("elephant"))
        hierarchy = part("api").build(obj)
        operator = part("cut.convex_parts").MESH_OT_partwheel_convex
        options = type("Options", (), {"each": "MODEL", "by": "HULLS", "hulls": 4, "vertices": 32, "keep_open": 0})
        self.assertEqual(len(self.check(obj, operator.plan(options, obj, hierarchy))), 4)

    def test_while_a_cut_is_computed(self):
        obj = self.add(*read_off("hand"))
        hierarchy = part("api").build(obj)
        options = type("Options", (), {"by": "LEAST_CONCAVITY", "parts": 6})
        cut = self.check(obj, part("cut.split").MESH_OT_partwheel_split.plan(options, obj, hierarchy))
        self.assertEqual(len(cut), 6)
