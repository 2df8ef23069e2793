# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts exchanged for compatible ones: known motions are found again, what comes out is closed and of the volume that
another library says, one operator does it all, and what is refused changes nothing."""

import bpy
from common import only_in, part
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
    def test_parts_of_a_transformed_duplicate_fit_exactly(self):
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

    @only_in("oldest", "newest")
    def test_a_part_of_a_sheared_object_keeps_its_shape(self):
        """Of an object that is turned in a stretched parent: all distances within the part change by one factor."""
        swapping, solid = part("compose.swapping"), part("solid.solids")
        model, hierarchy, giver, other = self.two_models()
        giver.parent = self.link(bpy.data.objects.new("stretched", None))
        giver.parent.scale = 1, 2, 3
        bpy.context.view_layer.update()
        place = swapping.SwapTarget(model, hierarchy, limb(model, hierarchy, 0, 1))
        offer = place.find_candidates([giver])[0]
        stand_in = place.create_stand_in(offer)
        place.move_stand_in(stand_in, offer, swapping.Adjustment(angle=1, scale=2))
        bpy.context.view_layer.update()
        mesh = part("solid.composition").create_part_mesh(giver, other, offer.node, solid.CapOptions(), place.snap)
        self.assertSameShape(stand_in.data, stand_in.matrix_world, mesh, giver.matrix_world)

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

    def test_nothing_changes_where_the_union_fails(self):
        model, hierarchy, giver, _ = self.two_models("hand", "homer")
        union, before = part("compose.union"), self.everything()
        self.addCleanup(setattr, union, "_attempt_unions", union._attempt_unions)
        union._attempt_unions = lambda *_: ()
        with self.assertRaises(part("mesh.errors").Refused):
            part("api").swap(model, limb(model, hierarchy, 0, 1), giver)
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
