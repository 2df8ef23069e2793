# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user sees while the native library can't be loaded, and of parts saved by other versions."""

import contextlib
import io
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

    def test_the_library_loads_once_its_file_exists(self):
        """Without a restart: what failed is not remembered."""
        self.add(*read_off("hand"))
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertRaises(RuntimeError, bpy.ops.mesh.partwheel_build)
        self.path.write_bytes(self.installed.read_bytes())
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
