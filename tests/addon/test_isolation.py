# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever befalls the worker process, Blender's session and selection are as before, and the error is shown."""

import os
import sys
import tempfile
import threading
from pathlib import Path

import bpy
from common import MeshTest, flags, only_in, package, part, read_off, snapshot

sys.path.append(str(Path(__file__).resolve().parents[1] / "faults"))
import faults  # noqa: E402


class Isolation(MeshTest):
    @classmethod
    def setUpClass(cls):
        directory = tempfile.TemporaryDirectory()
        cls.addClassCleanup(directory.cleanup)
        cls.directory = Path(directory.name)
        cls.library = faults.library(package("library").load()._name, directory.name)
        cls.sound = package("worker.job").ENTRY
        cls.entry = faults.entry(cls.sound, cls.library, directory.name)

    def harm(self, fault, stage):
        """From now on, and to the end of the test, workers come to harm; Blender itself has loaded the real library."""
        self.addCleanup(setattr, package("worker.job"), "ENTRY", self.sound)
        package("worker.job").ENTRY = self.entry
        os.environ["PARTWHEEL_FAULT"] = f"{fault}:{stage}"

    def edited(self, name="cross_quad"):
        """A mesh in Edit Mode with a selection, its active face and a history."""
        obj = self.add(*read_off(name))
        bm = self.edit(obj)
        bm.faces.ensure_lookup_table()
        for index in (5, 7, 9):
            bm.faces[index].select_set(True)
            bm.select_history.add(bm.faces[index])
        bm.faces.active = bm.faces[9]
        return obj, flags(obj)

    def refusal(self, operator=None, **arguments):
        with self.assertRaises(RuntimeError) as refused:
            (operator or bpy.ops.mesh.partwheel_select)(**arguments)
        return str(refused.exception)

    def unharmed(self, obj, before):
        self.assertEqual(obj.mode, "EDIT")
        self.assertTrue(flags(obj) == before, "the selection has changed")  # assertEqual() would tell how, for minutes
        self.assertEqual(part("parts.builds")._builds, {})
        self.assertIsNone(part("parts.registry").get_hierarchy(snapshot(obj)))
        self.assertEqual([thread.name for thread in threading.enumerate() if thread.name.startswith("partwheel-")], [])

    @only_in("newest")
    def test_crashes_at_each_stage(self):
        obj, before = self.edited()
        for stage in package().Stage:
            for fault, word in (("segv", "SIGSEGV"), ("kill", "SIGKILL")):  # others: tests/core/test_worker.py
                with self.subTest(f"{fault} {stage.name}"):
                    self.harm(fault, int(stage))
                    message = self.refusal(face_index=3)
                    self.assertIn(word, message)
                    self.assertIn("The worker process", message)
                    self.unharmed(obj, before)

    def test_a_build_works_after_a_crash(self):
        obj, _ = self.edited()
        self.harm("segv", 1)
        self.refusal(bpy.ops.mesh.partwheel_build)
        package("worker.job").ENTRY = self.sound
        self.assertEqual(bpy.ops.mesh.partwheel_select(face_index=3), {"FINISHED"})
        self.assertEqual(len(part("parts.registry").get_hierarchy(snapshot(obj)).order), len(obj.data.polygons))

    def test_what_is_installed_loads_no_other_library(self):
        """Tests and sanitizers name one in the environment; whoever else can set that must not get it into Blender."""
        os.environ.update(PARTWHEEL_LIBRARY=self.library, PARTWHEEL_FAULT="segv:0")
        self.addCleanup(os.environ.pop, "PARTWHEEL_LIBRARY")
        obj = self.add(*read_off("cross_quad"))
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.assertEqual(len(part("parts.registry").get_hierarchy(snapshot(obj)).order), len(obj.data.polygons))
        loaded = package("library").load.__wrapped__()._name  # once more, as the first time
        self.assertNotEqual(Path(loaded).resolve(), Path(self.library).resolve())
