# SPDX-License-Identifier: GPL-3.0-or-later
"""The groups of objects above a whole object, and what is selected there in Object Mode and in Edit Mode."""

import random
from pathlib import Path

import bpy
import numpy
from common import BOX, MeshTest, part, selected

KNIGHT = Path(__file__).resolve().parents[3] / "shared" / "assets" / "files" / "Knight.glb"


class GroupTest(MeshTest):
    """Boxes of side 1, far from each other unless a test says otherwise."""

    def setUp(self):
        super().setUp()
        for data in (bpy.data.collections, bpy.data.armatures):
            for item in list(data):
                data.remove(item)

    def collection(self, name, parent=None):
        collection = bpy.data.collections.new(name)
        (parent or bpy.context.scene.collection).children.link(collection)
        return collection

    def place(self, obj, collection=None, parent=None, at=(0, 0, 0)):
        (collection or bpy.context.scene.collection).objects.link(obj)
        obj.location, obj.parent = at, parent
        bpy.context.view_layer.update()
        return obj

    def box(self, name, at=None, collection=None, parent=None, mesh=BOX):
        data = bpy.data.meshes.new(name)
        data.from_pydata(mesh[0], [], mesh[1])
        return self.place(bpy.data.objects.new(name, data), collection, parent,
                          at or (10 * len(bpy.data.objects), 0, 0))

    def empty(self, name, parent=None, collection=None):
        return self.place(bpy.data.objects.new(name, None), collection, parent)

    def armature(self, name="rig"):
        return self.place(bpy.data.objects.new(name, bpy.data.armatures.new(name)))

    def groups(self, obj, candidates=None):
        """The names in each group, as words in alphabetical order."""
        candidates = bpy.context.selectable_objects if candidates is None else candidates
        meshes = [each for each in candidates if each.type == "MESH"]
        return [" ".join(sorted(each.name for each in group))
                for group in part("pick.object_groups").find_object_groups(obj, meshes)]


class Family(GroupTest):
    def test_an_object_without_any_relation_has_no_groups(self):
        a, _ = self.box("a"), self.box("b")
        self.assertEqual(self.groups(a), [])

    def test_families_grow_from_children_to_the_farthest_ancestor(self):
        root = self.empty("root")
        car = self.box("car", parent=root)
        wheel = self.box("wheel", parent=car)
        rim, _ = self.box("rim", parent=wheel), self.box("door", parent=car)
        self.box("other", parent=root)
        everything = "car door other rim wheel"
        self.assertEqual(self.groups(wheel), ["rim wheel", "car door rim wheel", everything])
        self.assertEqual(self.groups(rim), ["rim wheel", "car door rim wheel", everything])
        self.assertEqual(self.groups(car), ["car door rim wheel", everything])

    def test_a_circle_of_relations_ends(self):
        rig, a = self.armature(), self.box("a")
        b = self.box("b", parent=rig)
        rig.parent = a
        a.modifiers.new("Armature", "ARMATURE").object = rig
        self.assertEqual([self.groups(a), self.groups(b)], [["a b"]] * 2)


class Collections(GroupTest):
    def test_collections_grow_outward_without_the_root(self):
        outer = self.collection("outer")
        inner = self.collection("inner", outer)
        a, _ = self.box("a", collection=inner), self.box("b", collection=inner)
        c, d = self.box("c", collection=outer), self.box("d")
        self.assertEqual([self.groups(each) for each in (a, c, d)], [["a b", "a b c"], ["a b c"], []])

    def test_families_precede_collections(self):
        collection, root = self.collection("all"), self.empty("root")
        a, _ = self.box("a", collection=collection, parent=root), self.box("b", parent=root)
        self.box("c", collection=collection)
        self.assertEqual(self.groups(a), ["a b", "a b c"])

    def test_hidden_unselectable_and_excluded_objects_and_empty_meshes(self):
        collection = self.collection("all")
        names = "visible", "hidden", "off", "unselectable", "excluded", "removed"
        objects = {name: self.box(name, collection=collection) for name in names}
        a = self.box("a", collection=collection)
        self.box("blank", collection=collection, mesh=((), ()))
        objects["hidden"].hide_set(True)
        objects["off"].hide_viewport = True
        objects["unselectable"].hide_select = True
        away = self.collection("away", collection)
        away.objects.link(objects["excluded"])
        collection.objects.unlink(objects["excluded"])
        layer = bpy.context.view_layer.layer_collection.children["all"].children["away"]
        layer.exclude = True
        bpy.data.objects.remove(objects["removed"])
        bpy.context.view_layer.update()
        self.assertEqual(self.groups(a), ["a blank visible"])
        away.hide_select, layer.exclude = True, False
        self.assertEqual(self.groups(a), ["a blank visible"])


class Contacts(GroupTest):
    def row(self, *positions, **options):
        """Boxes a, b, ... at these places of a line."""
        return [self.box(name, at=(x, 0, 0), **options) for name, x in zip("abcdefgh", positions)]

    def test_contacts_precede_families(self):
        a, b, *_ = self.row(0, 1, 2, 3, 5, parent=self.empty("root"))
        self.assertEqual(self.groups(a), ["a b", "a b c d", "a b c d e"])
        self.assertEqual(self.groups(b), ["a b c", "a b c d", "a b c d e"])

    def test_the_distance_is_one_percent_of_the_diagonal(self):
        for gap, touches in ((0.015, True), (0.02, False)):  # of the box: 3 ** 0.5 / 100
            a, b = self.row(0, 1 + gap)
            self.assertEqual(self.groups(a), ["a b"] * touches, gap)
            bpy.data.objects.remove(a)
            bpy.data.objects.remove(b)

    def test_surfaces_that_intersect_far_from_all_vertices(self):
        blade = [(4.9 + 0.2 * x, 4.9 + 0.2 * y, 9 * z) for x, y, z in BOX[0]], BOX[1]
        a = self.box("blade", at=(0, 0, -4), mesh=blade)
        self.box("shield", at=(0, 0, 0), mesh=([(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)], [(0, 1, 2, 3)]))
        self.assertEqual(self.groups(a), ["blade shield"])

    def test_random_scenes_are_nested(self):
        draw = random.Random(53)
        for _ in range(5):
            self.setUp()
            parents, collections = [None], [None]
            for number in range(4):
                parents.append(self.empty(f"empty {number}", draw.choice(parents)))
                collections.append(self.collection(f"collection {number}", draw.choice(collections)))
            boxes = []
            for number in range(20):
                at = [draw.uniform(0, 6) for _ in range(3)]
                boxes.append(self.box(f"box {number}", at, draw.choice(collections), draw.choice(parents)))
                parents.append(boxes[-1])
            for obj in boxes:
                groups = part("pick.object_groups").find_object_groups(obj, boxes[:15])
                for smaller, larger in zip(({obj}, *groups), groups):
                    self.assertTrue(smaller < larger <= {obj, *boxes[:15]})


class ObjectMode(GroupTest):
    """Four boxes: a and b touch, c is their sibling, d is something else that is selected."""

    def setUp(self):
        super().setUp()
        root = self.empty("root")
        self.a, self.b, self.c = (self.box(name, at=(x, 0, 0), parent=root) for name, x in zip("abc", (0, 1, 5)))
        self.d = self.box("d")
        self.d.select_set(True)
        bpy.context.view_layer.objects.active = self.a
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.top = len(part("pick.states").pick_face(part("api").hierarchy(self.a), 0).stops)
        self.first = part("pick.states").pick_face(part("api").hierarchy(self.a), 0).start

    def pick(self, group, operator=None, **options):
        """Picks the group of this number above the whole, 0 for the whole itself."""
        operator = operator or bpy.ops.object.partwheel_pick
        self.assertEqual(operator("EXEC_DEFAULT", face_index=0, level=self.top - 1 + group - self.first, **options),
                         {"FINISHED"})

    def chosen(self):
        return "".join(sorted(each.name for each in bpy.context.selected_objects))

    def test_the_groups_are_selected_and_the_clicked_object_active(self):
        for group, names in ((0, "a"), (1, "ab"), (2, "abc"), (9, "abc"), (1, "ab")):
            bpy.context.view_layer.objects.active = self.a
            self.pick(group)
            self.assertEqual((self.chosen(), bpy.context.active_object), (names, self.a))

    def test_into_edit_mode(self):
        bpy.ops.object.mode_set(mode="OBJECT")
        copy = self.place(bpy.data.objects.new("copy", self.a.data), parent=self.a.parent, at=(0, 9, 0))
        self.pick(2, bpy.ops.object.partwheel_select)
        self.assertEqual({*bpy.context.objects_in_mode}, {self.a, self.b, self.c})
        self.assertEqual([selected(each) for each in (self.a, self.b, self.c)], [set(range(6))] * 3)
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertFalse(copy.select_get())


class Knight(GroupTest):
    def test_the_head_is_the_first_stop_of_the_knight(self):
        if not KNIGHT.exists():
            self.skipTest(f"{KNIGHT} is not there")
        vars(numpy).setdefault("bool", bool)  # for Debian's importer, which is older than its numpy
        bpy.ops.import_scene.gltf(filepath=str(KNIGHT))
        head = bpy.data.objects["Knight_Head"]
        touching, *_, whole = self.groups(head)
        self.assertEqual(set(whole.split()), {each.name for each in bpy.data.objects["Rig"].children_recursive
                                              if each.type == "MESH"})
        self.assertLessEqual({"Knight_Body", "Knight_Head", "Knight_Helmet"}, set(touching.split()))
        self.assertFalse({"Knight_LegLeft", "Knight_LegRight"} & set(touching.split()))
