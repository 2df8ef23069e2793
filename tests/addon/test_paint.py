# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_paint without a window: face set, mask, vertex group, paint mask; and what is refused."""


import bmesh
import bpy
from common import MeshTest, only_in, part, read_off, snapshot


class Paint(MeshTest):
    def begin(self, mode):
        """A hand in this mode: its faces and vertices of two parts."""
        self.obj = self.add(*read_off("hand"))
        h = self.hierarchy(self.obj)
        bpy.ops.object.mode_set(mode=mode)
        self.faces, self.vertices = [], []
        for face in (900, 1100):
            stops, start = h.wheel(face)
            expected = set(h.faces(stops[start]).tolist())
            self.faces.append(expected)
            self.vertices.append({v for index in expected for v in self.obj.data.polygons[index].vertices})

    def paint(self, face=900, **more):
        self.assertEqual(bpy.ops.mesh.partwheel_paint(face_index=face, **more), {"FINISHED"})

    def sets(self):
        return [value.value for value in self.obj.data.attributes[".sculpt_face_set"].data]

    def masked(self):
        if bpy.app.version >= (4, 1):
            values = [value.value for value in self.obj.data.attributes[".sculpt_mask"].data]
        else:
            bm = bmesh.new()
            bm.from_mesh(self.obj.data)
            layer = bm.verts.layers.paint_mask.active
            values = [vertex[layer] for vertex in bm.verts]
            bm.free()
        self.assertLessEqual(set(values), {0.0, 1.0})
        return {index for index, value in enumerate(values) if value}

    def test_face_sets(self):
        self.begin("SCULPT")
        self.paint(write="FACE_SET")
        self.paint(1100, write="FACE_SET")
        self.assertEqual(self.obj.mode, "SCULPT")
        actual = self.sets()
        first, second = self.faces
        self.assertFalse(first & second)
        self.assertEqual([len({actual[index] for index in part_}) for part_ in self.faces], [1, 1])
        rest = set(range(2390)) - first - second
        self.assertEqual(len({actual[index] for index in rest}), 1)
        self.assertEqual(len(set(actual)), 3)
        self.assertEqual(part("parts.picks").get_pick(snapshot(self.obj)).face, 1100)

    def test_mask(self):
        self.begin("SCULPT")
        self.paint()
        self.assertEqual(self.masked(), self.vertices[0])
        self.paint(1100, write="MASK", extend=True)
        self.assertEqual(self.masked(), self.vertices[0] | self.vertices[1])
        self.paint(write="MASK", deselect=True)
        self.assertEqual(self.masked(), self.vertices[1] - self.vertices[0])
        self.paint()
        self.assertEqual(self.masked(), self.vertices[0])

    def group(self, index):
        """Vertices of this vertex group; all have weight 1 there."""
        actual = [(vertex.index, group.weight) for vertex in self.obj.data.vertices for group in vertex.groups
                 if group.group == index]
        self.assertLessEqual({weight for _, weight in actual}, {1})
        return {vertex for vertex, _ in actual}

    def test_vertex_group(self):
        self.begin("WEIGHT_PAINT")
        self.paint()
        self.assertEqual(self.group(0), self.vertices[0])
        self.paint(1100)
        self.assertEqual([self.group(index) for index in range(len(self.obj.vertex_groups))], self.vertices)
        node = part("parts.picks").get_pick(snapshot(self.obj)).node
        self.assertEqual(self.obj.vertex_groups.active.name, f"Part {node}")
        self.paint(extend=True)
        self.assertEqual(self.group(1), self.vertices[0] | self.vertices[1])
        self.paint(1100, deselect=True)
        self.assertEqual([self.group(0), self.group(1)], [self.vertices[0], self.vertices[0] - self.vertices[1]])

    def arm(self, locked):
        """The hand with weights of the user's."""
        self.begin("OBJECT")
        arm = self.obj.vertex_groups.new(name="Arm.L")
        arm.add(range(1197), 0.37, "REPLACE")
        arm.lock_weight = locked
        bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
        return lambda: [arm.weight(vertex) for vertex in range(1197)]

    def test_weights_of_other_groups_stay(self):
        """A part gets a vertex group of its own, also where the active one is locked or full."""
        for locked in (True, False):
            MeshTest.setUp(self)
            weights = self.arm(locked)
            before = weights()
            self.paint()
            self.paint()
            self.assertEqual(weights(), before)
            self.assertEqual([self.group(1), self.group(2)], [self.vertices[0]] * 2)

    def test_locked_groups_refuse(self):
        weights = self.arm(locked=True)
        before = weights()
        for how in ("extend", "deselect"):
            with self.assertRaisesRegex(RuntimeError, "Arm.L is locked"):
                bpy.ops.mesh.partwheel_paint(face_index=900, **{how: True})
        self.assertEqual((weights(), len(self.obj.vertex_groups)), (before, 1))

    def test_paint_mask(self):
        """In Object Mode: a paint mask that is on, in a paint mode, crashes Blender 5.0.1 without a window at the next
        update of anything."""
        self.begin("OBJECT")
        write = part("pick.writers").WRITERS["PAINT_MASK"]
        first, second = (sorted(faces) for faces in self.faces)
        for faces, how, expected in ((first, (False, False), self.faces[0]),
                                     (second, (True, False), self.faces[0] | self.faces[1]),
                                     (first, (False, True), self.faces[1])):
            write(self.obj, faces, 0, *how)
            self.assertTrue(self.obj.data.use_paint_mask)
            self.assertEqual({p.index for p in self.obj.data.polygons if p.select}, expected)

    @only_in("oldest", "newest")
    def test_masks_of_multires_levels_are_refused(self):
        self.begin("OBJECT")
        modifier = self.obj.modifiers.new("multires", "MULTIRES")
        bpy.ops.object.multires_subdivide(modifier="multires")
        modifier.sculpt_levels = 1
        self.obj.data.polygons[0].hide = True
        bpy.ops.object.mode_set(mode="SCULPT")
        with self.assertRaisesRegex(RuntimeError, "Make the part a face set"):  # the scenario visible_surface writes one
            bpy.ops.mesh.partwheel_paint(face_index=900)
        self.assertEqual(self.obj.mode, "SCULPT")
        self.assertEqual([polygon.index for polygon in self.obj.data.polygons if polygon.hide], [0])
