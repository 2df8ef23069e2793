# SPDX-License-Identifier: GPL-3.0-or-later
"""Building for a mesh: the right arrays, nothing changed, named errors."""

import types
from pathlib import Path

import bmesh
import bpy
import common
import numpy as np
from common import BOX, NO_AREA, SHEET, MeshTest, flags, only_in, package, part, read_off, selected


def contents(mesh):
    """All that a mesh holds, attributes by name included."""
    values = [[tuple(vertex.co) for vertex in mesh.vertices], [tuple(edge.vertices) for edge in mesh.edges],
              [(tuple(polygon.vertices), polygon.select, polygon.hide) for polygon in mesh.polygons],
              [(vertex.select, vertex.hide) for vertex in mesh.vertices]]
    return values, sorted((attribute.name, attribute.domain, attribute.data_type) for attribute in mesh.attributes)


class Build(MeshTest):
    def current_hierarchy(self, obj):
        return part("parts.registry").get_hierarchy(obj)

    def check_arrays(self, obj):
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        if obj.mode == "EDIT":
            obj.update_from_editmode()
        expected, h = self.hierarchy(obj), self.current_hierarchy(obj)
        self.assertEqual(h.save(), expected.save())
        self.assertEqual(len(h.order), len(obj.data.polygons))

    def fail_to_build(self):
        """What the operator says."""
        with self.assertRaises(RuntimeError) as caught:
            bpy.ops.mesh.partwheel_build()
        return str(caught.exception)

    def test_a_vertex_that_an_error_names_is_selected(self):
        """Alone, as one undo step, also if it is hidden; in Object Mode the message has its number."""
        obj = self.add(*BOX)
        obj.data.vertices[5].co.y = float("nan")
        self.assertIn("Vertices that are the cause: 1, numbers 5. To select them", self.fail_to_build())
        for hidden in (False, True):
            bm = self.edit(obj)
            bm.faces.ensure_lookup_table()
            bm.faces[0].select_set(True)
            bm.verts.ensure_lookup_table()
            if hidden:
                bm.verts[5].hide_set(True)
            before = flags(obj), tuple(bpy.context.tool_settings.mesh_select_mode)
            bpy.ops.ed.undo_push(message="before")
            self.assertIn("Vertices that are the cause are selected: 1.", self.fail_to_build())
            bm = bmesh.from_edit_mesh(obj.data)
            bm.verts.ensure_lookup_table()
            self.assertEqual([vert.index for vert in bm.verts if vert.select], [5])
            self.assertFalse(bm.verts[5].hide or any(face.select for face in bm.faces))
            self.assertTrue(bpy.context.tool_settings.mesh_select_mode[0])
            bpy.ops.ed.undo()
            obj = bpy.context.object
            self.assertEqual((flags(obj), tuple(bpy.context.tool_settings.mesh_select_mode)), before)
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_faces_that_an_error_names_are_selected(self):
        """By an error of the library's own, since all meshes that would get one are repaired here."""
        vertices, polygons = BOX
        obj = self.add([*vertices[:7], (0.3, 0.3, -1)], polygons)  # a corner comes out on the other side
        obj.location = 10, 0, 0
        bpy.context.view_layer.update()
        surface = part("mesh.arrays").read_surface(obj.data)
        with self.assertRaises(package().PartwheelError) as caught:
            package().Hierarchy.build(*surface[:3], surface.face_count, fill_methods=package().FillMethod.EXACT)
        faces = caught.exception.faces
        self.assertEqual(len(faces), 2)
        point_out = part("mesh.faulty_elements").point_out
        self.assertRegex(point_out(obj, caught.exception), rf"cause: 2, numbers {faces[0]}, {faces[1]}. They are near 1\d[.\d]*, ")
        self.edit(obj)
        self.assertIn("selected: 2", point_out(obj, caught.exception))
        self.assertEqual(selected(obj), set(faces))
        self.assertEqual(point_out(obj, ValueError("another")), "")

    @only_in("newest")
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

    def test_a_large_mesh_is_built_coarse_unless_exactly_is_asked_for(self):
        rings, around = 28, 36
        builds, job = part("parts.builds"), part("parts.builds").Job
        self.addCleanup(setattr, builds, "Job", job)
        builds.Job = lambda *surface, **options: job(*surface, exact_triangles=1000, **options)  # large are those of 2000
        turn = np.linspace(0, np.pi, rings + 2)[1:-1]
        angle = np.linspace(0, 2 * np.pi, around, endpoint=False)
        bumps = 1 + 0.01 * np.sin(7 * turn)[:, None] * np.sin(5 * angle)
        vertices = np.stack([bumps * np.sin(turn)[:, None] * np.cos(angle), bumps * np.sin(turn)[:, None] * np.sin(angle),
                             bumps * np.cos(turn)[:, None]], axis=2).reshape(-1, 3)
        ring, k = np.meshgrid(np.arange(rings - 1) * around, np.arange(around), indexing="ij")
        n = (k + 1) % around
        quads = np.stack([ring + k, ring + around + k, ring + around + n, ring + n], axis=2).reshape(-1, 4).tolist()
        last = (rings - 1) * around
        obj = self.add(vertices, [*quads, list(range(around)), list(range(last + around - 1, last - 1, -1))])
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        h = self.current_hierarchy(obj)
        self.assertEqual(len(h.order), len(obj.data.polygons))
        self.assertGreater(h.summary.proxy_triangles, 0)
        copy = part("api").copy_part(obj, h.wheel(7)[0][-2])
        ends = np.bincount([index for polygon in copy.data.polygons for index in polygon.edge_keys and [
            copy.data.loops[loop].edge_index for loop in polygon.loop_indices]])
        self.assertEqual(set(ends.tolist()), {2})  # closed
        self.assertEqual(part("api").build(obj, full_resolution=True).summary.proxy_triangles, 0)

    def test_quality(self):
        obj = self.add(*read_off("hand"))
        bpy.ops.mesh.partwheel_build()
        plain = len(self.current_hierarchy(obj).tetrahedra)
        bpy.ops.mesh.partwheel_build(quality=1.4)
        self.assertGreater(len(self.current_hierarchy(obj).tetrahedra), plain)

    def refusal(self):
        with self.assertRaises(RuntimeError) as refused:
            bpy.ops.mesh.partwheel_build()
        return str(refused.exception)

    def test_suzanne_is_mended_and_the_report_says_so(self):
        bpy.ops.mesh.primitive_monkey_add()
        obj = bpy.context.object
        before = contents(obj.data)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        h = self.current_hierarchy(obj)
        self.assertEqual((h.summary.shells, h.summary.fill_method), (3, "repaired"))  # the eyes are shells of their own
        self.assertIn("3 shells: ", h.notes)
        self.assertEqual(sorted(h.order), list(range(len(obj.data.polygons))))
        self.assertEqual(contents(obj.data), before)

    @only_in("oldest", "newest")
    def test_a_sheet_is_filled_as_a_thin_solid(self):
        obj = self.add(*SHEET)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        h = self.current_hierarchy(obj)
        self.assertEqual((len(h.order), h.summary.sheets), (len(SHEET[1]), 1))
        self.assertTrue(any("Thin solids" in text for text in self.panel()[1]))

    @only_in("oldest", "newest")
    def test_the_panel_shows_how_many_shells_there_are(self):
        vertices, faces = BOX
        self.add([*vertices, *((x + 5, y, z) for x, y, z in vertices)],
                 [*faces, *(tuple(corner + len(vertices) for corner in face) for face in faces)])
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.assertTrue(any("2 shells" in text for text in self.panel()[1]))

    def panel(self):
        """The operators that the panel offers, with the properties that they are given; and its texts."""
        offered, texts = {}, []

        class Layout:
            operator_context = ""

            def operator(self, name, text="", icon=""):
                return offered.setdefault((name, text), types.SimpleNamespace())

            def label(self, text="", icon="", **_):
                texts.append(text)

            def separator(self):
                pass

            def column(self, **_):
                return self

            row = column

        panel = types.SimpleNamespace(layout=Layout())
        context = types.SimpleNamespace(
            region=types.SimpleNamespace(width=300),
            preferences=types.SimpleNamespace(system=types.SimpleNamespace(ui_scale=1.0)),
            **{name: getattr(bpy.context, name) for name in ("mode", "active_object", "edit_object", "scene")})
        bpy.types.VIEW3D_PT_partwheel.draw(panel, context)
        return offered, texts

    def test_a_mesh_without_area_is_refused(self):
        obj = self.add(*NO_AREA)
        self.assertIn("no area", self.refusal())
        self.assertIsNone(self.current_hierarchy(obj))

    def test_a_mesh_without_faces(self):
        for vertices in ([], [(0, 0, 0), (1, 0, 0)]):
            self.add(vertices, [])
            self.assertIn("no faces", self.refusal())

    def test_not_a_mesh(self):
        bpy.ops.object.camera_add()
        self.assertFalse(bpy.ops.mesh.partwheel_build.poll())
        self.assertFalse(bpy.ops.mesh.partwheel_select.poll())

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
        first = self.current_hierarchy(obj)
        self.edit(obj)
        self.assertIs(self.current_hierarchy(obj), first)
        self.check_arrays(obj)
        self.assertAlmostEqual(self.current_hierarchy(obj).summary.volume, 1)  # the basis, in both modes

    def test_numpy_views_stay_valid_after_the_hierarchy_is_dropped(self):
        obj = self.add(*read_off("hand"))
        bpy.ops.mesh.partwheel_build()
        order = self.current_hierarchy(obj).order
        expected = order.copy()
        part("parts.registry").forget(obj.data)
        bpy.ops.mesh.partwheel_build()
        self.assertTrue(np.array_equal(order, expected))

    def test_the_core_is_the_installed_one(self):
        library = package("library").load()
        root = bpy.utils.user_resource("EXTENSIONS" if bpy.app.version >= (4, 2, 0) else "SCRIPTS")
        self.assertIn(Path(root).resolve(), Path(library._name).resolve().parents)
        self.assertEqual(package().version(), "0.1.0")
        self.assertTrue(common.MODULE in bpy.context.preferences.addons)
