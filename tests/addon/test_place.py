# SPDX-License-Identifier: GPL-3.0-or-later
"""Placing parts: the border meets the surface, turned to its normal; borders are fitted, mirror images are solids."""

import math

import bpy
from common import part
from mathutils import Matrix, Vector
from solid_case import SolidTest, volume


class Place(SolidTest):
    def copied(self, name="hand", node=-2):
        """(object, its hierarchy, a copy of one of its parts, active)"""
        obj, hierarchy = self.built(name)
        node = self.nodes(hierarchy)[node]
        return obj, hierarchy, node, self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node)

    def place(self, obj, **options):
        for other in bpy.context.view_layer.objects:
            other.select_set(other == obj)
        bpy.context.view_layer.objects.active = obj
        self.assertEqual(bpy.ops.object.partwheel_place(**options), {"FINISHED"})
        bpy.context.view_layer.update()

    def near(self, one, other, places=4):
        for a, b in zip(one, other):
            self.assertAlmostEqual(a, b, places=places)

    def test_border_comes_onto_the_surface(self):
        placement = part("compose.placement")
        _, _, _, copy = self.copied()
        copy.matrix_world = Matrix.Rotation(1, 4, (1, 2, 3)) @ Matrix.Scale(0.5, 4)
        bpy.context.view_layer.update()
        before = placement.find_cap_loop(copy)
        for normal in ((0, 0, 1), (0, 0, -1), (1, 1, 0)):
            self.place(copy, location=(1, 2, 3), normal=normal, scale=1, depth=-placement.SINK_FRACTION)
            after = placement.find_cap_loop(copy)
            self.near(after.center, (1, 2, 3))
            self.near(after.normal, -Vector(normal).normalized())
            self.assertAlmostEqual(after.radius / before.radius, 1, places=4)
        self.place(copy, location=(1, 2, 3), normal=(0, 0, 1), scale=3, angle=1.0, depth=0.5)
        after = placement.find_cap_loop(copy)
        self.assertAlmostEqual(after.radius / before.radius, 3, places=3)
        self.near(after.center, (1, 2, 3 - 3 * before.radius * (0.5 + placement.SINK_FRACTION)))

    def test_angle_turns_about_the_normal(self):
        _, _, _, copy = self.copied()
        self.place(copy, location=(0, 0, 0), normal=(0, 0, 1))
        start = copy.matrix_world.copy()
        self.place(copy, location=(0, 0, 0), normal=(0, 0, 1), angle=math.radians(90))
        for axis, expected in zip(copy.matrix_world, Matrix.Rotation(math.radians(90), 4, "Z") @ start):
            self.near(axis, expected, 3)

    def test_part_fits_where_it_was_removed_and_makes_the_whole_again(self):
        placement = part("compose.placement")
        obj, hierarchy, node, copy = self.copied()
        whole = volume(obj.data)
        self.run_on(obj, bpy.ops.mesh.partwheel_remove, node=node)
        where = placement.find_cap_loop(copy)
        copy.matrix_world = Matrix.Translation((5, 6, 7)) @ Matrix.Rotation(2, 4, (1, 0, 1)) @ Matrix.Scale(0.3, 4)
        bpy.context.view_layer.update()
        self.place(copy, target=obj.name, location=where.center, normal=(0, 0, 1), fit=True)
        fitted = placement.find_cap_loop(copy)
        self.assertAlmostEqual(fitted.radius / where.radius, 1, places=3)
        self.near(fitted.normal, where.normal, 3)
        self.assertLess(Vector(fitted.center - where.center).length, 1.1 * placement.SINK_FRACTION * where.radius)
        self.ready(obj, copy)
        self.assertEqual(bpy.ops.object.partwheel_unite(), {"FINISHED"})
        self.assertSolid(obj.data)
        self.assertLess(abs(volume(obj.data) / whole - 1), 0.05)

    def test_a_part_in_a_stretched_parent_keeps_its_shape(self):
        obj, _, _, copy = self.copied()
        copy.parent = self.link(bpy.data.objects.new("stretched", None))
        copy.parent.scale = 1, 2, 3
        bpy.context.view_layer.update()
        before, transform = copy.matrix_world.copy(), part("compose.placement").local_transform(copy)
        for angle in (0.5, 2):
            self.place(copy, target=obj.name, location=(1, 2, 3), normal=(1, 1, 1), angle=angle, scale=2, mirror=True)
            mirrored = next(other for other in bpy.context.selected_objects if other != copy)
            for placed in (copy, mirrored):
                self.assertSameShape(placed.data, placed.matrix_world, copy.data, before)
            before = copy.matrix_world.copy()
        part("compose.placement").restore_transform(copy, transform)
        self.assertEqual(part("compose.placement").local_transform(copy), transform)

    def test_mirror_copy(self):
        obj, _, _, copy = self.copied()
        obj.matrix_world = Matrix.Translation((1, 2, 3)) @ Matrix.Rotation(0.5, 4, "Y")
        bpy.context.view_layer.update()
        self.place(copy, target=obj.name, location=(2, 2, 3), normal=(1, 0, 1), mirror=True)
        mirrored = next(other for other in bpy.context.selected_objects if other != copy)
        self.assertSolid(mirrored.data)
        self.assertFalse(mirrored.matrix_world.is_negative)
        self.assertAlmostEqual(volume(mirrored.data) / volume(copy.data), 1, places=4)
        inverse = obj.matrix_world.inverted()
        ours = sorted(tuple(round(c, 3) for c in inverse @ copy.matrix_world @ v.co) for v in copy.data.vertices)
        theirs = sorted((round(-p.x, 3), round(p.y, 3), round(p.z, 3)) for p in
                        (inverse @ mirrored.matrix_world @ v.co for v in mirrored.data.vertices))
        off = max(abs(a - b) for one, other in zip(ours, theirs) for a, b in zip(one, other))
        self.assertLess(off, 0.01)

    def test_a_linked_target_is_not_taken_for_a_local_one_of_its_name(self):
        """The mirror image comes to the other side of the target that was named, wherever another one is."""
        target, _, _, copy = self.copied()
        target.location = 3, 0, 0
        bpy.context.view_layer.update()
        linked = self.linked(target)
        before = set(bpy.data.objects)
        self.place(copy, target=linked.name_full, location=(7, 0, 0), normal=(1, 0, 0), mirror=True)
        (mirrored,) = set(bpy.data.objects) - before
        (x, y, z), image = (part("compose.placement").find_cap_loop(placed).center for placed in (copy, mirrored))
        self.near((x, y, z), (7, 0, 0), places=1)
        self.near(image, (2 * 3 - x, y, z))
