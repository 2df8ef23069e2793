# SPDX-License-Identifier: GPL-3.0-or-later
"""What wants parts finds them by itself: at once for scripts, beside Blender's own work in a window; and goes on then."""

import bpy
from common import MeshTest, part, read_off


class First(MeshTest):
    def setUp(self):
        super().setUp()
        self.obj = self.add(*read_off("hand"))
        self.registry = part("parts.registry")

    def select(self, faces):
        """In Edit Mode, these faces of a mesh without parts."""
        self.registry.forget_all()
        bm = self.edit(self.obj)
        bm.faces.ensure_lookup_table()
        for face in faces.tolist():
            bm.faces[face].select = True

    def limb(self):
        """(a node, its faces)"""
        hierarchy = part("api").build(self.obj)
        stops, start = hierarchy.wheel(700)
        return int(stops[start]), hierarchy.faces(int(stops[start]))

    def test_what_is_selected_tells_the_part(self):
        node, faces = self.limb()
        copied = part("solid.composition").create_part_object(self.obj, part("api").build(self.obj), node, snap=True)
        expected = len(copied.data.polygons)
        bpy.data.objects.remove(copied)
        self.select(faces)
        self.assertEqual(bpy.ops.mesh.partwheel_copy(), {"FINISHED"})
        self.assertEqual(len(bpy.context.active_object.data.polygons), expected)

    def test_what_is_selected_may_be_no_part(self):
        _, faces = self.limb()
        self.select(faces[::3])
        with self.assertRaisesRegex(RuntimeError, "selection is not a part"):
            bpy.ops.mesh.partwheel_remove()
        self.assertEqual(self.obj.mode, "EDIT")

    def test_without_a_selection_nothing_is_found_in_vain(self):
        with self.assertRaisesRegex(RuntimeError, "No part is picked"):
            bpy.ops.mesh.partwheel_copy()
        self.assertIsNone(self.registry.find_hierarchy(self.obj.data))

    def test_split(self):
        self.assertEqual(bpy.ops.mesh.partwheel_split(parts=3), {"FINISHED"})
        self.assertEqual(len(bpy.data.objects), 4)

    def test_all_selected_meshes_queue(self):
        other, beside = self.add(*read_off("homer"), "other"), self.add(*read_off("homer"), "beside")
        for obj, is_selected in ((self.obj, True), (other, True), (beside, False)):
            obj.select_set(is_selected)
        bpy.context.view_layer.objects.active = self.obj
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.assertEqual([self.registry.find_hierarchy(obj.data) is None for obj in (self.obj, other, beside)],
                         [False, False, True])


class Imported(MeshTest):
    """What is found for what was imported; tests/gui/scenarios/imports.py tells imports from other operations."""

    def test_selected_meshes_once_each(self):
        obj, other, beside = (self.add(*read_off("hand"), name) for name in ("hand", "other", "beside"))
        shared = bpy.data.objects.new("shared", obj.data)
        bpy.context.scene.collection.objects.link(shared)
        for target in (obj, other, shared, beside):
            target.select_set(target is not beside)
        part("parts.registry").forget_all()
        lacking = part("ui.on_import").find_without_parts(bpy.context.view_layer)
        self.assertEqual(len(lacking), 2)
        self.assertEqual({missing.data for missing in lacking}, {obj.data, other.data})
        self.assertEqual(bpy.ops.mesh.partwheel_imported(), {"FINISHED"})
        known = part("parts.registry").find_hierarchy
        self.assertEqual([known(target.data) is None for target in (obj, other, beside)], [False, False, True])
        self.assertEqual(part("ui.on_import").find_without_parts(bpy.context.view_layer), [])

    def test_a_mesh_without_area_is_no_error_that_pops_up(self):
        line = self.add([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
        line.select_set(True)
        self.assertEqual(bpy.ops.mesh.partwheel_imported(), {"CANCELLED"})
        self.assertIsNone(part("parts.registry").find_hierarchy(line.data))
