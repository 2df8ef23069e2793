# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of six assets as artists have them, of several shells: areas and volumes add up to the shells', UVs and materials
stay, and no polygon is lost or invented, but for caps. Two have sheets, one duplicate faces. They are not in the repository."""

import tarfile
from pathlib import Path

import bpy
import numpy
from common import only_in, part, snapshot
from solid_case import caps, polygons_at
from test_parts_to import PartsCase, volume64

ASSETS = Path(__file__).resolve().parents[3] / "shared" / "assets" / "tune.tar.xz"
SHEETS, DUPLICATES = {"kaykit_Knight": 1, "CruiseShip": 1, "Elk": 2}, ("Sheep",)
# How far objects may be from adding up. Where the repair changed a shell, they keep its own polygons. The knight's cape passes
# through itself: its 542 polygons wind twice around 0.073 of the 0.088 that are inside (40,000 random points), and its part as
# an object has 0.127 instead of 0.071. All others differ by 0.002 at most. Together 0.023, and 0.031 for twelve solids.
TOLERANCE = {"kaykit_Knight": 0.032, "CruiseShip": 2e-3, "Sheep": 1e-3, "NormalCar1": 1e-4}
# With marks, the upper decks are a part with ragged caps, whose object has an eighth less volume.
MARKED_TOLERANCE = {**TOLERANCE, "CruiseShip": 0.03}
NAMES = "Robot", "NormalCar1", *SHEETS, *DUPLICATES


def tet_volume(hierarchy, first=0, last=None):
    sides = numpy.diff(hierarchy.vertices[hierarchy.tetrahedra[first:last]], axis=1)
    return abs(numpy.linalg.det(sides)).sum() / 6


class Assets(PartsCase):
    built = {}

    def tearDown(self):
        part("preferences").preferences().property_unset("use_marks")
        super().tearDown()

    def assets(self, marks=()):
        """For each asset its name, a new object, its hierarchy, built with these kinds of marks."""
        if not ASSETS.exists():
            self.skipTest(f"{ASSETS} is not there")
        for name in NAMES:
            self.setUp()
            with tarfile.open(ASSETS) as archive, archive.extractfile(f"tune/{name}.npz") as file:
                arrays = numpy.load(file)
                vertices, triangles, materials = (arrays[key] for key in ("V", "F", "material"))
            obj = self.add(vertices.tolist(), triangles.tolist(), name)
            for number in range(materials.max() + 1):
                obj.data.materials.append(bpy.data.materials.get(f"paint {number}") or bpy.data.materials.new(f"paint {number}"))
            obj.data.polygons.foreach_set("material_index", materials.astype(numpy.int32))
            random = numpy.random.default_rng(1).random(2 * len(obj.data.loops))
            obj.data.uv_layers.new(name="map").data.foreach_set("uv", random.astype(numpy.float32))
            part("preferences").preferences().use_marks = set(marks)
            if (name, marks) not in self.built:
                self.built[name, marks] = part("api").build(obj)
            registry, arrays = part("parts.registry"), part("mesh.arrays")
            now = arrays.compute_fingerprint(obj.data)
            entry = registry.HierarchyEntry(now, (len(obj.data.vertices), len(obj.data.polygons)), self.built[name, marks])
            registry.store(snapshot(obj).state, entry, now)
            yield name, obj, part("api").hierarchy(obj)

    def check_objects(self, obj, hierarchy, created, tolerance):
        self.check_polygons(obj, created)
        about = numpy.mean([vertex.co for vertex in obj.data.vertices], axis=0)
        for new in created:
            self.assertSolid(new.data)
        whole = tet_volume(hierarchy)
        self.assertLess(abs(sum(volume64(new, about) for new in created) / whole - 1), tolerance)

    @only_in("newest")
    def test_parts_as_objects(self):
        for marks in (), ("MATERIALS", "COLORS"):
            for name, obj, hierarchy in self.assets(marks):
                with self.subTest(name=name, marks=marks):
                    self.check_parts(name, obj, hierarchy, (MARKED_TOLERANCE if marks else TOLERANCE).get(name, 1e-5))

    def check_parts(self, name, obj, hierarchy, tolerance):
        self.assertEqual(hierarchy.summary.sheets, SHEETS.get(name, 0))
        cut = part("api").cut(obj)
        created = part("api").write(obj, cut, {"OBJECTS"}, origins=False).objects
        self.check_objects(obj, hierarchy, created, tolerance)
        messages = [*part("cut.objects").difference_messages(obj, cut, created, False)]
        if name in DUPLICATES:
            self.assertIn("duplicate", messages[0])
        excess = sum(volume64(new, numpy.zeros(3)) for new in created) / tet_volume(hierarchy) - 1
        self.assertEqual(any("some places twice" in message for message in messages), excess > 0.01)
        self.assertEqual(any("is broken" in message for message in messages), excess < -0.01)

    @only_in("newest")
    def test_copy_and_remove(self):
        for name, obj, hierarchy in self.assets():
            cut = part("api").cut(obj)
            for number in range(0, len(cut), 1 + len(cut) // 5):
                node = int(cut[number])
                copy = part("api").copy_part(obj, node)
                self.assertSolid(copy.data)
                inside = set(hierarchy.faces(node).tolist())
                faces = {place: [polygon for polygon in polygons if polygon.index in inside]
                         for place, polygons in polygons_at(obj.data).items()}
                rest = {place: polygons for place, polygons in polygons_at(obj.data).items() if len(faces[place]) < len(polygons)}
                self.check_polygons(obj, [copy], {place: polygons for place, polygons in faces.items() if polygons})
                remaining = obj.copy()
                remaining.data = obj.data.copy()
                self.link(remaining)
                part("api").hierarchy(remaining)
                part("solid.composition").remove_part(remaining, hierarchy, node)
                self.check_polygons(obj, [remaining], rest)
                self.assertEqual((~caps(remaining.data)).sum(), len(obj.data.polygons) - len(inside))
                for new in (copy, remaining):
                    bpy.data.objects.remove(new)
