# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole model in parts for a 3D printer, from Blender: what is made is read back, and compared by the manifold3d that the
add-on contains."""

import sys
from unittest.mock import patch

import bpy
import manifold3d
import numpy
from common import only_in, part
from solid_case import arrays, volume
from test_parts_to import PartsCase

SIZE, GAP, WALL = 200, 0.3, 1.0  # millimeters
NEAR = 1e-5  # of SIZE: Blender keeps single floats


class Print(PartsCase):
    def setUp(self):
        super().setUp()
        bpy.context.scene.unit_settings.scale_length = 0.001  # a unit is a millimeter

    def tearDown(self):
        bpy.context.scene.unit_settings.scale_length = 1
        super().tearDown()

    def sized(self, name):
        """(the object, scaled so that it is SIZE long, its cut)"""
        obj, cut = self.model(name)
        obj.scale = [SIZE / max(obj.dimensions)] * 3
        obj.location, obj.rotation_euler = (3, 1, 2), (0.3, 0.2, 1)
        bpy.context.view_layer.update()
        bpy.context.view_layer.objects.active = obj
        return obj, cut

    @only_in("oldest", "newest")
    def test_pegs_fit_their_sockets(self):
        for name, count in (("homer", 5), ("elephant", 6), ("cow", 4)):
            obj, _ = self.sized(name)
            cut = part("api").cut(obj, count)
            objects, pegs, notes = part("api").print_parts(obj, cut, GAP, WALL)
            self.assertEqual(len(objects), count, notes)
            self.assertGreater(len(pegs), 1, notes)
            bodies = {}
            for new in objects:
                self.assertSolid(new.data)
                places, polygons = arrays(new.data)
                places = places * obj.scale[0]
                body = manifold3d.Manifold(manifold3d.Mesh64(places, numpy.array(polygons, numpy.uint64)))
                self.assertEqual(body.status(), manifold3d.Error.NoError)
                bodies[new.name] = body
                self.assertLess(abs(numpy.array(new.matrix_world) - numpy.array(obj.matrix_world)).max(), 1e-6 * SIZE)
            # Parts meet at their cuts, but overlap nowhere by more than single floats do.
            all_of_them = list(bodies.values())
            for one in range(len(all_of_them)):
                for other in range(one):
                    both = all_of_them[one] ^ all_of_them[other]
                    self.assertLess(both.volume(), NEAR * SIZE * both.surface_area() + 1e-9)
            names = [new.name for new in objects]
            for peg in pegs:
                # Around the middle of the peg: it is the one's, and the other is as far away as the gap is wide.
                own, other = bodies[names[peg.part]], bodies[names[peg.into]]
                middle, way = peg.center + 0.5 * peg.length * peg.direction, peg.direction.tolist()
                inside = manifold3d.Manifold.sphere(0.3 * peg.radius, 24).translate(middle.tolist())
                self.assertLess((inside - own).volume(), 1e-6 * inside.volume())
                slab = [each.trim_by_plane(way, float(peg.direction @ middle) - 0.1 * peg.length) for each in (own, other)]
                around = manifold3d.Manifold.sphere(0.6 * peg.length + 2 * peg.radius, 32).translate(middle.tolist())
                self.assertAlmostEqual((slab[0] ^ around).min_gap(slab[1] ^ around, 3 * GAP), GAP, 2)

    @only_in("oldest", "newest")
    def test_printed_parts_lose_only_the_clearance(self):
        obj, _ = self.sized("homer")
        cut = part("api").cut(obj, 5)
        whole = volume(obj.data) * obj.scale[0] ** 3
        flat = sum(volume(new.data) for new in part("api").print_parts(obj, cut, None).objects) * obj.scale[0] ** 3
        self.assertLess(abs(flat - whole), 1e-5 * whole)
        objects, pegs, _ = part("api").print_parts(obj, cut, GAP, WALL)
        self.assertGreater(len(pegs), 1)
        gaps = whole - sum(volume(new.data) for new in objects) * obj.scale[0] ** 3
        sockets = 0
        for peg in pegs:  # an outline grows by its perimeter times the gap, and by a bit at its corners
            corners = peg.outline - peg.center
            after = numpy.roll(corners, -1, axis=0)
            area = abs(numpy.cross(corners, after) @ peg.direction).sum() / 2
            perimeter = numpy.linalg.norm(after - corners, axis=1).sum()
            sockets += (area + GAP * perimeter + 4 * GAP ** 2) * (peg.length + GAP) - area * peg.length
        self.assertLess(abs(gaps - sockets), 0.02 * sockets + 1e-5 * whole)

    @only_in("oldest", "newest")
    def test_holes_for_magnets_and_dowels_in_both_sides(self):
        obj, _ = self.sized("homer")
        whole = volume(obj.data) * obj.scale[0] ** 3
        for joints, depth in (("MAGNETS", 3), ("DOWELS", 1.5)):
            before = set(bpy.data.objects)
            bpy.ops.mesh.partwheel_parts(to={"PRINT"}, count=3, joints=joints, insert_diameter=4, insert_length=3)
            new = set(bpy.data.objects) - before
            taken = whole - sum(volume(each.data) for each in new) * obj.scale[0] ** 3
            both = 2 * numpy.pi * 2.2 ** 2 * (depth + 0.2)
            self.assertGreater(taken, 0.99 * both)
            self.assertLess(abs(taken / both - round(taken / both)), 0.05)  # a whole number of pairs of holes
            engraved = set(bpy.data.objects)
            bpy.context.view_layer.objects.active = obj
            bpy.ops.mesh.partwheel_parts(to={"PRINT"}, count=3, joints="NONE", numbers=True)
            taken = whole - sum(volume(each.data) for each in set(bpy.data.objects) - engraved) * obj.scale[0] ** 3
            self.assertGreater(taken, 2)
            bpy.context.view_layer.objects.active = obj

    @only_in("oldest", "newest")
    def test_snap_pins_and_dovetails(self):
        obj, _ = self.sized("homer")
        for joints, kind in (("SNAP_PINS", "snap pin"), ("DOVETAILS", "dovetail")):
            made = part("api").print_parts(obj, part("api").cut(obj, 3), GAP, WALL, joint=kind)
            self.assertIn(kind, {peg.kind for peg in made.pegs})
            before = set(bpy.data.objects)
            bpy.context.view_layer.objects.active = obj
            bpy.ops.mesh.partwheel_parts(to={"PRINT"}, count=3, joints=joints, clearance=GAP, wall=WALL)
            volumes = sorted(volume(new.data) for new in set(bpy.data.objects) - before)
            expected = sorted(volume(new.data) for new in made.objects)
            self.assertLess(max(abs(numpy.subtract(volumes, expected))), 1e-4 * sum(expected))

    def test_without_manifold3d_nothing_changes(self):
        obj, _ = self.sized("homer")
        before = len(bpy.data.objects), len(bpy.data.collections)
        with patch.dict(sys.modules, {"manifold3d": None}), self.assertRaisesRegex(RuntimeError, "pip install manifold3d"):
            bpy.ops.mesh.partwheel_parts(to={"PRINT", "FACE_SETS"})
        self.assertEqual((len(bpy.data.objects), len(bpy.data.collections)), before)
        self.assertIsNone(part("api").load_cut(obj))
        obj.scale.x *= 2
        bpy.context.view_layer.update()
        with self.assertRaisesRegex(RuntimeError, "scale"):
            bpy.ops.mesh.partwheel_parts(to={"PRINT"})

    def test_an_object_in_a_stretched_parent_is_refused(self):
        obj, _ = self.sized("homer")
        obj.rotation_euler = 0, 0, numpy.pi / 4
        obj.parent = bpy.data.objects.new("parent", None)
        bpy.context.collection.objects.link(obj.parent)
        for stretched in ((1, 1, 2), (2, 1, 2.5 ** 0.5)):  # the second shears it: all of its axes have the same length
            obj.parent.scale = stretched
            bpy.context.view_layer.update()
            with self.assertRaisesRegex(RuntimeError, "scale"):
                bpy.ops.mesh.partwheel_parts(to={"PRINT"})
