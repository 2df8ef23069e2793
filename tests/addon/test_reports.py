# SPDX-License-Identifier: GPL-3.0-or-later
"""Public bug reports of comparable add-ons, each on a small model. The comment before a test names the reports."""

import bpy
import numpy
from common import BOX, MeshTest, package, part


class Reports(MeshTest):
    def two_boxes(self, name="model"):
        """Two boxes apart, so two parts."""
        points, polygons = BOX
        return self.add(points + [(x + 3, y, z) for x, y, z in points],
                        polygons + [tuple(corner + 8 for corner in polygon) for polygon in polygons], name)

    def objects(self, obj):
        part("api").build(obj)
        return part("api").write(obj, part("api").cut(obj, 2), {"OBJECTS"}).objects

    # MMD-Blender/blender_mmd_tools 171, teamneoneko/Cats-Blender-Plugin 64
    def test_parts_to_objects_a_second_time(self):
        obj = self.two_boxes()
        for _ in range(2):
            hulls = self.objects(obj)
            self.assertEqual([len(hull.data.polygons) for hull in hulls], [6, 6])
        self.assertEqual(len(obj.data.polygons), 12)

    # MMD-Blender/blender_mmd_tools 309, danielboxer/UVgami 11
    def test_empty_slots_of_materials_are_kept(self):
        obj = self.two_boxes()
        for material in (None, bpy.data.materials.new("second"), None):
            obj.data.materials.append(material)
        obj.data.polygons.foreach_set("material_index", [1, 2] * 6)
        for child in self.objects(obj):
            self.assertEqual([slot and slot.name for slot in child.data.materials], [None, "second", None])
            self.assertEqual(sorted(polygon.material_index for polygon in child.data.polygons), [1] * 3 + [2] * 3)
        part("api").write(obj, part("api").cut(obj, 2), {"SEAMS"})
        self.assertEqual([polygon.material_index for polygon in obj.data.polygons], [1, 2] * 6)

    # mattedicksoncom/blender-xatlas 13, ksami/QRemeshify 2, Roblox/roblox-blender-plugin 67
    def test_any_name_of_an_object(self):
        for name in ("Test-Test 10x20x30mm [1234]", "*", "a/../b", "\u96f6\u4ef6"):
            obj = self.two_boxes(name)
            self.assertEqual(len(self.objects(obj)), 2)
            for engine in ("UNREAL", "GODOT", "UNITY"):
                names = [hull.name for hull in part("api").convex(obj, hulls=2, engine=engine)]
                self.assertEqual(len(set(names)), 2)
            self.assertEqual(obj.name, name)
        longest = 255 if bpy.app.version >= (5, 0, 0) else 63  # bytes in a name
        obj = self.two_boxes("x" * longest)
        self.assertEqual(len(self.objects(obj)), 2)
        with self.assertRaisesRegex(package().Error, "too long.*shorten it"):
            part("api").convex(obj, hulls=2)

    # Any2HRTF/Mesh2HRTF 154, Takanu/Capsule 7
    def test_a_mesh_of_several_objects(self):
        obj = self.two_boxes()
        other = self.link(bpy.data.objects.new("other", obj.data))
        other.location.x = 10
        self.add(*BOX, "third")
        bpy.context.view_layer.objects.active = obj
        self.assertEqual(len(self.objects(obj)), 2)
        self.assertEqual((other.data, len(obj.data.polygons)), (obj.data, 12))

    # mrdoob/three.js 6276, KhronosGroup/glTF-Blender-IO 517
    def test_hidden_objects_and_excluded_collections(self):
        obj = self.two_boxes()
        obj.hide_set(True)
        self.assertEqual(len(self.objects(obj)), 2)
        collection = bpy.data.collections.new("excluded")
        bpy.context.scene.collection.children.link(collection)
        for each in obj.users_collection:
            each.objects.unlink(obj)
        collection.objects.link(obj)
        bpy.context.view_layer.layer_collection.children["excluded"].exclude = True
        self.assertEqual(len(self.objects(obj)), 2)
        bpy.data.collections.remove(collection)

    # Weisl/simple_collider 452
    def test_hulls_of_a_scaled_and_mirrored_object_stand_on_it(self):
        for scale in ((1, 1, 1), (2, 0.5, 3), (-1, 2, 1)):
            obj = self.two_boxes()
            obj.scale, obj.rotation_euler, obj.location = scale, (0.3, 0.5, 0.7), (5, 6, 7)
            bpy.context.view_layer.update()
            part("api").build(obj)
            for primitives in (0.0, 0.01):
                hulls = part("api").convex(obj, hulls=2, primitives=primitives)
                bpy.context.view_layer.update()
                places = [{tuple(round(x, 4) for x in hull.matrix_world @ vertex.co) for vertex in hull.data.vertices}
                          for hull in hulls]
                expected = {tuple(round(x, 4) for x in obj.matrix_world @ vertex.co) for vertex in obj.data.vertices}
                self.assertEqual(len(hulls), 2)
                difference = numpy.abs(numpy.array(sorted(set.union(*places))) - numpy.array(sorted(expected))).max()
                self.assertLess(difference, 1e-3)

    # animate1978/MB-Lab 110, ScanMountGoat/xenoblade_blender 57
    def test_locked_and_empty_vertex_groups_stay(self):
        obj = self.two_boxes()
        part("api").build(obj)
        cut = part("api").cut(obj, 2)
        mine, empty = obj.vertex_groups.new(name="mine"), obj.vertex_groups.new(name="empty")
        mine.add([0], 0.25, "REPLACE")
        mine.lock_weight = empty.lock_weight = True
        names = part("api").write(obj, cut, {"VERTEX_GROUPS"}).names
        self.assertEqual({group.name for group in obj.vertex_groups}, {"mine", "empty", *names})
        self.assertEqual((mine.weight(0), mine.lock_weight, empty.lock_weight), (0.25, True, True))
        sums = [sum(weight.weight for weight in vertex.groups if obj.vertex_groups[weight.group].name in names)
                for vertex in obj.data.vertices]
        self.assertLess(max(abs(total - 1) for total in sums), 1e-6)

    # leukbaars/DreamUV 27, danielboxer/UVgami 5
    def test_seams_of_triangles_quads_and_polygons(self):
        points = [(x, y, z) for z in (0, 1) for x, y in ((2, 2), (1, 0.5), (0, 2), (0, 0), (2, 0))] + [(1, 0.2, 2)]
        obj = self.add(points, [(4, 3, 2, 1, 0), *((i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5) for i in range(5)),
                                *((i + 5, (i + 1) % 5 + 5, 10) for i in range(5))])
        part("api").build(obj)
        part("api").write(obj, part("api").cut(obj, 1), {"SEAMS"}, unwrap=True)
        uv = numpy.empty(2 * len(obj.data.loops))
        obj.data.uv_layers.active.data.foreach_get("uv", uv)
        self.assertTrue(numpy.isfinite(uv).all() and numpy.ptp(uv) > 0.1)
        self.assertTrue(any(edge.use_seam for edge in obj.data.edges))
