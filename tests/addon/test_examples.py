# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of docs/scripting.md that need Blender, as they stand there."""

import re
import shlex
import tempfile
from pathlib import Path

import bmesh
import bpy
import numpy as np
from common import MeshTest, only_in, part, read_off, selected

PAGE = Path(__file__).resolve().parents[2] / "docs" / "scripting.md"
ACTIVE, BY_API = [text for text in re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.S)
                  if "bpy" in text or "import api" in text]


def run(text, **scope):
    exec(compile(text, str(PAGE), "exec"), scope)
    return scope


def with_42(name, face):
    """(vertices, polygons) of an OFF file, in which this face, at the end of a limb, has become number 42."""
    vertices, polygons = read_off(name)
    polygons[42], polygons[face] = polygons[face], polygons[42]
    return vertices, polygons


@only_in("newest")
class Examples(MeshTest):
    def test_shell_command(self):
        commands = re.findall(r"^    blender --command partwheel (.+)$", PAGE.read_text("utf-8"), re.M)
        self.assertTrue(commands)
        with tempfile.TemporaryDirectory() as folder:
            for command in commands:
                name, file, *options = shlex.split(command)
                self.add(*read_off("hand"))
                path = str(Path(folder) / file)
                bpy.ops.wm.save_as_mainfile(filepath=path)
                self.assertEqual(part("command").run([name, path, *options]), 0, command)
                bpy.ops.wm.open_mainfile(filepath=path)
                numbers = bpy.data.objects[0].data.attributes["part"].data
                self.assertEqual({number.value for number in numbers}, set(range(8)))

    def test_operator(self):
        obj = self.add(*with_42("hand", 468))
        run(ACTIVE, bpy=bpy)
        self.assertEqual(bpy.context.mode, "EDIT_MESH")
        picked = part("api").part(obj, 42, level=2)
        self.assertEqual(selected(obj), set(np.asarray(picked.faces).tolist()))
        self.assertTrue(0 < len(picked.faces) < len(obj.data.polygons))

    def test_functions(self):
        other = self.add(*read_off("bear"), "other")
        obj = self.add(*with_42("homer", 425), "obj")
        faces, area = len(obj.data.polygons), sum(polygon.area for polygon in obj.data.polygons)
        scope = run(BY_API, obj=obj, other=other)
        arm, copy, whole = scope["arm"], scope["copy"], scope["whole"]
        self.assertTrue(0 < len(arm.faces) < faces)
        mesh = bmesh.new()
        mesh.from_mesh(copy.data)
        self.assertTrue(all(edge.is_manifold for edge in mesh.edges))
        mesh.free()
        self.assertEqual((len(scope["labels"]), len(np.unique(scope["labels"]))), (faces, 8))
        created = [candidate for candidate in bpy.data.objects if candidate not in (obj, other, copy, scope["head"])]
        self.assertEqual(sum(created_object.type == "MESH" for created_object in created), len(whole))
        self.assertGreater(len(obj.vertex_groups), 1)
        nodes, scores = zip(*scope["ranked"])
        self.assertEqual(sorted(scores, reverse=True), list(scores))
        self.assertNotEqual(sum(polygon.area for polygon in obj.data.polygons), area)  # another arm
        built = scope["build"].result()
        largest = int(built.wheel(0)[0][-1])
        self.assertEqual(len(built.faces(largest)), len(other.data.polygons))
