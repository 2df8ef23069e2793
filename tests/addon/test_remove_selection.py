# SPDX-License-Identifier: GPL-3.0-or-later
"""Remove and Swap take only what is selected out of a mesh, whatever undo, the user or a script made of the selection."""

import bmesh
import bpy
from common import MeshTest, part, read_off, selected, snapshot


class RemoveSelection(MeshTest):
    def begin(self, kinds=("FACE",)):
        self.obj = self.add(*read_off("hand"))
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        bpy.ops.ed.undo_push(message="built")
        self.edit(self.obj, kinds)
        bpy.ops.ed.undo_push(message="Edit Mode")

    def pick(self, face, **options):
        self.assertEqual(bpy.ops.mesh.partwheel_select(face_index=face, **options), {"FINISHED"})
        bpy.ops.ed.undo_push(message="Select Part")

    def choose(self, faces, active):
        """As a user selects faces."""
        bpy.ops.mesh.select_all(action="DESELECT")
        bm = bmesh.from_edit_mesh(self.obj.data)
        bm.faces.ensure_lookup_table()
        for face in faces:
            bm.faces[face].select_set(True)
        bm.faces.active = bm.faces[active]
        bmesh.update_edit_mesh(self.obj.data)
        bpy.ops.ed.undo_push(message="Select")

    def undo(self):
        bpy.ops.ed.undo()
        self.obj = bpy.context.view_layer.objects.active

    def refused(self, operator=bpy.ops.mesh.partwheel_remove):
        before = len(self.obj.data.polygons), bpy.context.mode
        with self.assertRaisesRegex(RuntimeError, "exactly one whole part.*Pick the part again"):
            operator()
        self.assertEqual((len(self.obj.data.polygons), bpy.context.mode), before)

    def removed(self, faces):
        """Exactly these."""
        centers = {tuple(round(value, 4) for value in self.obj.data.polygons[face].center) for face in faces}
        self.assertEqual(bpy.ops.mesh.partwheel_remove(), {"FINISHED"})
        bpy.ops.object.mode_set(mode="OBJECT")
        caps = {face.center[:] for face in self.obj.data.polygons}
        left = {tuple(round(value, 4) for value in center) for center in caps}
        self.assertFalse(centers & left)

    def test_undo_to_another_selection_of_the_same_size(self):
        """With the same active face: by these alone it was taken for the first pick."""
        self.begin()
        self.pick(700)
        first = selected(self.obj)
        other = [face for face in range(len(self.obj.data.polygons)) if face not in first][:len(first) - 1] + [700]
        self.choose(other, 700)
        self.pick(1100)
        second = part("parts.picks").get_pick(snapshot(self.obj))
        self.undo()
        self.assertEqual(selected(self.obj), set(other))
        self.assertEqual(part("parts.picks").get_pick(snapshot(self.obj)), second)
        self.refused()
        self.undo()
        self.assertEqual(selected(self.obj), first)
        self.assertEqual(part("parts.picks").get_pick(snapshot(self.obj)).face, 700)
        self.removed(first)

    def test_undo_restores_the_pick_in_object_mode(self):
        self.begin()
        bpy.ops.object.mode_set(mode="OBJECT")
        for face in (700, 1100):
            self.assertEqual(bpy.ops.object.partwheel_pick(face_index=face), {"FINISHED"})
            bpy.ops.ed.undo_push(message="Pick")
        next(face for face in self.obj.data.polygons if not face.select).select = True
        self.refused()
        self.undo()
        self.assertEqual(part("parts.picks").get_pick(snapshot(self.obj)).face, 700)
        self.removed([face.index for face in self.obj.data.polygons if face.select])

    def test_undo_to_no_selection_leaves_no_pick(self):
        self.begin()
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.ed.undo_push(message="Object Mode")
        self.assertEqual(bpy.ops.object.partwheel_pick(face_index=700), {"FINISHED"})
        bpy.ops.ed.undo_push(message="Pick")
        self.assertIsNotNone(part("parts.picks").get_pick(snapshot(self.obj)))
        self.undo()
        self.assertFalse(any(face.select for face in self.obj.data.polygons))
        self.assertIsNone(part("parts.picks").get_pick(snapshot(self.obj)))

    def test_more_or_less_than_the_part(self):
        """Added, taken away, nothing; and what a pick has added to what was selected."""
        self.begin()
        self.pick(700)
        first = selected(self.obj)
        for faces in (first | {1100}, first - {700}, {}):
            self.choose(faces, 700)
            self.refused()
            self.refused(bpy.ops.mesh.partwheel_swap)
        self.choose(first, 700)
        self.pick(1100, extend=True)
        self.refused()
        self.choose(first | {1100}, 700)
        snapshot(self.obj).state.pick = None  # by its selection alone it would pass for the part
        self.refused()
        self.choose(first, 700)
        self.removed(first)

    def test_each_select_mode(self):
        for kinds in (("VERT",), ("EDGE",), ("FACE",), ("VERT", "FACE")):
            with self.subTest(kinds):
                self.setUp()
                self.begin(kinds)
                self.pick(700)
                self.removed(part("parts.registry").get_hierarchy(snapshot(self.obj)).faces(part("parts.picks").get_pick(snapshot(self.obj)).node).tolist())

    def test_a_border_in_creases_and_hidden_faces(self):
        self.begin()
        self.pick(700, snap=True)
        self.assertEqual(bpy.ops.mesh.partwheel_remove(), {"FINISHED"})
        self.setUp()
        self.begin()
        self.pick(700)
        bm = bmesh.from_edit_mesh(self.obj.data)
        bm.faces.ensure_lookup_table()
        bm.faces[700].hide_set(True)
        bmesh.update_edit_mesh(self.obj.data)
        self.assertEqual(bpy.ops.mesh.partwheel_remove(), {"FINISHED"})

    def test_a_script_names_the_part(self):
        self.begin()
        self.pick(700)
        self.choose({}, 700)
        node = part("parts.picks").get_pick(snapshot(self.obj)).node
        self.assertEqual(bpy.ops.mesh.partwheel_remove(node=node), {"FINISHED"})
