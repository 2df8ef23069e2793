# SPDX-License-Identifier: GPL-3.0-or-later
"""From the part in hand to others, without a window: those that are alike, and the one on the other side."""

import tempfile
from pathlib import Path

import bpy
import numpy
from common import MeshTest, part, selected, snapshot
from test_modal import FakeContext, Tool, event


def jack(lengths, cells=4):
    """A cube of quads with a bar on each of its six sides, so many cells long: towards -x, +x, -y, +y, -z, +z."""
    full = {(x, y, z) for x in range(cells) for y in range(cells) for z in range(cells)}
    for axis in range(3):
        for way in (-1, 1):
            for along in range(lengths[2 * axis + (way > 0)]):
                for u in range(1, cells - 1):
                    for v in range(1, cells - 1):
                        cell = [0, 0, 0]
                        cell[axis], cell[axis - 1], cell[axis - 2] = cells + along if way > 0 else -1 - along, u, v
                        full.add(tuple(cell))
    return surface(full)


def table():
    """A plate of quads on four legs."""
    plate = {(x, y, 0) for x in range(12) for y in range(8)}
    return surface(plate | {(x, y, -z) for x in (0, 1, 10, 11) for y in (0, 1, 6, 7) for z in range(1, 9)})


def surface(full):
    """(vertices, quads) of a set of cells."""
    vertices, polygons = {}, []
    for cell in sorted(full):
        for axis in range(3):
            for way in (0, 1):
                if tuple(numpy.array(cell) + (2 * way - 1) * numpy.eye(3, dtype=int)[axis]) in full:
                    continue
                corners = []
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))[::1 if way else -1]:
                    corner = list(cell)
                    corner[axis] += way
                    corner[(axis + 1) % 3] += u
                    corner[(axis + 2) % 3] += v
                    corners.append(vertices.setdefault(tuple(corner), len(vertices)))
                polygons.append(tuple(corners))
    return list(vertices), polygons


class Related(MeshTest):
    def setUp(self):
        super().setUp()
        self.use(4, 8, 4, 8, 4, 8)

    def use(self, *lengths):
        self.obj = self.add(*jack(lengths))
        self.h = self.api.build(self.obj)

    @property
    def api(self):
        return part("api")

    def bar(self, axis, way, begin=4):
        """The node that is nearest to being a bar. begin: of the one towards +."""
        centers = numpy.array([face.center for face in self.obj.data.polygons])[:, axis]
        return self.nearest_node(centers > begin if way > 0 else centers < 0)

    def nearest_node(self, is_inside):
        expected = set(numpy.flatnonzero(is_inside).tolist())
        overlap = [len(expected & faces) / len(expected | faces)
                   for faces in (set(self.h.faces(node).tolist()) for node in range(len(self.h.parent)))]
        self.assertGreater(max(overlap), 0.8)
        return int(numpy.argmax(overlap))

    def faces(self, *nodes):
        return set(face for node in nodes for face in self.h.faces(node).tolist())

    def remembered(self):
        """{name: its faces}. Not its node: another one may have the same faces, and other tetrahedra inside."""
        return {name: self.faces(node) for name, node in self.api.remembered_parts(self.obj).items()}

    def in_hand(self, node):
        self.edit(self.obj)
        self.api.select(self.obj, node)

    def test_all_bars_of_one_length(self):
        for way in (1, -1):
            bars = [self.bar(axis, way) for axis in range(3)]
            likeness_of = self.api.similar(self.obj, bars[0])
            self.assertEqual(self.faces(*(node for node, _ in likeness_of[:2])), self.faces(*bars[1:]))
            self.in_hand(bars[0])
            self.assertEqual(bpy.ops.mesh.partwheel_similar(threshold=likeness_of[1][1] - 1e-4), {"FINISHED"})
            self.assertEqual(selected(self.obj), self.faces(*bars))
            self.assertEqual(bpy.ops.mesh.partwheel_similar(threshold=1, extend=False), {"FINISHED"})
            self.assertEqual(selected(self.obj), self.faces(bars[0], *(node for node, value in likeness_of if value == 1)))
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_the_mirrored_part_is_selected(self):
        self.use(6, 6, 4, 7, 3, 8)
        left, right = self.bar(0, -1), self.bar(0, 1)
        self.assertEqual((self.api.mirror_image(self.obj, left), self.api.mirror_image(self.obj, right)), (right, left))
        self.assertEqual(self.api.mirror_image(self.obj, left, plane=0), right)
        with self.assertRaisesRegex(ValueError, "numbered from 0 to 0"):
            self.api.mirror_image(self.obj, left, plane=1)
        self.in_hand(left)
        self.assertEqual(bpy.ops.mesh.partwheel_mirrored(plane=0), {"FINISHED"})
        self.assertEqual(selected(self.obj), self.faces(left, right))
        self.assertEqual(part("parts.picks").get_pick(snapshot(self.obj)).node, left)
        self.assertEqual(bpy.ops.mesh.partwheel_mirrored(extend=False), {"FINISHED"})
        self.assertEqual(selected(self.obj), self.faces(right))
        self.assertEqual(part("parts.picks").get_pick(snapshot(self.obj)).node, right)
        # What the panel of the last operation does again, with the part of then.
        self.assertEqual(bpy.ops.mesh.partwheel_mirrored(node=left), {"FINISHED"})
        self.assertEqual(selected(self.obj), self.faces(left, right))

    def test_planes_count_from_0_for_operators_as_in_the_api(self):
        self.obj = self.add(*table())
        self.h = self.api.build(self.obj)
        centers = numpy.array([face.center for face in self.obj.data.polygons])
        leg = self.nearest_node((centers < (3, 3, 0)).all(axis=1))
        images = [self.api.mirror_image(self.obj, leg, plane=plane) for plane in range(2)]
        self.assertEqual(len({leg, *images}), 3)
        for plane, image in enumerate(images):
            self.in_hand(leg)
            self.assertEqual(bpy.ops.mesh.partwheel_mirrored(plane=plane, extend=False), {"FINISHED"})
            self.assertEqual(selected(self.obj), self.faces(image), plane)
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_remembered_parts(self):
        bars = [self.bar(axis, 1) for axis in range(3)]
        for bar, name in zip(bars, ("Left Arm", "Bein", "頭")):
            self.in_hand(bar)
            self.assertEqual(bpy.ops.mesh.partwheel_remember(part=f" {name} "), {"FINISHED"})
            bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(self.remembered(), dict(zip(("Left Arm", "Bein", "頭"), map(self.faces, bars))))
        self.edit(self.obj)
        for name, bar in zip(("頭", "Left Arm"), (bars[2], bars[0])):
            self.assertEqual(bpy.ops.mesh.partwheel_recall(part=name), {"FINISHED"})
            self.assertEqual(selected(self.obj), self.faces(bar))
            self.assertEqual(self.faces(part("parts.picks").get_pick(snapshot(self.obj)).node), self.faces(bar))
        bpy.ops.mesh.partwheel_recall(part="Bein", extend=True)
        self.assertEqual(selected(self.obj), self.faces(bars[0], bars[1]))
        for modifiers in ({}, {"shift": True}, {"ctrl": True}):  # a click on the name
            tool = Tool("recall", ("MESH",), part="Left Arm")
            self.assertEqual(tool.invoke(FakeContext(), event("LEFTMOUSE", **modifiers)), {"FINISHED"})
            self.assertEqual((tool.extend, tool.deselect), (bool(modifiers.get("shift")), bool(modifiers.get("ctrl"))))
            bpy.ops.mesh.partwheel_recall(part="Bein", extend=True)
        bpy.ops.mesh.partwheel_recall(part="Left Arm", deselect=True)
        self.assertEqual(selected(self.obj), self.faces(bars[1]))
        self.assertEqual(bpy.ops.mesh.partwheel_rename(part="Bein", new="Leg"), {"FINISHED"})
        self.assertEqual(bpy.ops.mesh.partwheel_forget(part="Left Arm"), {"FINISHED"})
        self.assertEqual(set(part("related.named_parts").part_names(self.obj.data)), {"Leg", "頭"})
        for operator, values, words in (
                (bpy.ops.mesh.partwheel_remember, {"part": "Leg"}, "There already is a remembered part Leg"),
                (bpy.ops.mesh.partwheel_remember, {"part": "  "}, "Enter a name"),
                (bpy.ops.mesh.partwheel_remember, {"part": 60 * "x"}, "too long"),
                (bpy.ops.mesh.partwheel_rename, {"part": "Leg", "new": "頭"}, "There already is"),
                (bpy.ops.mesh.partwheel_recall, {"part": "Left Arm"}, "model has no remembered part Left Arm"),
                (bpy.ops.mesh.partwheel_forget, {"part": "Left Arm"}, "no remembered part")):
            with self.assertRaisesRegex(RuntimeError, words):
                operator(**values)
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(self.remembered(), {"Leg": self.faces(bars[1]), "頭": self.faces(bars[2])})

    def test_remembered_parts_are_found_again(self):
        """After moving vertices, after finding the parts anew, after edits of the mesh, in another file."""
        obj = self.obj
        bar, own = self.bar(1, 1), self.faces(self.bar(1, 1))
        self.api.remember(obj, bar, "Bar")
        for vertex in obj.data.vertices:
            vertex.co.y *= 1.5
        obj.data.update()
        self.assertEqual(self.remembered(), {"Bar": own})
        self.h = self.api.build(obj)
        self.assertEqual(self.remembered(), {"Bar": self.faces(self.bar(1, 1, 6))})
        self.edit(obj)
        bpy.ops.mesh.partwheel_recall(part="Bar")
        self.assertGreater(len(selected(obj) & own), 0.8 * len(selected(obj) | own))
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide(number_cuts=1)
        bpy.ops.object.mode_set(mode="OBJECT")
        with tempfile.TemporaryDirectory() as directory:
            path = str(Path(directory) / "kept.blend")
            bpy.data.libraries.write(path, {obj})
            bpy.data.objects.remove(obj)
            with bpy.data.libraries.load(path) as (_, bar_faces):
                bar_faces.objects = ["model"]
        self.obj = obj = self.link(bar_faces.objects[0])
        self.h = self.api.build(obj)
        remembered, bar_faces = self.faces(self.api.remembered_parts(obj)["Bar"]), self.faces(self.bar(1, 1, 6))
        self.assertGreater(len(remembered & bar_faces), 0.7 * len(remembered | bar_faces))
        with self.assertRaisesRegex(part("mesh.errors").Refused, "model no longer has a part similar to"):
            few = obj.data.attributes.new("part: every other", "INT", "FACE")
            few.data.foreach_set("value", (numpy.arange(len(obj.data.polygons)) % 3 == 0).astype(numpy.int32))
            self.api.remembered_parts(obj)
