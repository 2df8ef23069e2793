# SPDX-License-Identifier: GPL-3.0-or-later
"""When a hierarchy is kept, shared, left aside and let go: after every kind of edit, never one of another topology."""

from unittest import mock

import bmesh
import bpy
from common import BOX, MeshTest, part, read_off, snapshot


class Staleness(MeshTest):
    def setUp(self):
        super().setUp()
        self.State = part("parts.registry").State

    def hierarchy_in_use(self, obj):
        """The hierarchy in use, after a check that it is the very one that a build would give."""
        h = part("parts.registry").get_hierarchy(snapshot(obj))
        if h:
            self.assertEqual(h.save(), self.hierarchy(obj).save())
        return h

    def state(self, obj):
        return part("parts.registry").get_state(obj.data)[0]

    def built(self, name="cross_quad"):
        obj = self.add(*(BOX if name == "box" else read_off(name)))
        self.assertEqual(self.state(obj), self.State.NONE)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.assertEqual(self.state(obj), self.State.FITS)
        return obj

    # ---- Edits

    def test_moving_vertices_keeps_the_hierarchy(self):
        obj = self.built()
        first = self.hierarchy_in_use(obj)
        obj.data.vertices[0].co.z += 0.01
        obj.data.update()
        bpy.context.view_layer.update()
        self.assertEqual(self.state(obj), self.State.MOVED)
        self.assertIs(part("parts.registry").get_hierarchy(snapshot(obj)), first)
        self.assertEqual(self.state(obj), self.State.MOVED)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.assertEqual(self.state(obj), self.State.FITS)
        self.assertIsNot(self.hierarchy_in_use(obj), first)

    def test_other_edits_invalidate_the_hierarchy(self):
        obj = self.built("hand")
        bm = self.edit(obj)
        bm.faces.ensure_lookup_table()
        bm.faces[0].select_set(True)
        bpy.ops.mesh.poke()
        self.assertEqual(self.state(obj), self.State.CHANGED)
        self.assertIsNone(self.hierarchy_in_use(obj))
        bpy.ops.mesh.partwheel_select(face_index=0)
        self.assertEqual(self.state(obj), self.State.FITS)
        self.assertEqual(len(self.hierarchy_in_use(obj).order), 2390 + 2)

    def test_other_faces_of_equal_count_invalidate_the_hierarchy(self):
        obj = self.built("hand")
        bm = self.edit(obj)
        edge = next(edge for edge in bm.edges if edge.calc_face_angle() < 0.1)
        self.assertTrue(bmesh.ops.rotate_edges(bm, edges=[edge])["edges"])
        bmesh.update_edit_mesh(obj.data)
        self.assertIsNone(self.hierarchy_in_use(obj))
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(self.state(obj), self.State.CHANGED)

    def test_the_same_corners_in_other_polygons_invalidate_the_hierarchy(self):
        """Two triangles and two pentagons become four quads: as many vertices, corners and polygons, in the same order."""
        points = [(x, 0, y) for x in range(4) for y in range(4)]
        corners = (0, 4, 1, 5, 4, 8, 9, 13, 12, 2, 6, 7, 3, 10, 14, 15)
        digests = set()
        for sizes in ((3, 3, 5, 5), (4, 4, 4, 4)):
            ends = [sum(sizes[:k + 1]) for k in range(4)]
            obj = self.add(points, [corners[end - size:end] for size, end in zip(sizes, ends)])
            self.assertEqual([loop.vertex_index for loop in obj.data.loops], list(corners))
            digests.add(snapshot(obj).fingerprint.topology)
        self.assertEqual(len(digests), 2)

    # ---- Undo and redo

    def test_undo_and_redo_in_object_mode(self):
        obj = self.built()
        faces = len(obj.data.polygons)
        name = obj.name
        bpy.ops.ed.undo_push(message="built")
        bm = bmesh.new()
        bm.from_mesh(obj.data)
        bmesh.ops.triangulate(bm, faces=bm.faces)
        bm.to_mesh(obj.data)
        bm.free()
        bpy.ops.ed.undo_push(message="triangulated")
        self.assertEqual(self.state(obj), self.State.CHANGED)
        for _ in range(2):
            bpy.ops.ed.undo()
            obj = bpy.data.objects[name]
            self.assertEqual((len(obj.data.polygons), self.state(obj)), (faces, self.State.FITS))
            self.assertEqual(len(self.hierarchy_in_use(obj).order), faces)
            bpy.ops.ed.redo()
            obj = bpy.data.objects[name]
            self.assertEqual((len(obj.data.polygons), self.state(obj)), (2 * faces, self.State.CHANGED))
            self.assertIsNone(self.hierarchy_in_use(obj))
        bpy.ops.mesh.partwheel_build()
        self.assertEqual(len(self.hierarchy_in_use(obj).order), 2 * faces)
        bpy.ops.ed.undo()  # to the mesh of before: its parts are remembered
        self.assertEqual(len(self.hierarchy_in_use(bpy.data.objects[name]).order), faces)

    def test_undo_and_redo_in_edit_mode(self):
        obj = self.built("hand")
        name = obj.name
        self.edit(obj)
        bpy.ops.mesh.partwheel_select(face_index=700)
        bpy.ops.ed.undo_push(message="picked")
        bpy.ops.mesh.delete(type="FACE")
        bpy.ops.ed.undo_push(message="deleted")
        self.assertIsNone(self.hierarchy_in_use(obj))
        bpy.ops.ed.undo()
        obj = bpy.data.objects[name]
        self.assertEqual(len(self.hierarchy_in_use(obj).order), 2390)
        bpy.ops.ed.redo()
        self.assertIsNone(self.hierarchy_in_use(bpy.data.objects[name]))

    # ---- Several objects

    def test_a_duplicate_shares_the_hierarchy(self):
        one = self.built()
        bpy.ops.object.duplicate()
        two = bpy.context.object
        self.assertNotEqual(one.data, two.data)
        self.assertIs(self.hierarchy_in_use(two), self.hierarchy_in_use(one))
        two.data.vertices[0].co.z += 0.01  # one's is not touched by that
        bpy.context.view_layer.update()
        self.assertEqual((self.state(one), self.state(two)), (self.State.FITS, self.State.MOVED))
        bpy.ops.mesh.partwheel_build()
        self.assertIsNot(self.hierarchy_in_use(two), self.hierarchy_in_use(one))

    # ---- Clear

    def test_after_undo_in_edit_mode_parts_fit_again(self):
        """Where the changed mesh was looked at in Object Mode meanwhile."""
        obj = self.built()
        bpy.ops.ed.undo_push(message="start")
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.ed.undo_push(message="edit")
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.ed.undo_push(message="object")
        bpy.ops.object.modifier_add(type="TRIANGULATE")
        obj.modifiers.new("more", "SUBSURF")
        bpy.ops.object.modifier_apply(modifier="more")
        bpy.ops.ed.undo_push(message="changed")
        self.assertEqual(self.state(obj), self.State.CHANGED)
        for looks in (True, False):  # in Object Mode on the way, which finds it, too
            for mode in ("OBJECT", "EDIT"):
                bpy.ops.ed.undo()
                obj = bpy.context.active_object
                self.assertEqual(obj.mode, mode)
                if looks or mode == "EDIT":
                    self.assertEqual(self.state(obj), self.State.FITS)
            bpy.ops.ed.redo()
            bpy.ops.ed.redo()
            self.assertEqual(self.state(bpy.context.active_object), self.State.CHANGED)

    def test_undo_brings_cleared_parts_back(self):
        """In each mode; redo clears them again; a build ends that, and so does each mesh for itself."""
        registry = part("parts.registry")
        for mode in ("OBJECT", "EDIT", "SCULPT"):
            obj = self.built()
            name = obj.name
            bpy.ops.object.mode_set(mode=mode)
            for step in ("start", "before"):
                bpy.ops.ed.undo_push(message=step)
            own = registry.get_hierarchy(snapshot(obj))
            if mode == "EDIT":
                bpy.ops.mesh.partwheel_select(face_index=0)
                bpy.ops.ed.undo_push(message="selected")
            bpy.ops.mesh.partwheel_clear()
            self.assertEqual([self.state(obj), registry.find_hierarchy(obj.data)], [self.State.NONE, None])
            self.assertIsNone(part("parts.picks").get_pick_for_poll(obj))
            bpy.ops.ed.undo_push(message="cleared")
            for count in range(2):
                bpy.ops.ed.undo()
                obj = bpy.data.objects[name]
                self.assertEqual(obj.mode, mode)
                self.assertEqual(self.state(obj), self.State.FITS)
                self.assertIs(registry.get_hierarchy(snapshot(obj)), own)
                self.assertEqual(part("parts.picks").get_pick(snapshot(obj)) is not None, mode == "EDIT")
                bpy.ops.ed.redo()
                obj = bpy.data.objects[name]
                self.assertEqual(self.state(obj), self.State.NONE)
                self.assertIsNone(registry.get_hierarchy(snapshot(obj)))
            part("api").build(obj)
            self.assertEqual(self.state(obj), self.State.FITS)
            self.assertNotIn(registry.CLEARED_ATTRIBUTE, obj.data.attributes)
            self.setUp()


class Snapshots(MeshTest):
    """What one step reads of a mesh in Edit Mode."""

    def setUp(self):
        super().setUp()
        self.obj = self.add(*read_off("hand"))
        bpy.ops.mesh.partwheel_build()
        self.bm = self.edit(self.obj)
        bpy.context.view_layer.update()

    def count(self, step):
        """How often a step writes edits back, and hashes the mesh."""
        arrays = part("mesh.arrays")
        with (mock.patch.object(arrays, "update_mesh", wraps=arrays.update_mesh) as writes,
              mock.patch.object(arrays, "compute_fingerprint", wraps=arrays.compute_fingerprint) as hashes):
            step()
        return writes.call_count, hashes.call_count

    def test_a_step_writes_back_and_hashes_once(self):
        def step():
            now = snapshot(self.obj)
            part("parts.registry").get_hierarchy(now)
            part("parts.picks").resolve_node(now, 0)
            part("parts.builds").is_being_built(now)
            part("mesh.selection").Selections.of_edited(bpy.context, now)

        self.assertEqual(self.count(step), (1, 1))
        self.assertEqual(self.count(step), (1, 1))  # the next one reads anew

    def test_changes_without_a_report_are_seen_by_the_next_step(self):
        before = snapshot(self.obj).fingerprint
        self.bm.verts.ensure_lookup_table()
        self.bm.verts[0].co.x += 1
        self.assertNotEqual(snapshot(self.obj).fingerprint, before)

    def test_reports_decide_where_they_are_trusted(self):
        trusting = lambda: part("mesh.snapshot").MeshSnapshot(self.obj, trust_reports=True).update_mesh()
        snapshot(self.obj).update_mesh()
        self.assertEqual(self.count(trusting), (0, 0))
        bmesh.update_edit_mesh(self.obj.data)
        bpy.context.view_layer.update()
        self.assertEqual(self.count(trusting), (1, 0))
