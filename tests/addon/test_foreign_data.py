# SPDX-License-Identifier: GPL-3.0-or-later
"""Data under our names that others have written, or a later version: never an error, and the user's own is left alone."""

import json

import bpy
import numpy as np
from common import MeshTest, part, read_off, snapshot

# What a custom property can be.
VALUES = (7, 7.5, True, [1, 2], [1.5], {"a": 1}, {}, b"", b"\xff\x00", "", "{", "[]", "3", "null", '"a"', "[" * 100_000,
          '{"0": 5}', '{"0": null}', '{"x": "a"}', '{"0": ""}', '{"-1": "a"}', '{"' + "9" * 5000 + '": "a"}',
          '{"0": "\\ud800"}', '{"0": "a\\u0000b"}', '{"0": "' + "x" * 64 + '"}', '{"²": "a"}', '{"0": {"a": 1}}')


class Foreign(MeshTest):
    def parts(self, obj):
        self.assertEqual(bpy.ops.mesh.partwheel_parts(to={"VERTEX_GROUPS"}, count=0), {"FINISHED"})
        names = [group.name for group in obj.vertex_groups]
        self.assertEqual(len(names), len(set(names)))
        self.assertNotIn("", names)
        obj.vertex_groups.clear()
        return names

    def test_names_of_parts(self):
        """Whatever is there instead of ours, names are found anew; ours are kept."""
        obj = self.add(*read_off("cross_quad"))
        fresh = self.parts(obj)
        stored = part("cut.saved_cut")
        for value in VALUES:
            with self.subTest(str(value)[:40]):
                obj.data[stored.NAMES_PROPERTY] = obj.data[stored.KEEPS_BORDERS_PROPERTY] = value
                self.assertEqual(self.parts(obj), fresh)
        self.assertEqual(bpy.ops.mesh.partwheel_parts(to=set(), count=0), {"FINISHED"})
        obj.data[stored.NAMES_PROPERTY] = json.dumps({**json.loads(obj.data[stored.NAMES_PROPERTY]), "0": "Stem", "77": "nobody's"})
        self.assertIn("Stem", self.parts(obj))

    def test_numbers_of_parts(self):
        obj = self.add(*read_off("cross_quad"))
        self.parts(obj)
        name, count = part("cut.saved_cut").ATTRIBUTE, len(obj.data.polygons)
        for values in (np.full(count, -2**31), np.arange(count) - 5, np.full(count, 2**31 - 1)):
            obj.data.attributes[name].data.foreach_set("value", values.astype(np.int32))
            self.parts(obj)
        for kind, domain in (("FLOAT", "FACE"), ("INT", "POINT"), ("BOOLEAN", "CORNER"), ("FLOAT_COLOR", "POINT")):
            with self.subTest(kind, domain=domain):
                obj.data.attributes.remove(obj.data.attributes[name])
                obj.data.attributes.new(name, kind, domain)
                self.parts(obj)

    def test_parts_that_came_with_a_file(self):
        """No bytes of ours, or cut off anywhere: they are left aside, and the parts found anew."""
        stored, registry = part("parts.stored"), part("parts.registry")
        obj = self.add(*read_off("cross_quad"))
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        entry = registry.find_entry(obj.data)
        packed = stored.pack(entry.built_for, entry.hierarchy)
        cut_off = [packed[:size] for size in (1, 7, 8, 12, 44, 59, 60, 61, len(packed) // 2, len(packed) - 1)]
        for value in (*VALUES, *cut_off, packed + b"\1", packed[::-1]):
            registry.forget(obj.data)
            obj.data[stored.PROPERTY] = value
            part("parts.files").on_load()
            self.assertIsNone(registry.get_hierarchy(snapshot(obj)))
            self.assertEqual(bpy.ops.mesh.partwheel_select.poll(), False)
            self.assertEqual(bpy.ops.mesh.partwheel_clear.poll(), False)
        self.assertNotIn(stored.PROPERTY, obj.data)

    def test_attributes_of_another_type(self):
        """Under names that Blender or we use: face sets, caps, parts that are remembered."""
        obj = self.add(*read_off("hand"))
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        names = [part("pick.writers").FACE_SET, part("solid.solids").CAP_ATTRIBUTE, "part: hand"]
        for kind, domain in (("FLOAT", "FACE"), ("INT", "POINT"), ("FLOAT_VECTOR", "CORNER")):
            for name in names:
                if name in obj.data.attributes:
                    obj.data.attributes.remove(obj.data.attributes[name])
                obj.data.attributes.new(name, kind, domain)
            with self.subTest(kind, domain=domain):
                self.assertEqual(part("related.named_parts").part_names(obj.data), [])
                self.assertEqual(bpy.ops.mesh.partwheel_parts(to={"FACE_SETS"}, count=3), {"FINISHED"})
                layer = obj.data.attributes[names[0]]
                self.assertEqual((layer.data_type, layer.domain), ("INT", "FACE"))
                values = np.zeros(len(layer.data), np.int32)
                layer.data.foreach_get("value", values)
                self.assertEqual(len(set(values.tolist())), 3)
                self.assertEqual(bpy.ops.mesh.partwheel_copy(node=part("parts.registry").get_hierarchy(snapshot(obj)).parent[0]), {"FINISHED"})
                bpy.data.objects.remove(bpy.context.active_object)
                bpy.context.view_layer.objects.active = obj
