# SPDX-License-Identifier: GPL-3.0-or-later
"""Floating fragments below a size are deleted, and all else of the mesh stays."""

import bpy
import numpy
from common import BOX, MeshTest, part, read_off
from test_coincident import split


class LooseBits(MeshTest):
    def littered(self, vertices, polygons, scales=(0.01, 0.03)):
        """(an object: the model, split along its edges, with a box of each of these sizes beside it; its own counts)"""
        vertices, polygons, _ = split(vertices, polygons, "along the axes")
        counts = len(vertices), len(polygons)
        low, high = (extreme(numpy.array(vertices), axis=0) for extreme in (numpy.min, numpy.max))
        size = float(numpy.linalg.norm(high - low))
        for number, scale in enumerate(scales):
            start = len(vertices)
            vertices = [*vertices, *(tuple(high - (number + 1) * 0.1 * (high - low) + scale * size / 3 ** 0.5 * numpy.array(corner))
                                     for corner in BOX[0])]
            polygons = [*polygons, *(tuple(start + corner for corner in polygon) for polygon in BOX[1])]
        return self.add(vertices, polygons), counts

    def test_fragments_below_the_size_are_deleted(self):
        """In Object Mode and in Edit Mode; those with hidden faces stay there; the one piece of a mesh stays."""
        for mode in ("OBJECT", "EDIT"):
            obj, (vertex_count, face_count) = self.littered(*read_off("hand"))
            for name in ("Basis", "gone", "key"):
                obj.shape_key_add(name=name, from_mix=False)
            obj.shape_key_remove(obj.data.shape_keys.key_blocks["gone"])
            obj.data.shape_keys.key_blocks["key"].data[0].co.x += 1
            bpy.ops.object.mode_set(mode=mode)
            api = part("api")
            with self.assertRaisesRegex(ValueError, "Choose a larger size"):
                api.delete_loose_bits(obj, 0.001)
            self.assertEqual(api.delete_loose_bits(obj, 0.02), 6)
            self.assertEqual(obj.mode, mode)
            self.assertEqual(api.delete_loose_bits(obj, 0.04), 6)
            with self.assertRaisesRegex(ValueError, "It is in one piece"):
                api.delete_loose_bits(obj, 1)
            bpy.ops.object.mode_set(mode="OBJECT")
            mesh = obj.data
            self.assertEqual((len(mesh.vertices), len(mesh.polygons)), (vertex_count, face_count))
            offsets = [numpy.array(point.co) - numpy.array(vertex.co) for point, vertex in zip(mesh.shape_keys.key_blocks["key"].data, mesh.vertices)]
            numpy.testing.assert_allclose(offsets[0], (1, 0, 0), atol=1e-4)
            self.assertEqual(abs(numpy.array(offsets[1:])).max(), 0)
            self.setUp()

    def test_hidden_fragments_stay_in_edit_mode(self):
        obj, (_, face_count) = self.littered(*read_off("hand"))
        for mode, hidden in (("EDIT", True), ("OBJECT", False)):
            obj.data.polygons[face_count].hide = hidden
            bpy.ops.object.mode_set(mode=mode)
            before = len(obj.data.polygons)
            self.assertEqual(part("api").delete_loose_bits(obj, 0.04), 6)
            bpy.ops.object.mode_set(mode="OBJECT")
            self.assertEqual(len(obj.data.polygons), before - 6)
