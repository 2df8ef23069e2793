# SPDX-License-Identifier: GPL-3.0-or-later
"""partwheel.api, and the part that was picked last, which other operators act on."""


import bmesh
import bpy
import numpy as np
from common import BOX, MeshTest, package, part, read_off, selected, snapshot


def places(obj):
    """(V,3), in either mode."""
    return np.array([vertex.co[:] for vertex in part("mesh.arrays").update_mesh(obj).vertices])


class Api(MeshTest):
    def setUp(self):
        super().setUp()
        self.api = part("api")

    def click(self, obj, face, level=0, **options):
        """The node that it selects, which is the one picked last then, by this face."""
        found = self.api.part(obj, face, level)
        self.api.select(obj, found, **options)
        picked = part("parts.picks").get_pick(snapshot(obj))
        self.assertEqual((picked.node, picked.face), (found.node, face))
        return found.node

    def selected_faces(self, obj):
        return {polygon.index for polygon in part("mesh.arrays").update_mesh(obj).polygons if polygon.select}

    def in_both_modes(self, obj):
        for mode in ("OBJECT", "EDIT"):
            bpy.ops.object.mode_set(mode=mode)
            with self.subTest(mode):
                yield mode
        bpy.ops.object.mode_set(mode="OBJECT")

    def test_waiting_for_a_build_returns_its_hierarchy(self):
        obj = self.add(*read_off("hand"))
        for mode in self.in_both_modes(obj):
            self.api.clear(obj)
            build, polled = self.api.start_build(obj), []
            self.assertEqual(self.api.state(obj), self.api.State.NONE)
            while not build.wait(0.01):
                polled.append(build.poll() or (1.0, ""))
            self.assertIsNone(build.poll())
            hierarchy = build.result()
            self.assertIs(hierarchy, self.api.hierarchy(obj))
            self.assertIs(hierarchy, build.result())
            self.assertEqual(hierarchy.save(), self.hierarchy(obj).save())
            fractions = [fraction for fraction, _ in polled]
            self.assertTrue(fractions and fractions == sorted(fractions) and 0 <= fractions[0] <= fractions[-1] <= 1)

    def test_a_canceled_build_stores_nothing(self):
        obj, error = self.add(*read_off("hand")), package().PartwheelError
        asked = []

        def cancel_at_once(fraction, what):
            asked.append((fraction, what))
            return True

        def broken(_fraction, _what):
            raise KeyError("a script's own")

        canceled = self.api.start_build(obj)
        canceled.cancel()
        for ended in (canceled.result, lambda: self.api.build(obj, progress=cancel_at_once)):
            with self.assertRaises(error) as raised:
                ended()
            self.assertEqual(raised.exception.status, package().Status.CANCELED)
        self.assertTrue(asked and all(0 <= fraction <= 1 and what for fraction, what in asked))
        with self.assertRaises(KeyError):
            self.api.build(obj, progress=broken)
        for limit, name in (({"cpu_limit": 1e-9}, "time limit"), ({"memory_limit": 2**20}, "memory")):
            with self.subTest(name), self.assertRaises(error) as raised:
                self.api.build(obj, **limit)
            self.assertIn(raised.exception.name, (name, "worker"))  # a worker that can't even begin with so little
        self.assertEqual(self.api.state(obj), self.api.State.NONE)
        self.assertEqual(part("parts.builds")._builds, {})
        edited = self.api.start_build(obj)
        bm = self.edit(obj)
        bmesh.ops.delete(bm, geom=list(bm.faces)[:1], context="FACES_ONLY")
        with self.assertRaisesRegex(package().Error, "edited while"):
            edited.result()

    def test_part(self):
        """Against the core's wheel, Blender's areas and the tree walked from each node."""
        obj = self.add(*read_off("hand"))
        h, areas = self.hierarchy(obj), np.array([polygon.area for polygon in obj.data.polygons])
        stops, start = h.wheel(700)
        for mode in self.in_both_modes(obj):
            for level in (-10**6, -1, 0, 1, 10**6):
                picked = self.api.part(obj, 700, level)
                index = min(max(start + level, 0), len(stops) - 1)
                self.assertEqual((picked.node, picked.face, list(picked.stops), picked.start),
                                 (stops[index], 700, stops.tolist(), start))
                self.assertEqual(sorted(picked.faces.tolist()), sorted(h.faces(picked.node).tolist()))
                self.assertAlmostEqual(picked.area / areas[picked.faces].sum(), 1, places=4)
                self.assertEqual(-1 if picked.parent is None else picked.parent, h.parent[picked.node])
                self.assertEqual(list(picked.children), [n for n, up in enumerate(h.parent) if up == picked.node])
                self.assertEqual(sorted(sum((h.faces(child).tolist() for child in picked.children), [])),
                                 sorted(picked.faces.tolist()))
                self.assertEqual(self.api.faces(obj, picked).tolist(), h.faces(picked.node).tolist())  # stands for it
            for size in (0, 0.01, 0.2, 0.5, 1):
                shares = [areas[h.faces(stop)].sum() / areas.sum() for stop in stops]
                fitting = [stop for stop, share in zip(stops, shares) if share <= size + 1e-6]
                self.assertEqual(self.api.part(obj, 700, size=size).node, (fitting or stops)[-1 if fitting else 0])
        self.api.build(obj, mode=package().Mode.PAPER)
        self.assertEqual(self.api.part(obj, 700).children, ())  # a tetrahedron
        snapped = self.api.part(obj, 700, 9, snap=True)
        self.assertEqual(snapped.faces.tolist(), self.api.faces(obj, snapped, snap=True).tolist())

    def test_what_is_no_mesh_object_is_refused(self):
        lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
        calls = {"build": (), "hierarchy": (), "state": (), "clear": (), "part": (0,), "path": (0,), "faces": (0,), "select": (0,),
                 "similar": (0,), "mirror_image": (0,), "remember": (0, "a"), "remembered_parts": (), "cut": (), "load_cut": (),
                 "write": (None,), "print_parts": (None,), "convex": (), "copy_part": (0,), "remove": (0,), "split": (),
                 "delete_loose_bits": (), "place": ((0, 0, 0),), "unite": ([],), "compatible": (0, lamp), "swap": (0, lamp),
                 "deform": (0, [], np.eye(4)), "bend": (0, np.eye(3))}
        for name, arguments in calls.items():
            for obj in (None, "model", lamp):
                with self.subTest(name, obj=obj):
                    self.assertRaisesRegex(ValueError, "is not a mesh object", getattr(self.api, name), obj, *arguments)

    def test_numbers_that_make_no_sense_are_refused_without_changes(self):
        """Above all those that are no numbers: Blender would write them into the mesh or the matrix of an object."""
        api, obj = self.api, self.add(*read_off("hand"))
        finger = api.part(obj, 700)
        solid, cut = api.copy_part(obj, finger), api.cut(obj, parts=3)
        on_border = {vertex for polygon in obj.data.polygons if polygon.index not in finger.faces for vertex in polygon.vertices}
        inside = next(vertex for face in finger.faces for vertex in obj.data.polygons[face].vertices if vertex not in on_border)
        before = places(obj).tolist(), solid.matrix_world.copy(), sorted(bpy.data.objects.keys())
        nan = float("nan")
        pose = {"scale": (nan, 0, None, "a"), "angle": (nan, None), "depth": (nan, np.inf)}
        invalid = [
            (lambda **options: api.place(solid, **{"location": (0, 0, 0), **options}),
             {**pose, "location": ((0, nan, 0), (0, 0), 1), "normal": ((0, 0, 0), (0, 0, nan))}),
            (lambda **options: api.swap(obj, finger, obj, **options), {**pose, "blend": (nan, -1), "other_node": ("a", 1.5)}),
            (lambda **options: api.unite(obj, **{"others": [solid], **options}), {"blend": (nan, -1, "a"), "others": (None, 1)}),
            (lambda **options: api.part(obj, **{"face": 700, **options}),
             {"face": ("a", None, 1.5), "level": ("a", None, 1.5), "size": (nan, "a")}),
            (lambda **options: api.path(obj, **options), {"face": ("a", None, 1.5)}),
            (lambda **options: api.faces(obj, **options), {"node": ("a", None, 1.5)}),
            (lambda **options: api.similar(obj, finger, **options), {"threshold": (nan, None, "a")}),
            (lambda **options: api.mirror_image(obj, finger, **options), {"plane": (None, 1.5)}),
            (lambda **options: api.cut(obj, **options), {"parts": ("a", 1.5), "height": ("a", nan, -1), "least_concavity": ("a", 1.5)}),
            (lambda **options: api.split(obj, **options), {"parts": ("a",), "explode": (nan,), "height": ("a", nan)}),
            (lambda **options: api.write(obj, cut, {"OBJECTS"}, **options),
             {"explode": (nan,), "shell": (nan,), "own_parts": ([3], [-1], [0.5])}),
            (lambda **options: api.print_parts(obj, cut, **options),
             {"clearance": (nan, -1), "wall": (nan, -1), "bed": (1, (1, 2), (1, 2, 0), (1, 2, nan))}),
            (lambda **options: api.convex(obj, **{"hulls": 4, **options}),
             {"primitives": (nan, -1, None), "hulls": ("a", 1.5), "max_vertices": ("a", 1.5), "keep_open": ("a", nan)}),
            (lambda **options: api.convex(obj, **options), {"error": ("a", nan, -1)}),
            (lambda **options: api.delete_loose_bits(obj, **options), {"size": (nan, -1)}),
            (lambda **options: api.build(obj, **options), {"cpu_limit": (0, -1, nan), "memory_limit": (0, -1), "quality": ("a", nan)}),
            (lambda **options: api.deform(obj, finger, **{"handle": [inside], "matrix": np.eye(4), **options}),
             {"matrix": (np.eye(3), np.full((4, 4), nan), None), "handle": ([-1], [10**9], [0.5], np.ones(3, bool)), "rings": ("a", 1.5),
              "time_limit": ("a", nan)}),
            (lambda **options: api.bend(obj, finger, **{"rotation": np.eye(3), **options}),
             {"rotation": (np.eye(4), np.full((3, 3), nan)), "reach": (nan, 0)}),
            (lambda **options: api.select(obj, **options), {"faces": ([-1], [10**9], [0.5], np.ones(3, bool))})]
        for function, values in invalid:
            for name, choices in values.items():
                for value in choices:
                    with self.subTest(name, value=value):
                        self.assertRaisesRegex(ValueError, name, function, **{name: value})
        self.assertEqual((places(obj).tolist(), solid.matrix_world, sorted(bpy.data.objects.keys())), before)

    def test_a_handle_outside_the_part_is_refused_with_a_vertex_that_would_do(self):
        obj = self.add(*read_off("hand"))
        finger = self.api.part(obj, 700)
        other = next(vertex for polygon in obj.data.polygons if polygon.index not in finger.faces for vertex in polygon.vertices)
        for handle in ([], [other]):
            with self.assertRaisesRegex(ValueError, "such as [0-9]+") as caught:
                self.api.deform(obj, finger, handle, np.eye(4))
            example = int(str(caught.exception).partition("such as ")[2].partition(";")[0].rstrip("."))
            self.api.deform(obj, finger, [example], np.eye(4))
        # So many rings end at once, with the whole mesh.
        self.assertRaisesRegex(package().Error, "whole mesh", self.api.deform, obj, finger, [example], np.eye(4), rings=10**9)

    def test_select_faces_and_less(self):
        obj = self.add(*read_off("hand"))
        picked = self.api.part(obj, 700)
        for mode in self.in_both_modes(obj):
            some = set(picked.faces.tolist()[:7])
            self.api.select(obj, picked)
            self.assertEqual(self.selected_faces(obj), set(picked.faces.tolist()))
            self.api.select(obj, faces=sorted(some), deselect=True)
            self.assertEqual(self.selected_faces(obj), set(picked.faces.tolist()) - some)
            self.api.select(obj, faces=[0, 5])
            self.api.select(obj, faces=np.array([9]), extend=True)
            self.assertEqual(self.selected_faces(obj), {0, 5, 9})
            for wrong in ({}, {"node": 0, "faces": [0]}, {"faces": [2390]}, {"faces": [-1]}):
                with self.assertRaises(ValueError):
                    self.api.select(obj, **wrong)
            self.assertEqual(self.selected_faces(obj), {0, 5, 9})
            self.api.select(obj, faces=[])
            self.assertEqual(self.selected_faces(obj), set())
            self.assertEqual(part("parts.picks").get_pick(snapshot(obj)).node, picked.node)  # stays

    def changing(self, obj, other):
        """Calls that change the mesh, and those of them that need Object Mode first."""
        node = len(self.hierarchy(other).parent) - 2
        return (lambda: self.api.remove(obj, node), lambda: self.api.unite(obj, [other]),
                lambda: self.api.swap(obj, node, other)), (
                lambda: self.api.deform(obj, node, [0], np.eye(4)), lambda: self.api.bend(obj, node, np.eye(3)),
                lambda: self.api.select(obj, node), lambda: self.api.select(obj, faces=[0]))

    def test_a_linked_mesh(self):
        """All that only reads it is as for a local one; all that would change it says why not."""
        local = self.add(*read_off("hand"))
        expected = self.hierarchy(local)
        other = self.add(*read_off("hand"), "other")
        self.assertTrue(bpy.ops.mesh.partwheel_parts.poll())
        obj = self.linked(local)
        self.assertFalse(bpy.ops.mesh.partwheel_parts.poll())
        before = places(obj)
        self.assertEqual(self.api.start_build(obj).result().save(), expected.save())
        self.assertEqual(self.api.state(obj), self.api.State.FITS)
        picked = self.api.part(obj, 700)
        self.assertEqual(picked.node, expected.wheel(700)[0][expected.wheel(700)[1]])
        self.assertEqual(self.api.cut(obj, parts=4).labels.tolist(), expected.face_labels(expected.cut_parts(4)).tolist())
        self.assertGreater(len(self.api.copy_part(obj, picked).data.polygons), len(picked.faces))
        self.assertEqual(len(self.api.split(obj, parts=3)), 3)
        for change in sum(self.changing(obj, other), ()):
            with self.assertRaisesRegex(ValueError, "linked from another file"):
                change()
        with self.assertRaisesRegex(ValueError, "linked from another file"):
            self.api.place(obj, (0, 0, 0))
        bpy.context.view_layer.objects.active = obj
        for pick in (bpy.ops.object.partwheel_select, bpy.ops.object.partwheel_pick):
            with self.assertRaisesRegex(RuntimeError, "^Error: The mesh of .* is linked from another file"):
                pick(face_index=700)
        self.assertTrue((places(obj) == before).all())
        self.api.clear(obj)
        self.assertEqual(self.api.state(obj), self.api.State.NONE)

    def test_select_in_both_modes_is_what_the_operator_selects(self):
        obj = self.add(*read_off("hand"))
        for level in (-1, 0, 2, 10**6):
            self.edit(obj)
            bpy.ops.mesh.partwheel_select(face_index=700, level=level)
            expected = selected(obj)
            node = part("parts.picks").get_pick(snapshot(obj)).node
            bpy.ops.mesh.select_all(action="DESELECT")
            self.assertEqual(self.click(obj, 700, level), node)
            self.assertEqual(selected(obj), expected)
            bpy.ops.mesh.select_all(action="DESELECT")
            bpy.ops.object.mode_set(mode="OBJECT")
            self.assertEqual(self.click(obj, 700, level), node)
            self.assertEqual({p.index for p in obj.data.polygons if p.select}, expected)
            corners = {v for p in obj.data.polygons if p.select for v in p.vertices}
            self.assertEqual({v.index for v in obj.data.vertices if v.select}, corners)
            bpy.ops.object.mode_set(mode="EDIT")  # Blender agrees that this is a consistent selection
            self.assertEqual(selected(obj), expected)
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_a_part_of_a_cut_stands_for_its_node(self):
        obj = self.add(*read_off("hand"))
        cut = self.api.cut(obj, parts=5)
        for number in range(len(cut)):
            own = np.flatnonzero(cut.labels == number).tolist()
            self.assertEqual(sorted(self.api.faces(obj, cut[number]).tolist()), own)
            self.assertEqual(sorted(self.api.select(obj, cut[number]).tolist()), own)
            copies = [self.api.copy_part(obj, node) for node in (cut[number], cut.node(number))]
            np.testing.assert_array_equal(*(places(copy) for copy in copies))
        merged = (cut.merge(one, two) for one in range(5) for two in range(one))
        no_node = next(part for candidates in merged for part in candidates if candidates.node(part.number) is None)
        with self.assertRaisesRegex(package().Error, "merged by hand"):
            self.api.copy_part(obj, no_node)
        other = self.add(*BOX, "other")
        with self.assertRaisesRegex(package().Error, "not of other as it is now"):
            self.api.copy_part(other, cut[0])


class LastPick(MeshTest):
    def setUp(self):
        super().setUp()
        self.obj = self.add(*read_off("hand"))

    def expect(self, pick):
        """What picked() says; has_pick() must say the same."""
        found = part("parts.picks").get_pick(snapshot(self.obj))
        self.assertEqual(found and (found.face, found.node), pick)
        self.assertEqual(part("parts.picks").get_pick_for_poll(self.obj) is not None, pick is not None)

    def pick(self, face, level=0):
        self.assertEqual(bpy.ops.mesh.partwheel_select(face_index=face, level=level), {"FINISHED"})
        stops, start = self.h.wheel(face)
        return face, stops[start + level]

    def test_the_last_pick_replaces_earlier_ones(self):
        self.h = self.hierarchy(self.obj)
        self.expect(None)
        self.edit(self.obj)
        first = self.pick(700, 1)
        self.expect(first)
        self.assertIs(part("parts.picks").get_pick(snapshot(self.obj)).hierarchy, part("parts.registry").get_hierarchy(snapshot(self.obj)))
        self.expect(self.pick(100))
        bpy.ops.object.mode_set(mode="OBJECT")
        other = self.obj
        self.obj = self.add(*BOX, "other")
        self.expect(None)
        self.obj = other
        self.expect((100, self.h.wheel(100)[0][self.h.wheel(100)[1]]))

    def test_a_changed_mesh_or_another_hierarchy_has_none(self):
        for change in (lambda: bmesh.ops.delete(self.bm, geom=self.bm.faces[:1], context="FACES_ONLY"),
                       bpy.ops.mesh.partwheel_build, bpy.ops.mesh.partwheel_clear, part("parts.files").on_load):
            self.setUp()
            self.h = self.hierarchy(self.obj)
            self.bm = self.edit(self.obj)
            self.expect(self.pick(700))
            self.bm.faces.ensure_lookup_table()
            change()
            self.expect(None)
