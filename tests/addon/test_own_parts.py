# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts made by hand become wheel stops of their mesh: after undo, in files, in Edit Mode, and whatever others write."""

import json
import tempfile
from pathlib import Path

import bpy
import numpy
from common import MeshTest, part, read_off, snapshot
from partwheel.cut import Cut
from test_foreign_data import VALUES

FACE = 700


class OwnParts(MeshTest):
    def setUp(self):
        super().setUp()
        self.obj = self.add(*read_off("hand"))
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        hierarchy = self.tree()
        cut = Cut.automatic(hierarchy)
        # Neighbors in the list of parts that aren't siblings: their union is no node.
        pairs = [(cut.merge(0, other), 0) for other in range(1, len(cut))]
        self.cut, self.number = next((merged, k) for merged, k in pairs if merged.node(k) is None)
        self.faces = frozenset(self.cut.faces(self.number).tolist())

    def tree(self):
        return part("parts.registry").get_hierarchy(snapshot(self.obj))

    def stops(self):
        tree = self.tree()
        return [frozenset(tree.faces(stop).tolist()) for stop in tree.wheel(min(self.faces))[0]]

    def write(self):
        return bpy.ops.mesh.partwheel_parts(to=set(), clusters=json.dumps(self.cut.parts),
                                            own_parts=json.dumps([self.cut.parts[self.number]]))

    def test_a_merged_part_is_a_stop_until_undo(self):
        name, before = self.obj.name, self.tree()
        self.assertNotIn(self.faces, self.stops())
        bpy.ops.ed.undo_push(message="built")
        self.assertEqual(self.write(), {"FINISHED"})
        bpy.ops.ed.undo_push(message="parts")
        after = self.tree()
        self.assertIn(self.faces, self.stops())
        for _ in range(2):
            bpy.ops.ed.undo()
            self.obj = bpy.data.objects[name]
            self.assertIs(self.tree(), before)
            bpy.ops.ed.redo()
            self.obj = bpy.data.objects[name]
            self.assertIs(self.tree(), after)
        self.assertIs(part("parts.registry").get_state(self.obj.data)[1].hierarchy, after)

    def test_it_is_a_stop_of_a_new_build(self):
        self.write()
        self.obj.data.vertices[0].co.x += 0.001
        self.obj.data.update()
        tree = part("api").build(self.obj)
        self.assertIs(tree, self.tree())
        self.assertIn(self.faces, self.stops())

    def test_it_comes_with_the_file_and_with_a_copy(self):
        self.write()
        saved = self.tree().save()
        with tempfile.TemporaryDirectory() as directory:
            path = str(Path(directory) / "own.blend")
            bpy.ops.wm.save_as_mainfile(filepath=path)
            bpy.ops.wm.open_mainfile(filepath=path)
        self.obj = bpy.data.objects["model"]
        self.assertEqual(self.tree().save(), saved)
        entry = part("parts.registry").find_entry(self.obj.data)
        self.assertIs(entry.hierarchy, entry.built)  # the file has it with the parts: nothing is computed
        copy = self.obj.copy()
        copy.data = self.obj.data.copy()
        self.obj = self.link(copy)
        self.assertIn(self.faces, self.stops())

    def test_it_is_picked_in_edit_mode(self):
        self.write()
        bpy.context.view_layer.objects.active = self.obj
        self.edit(self.obj)
        self.assertIn(self.faces, self.stops())
        self.assertEqual(bpy.ops.mesh.partwheel_select(face_index=min(self.faces)), {"FINISHED"})
        bpy.ops.object.mode_set(mode="OBJECT")
        selected = {face.index for face in self.obj.data.polygons if face.select}
        self.assertEqual(selected, self.faces)

    def test_parts_that_are_stops_and_automatic_ones_change_nothing(self):
        cut = Cut.automatic(self.tree())
        bpy.ops.mesh.partwheel_parts(to=set(), count=0)
        self.assertNotIn("partwheel_own_part", self.obj.data.attributes)
        part("api").write(self.obj, cut, own_parts=[k for k in range(len(cut)) if part("cut.writing").is_wheel_stop(cut, k)])
        self.assertNotIn("partwheel_own_part", self.obj.data.attributes)

    def test_a_second_part_stays_beside_the_first_unless_they_cross(self):
        part("api").write(self.obj, self.cut, own_parts=[self.number])
        inner = part("api").cut(self.obj, parts=1)
        labels = numpy.ones(len(self.obj.data.polygons), int)
        labels[sorted(self.faces)[:len(self.faces) // 2]] = 0
        inner = Cut.from_labels(self.tree(), labels)
        inside = frozenset(inner.faces(0).tolist())
        part("api").write(self.obj, inner, own_parts=[0])
        stored = [frozenset(numpy.flatnonzero(mask).tolist()) for mask in part("parts.own_parts").load(self.obj.data)]
        self.assertIn(inside, stored)
        self.assertEqual(self.faces in stored, inside <= self.faces)

    def test_whatever_others_write_is_no_error(self):
        self.write()
        own = part("parts.own_parts")
        saved = [mask.sum() for mask in own.load(self.obj.data)]
        for value in VALUES:
            self.obj.data[own.PROPERTY] = value
            self.assertEqual([mask.sum() for mask in own.load(self.obj.data)], saved, value)
        data = self.obj.data.attributes[own.ATTRIBUTE].data
        data.foreach_set("value", numpy.arange(len(data), dtype=numpy.int32) * 10**5 - 10**8)
        self.assertEqual(own.load(self.obj.data), [])
        self.obj.data.update()
        self.assertEqual(len(self.stops()), len(self.tree().wheel(min(self.faces))[0]))
