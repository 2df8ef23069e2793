# SPDX-License-Identifier: GPL-3.0-or-later
"""Building for a mesh: the right arrays, nothing changed, named errors."""


import bmesh
import bpy
from common import BOX, MeshTest, flags, package, part, read_off, selected, snapshot


def contents(mesh):
    """All that a mesh holds, attributes by name included."""
    values = [[tuple(vertex.co) for vertex in mesh.vertices], [tuple(edge.vertices) for edge in mesh.edges],
              [(tuple(polygon.vertices), polygon.select, polygon.hide) for polygon in mesh.polygons],
              [(vertex.select, vertex.hide) for vertex in mesh.vertices]]
    return values, sorted((attribute.name, attribute.domain, attribute.data_type) for attribute in mesh.attributes)


class Build(MeshTest):
    def current_hierarchy(self, obj):
        return part("parts.registry").get_hierarchy(snapshot(obj))

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
