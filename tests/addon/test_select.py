# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_select without a window: which faces are selected after each level, and the hand-off."""

import random

import bmesh
import bpy
from common import BOX, MeshTest, flags, only_in, part, read_off, selected, snapshot


class Select(MeshTest):
    def pick(self, face, level=0, **more):
        self.assertEqual(bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", face_index=face, level=level, **more),
                         {"FINISHED"})

    @only_in("newest")
    def test_every_level_of_real_meshes(self):
        for name in ("hand", "homer", "cross_quad", "P", "corner_poly"):
            with self.subTest(name):
                obj = self.add(*read_off(name))
                h = self.hierarchy(obj)
                self.edit(obj)
                for face in random.Random(name).sample(range(len(h.order)), 5):
                    stops, start = h.wheel(face)
                    for index, stop in enumerate(stops):
                        self.pick(face, index - start)
                        self.assertEqual(selected(obj), set(h.faces(stop).tolist()))
                        self.assertEqual(bmesh.from_edit_mesh(obj.data).faces.active.index, face)
                    self.pick(face, 10**6)
                    self.assertEqual(len(selected(obj)), len(h.order))
                    self.pick(face, -(10**6))
                    self.assertEqual(selected(obj), set(h.faces(stops[0]).tolist()))
                bpy.ops.object.mode_set(mode="OBJECT")

    def always_all_off(self):
        """For this test most is deselected at once also in small meshes, where one by one would be quicker."""
        self.addCleanup(setattr, part("mesh.selection"), "DESELECT_ALL_COST", part("mesh.selection").DESELECT_ALL_COST)
        part("mesh.selection").DESELECT_ALL_COST = 0

    def test_other_objects_in_edit_mode_keep_what_they_should(self):
        self.always_all_off()
        objects = [self.add(*BOX, name) for name in ("one", "two")]
        for obj in objects:
            obj.select_set(True)
        self.edit(objects[1])
        for extend in (True, False):
            for obj in objects:
                bm = bmesh.from_edit_mesh(obj.data)
                bm.faces.ensure_lookup_table()
                bm.faces[1].select_set(True)
            selections = part("mesh.selection").Selections(map(snapshot, objects))
            for faces in (range(6), [2]):  # so most of it is deselected again
                selections.select(objects[0], faces, 2, extend=extend)
            self.assertEqual(selected(objects[0]), {1, 2} if extend else {2})
            self.assertEqual(selected(objects[1]), {1} if extend else set())
            selections.restore()
            self.assertEqual([selected(obj) for obj in objects], [{1}, {1}])

    def test_vertex_and_edge_modes_look_as_blender_selects(self):
        obj = self.add(*read_off("hand"))
        h = self.hierarchy(obj)
        stops, start = h.wheel(700)
        self.always_all_off()
        for kinds in (("VERT",), ("EDGE",), ("FACE",), ("VERT", "FACE"), ("EDGE", "FACE")):
            Selection = part("mesh.selection").Selection
            bm = self.edit(obj, kinds)
            expected = []
            for stop in stops:
                bpy.ops.mesh.select_all(action="DESELECT")
                bm.faces.ensure_lookup_table()
                for face in h.faces(stop):
                    bm.faces[face].select_set(True)
                bm.select_flush_mode()
                expected.append(flags(obj)[:3])
            bpy.ops.mesh.select_all(action="DESELECT")
            selection = Selection(snapshot(obj))
            order = [*range(len(stops)), *reversed(range(len(stops))), len(stops) - 1, 0]
            for index in order:
                selection.select(obj, h.faces(stops[index]))
                with self.subTest(f"{kinds} stop {index}"):
                    self.assertEqual(flags(obj)[:3], expected[index])
            totals = obj.data.total_vert_sel, obj.data.total_edge_sel, obj.data.total_face_sel
            self.assertEqual(totals, tuple(map(sum, expected[0])))
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_restoring_is_exact(self):
        obj = self.add(*read_off("hand"))
        h = self.hierarchy(obj)
        stops, _ = h.wheel(700)
        draw = random.Random(6)
        for kind in ("VERT", "EDGE", "FACE"):
            bm = self.edit(obj, (kind,))
            elements = {"VERT": bm.verts, "EDGE": bm.edges, "FACE": bm.faces}[kind]
            elements.ensure_lookup_table()
            for index in draw.sample(range(len(elements)), 60):
                elements[index].select_set(True)
                bm.select_history.add(elements[index])
            bm.faces.ensure_lookup_table()
            bm.faces.active = bm.faces[11]
            bm.select_flush_mode()
            before = flags(obj)
            selection = part("mesh.selection").Selection(snapshot(obj))
            for last in stops:
                for stop in (*stops, last):
                    selection.select(obj, h.faces(stop), 700)
                self.assertNotEqual(flags(obj), before)
                selection.restore(snapshot(obj))
                self.assertEqual(flags(obj), before)
                self.assertEqual((obj.data.total_vert_sel, obj.data.total_edge_sel, obj.data.total_face_sel),
                                 tuple(map(sum, before[:3])))
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_hidden_faces_are_never_selected(self):
        obj = self.add(*read_off("hand"))
        h = self.hierarchy(obj)
        stops, start = h.wheel(701)
        for kinds in (("FACE",), ("VERT",), ("EDGE",)):
            bm = self.edit(obj, kinds)
            bm.faces.ensure_lookup_table()
            hidden = {index for index in range(2390) if index % 5}
            for index in hidden:
                bm.faces[index].hide_set(True)
            for level, stop in enumerate(stops, -start):
                self.pick(701, level)
                visible = [bm.faces[index] for index in set(h.faces(stop).tolist()) - hidden]
                for kind, sequence, expected in (("FACE", bm.faces, visible),
                                               ("EDGE", bm.edges, [e for face in visible for e in face.edges]),
                                               ("VERT", bm.verts, [v for face in visible for v in face.verts])):
                    actual = {element.index for element in sequence if element.select}
                    # Blender adds what lies between selected vertices or edges to these, but never what is hidden.
                    added = actual - {element.index for element in expected}
                    self.assertEqual(len(actual) - len(added), len(set(expected)))
                    sequence.ensure_lookup_table()
                    self.assertFalse(any(sequence[index].hide for index in actual))
                    if kind == kinds[0]:
                        self.assertFalse(added)
            bpy.ops.mesh.reveal(select=False)
            bpy.ops.object.mode_set(mode="OBJECT")
