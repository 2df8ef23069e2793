# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user sees while the native library can't be loaded, and of parts saved by other versions."""

import contextlib
import io
import struct
import tempfile
from pathlib import Path

import bpy
from common import MeshTest, package, part, read_off


class NoLibrary(MeshTest):
    """The installed library is a file that no system can load."""

    def setUp(self):
        super().setUp()
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.binding = package("library")
        self.installed = self.binding.LIBRARY
        self.path = Path(directory.name) / self.installed.name
        self.path.write_bytes(b"no library")
        self.addCleanup(setattr, self.binding, "LIBRARY", self.installed)
        self.addCleanup(self.binding.load.cache_clear)
        self.binding.LIBRARY = self.path
        self.binding.load.cache_clear()
        part("library_error")._logged.clear()

    def test_a_build_says_why_and_the_log_has_the_loaders_words_once(self):
        self.add(*read_off("hand"))
        log = io.StringIO()
        with contextlib.redirect_stdout(log):
            for _ in range(2):
                with self.assertRaises(RuntimeError) as refused:
                    bpy.ops.mesh.partwheel_build()
                self.assertIn("is damaged", str(refused.exception))
        self.assertEqual(log.getvalue().count("The loader said: "), 1)
        self.assertNotIn("Traceback", log.getvalue())

    def test_it_works_once_the_file_is_there(self):
        """Without a restart: what failed is not remembered."""
        self.add(*read_off("hand"))
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertRaises(RuntimeError, bpy.ops.mesh.partwheel_build)
        self.path.write_bytes(self.installed.read_bytes())
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})


class OtherVersions(MeshTest):
    """Parts that another version saved with the mesh."""

    def open_saved(self, version):
        """What the console got when parts of such a version were there, and what a build then reports."""
        obj = self.add(*read_off("hand"))
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        stored, registry = part("parts.stored"), part("parts.registry")
        packed = bytearray(stored.pack(registry.find_entry(obj.data).built_for, registry.find_hierarchy(obj.data)))
        packed[8:12] = struct.pack("<I", version)
        registry.forget(obj.data)
        obj.data[stored.PROPERTY] = bytes(packed)
        self.assertEqual(registry.get_state(obj.data)[0], registry.State.UNOPENED)
        log, reports = io.StringIO(), []
        with contextlib.redirect_stdout(log):
            self.assertIsNone(registry.get_hierarchy(obj))

            class Operator:
                @staticmethod
                def report(kind, text):
                    reports.append((*kind, text))
            building = part("pick.build").start_build(Operator, obj)
            building.wait(bpy.context)
        self.assertIsNotNone(registry.find_hierarchy(obj.data))
        return log.getvalue(), reports

    def test_newer_ones_are_found_anew_and_that_is_said(self):
        _, reports = self.open_saved(part("parts.stored").VERSION + 1)
        self.assertEqual([kind for kind, _ in reports], ["WARNING", "INFO"])
        self.assertIn("from a newer version of Partwheel", reports[0][1])
