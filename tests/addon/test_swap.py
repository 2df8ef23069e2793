# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts exchanged for compatible ones: known motions are found again, what comes out is closed and of the volume that
another library says, one operator does it all, and what is refused changes nothing."""

import bpy
import numpy
from common import only_in, package, part, read_off
from mathutils import Matrix
from solid_case import SolidTest, arrays, volume
from test_unite import reference, triangles

MOTION = Matrix.Translation((5, -6, 7)) @ Matrix.Rotation(2, 4, (1, 2, 3)) @ Matrix.Scale(0.3, 4)


def limb(obj, hierarchy, axis, end, share=0.03):
    """The part that sticks out: where the wheel stops first with this share of the area, above the face that is
    farthest along an axis (end: 1), or against it (-1)."""
    face = max(obj.data.polygons, key=lambda polygon: end * polygon.center[axis]).index
    stops, _ = hierarchy.wheel(face)
    return next(int(stop) for stop in stops if hierarchy.area[stop] >= share * hierarchy.area[-1])


class Swap(SolidTest):
    def two_models(self, one="hand", other="homer"):
        """Two models with their hierarchies, the first active."""
        model, parts = self.built(one)
        giver, other_hierarchy = self.built(other)
        giver.matrix_world = MOTION
        bpy.context.view_layer.update()
        bpy.context.view_layer.objects.active = model
        return model, parts, giver, other_hierarchy

    def everything(self):
        """Of the scene, as far as a swap could change it."""
        meshes = {mesh.name: [array.tolist() if hasattr(array, "tolist") else array for array in arrays(mesh)]
                  for mesh in bpy.data.meshes}
        return meshes, {obj.name: (obj.data.name, obj.mode, obj.select_get(), obj.hide_viewport,
                                   [list(row) for row in obj.matrix_world]) for obj in bpy.data.objects}

    def twin(self, model, matrix):
        """A duplicate somewhere else."""
        twin = self.link(bpy.data.objects.new("twin", model.data.copy()))
        twin.matrix_world = matrix
        bpy.context.view_layer.update()
        return twin

    def assertIdentity(self, matrix, tolerance):
        off = max(abs(a - b) for ours, theirs in zip(matrix, Matrix()) for a, b in zip(ours, theirs))
        self.assertLess(off, tolerance)

    @only_in("newest")
    def test_a_known_motion_is_found_again(self):
        """A duplicate that was moved, turned and scaled: each part's own twin is its first, and comes to its place."""
        swapping = part("compose.swapping")
        model, hierarchy = self.built("hand")
        twin = self.twin(model, MOTION)
        for node in {limb(model, hierarchy, 0, end) for end in (-1, 1)}:
            place = swapping.SwapTarget(model, hierarchy, node)
            first = place.find_candidates([twin])[0]
            self.assertEqual(first.node, node)
            self.assertGreater(first.score, 0.99)
            copy = place.create_stand_in(first, swapping.Adjustment(depth=-part("compose.placement").SINK_FRACTION))
            self.assertIdentity(copy.matrix_world, 1e-4 * max(model.dimensions))

    def test_mirror_image_of_a_reflected_twin(self):
        swapping = part("compose.swapping")
        model, hierarchy = self.built("hand")
        twin = self.twin(model, MOTION @ Matrix.Scale(-1, 4, (1, 0, 0)))
        node = limb(model, hierarchy, 0, 1)
        place = swapping.SwapTarget(model, hierarchy, node)
        offer = place.find_candidate(twin, node)
        plain, mirrored = (package("compatible").fit(place.shape, offer.shape, mirror) for mirror in (False, True))
        self.assertLess(mirrored.distance, 0.1 * plain.distance)
        copy = place.create_stand_in(offer, swapping.Adjustment(depth=-part("compose.placement").SINK_FRACTION, mirror=True))
        self.assertIdentity(copy.matrix_world, 1e-4 * max(model.dimensions))
        swapping.remove_object(copy)
        whole = volume(model.data)
        self.assertEqual(part("api").swap(model, node, twin, node, mirror=True), node)
        self.assertSolid(model.data)
        self.assertLess(abs(volume(model.data) / whole - 1), 0.02)

    @only_in("newest")
    def test_volume_by_inclusion_and_exclusion(self):
        """Limbs of other models: what is left, what was placed and the union, as manifold3d has them."""
        swapping, pairs, measured = part("compose.swapping"), [], []
        model, hierarchy, giver, _ = self.two_models("hand", "homer")
        before = arrays(giver.data)[0].tolist()
        for axis, end in ((0, -1), (0, 1)):
            node = limb(model, hierarchy, axis, end)
            place = swapping.SwapTarget(model, hierarchy, node)
            for offer in place.find_candidates([giver])[:2]:
                rest = bpy.data.objects.new("rest", place.create_rest_mesh())
                new = place.create_stand_in(offer)
                bpy.context.view_layer.update()
                pairs.append((triangles(rest), triangles(new)))
                bpy.data.objects.remove(rest)
                swapping.remove_object(new)
                again = self.link(bpy.data.objects.new("again", model.data.copy()))
                self.assertEqual(part("api").swap(again, node, giver, offer.node), offer.node)
                self.assertSolid(again.data)
                measured.append(volume(again.data))
        self.assertEqual(arrays(giver.data)[0].tolist(), before)
        for ours, (one, other, common, union) in zip(measured, reference(pairs)):
            self.assertAlmostEqual(one + other - common, union, delta=1e-6 * union)
            self.assertAlmostEqual(ours, union, delta=1e-5 * union)
            self.assertGreater(common, 0)

    @only_in("oldest", "newest")
    def test_borders_are_in_creases(self):
        """Rest and part are those that removing and copying with snapped borders give, and the union is theirs; the
        border that the part was fitted by is the one that it was cut out with."""
        swapping, api = part("compose.swapping"), part("api")
        model, hierarchy, giver, other_hierarchy = self.two_models("hand", "homer")
        node = next(node for node in self.nodes(hierarchy, 40)[::-1]
                    if set(api.faces(model, node).tolist()) != set(api.faces(model, node, snap=True).tolist()))
        places = {snap: swapping.SwapTarget(model, hierarchy, node, snap) for snap in (False, True)}
        offer = places[True].find_candidates([giver])[0]
        pairs = []
        for snap, place in places.items():
            rest = place.create_rest_mesh()
            expected = self.link(bpy.data.objects.new("expected", model.data.copy()))
            self.run_on(expected, bpy.ops.mesh.partwheel_remove, node=node, snap=snap)
            self.assertEqual(arrays(rest)[1], arrays(expected.data)[1])
            new = place.create_stand_in(offer)
            copy = api.copy_part(giver, offer.node, snap=snap)
            self.assertEqual(arrays(new.data)[1], arrays(copy.data)[1])
            bpy.context.view_layer.update()
            pairs.append((triangles(bpy.data.objects.new("rest", rest)), triangles(new)))
        again = self.link(bpy.data.objects.new("again", model.data.copy()))
        bpy.context.view_layer.objects.active = again
        done = bpy.ops.mesh.partwheel_swap(node=node, other=giver.name, other_node=offer.node, build=False)
        self.assertEqual(done, {"FINISHED"})  # snapped by default
        self.assertSolid(again.data)
        united = reference(pairs)[:, 3]
        self.assertGreater(abs(united[0] / united[1] - 1), 1e-4)
        self.assertAlmostEqual(volume(again.data), united[1], delta=1e-5 * united[1])

    @only_in("newest")
    def test_legs_of_one_animal(self):
        """The first that is offered for a leg is a leg, the opposite one is among the first two, and it fits."""
        api = part("api")
        model, hierarchy = self.built("triceratops")
        whole, (low, high) = volume(model.data), numpy.array(model.bound_box)[[0, 6]]

        def middle(node):
            tetrahedra = hierarchy.tetrahedra[hierarchy.tet_first[node]:hierarchy.tet_last[node]]
            return (hierarchy.vertices[tetrahedra].mean(axis=(0, 1)) - low) / (high - low)

        for axis, end in ((1, -1), (2, 1)):
            node = limb(model, hierarchy, axis, end)
            offered = api.compatible(model, node, model)
            self.assertEqual(sorted(offered, key=lambda offer: -offer[1]), offered)
            first, second = (middle(other) for other, _ in offered[:2])
            self.assertLess(first[1], 0.25)
            opposite = middle(node) * [1, 1, -1] + [0, 0, 1]
            self.assertLess(min(abs(place - opposite).max() for place in (first, second)), 0.1)
        again = self.link(bpy.data.objects.new("again", model.data.copy()))
        self.assertEqual(api.swap(again, node, again), offered[0][0])
        self.assertSolid(again.data)
        self.assertLess(abs(volume(again.data) / whole - 1), 0.05)

    def test_operator_from_edit_mode_is_one_step(self):
        model, hierarchy, giver, _ = self.two_models("hand", "homer")
        node = limb(model, hierarchy, 0, 1)
        before = volume(model.data)
        bpy.ops.object.mode_set(mode="EDIT")
        self.assertEqual(bpy.ops.mesh.partwheel_swap(node=node, build=False), {"FINISHED"})
        self.assertEqual((model.mode, len(bpy.data.objects), len(bpy.data.meshes)), ("OBJECT", 2, 2))
        self.assertSolid(model.data)
        self.assertNotEqual(volume(model.data), before)
        self.assertEqual(bpy.context.view_layer.objects.active, model)

    def test_a_part_that_was_copied_stands_in_without_its_model(self):
        """As when it was pasted from another file."""
        api = part("api")
        model, hierarchy, giver, other_hierarchy = self.two_models("hand", "homer")
        node, arm = limb(model, hierarchy, 0, 1), limb(giver, other_hierarchy, 0, 1)
        copy = api.copy_part(giver, arm)
        mesh = copy.data
        bpy.data.objects.remove(giver)
        (best, score), = api.compatible(model, node, copy)
        self.assertIsNone(best)
        self.assertTrue(0 < score < 1)
        count = len(mesh.vertices)
        bpy.context.view_layer.objects.active = model
        done = bpy.ops.mesh.partwheel_swap(node=node, other=copy.name, whole=True, angle=1, build=False)
        self.assertEqual(done, {"FINISHED"})
        self.assertSolid(model.data)
        self.assertEqual(len(mesh.vertices), count)

    def test_what_is_refused_says_why_and_changes_nothing(self):
        model, hierarchy = self.built("hand")
        node, whole = limb(model, hierarchy, 0, 1), len(hierarchy.parent) - 1
        before = self.everything()

        def refused(words, **options):
            bpy.context.view_layer.objects.active = model
            with self.assertRaisesRegex(RuntimeError, words):
                bpy.ops.mesh.partwheel_swap(**options)
            self.assertEqual(self.everything(), before)

        refused("No other object has parts", node=node)
        refused("is the whole model", node=whole)
        refused("No part is picked")
        refused("There is no part 99999999", node=99999999)
        refused("There is no mesh object nobody", node=node, other="nobody")
        other, parts = self.built("dragknob")
        before = self.everything()
        refused("has no part 99999999", node=node, other=other.name, other_node=99999999)
        refused("has no border", node=node, other=other.name, other_node=len(parts.parent) - 1)
        refused("has no border", node=node, other=other.name, whole=True)
        self.edit(model)
        with self.assertRaisesRegex(ValueError, "Edit Mode"):
            part("api").swap(model, node, other)

    def test_a_piece_of_its_own_has_no_border(self):
        """Two cubes apart from each other in one mesh."""
        vertices, polygons = read_off("cube")
        both_bodies = vertices + [(x + 5, y, z) for x, y, z in vertices]
        model = self.add(both_bodies, polygons + [tuple(i + len(vertices) for i in polygon) for polygon in polygons])
        hierarchy = part("api").build(model)
        node = int(numpy.flatnonzero(hierarchy.last - hierarchy.first == len(polygons))[0])
        with self.assertRaisesRegex(part("mesh.errors").Refused, "no border with the rest"):
            part("api").compatible(model, node, model)

    def test_nothing_changes_where_the_union_fails(self):
        model, hierarchy, giver, _ = self.two_models("hand", "homer")
        union, before = part("compose.union"), self.everything()
        ways, union.SOLVERS = union.SOLVERS, ()
        try:
            with self.assertRaises(part("mesh.errors").Refused):
                part("api").swap(model, limb(model, hierarchy, 0, 1), giver)
        finally:
            union.SOLVERS = ways
        self.assertEqual(self.everything(), before)

    @only_in("oldest", "newest")
    def test_a_linked_object_is_not_taken_for_a_local_one_of_its_name(self):
        api = part("api")
        model, parts, giver, _ = self.two_models()
        node = limb(model, parts, 0, 1)
        expected = api.compatible(model, node, giver)
        twin = self.twin(model, model.matrix_world)
        api.build(twin)
        api.swap(twin, node, giver)
        linked = self.linked(giver)
        self.assertEqual(api.compatible(model, node, linked), expected)
        bpy.context.view_layer.objects.active = model
        options = {"node": node, "other": linked.name_full, "snap": False, "build": False}
        self.assertEqual(bpy.ops.mesh.partwheel_swap(**options), {"FINISHED"})
        self.assertAlmostEqual(volume(model.data) / volume(twin.data), 1, places=6)

    @only_in("oldest", "newest")
    def test_its_own_name_at_another_object(self):
        """A linked object of the same name is another one, with parts of its own."""
        api = part("api")
        model, parts, giver, _ = self.two_models()
        node = limb(model, parts, 0, 1)
        expected = api.compatible(model, node, giver)
        giver.name, model.name = "same", "other"
        linked = self.linked(giver)
        bpy.data.objects["same"].name = "box"
        model.name = "same"
        self.assertEqual((model.name, linked.name), ("same", "same"))
        self.assertEqual(api.compatible(model, node, linked), expected)
