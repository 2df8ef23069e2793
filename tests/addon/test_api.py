# SPDX-License-Identifier: GPL-3.0-or-later
"""partwheel.api, and the part that was picked last, which other operators act on."""

import bmesh
import bpy
import numpy as np
from common import BOX, MeshTest, package, part, read_off, selected


class Api(MeshTest):
    def setUp(self):
        super().setUp()
        self.api = part("api")

    def test_build_path_faces(self):
        obj = self.add(*read_off("hand"))
        expected = self.hierarchy(obj)
        built = self.api.build(obj)
        self.assertIs(part("parts.registry").hierarchy(obj), built)
        self.assertTrue((built.parent == expected.parent).all())
        self.assertEqual(self.api.path(obj, 700).tolist(), expected.path(700).tolist())
        for node in expected.path(700).tolist():
            self.assertEqual(self.api.faces(obj, node).tolist(), expected.faces(node).tolist())

    def test_mode_of_the_preferences_unless_a_script_names_one(self):
        obj, preferences = self.add(*read_off("hand")), part("preferences").preferences()
        expected = {mode: package().Hierarchy.build(*part("mesh.arrays").surface(obj.data), mode=mode).parent.tolist()
                    for mode in package().Mode}
        self.assertNotEqual(*expected.values())
        for mode in package().Mode:
            self.addCleanup(setattr, preferences, "parts", preferences.parts)
            preferences.parts = mode.name
            self.assertEqual(self.api.build(obj).parent.tolist(), expected[mode])
            for other in package().Mode:
                self.assertEqual(self.api.build(obj, mode=other).parent.tolist(), expected[other])

    def test_builds_when_there_is_none(self):
        obj = self.add(*BOX)
        self.assertEqual(self.api.path(obj, 0)[-1], len(self.hierarchy(obj).parent) - 1)
        self.assertIs(self.api.hierarchy(obj), self.api.hierarchy(obj))

    def test_select_in_both_modes_is_what_the_operator_selects(self):
        obj = self.add(*read_off("hand"))
        for level in (-1, 0, 2, 10**6):
            self.edit(obj)
            bpy.ops.mesh.partwheel_select(face_index=700, level=level)
            expected = selected(obj)
            node = part("parts.picks").picked(obj).node
            bpy.ops.mesh.select_all(action="DESELECT")
            self.assertEqual(self.api.select(obj, 700, level), node)
            self.assertEqual(selected(obj), expected)
            bpy.ops.mesh.select_all(action="DESELECT")
            bpy.ops.object.mode_set(mode="OBJECT")
            self.assertEqual(self.api.select(obj, 700, level), node)
            self.assertEqual({p.index for p in obj.data.polygons if p.select}, expected)
            corners = {v for p in obj.data.polygons if p.select for v in p.vertices}
            self.assertEqual({v.index for v in obj.data.vertices if v.select}, corners)
            bpy.ops.object.mode_set(mode="EDIT")  # Blender agrees that this is a consistent selection
            self.assertEqual(selected(obj), expected)
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_select_leaves_hidden_faces_and_extends(self):
        obj = self.add(*read_off("hand"))
        obj.data.polygons.foreach_set("select", np.arange(2390) == 2000)
        hidden = np.arange(2390) % 3 == 0
        obj.data.polygons.foreach_set("hide", hidden)
        node = self.api.select(obj, 700, extend=True)
        expected = set(self.api.faces(obj, node).tolist()) - set(np.flatnonzero(hidden).tolist()) | {2000}
        self.assertEqual({p.index for p in obj.data.polygons if p.select}, expected)

    def test_cut(self):
        obj = self.add(*read_off("hand"))
        h = self.hierarchy(obj)
        for parts in (1, 2, 8):
            labels = self.api.cut(obj, parts=parts)
            self.assertEqual((len(labels), labels.max() < parts), (2390, True))
            self.assertEqual(labels.tolist(), h.face_labels(h.cut_parts(parts)).tolist())
            self.assertEqual(self.api.cut(obj, least_concavity=parts).tolist(),
                             h.face_labels(h.cut_least_concavity(parts)).tolist())
        self.assertEqual(self.api.cut(obj, height=0.5 * h.height[-1]).tolist(),
                         h.face_labels(h.cut_height(0.5 * h.height[-1])).tolist())
        for arguments in ({}, {"parts": 2, "height": 0.5}, {"parts": 2, "least_concavity": 2}):
            with self.assertRaises(ValueError):
                self.api.cut(obj, **arguments)

    def test_mode_paper_goes_through_the_whole_path(self):
        obj = self.add(*read_off("hand"))
        self.api.build(obj, mode=package().Mode.PAPER)
        path = self.api.path(obj, 700).tolist()
        for level in (0, 1, 5, len(path) - 1):
            self.assertEqual(self.api.select(obj, 700, level), path[level])

    def test_refusals(self):
        error = package().PartwheelError
        with self.assertRaises(ValueError):
            self.api.build(None)
        with self.assertRaises(ValueError):
            self.api.faces(self.link(bpy.data.objects.new("empty", None)), 0)
        obj = self.add(*BOX)
        with self.assertRaises(error):
            self.api.select(obj, 6)
        with self.assertRaises(error):
            self.api.faces(obj, 10**6)
        self.assertIsNone(part("parts.picks").picked(obj))


class PickedLast(MeshTest):
    def setUp(self):
        super().setUp()
        self.obj = self.add(*read_off("hand"))

    def expect(self, pick):
        """What picked() says; has_pick() must say the same."""
        found = part("parts.picks").picked(self.obj)
        self.assertEqual(found and (found.face, found.node), pick)
        self.assertEqual(part("parts.picks").picked_as_told(self.obj) is not None, pick is not None)

    def pick(self, face, level=0):
        self.assertEqual(bpy.ops.mesh.partwheel_select(face_index=face, level=level), {"FINISHED"})
        stops, start = self.h.wheel(face)
        return face, stops[start + level]

    def test_the_last_one_counts(self):
        self.h = self.hierarchy(self.obj)
        self.expect(None)
        self.edit(self.obj)
        first = self.pick(700, 1)
        self.expect(first)
        self.assertIs(part("parts.picks").picked(self.obj).hierarchy, part("parts.registry").hierarchy(self.obj))
        self.expect(self.pick(100))
        bpy.ops.object.mode_set(mode="OBJECT")
        other = self.obj
        self.obj = self.add(*BOX, "other")
        self.expect(None)
        self.obj = other
        self.expect((100, self.h.wheel(100)[0][self.h.wheel(100)[1]]))

    def test_moved_vertices_keep_it(self):
        self.h = self.hierarchy(self.obj)
        bm = self.edit(self.obj)
        pick = self.pick(700)
        bm.verts.ensure_lookup_table()
        bm.verts[0].co.x += 1
        self.expect(pick)

    def test_a_changed_mesh_or_another_hierarchy_has_none(self):
        for change in (lambda: bmesh.ops.delete(self.bm, geom=self.bm.faces[:1], context="FACES_ONLY"),
                       bpy.ops.mesh.partwheel_build, bpy.ops.mesh.partwheel_clear, part("parts.files").after_loading):
            self.setUp()
            self.h = self.hierarchy(self.obj)
            self.bm = self.edit(self.obj)
            self.expect(self.pick(700))
            self.bm.faces.ensure_lookup_table()
            change()
            self.expect(None)
