# SPDX-License-Identifier: GPL-3.0-or-later
"""Building for a mesh: the right arrays, nothing changed, named errors, and when a hierarchy is kept."""

import tempfile
from pathlib import Path

import bpy
import common
import numpy as np
from common import BOX, MeshTest, part, read_off


def contents(mesh):
    """All that a mesh holds, attributes by name included."""
    values = [[tuple(vertex.co) for vertex in mesh.vertices], [tuple(edge.vertices) for edge in mesh.edges],
              [(tuple(polygon.vertices), polygon.select, polygon.hide) for polygon in mesh.polygons],
              [(vertex.select, vertex.hide) for vertex in mesh.vertices]]
    return values, sorted((attribute.name, attribute.domain, attribute.data_type) for attribute in mesh.attributes)


class Build(MeshTest):
    def kept(self, obj):
        return part("session").hierarchy(obj)

    def check_arrays(self, obj):
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        if obj.mode == "EDIT":
            obj.update_from_editmode()
        expected, h = self.hierarchy(obj), self.kept(obj)
        self.assertEqual(h.save(), expected.save())
        self.assertEqual(len(h.order), len(obj.data.polygons))

    def test_triangles_quads_and_ngons(self):
        for name in ("hand", "cube_quad", "cross_quad", "P", "corner_poly", "homer"):
            with self.subTest(name):
                obj = self.add(*read_off(name))
                self.check_arrays(obj)
                self.edit(obj)
                self.check_arrays(obj)
                bpy.ops.object.mode_set(mode="OBJECT")

    def test_the_mesh_is_not_changed(self):
        obj = self.add(*read_off("hand"))
        obj.data.uv_layers.new(name="UVMap")
        before = contents(obj.data)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.assertEqual(contents(obj.data), before)
        self.edit(obj)
        bpy.ops.object.mode_set(mode="OBJECT")
        before = contents(obj.data)
        bpy.ops.object.mode_set(mode="EDIT")
        self.assertEqual(bpy.ops.mesh.partwheel_build(quality=1.5), {"FINISHED"})
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(contents(obj.data), before)

    def test_quality(self):
        obj = self.add(*read_off("hand"))
        bpy.ops.mesh.partwheel_build()
        plain = len(self.kept(obj).tetrahedra)
        bpy.ops.mesh.partwheel_build(quality=1.4)
        self.assertGreater(len(self.kept(obj).tetrahedra), plain)

    def refusal(self):
        with self.assertRaises(RuntimeError) as refused:
            bpy.ops.mesh.partwheel_build()
        return str(refused.exception)

    def test_suzanne_is_open_and_the_report_says_so(self):
        bpy.ops.mesh.primitive_monkey_add()
        message = self.refusal()
        self.assertIn("open", message)
        self.assertIn("Fill", message)
        self.assertIsNone(self.kept(bpy.context.object))

    def test_a_mesh_without_faces(self):
        for vertices in ([], [(0, 0, 0), (1, 0, 0)]):
            self.add(vertices, [])
            self.assertIn("empty", self.refusal())

    def test_not_a_mesh(self):
        bpy.ops.object.camera_add()
        self.assertFalse(bpy.ops.mesh.partwheel_build.poll())
        self.assertFalse(bpy.ops.mesh.partwheel_select.poll())

    def test_moving_vertices_keeps_it_and_other_edits_do_not(self):
        obj = self.add(*read_off("hand"))
        bpy.ops.mesh.partwheel_build()
        first = self.kept(obj)
        bm = self.edit(obj)
        bm.verts.ensure_lookup_table()
        bm.verts[0].co.x += 0.01
        self.assertIs(self.kept(obj), first)
        self.assertTrue(part("session").peek(obj)[1])
        bm.faces.ensure_lookup_table()
        bm.faces[0].select_set(True)
        bpy.ops.mesh.poke()
        self.assertIsNone(self.kept(obj))
        bpy.ops.mesh.partwheel_select(face_index=0)
        self.assertEqual(len(self.kept(obj).order), 2390 + 2)

    def test_same_counts_but_other_polygons_is_stale(self):
        obj = self.add(*BOX)
        bpy.ops.mesh.partwheel_build()
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.flip_normals()
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertIsNone(self.kept(obj))

    def test_each_mesh_has_its_own(self):
        one, two = self.add(*BOX, "one"), self.add(*read_off("cross_quad"), "two")
        bpy.ops.mesh.partwheel_build()
        self.assertIsNone(self.kept(one))
        self.assertEqual(len(self.kept(two).order), len(two.data.polygons))
        bpy.context.view_layer.objects.active = one
        bpy.ops.mesh.partwheel_build()
        self.assertEqual(len(self.kept(one).order), 6)

    def test_users_of_one_mesh_share_it(self):
        one = self.add(*BOX)
        bpy.ops.mesh.partwheel_build()
        self.assertIs(self.kept(self.link(bpy.data.objects.new("two", one.data))), self.kept(one))

    def test_those_of_removed_meshes_are_let_go(self):
        obj = self.add(*BOX)
        bpy.ops.mesh.partwheel_build()
        bpy.data.meshes.remove(obj.data)
        bpy.context.view_layer.update()
        self.add(*BOX)
        bpy.ops.mesh.partwheel_build()
        self.assertEqual(len(part("session")._entries), 1)

    def test_modifiers_do_not_count(self):
        obj = self.add(*BOX)
        obj.modifiers.new("Subdivision", "SUBSURF").levels = 2
        self.check_arrays(obj)

    def test_shape_keys(self):
        obj = self.add(*BOX)
        obj.shape_key_add(name="Basis")
        key = obj.shape_key_add(name="Long")
        for point in key.data:
            point.co.x *= 3
        obj.active_shape_key_index = 1
        self.check_arrays(obj)
        first = self.kept(obj)
        self.edit(obj)
        self.assertIs(self.kept(obj), first)
        self.check_arrays(obj)
        self.assertAlmostEqual(self.kept(obj).summary.volume, 1)  # the basis, in both modes

    def test_linked_meshes(self):
        obj = self.add(*BOX)
        with tempfile.TemporaryDirectory() as directory:
            path = str(Path(directory) / "library.blend")
            bpy.data.libraries.write(path, {obj})
            self.setUp()
            with bpy.data.libraries.load(path, link=True) as (there, here):
                here.objects = there.objects
            obj = self.link(bpy.data.objects[0])
            self.assertIsNotNone(obj.library)
            self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
            self.assertEqual(len(self.kept(obj).order), 6)

    def test_opening_a_file_forgets(self):
        self.add(*BOX)
        bpy.ops.mesh.partwheel_build()
        with tempfile.TemporaryDirectory() as directory:
            path = str(Path(directory) / "saved.blend")
            bpy.ops.wm.save_as_mainfile(filepath=path)
            self.assertTrue(part("session")._entries)
            bpy.ops.wm.open_mainfile(filepath=path)
        self.assertFalse(part("session")._entries)
        bpy.context.view_layer.objects.active = bpy.data.objects["model"]
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})

    def test_numpy_views_stay_valid_after_the_hierarchy_is_dropped(self):
        obj = self.add(*read_off("hand"))
        bpy.ops.mesh.partwheel_build()
        order = self.kept(obj).order
        expected = order.copy()
        part("session")._entries.clear()
        bpy.ops.mesh.partwheel_build()
        self.assertTrue(np.array_equal(order, expected))

    def test_the_core_is_the_installed_one(self):
        library = part("core.library").load()
        root = bpy.utils.user_resource("EXTENSIONS" if bpy.app.version >= (4, 2, 0) else "SCRIPTS")
        self.assertIn(Path(root).resolve(), Path(library._name).resolve().parents)
        self.assertEqual(part("core").version(), "0.1.0")
        self.assertTrue(common.MODULE in bpy.context.preferences.addons)
