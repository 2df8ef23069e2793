# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of models with duplicate faces, and with walls inside: closed, no cap too many, of the model's volume."""

import sys
from pathlib import Path

import bpy
import numpy
from common import BOX, part
from solid_case import SolidTest, caps, volume

sys.path.append(str(Path(__file__).resolve().parents[1] / "core"))
import shapes  # noqa: E402  (found only now)

QUADS = 2058


def corners_of(mesh, matrix):
    """Of each polygon its corners' places, rounded, in no order."""
    places = [tuple(round(x, 4) for x in matrix @ vertex.co) for vertex in mesh.vertices]
    return [frozenset(places[vertex] for vertex in polygon.vertices) for polygon in mesh.polygons]


class Duplicates(SolidTest):
    def house(self, flipped=False):
        vertices, quads = shapes.house()
        rng = numpy.random.default_rng(0)
        quads = quads + [quads[i] for i in rng.permutation(QUADS)[:QUADS // 2]]
        if flipped:
            quads = [quad[::-1] if flip else quad for quad, flip in zip(quads, rng.random(len(quads)) < 0.3)]
        obj = self.add(vertices, quads, "house")
        self.assertEqual(part("api").build(obj).summary.fill_method, "repaired")
        return obj

    def check_objects(self, obj, cut, created, whole):
        """Closed, together of the volume, with each of the model's polygons that lies in one part once."""
        sources = {*corners_of(obj.data, obj.matrix_world)}
        own = []
        for new in created:
            self.assertSolid(new.data)
            marks = caps(new.data)
            own += [corners for corners, cap in zip(corners_of(new.data, new.matrix_world), marks) if not cap]
        self.assertAlmostEqual(sum(volume(new.data) for new in created), whole, 3)
        self.assertEqual(len(own), len(sources))
        self.assertEqual(set(own), sources)

    def test_part_objects_contain_each_duplicate_once(self):
        for flipped in (False, True):
            obj = self.house(flipped)
            cut = part("api").cut(obj)
            created = part("api").write(obj, cut, {"OBJECTS"}, origins=False).objects
            self.check_objects(obj, cut, created, shapes.HOUSE_VOLUME)
            # Caps are where parts meet, the same on both sides, and nowhere else.
            actual = [corners for new in created for corners, cap in zip(corners_of(new.data, new.matrix_world), caps(new.data)) if cap]
            self.assertGreater(len(actual), 0)
            self.assertTrue(all(actual.count(corners) == 2 for corners in actual))

    def test_the_operator_reports_removed_duplicates(self):
        obj = self.house()
        bpy.context.view_layer.objects.active = obj
        objects = part("cut.objects")
        cut = part("api").cut(obj)
        created = part("api").write(obj, cut, {"OBJECTS"}).objects
        note, = objects.difference_messages(obj, cut, created, False)
        self.assertIn("1,029 duplicate faces", note)
        bpy.data.objects.remove(created.pop())
        self.assertIn("volumes", [*objects.difference_messages(obj, cut, created, False)][-1])

    def test_removing_a_part_keeps_duplicates_elsewhere(self):
        obj = self.house()
        hierarchy = part("api").build(obj)
        first, last = part("api").cut(obj).slices(0)
        inside = numpy.isin(hierarchy.leaf, numpy.concatenate([numpy.arange(a, b) for a, b in zip(first, last)]))
        node = next(node for node in hierarchy.path(int(numpy.flatnonzero(inside)[0]))
                    if hierarchy.tet_first[node] <= first[0] and hierarchy.tet_last[node] >= last[-1])
        faces = set(hierarchy.faces(node).tolist())
        left = [corners for face, corners in enumerate(corners_of(obj.data, obj.matrix_world)) if face not in faces]
        part("solid.solids").remove_from_mesh(obj, hierarchy, hierarchy.tet_slice(node))
        marks = caps(obj.data)
        remaining = [corners for corners, cap in zip(corners_of(obj.data, obj.matrix_world), marks) if not cap]
        self.assertEqual(sorted(map(sorted, remaining)), sorted(map(sorted, left)))
        self.assertLess(len(set(remaining)), len(remaining))


class Walls(SolidTest):
    def test_parts_as_objects_are_closed_by_walls(self):
        obj = self.add(*shapes.prisms(), "prisms")
        hierarchy = part("api").build(obj)
        self.assertAlmostEqual(hierarchy.summary.volume, shapes.PRISMS_VOLUME, 4)
        for count in (12, 4):
            created = part("api").write(obj, part("api").cut(obj, count), {"OBJECTS"}, origins=False).objects
            self.assertEqual(len(created), count)
            Duplicates.check_objects(self, obj, None, created, shapes.PRISMS_VOLUME)
            self.assertFalse([*part("cut.objects").difference_messages(obj, part("api").cut(obj, count), created, False)])

    def test_walls_with_a_window_and_fins_are_kept_as_sheets(self):
        vertices, polygons, _, sheets = shapes.prisms_with_window_and_fins()
        obj = self.add(vertices, polygons, "prisms")
        cut = part("api").cut(obj, 11)
        created = part("api").write(obj, cut, {"OBJECTS"}, origins=False).objects
        Duplicates.check_objects(self, obj, None, created, shapes.PRISMS_VOLUME)
        self.assertFalse([*part("cut.objects").difference_messages(obj, cut, created, False)])
        # A fan of triangles closes each fin, one fan the wall around the window on each of its two borders.
        loops = sum(len(component_borders) for component_borders in ([4] * (sheets - 4), [4, 4]))
        walls = 12 * 8 - len(shapes.prisms()[1]) - 1
        self.assertEqual(sum(int(caps(new.data).sum()) for new in created), 4 * loops + 2 * walls)


class Touching(SolidTest):
    """Where two shells have the same face, each keeps its own."""

    def test_boxes_that_touch_have_six_polygons_each(self):
        box, quads = BOX
        vertices = [(x + dx, y, z) for dx in (0, 1, 4) for x, y, z in box]
        # Of the third, a face is missing: the model isn't filled exactly.
        faces = [tuple(vertex + 8 * k for vertex in quad) for k in range(3) for quad in quads][:-1]
        obj = self.add(vertices, faces, "boxes")
        for number in range(3):
            obj.data.materials.append(bpy.data.materials.new(f"paint {number}"))
        obj.data.polygons.foreach_set("material_index", [number // 6 for number in range(17)])
        self.assertEqual(part("api").build(obj).summary.fill_method, "repaired")
        created = part("api").write(obj, part("api").cut(obj, 3), {"OBJECTS"}, origins=False).objects
        for new in [*created, *(part("api").copy_part(obj, part("api").cut(obj, 3)[k]) for k in range(3))]:
            self.assertSolid(new.data)
            self.assertAlmostEqual(volume(new.data), 1, 5)
            own = [polygon for polygon, cap in zip(new.data.polygons, caps(new.data)) if not cap]
            paint, = {polygon.material_index for polygon in own}
            self.assertEqual(len(own), 5 if paint == 2 else 6)
        self.assertFalse([*part("cut.objects").difference_messages(obj, part("api").cut(obj, 3), created, False)])
