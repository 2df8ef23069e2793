# SPDX-License-Identifier: GPL-3.0-or-later
"""blender --command partwheel builds and cuts the meshes of a file. Its function is called; Blender 4.2 registers it."""

import contextlib
import io
import os
import tempfile

import bpy
from common import BOX, NO_AREA, MeshTest, part, read_off, snapshot


class Command(MeshTest):
    def setUp(self):
        super().setUp()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path, self.other = os.path.join(folder.name, "in.blend"), os.path.join(folder.name, "out.blend")

    def run_command(self, *words):
        """(exit code, what it printed)"""
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            code = part("command").run([*words])
        return code, printed.getvalue()

    def save(self):
        bpy.ops.wm.save_as_mainfile(filepath=self.path)

    def test_build_and_cut(self):
        self.add(*read_off("hand"), "hand")
        self.add(*BOX, "box")
        self.save()
        code, printed = self.run_command("build", self.path)
        self.assertEqual(code, 0, printed)
        self.assertIn("hand: 2390 faces", printed)
        self.assertIn("box: 6 faces", printed)
        bpy.ops.wm.open_mainfile(filepath=self.path)
        for name in ("hand", "box"):
            self.assertIsNotNone(part("parts.registry").get_hierarchy(snapshot(bpy.data.objects[name])))
        for way in ("parts", "least-concavity"):
            bpy.ops.wm.open_mainfile(filepath=self.path)
            expected = part("api").cut(bpy.data.objects["hand"], **{way.replace("-", "_"): 5}).labels.tolist()
            code, printed = self.run_command("cut", self.path, "--object", "hand", f"--{way}", "5",
                                             "--attribute", "limb", "--output", self.other)
            self.assertEqual(code, 0, printed)
            bpy.ops.wm.open_mainfile(filepath=self.other)
            actual = [value.value for value in bpy.data.objects["hand"].data.attributes["limb"].data]
            self.assertEqual(actual, expected)
            self.assertNotIn("limb", bpy.data.objects["box"].data.attributes)

    def test_each_object_is_reported_immediately(self):
        """Also into a pipe or a file: what has failed is said before the next is begun, too."""
        for name, mesh in (("a", BOX), ("b", NO_AREA), ("c", BOX)):
            self.add(*mesh, name)
        self.save()
        written, lines_so_far = io.BytesIO(), []
        api, build = part("api"), part("api").build
        self.addCleanup(setattr, api, "build", build)

        def noted(*arguments, **more):
            lines_so_far.append([line[:2] for line in written.getvalue().decode().splitlines()])
            return build(*arguments, **more)

        api.build = noted
        with contextlib.redirect_stdout(io.TextIOWrapper(written, "utf-8")):
            part("command").run(["build", self.path])
        self.assertEqual(lines_so_far, [[], ["a:"], ["a:", "b:"]])
