# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts from what a model has already: materials, face sets, vertex groups, attributes, loose parts."""

import tempfile
from pathlib import Path

import bpy
import numpy
from common import BOX, only_in, part
import painted_figure
from solid_case import SolidTest, caps, volume

NAMES = ["skin", "shirt", "hair"]


class LabelsTest(SolidTest):
    def figure(self, source):
        """(a figure with shirt and hair, whose patches are of this source; the patch of each polygon)"""
        obj = painted_figure.create_figure()
        mesh, patches = obj.data, painted_figure.patches(obj).astype(numpy.int32)
        mesh.attributes.new("number", "INT", "FACE").data.foreach_set("value", numpy.arange(len(patches), dtype=numpy.int32))
        if source == "MATERIALS":
            mesh.materials.clear()
            for name in NAMES:
                mesh.materials.append(bpy.data.materials.new(name))
            mesh.polygons.foreach_set("material_index", patches)
        elif source == "FACE_SETS":
            mesh.attributes.new(".sculpt_face_set", "INT", "FACE").data.foreach_set("value", 7 * patches + 2)
        elif source == "VERTEX_GROUPS":  # a polygon may have corners of two groups, and one has the larger sum
            weights = numpy.zeros((3, len(mesh.vertices)))
            for polygon, patch in zip(mesh.polygons, patches):
                weights[patch, polygon.vertices[:]] += 1 / 8
            for name, of_group in zip(NAMES, weights):
                group = obj.vertex_groups.new(name=name)
                for vertex in numpy.flatnonzero(of_group).tolist():
                    group.add([vertex], of_group[vertex], "REPLACE")
            patches = numpy.array([weights[:, polygon.vertices[:]].sum(axis=1).argmax() for polygon in mesh.polygons])
        elif source == "ATTRIBUTE":
            mesh.attributes.new("segment", "INT", "FACE").data.foreach_set("value", patches - 1)
        return obj, patches

    def two_boxes(self):
        obj = self.add([*BOX[0], *((x + 5, 2 * y, z) for x, y, z in BOX[0])],
                       [*BOX[1], *(tuple(corner + 8 for corner in polygon) for polygon in BOX[1])])
        obj.data.attributes.new("number", "INT", "FACE").data.foreach_set("value", numpy.arange(12, dtype=numpy.int32))
        return obj, numpy.arange(12) // 6

    def borders_without_seam(self, obj, labels):
        sides = {}
        for polygon, label in zip(obj.data.polygons, labels.tolist()):
            for key in polygon.edge_keys:
                sides.setdefault(key, set()).add(label)
        unmarked = {tuple(edge.vertices) for edge in obj.data.edges if not edge.use_seam}
        return [key for key, meeting in sides.items() if len(meeting) > 1 and (key in unmarked or key[::-1] in unmarked)]

    def numbers(self, mesh):
        """Which polygons of the model a part has."""
        values = numpy.empty(len(mesh.polygons), numpy.int32)
        mesh.attributes["number"].data.foreach_get("value", values)
        return values[~caps(mesh)]

    def test_objects_are_exactly_the_faces_of_each_label(self):
        names = {"MATERIALS": set(NAMES), "VERTEX_GROUPS": set(NAMES), "ATTRIBUTE": {"segment -1", "segment 0", "segment 1"}}
        for source in ("MATERIALS", "FACE_SETS", "VERTEX_GROUPS", "ATTRIBUTE", "LOOSE"):
            with self.subTest(source):
                obj, labels = self.two_boxes() if source == "LOOSE" else self.figure(source)
                self.assertIn((source, "segment" * (source == "ATTRIBUTE")), part("mesh.labels").list_sources(obj))
                whole = volume(obj.data)
                before = set(bpy.data.objects)
                part("api").build(obj)  # its parts cross the borders, so they are found again
                self.assertEqual(bpy.ops.mesh.partwheel_parts(source=source, attribute="segment" * (source == "ATTRIBUTE"),
                                                              to={"OBJECTS"}), {"FINISHED"})
                objects = set(bpy.data.objects) - before
                expected = {frozenset(numpy.flatnonzero(labels == label).tolist()) for label in numpy.unique(labels)}
                self.assertEqual({frozenset(self.numbers(new.data).tolist()) for new in objects}, expected)
                for new in objects:
                    self.assertSolid(new.data)
                self.assertAlmostEqual(sum(volume(new.data) for new in objects) / whole, 1, delta=0.002)  # it crosses itself and is repaired
                if source in names:
                    self.assertEqual({new.name.split(".0")[0] for new in objects}, names[source])

    def test_only_what_a_model_has_is_listed(self):
        obj = self.add(*BOX)
        self.assertEqual(list(part("mesh.labels").list_sources(obj)), [])
        with self.assertRaisesRegex(RuntimeError, "no Face Sets"):
            bpy.ops.mesh.partwheel_parts(source="FACE_SETS")
        with self.assertRaisesRegex(RuntimeError, "no segment"):
            bpy.ops.mesh.partwheel_parts(source="ATTRIBUTE", attribute="segment")

    @only_in("oldest", "newest")
    def test_other_results_and_edits_continue_from_labels(self):
        obj, labels = self.figure("MATERIALS")
        api = part("api")
        cut = api.cut(obj, labels=labels * 10)
        self.assertEqual(cut.labels.tolist(), labels.tolist())
        self.assertEqual(api.cut(obj, labels="MATERIALS"), cut)
        self.assertIs(api.hierarchy(obj), cut.hierarchy)  # it was not built again
        names, _, rig = api.write(obj, cut, to={"SEAMS", "BONES"})
        self.assertEqual({name.split(".")[0] for name in names}, set(NAMES))
        self.assertEqual({bone.name for bone in rig.data.bones}, set(names))
        self.assertEqual(self.borders_without_seam(obj, labels), [])
        halves = cut.split(int(labels[0]))
        self.assertGreater(len(halves), len(cut))
        for number in range(len(halves)):
            self.assertEqual(len(set(labels[halves.labels == number])), 1)
        self.assertEqual(bpy.ops.mesh.partwheel_convex(hulls=2, each="MATERIALS"), {"FINISHED"})
        with self.assertRaisesRegex(ValueError, "a label for each"):
            api.cut(obj, labels=[1, 2])
        with self.assertRaisesRegex(ValueError, "only one of"):
            api.cut(obj, parts=3, labels="MATERIALS")

    @only_in("oldest", "newest")
    def test_a_saved_cut_keeps_the_borders_of_labels_after_a_restart(self):
        """Also if the file has no hierarchy with these borders; automatic parts have none that somebody chose."""
        obj, labels = self.figure("MATERIALS")
        self.assertEqual(bpy.ops.mesh.partwheel_parts(source="MATERIALS", to=set()), {"FINISHED"})
        with tempfile.TemporaryDirectory() as directory:
            path = str(Path(directory) / "saved.blend")
            bpy.ops.wm.save_as_mainfile(filepath=path)
            bpy.ops.wm.open_mainfile(filepath=path)
        obj = bpy.data.objects["figure"]
        bpy.context.view_layer.objects.active = obj
        api = part("api")
        for is_stored in (True, False):
            with self.subTest(is_stored=is_stored):
                if not is_stored:
                    obj.data.materials.clear()  # which would be marks
                    api.clear(obj)
                    api.build(obj)
                obj.data.edges.foreach_set("use_seam", numpy.zeros(len(obj.data.edges), bool))
                self.assertEqual(bpy.ops.mesh.partwheel_parts(to={"SEAMS"}), {"FINISHED"})
                self.assertEqual(self.borders_without_seam(obj, labels), [])
                cut, names = api.load_cut(obj)
                self.assertEqual((cut.labels.tolist(), cut.keeps_borders, names), (labels.tolist(), True, NAMES))
        for count in (4, 0):  # 0: continues the four
            self.assertEqual(bpy.ops.mesh.partwheel_parts(to=set(), count=count), {"FINISHED"})
            cut, _ = api.load_cut(obj)
            self.assertEqual((len(cut), cut.keeps_borders), (4, False))
