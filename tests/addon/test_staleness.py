# SPDX-License-Identifier: GPL-3.0-or-later
"""When a hierarchy is kept, shared, left aside and let go: after every kind of edit, never one of another topology."""

import bmesh
import bpy
from common import BOX, MeshTest, WritesBack, part, read_off, selected


class Staleness(MeshTest):
    def setUp(self):
        super().setUp()
        self.State = part("parts.registry").State

    def hierarchy_in_use(self, obj):
        """The hierarchy in use, after a check that it is the very one that a build would give."""
        h = part("parts.registry").get_hierarchy(obj)
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

    def test_moved_vertices_keep_it(self):
        obj = self.built()
        first = self.hierarchy_in_use(obj)
        obj.data.vertices[0].co.z += 0.01
        obj.data.update()
        bpy.context.view_layer.update()
        self.assertEqual(self.state(obj), self.State.MOVED)
        self.assertIs(part("parts.registry").get_hierarchy(obj), first)
        self.assertEqual(self.state(obj), self.State.MOVED)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.assertEqual(self.state(obj), self.State.FITS)
        self.assertIsNot(self.hierarchy_in_use(obj), first)

    def test_moved_vertices_in_edit_mode(self):
        obj = self.built("hand")
        first = self.hierarchy_in_use(obj)
        bm = self.edit(obj)
        bm.verts.ensure_lookup_table()
        bm.verts[0].co.x += 0.01
        self.assertIs(part("parts.registry").get_hierarchy(obj), first)
        self.assertEqual(self.state(obj), self.State.MOVED)
        bm.verts[0].co.x += 0.01
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(self.state(obj), self.State.MOVED)

    def test_to_ask_for_it_is_no_edit(self):
        """Blender writes its edits back into the mesh for that, and tells of geometry. What was made for hovering stays.
        """
        obj = self.built()
        bm = self.edit(obj)
        prepared = part("pick.view_cache").get_view_cache
        part("parts.registry").get_hierarchy(obj)
        first, revision = prepared(obj), part("mesh.mesh_state").get_mesh_state(obj.data).revision
        part("parts.registry").get_hierarchy(obj)
        self.assertEqual(part("mesh.mesh_state").get_mesh_state(obj.data).revision, revision)
        self.assertIs(prepared(obj), first)
        bm.verts.ensure_lookup_table()
        bm.verts[0].co.x += 0.01
        bmesh.update_edit_mesh(obj.data)
        part("parts.registry").get_hierarchy(obj)
        self.assertNotEqual(part("mesh.mesh_state").get_mesh_state(obj.data).revision, revision)
        self.assertIsNot(prepared(obj), first)

    def test_a_step_reads_the_mesh_once(self):
        obj = self.built("hand")
        self.edit(obj)
        registry, one_reading = part("parts.registry"), part("mesh.arrays").use_snapshot

        def query():
            with WritesBack() as writes:
                registry.get_hierarchy(obj)
                part("parts.builds").is_being_built(obj)
                part("pick.view_cache").get_view_cache(obj).get_hierarchy(obj)
                part("mesh.selection").Selection(obj)
                registry.get_hierarchy(obj)
            return writes.count

        with one_reading():
            with one_reading():
                self.assertEqual(query(), 1)
            self.assertEqual(query(), 0)
        self.assertGreater(query(), 1)  # each by itself, for in between anything may have happened
        with one_reading():
            self.assertEqual(query(), 1)

    def test_what_changes_in_a_step_is_seen(self):
        """Told of by Blender, or by whoever changes it."""
        obj = self.built("hand")
        bm = self.edit(obj)
        arrays = part("mesh.arrays")
        bm.verts.ensure_lookup_table()

        def moved():
            bm.verts[0].co.x += 0.01

        with arrays.use_snapshot():
            seen = [arrays.current_fingerprint(obj)]
            moved()
            self.assertEqual(arrays.current_fingerprint(obj), seen[0])  # nobody said so
            bmesh.update_edit_mesh(obj.data)
            bpy.context.view_layer.update()
            seen.append(arrays.current_fingerprint(obj))
            moved()
            part("mesh.mesh_state").invalidate(part("mesh.mesh_state").Reason.OWN_EDIT, obj.data)
            seen.append(arrays.current_fingerprint(obj))
            moved()
        seen.append(arrays.current_fingerprint(obj))
        self.assertEqual(len(set(seen)), 4)
        self.assertEqual(len({fingerprint.topology for fingerprint in seen}), 1)
        with arrays.use_snapshot():
            arrays.current_fingerprint(obj)
            edge = next(edge for edge in bm.edges if edge.calc_face_angle() < 0.1)
            self.assertTrue(bmesh.ops.rotate_edges(bm, edges=[edge])["edges"])
            bmesh.update_edit_mesh(obj.data)
            bpy.context.view_layer.update()
            self.assertIsNone(part("parts.registry").get_hierarchy(obj))

    def test_undo_in_a_step_is_seen(self):
        obj = self.built("hand")
        name = obj.name
        self.edit(obj)
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.transform.translate(value=(1, 0, 0))
        bpy.ops.ed.undo_push(message="moved")
        arrays = part("mesh.arrays")
        with arrays.use_snapshot():
            moved = arrays.current_fingerprint(obj)
            bpy.ops.ed.undo()
            obj = bpy.data.objects[name]
            self.assertNotEqual(arrays.current_fingerprint(obj), moved)

    def test_what_a_step_selects_is_seen(self):
        obj = self.built("hand")
        self.edit(obj)
        Selection = part("mesh.selection").Selection
        with part("mesh.arrays").use_snapshot():
            first = Selection(obj)
            first.select(obj, [3, 4, 5])
            second = Selection(obj)
            self.assertEqual(set(second.initial["FACE"].nonzero()[0].tolist()), {3, 4, 5})
            second.select(obj, [7])
            second.restore(obj)
            self.assertEqual(selected(obj), {3, 4, 5})
            first.restore(obj)
            self.assertFalse(Selection(obj).initial["FACE"].any())

    def test_other_edits_do_not(self):
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

    def test_same_counts_but_other_polygons(self):
        obj = self.built("box")
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.flip_normals()
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(self.state(obj), self.State.CHANGED)
        self.assertIsNone(self.hierarchy_in_use(obj))

    def test_another_triangulation_of_the_same_counts(self):
        obj = self.built("hand")
        bm = self.edit(obj)
        edge = next(edge for edge in bm.edges if edge.calc_face_angle() < 0.1)
        self.assertTrue(bmesh.ops.rotate_edges(bm, edges=[edge])["edges"])
        bmesh.update_edit_mesh(obj.data)
        self.assertIsNone(self.hierarchy_in_use(obj))
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(self.state(obj), self.State.CHANGED)

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

    def test_each_mesh_has_its_own(self):
        one, two = self.add(*BOX, "one"), self.add(*read_off("cross_quad"), "two")
        bpy.ops.mesh.partwheel_build()
        self.assertIsNone(self.hierarchy_in_use(one))
        self.assertEqual(len(self.hierarchy_in_use(two).order), len(two.data.polygons))
        bpy.context.view_layer.objects.active = one
        bpy.ops.mesh.partwheel_build()
        self.assertEqual(len(self.hierarchy_in_use(one).order), 6)

    def test_users_of_one_mesh_share_it(self):
        one = self.built("box")
        self.assertIs(self.hierarchy_in_use(self.link(bpy.data.objects.new("two", one.data))), self.hierarchy_in_use(one))

    def test_a_duplicate_has_it_at_once(self):
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

    def test_the_same_topology_elsewhere_is_another_mesh(self):
        one = self.built()
        bpy.ops.object.duplicate()
        two = bpy.context.object
        two.data.vertices[0].co.z += 0.01
        self.assertIsNotNone(self.hierarchy_in_use(one))
        self.assertIsNone(self.hierarchy_in_use(two))

    def test_join_and_separate(self):
        one = self.built()
        faces = len(one.data.polygons)
        two = self.add(*BOX)
        two.location.x = 100
        bpy.ops.mesh.partwheel_build()
        one.select_set(True)
        bpy.context.view_layer.objects.active = one
        bpy.ops.object.join()
        self.assertEqual(len(one.data.polygons), faces + 6)
        self.assertEqual(self.state(one), self.State.CHANGED)
        self.assertIsNone(self.hierarchy_in_use(one))
        bpy.ops.mesh.partwheel_build()
        self.assertEqual(len(self.hierarchy_in_use(one).order), faces + 6)
        self.edit(one)
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.separate(type="LOOSE")
        bpy.ops.object.mode_set(mode="OBJECT")
        for obj in bpy.context.scene.objects:
            hierarchy_in_use = self.hierarchy_in_use(obj)  # none, or those that the very same mesh had before
            self.assertIn(hierarchy_in_use and len(hierarchy_in_use.order), {None, len(obj.data.polygons)})
            bpy.context.view_layer.objects.active = obj
            bpy.ops.mesh.partwheel_build()
            self.assertEqual(len(self.hierarchy_in_use(obj).order), len(obj.data.polygons))

    def test_deleted_and_made_anew_under_the_same_name(self):
        obj = self.built("box")
        name = obj.data.name
        bpy.data.meshes.remove(obj.data)
        other = self.add(*read_off("cross_quad"))
        other.data.name = name
        self.assertEqual(other.data.name, name)
        self.assertIsNone(self.hierarchy_in_use(other))

    def test_those_of_removed_meshes_are_let_go(self):
        obj = self.built("box")
        bpy.data.meshes.remove(obj.data)
        self.add(*read_off("cross_quad"), "another")
        bpy.ops.mesh.partwheel_build()
        self.assertEqual(len(part("parts.registry").list_entries()), 1)

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
        for mode in ("OBJECT", "EDIT"):
            bpy.ops.ed.undo()
            obj = bpy.context.active_object
            self.assertEqual((obj.mode, self.state(obj)), (mode, self.State.FITS))
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
            own = registry.get_hierarchy(obj)
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
                self.assertIs(registry.get_hierarchy(obj), own)
                self.assertEqual(part("parts.picks").get_pick(obj) is not None, mode == "EDIT")
                bpy.ops.ed.redo()
                obj = bpy.data.objects[name]
                self.assertEqual(self.state(obj), self.State.NONE)
                self.assertIsNone(registry.get_hierarchy(obj))
            part("api").build(obj)
            self.assertEqual(self.state(obj), self.State.FITS)
            self.assertNotIn(registry.CLEARED_ATTRIBUTE, obj.data.attributes)
            self.setUp()

    def test_clear(self):
        obj = self.built()
        bpy.ops.mesh.partwheel_clear()
        self.assertEqual(self.state(obj), self.State.NONE)
        self.assertIsNone(self.hierarchy_in_use(obj))
        self.assertFalse(bpy.ops.mesh.partwheel_clear.poll())
