# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole model in parts, as bones: what is written is read back and posed, on five real models, three of them
broken."""

import math
from types import SimpleNamespace

import bpy
import numpy
from common import only_in, part
from mathutils import Matrix, Vector
from test_parts_to import PartsCase


def posed(obj):
    """(V,3) where the modifiers have the vertices."""
    bpy.context.view_layer.update()
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return numpy.array([vertex.co[:] for vertex in mesh.vertices])


def at_rest(obj):
    return numpy.array([vertex.co[:] for vertex in obj.data.vertices])


def turn(rig, name, degrees):
    bone = rig.pose.bones[name]
    bone.rotation_mode = "XYZ"
    bone.rotation_euler = math.radians(degrees), 0, 0


class Bones(PartsCase):
    @only_in("oldest", "newest")
    def test_an_armature_of_the_parts(self):
        for model, obj, cut in self.each():
            obj.location, obj.rotation_euler = (3, 1, 2), (0.3, 0.2, 1)
            bpy.context.view_layer.update()
            before = obj.matrix_world.copy()
            names, created, rig = part("api").write(obj, cut, {"BONES"})
            self.assertEqual(created, [])
            self.assertEqual(rig, obj.find_armature())
            self.assertEqual(set(rig.data.bones.keys()), set(names))
            self.assertEqual({group.name for group in obj.vertex_groups}, set(names))
            self.assertEqual(sum(bone.parent is None for bone in rig.data.bones), 1)
            self.assertTrue(all(bone.use_deform and bone.length > 0 for bone in rig.data.bones))
            bpy.context.view_layer.update()
            for changed in (obj, rig):
                self.assertLess(abs(numpy.array(changed.matrix_world) - numpy.array(before)).max(), 1e-6)
            self.assertEqual(obj.parent, rig)
            self.assertLess(abs(posed(obj) - at_rest(obj)).max(), 1e-5 * max(obj.dimensions), model)
            self.assertEqual(bpy.context.view_layer.objects.active, obj)
            self.assertEqual(bpy.context.mode, "OBJECT")

    @only_in("oldest", "newest")
    def test_posing_works_at_once(self):
        for model, obj, cut in self.each():
            names = part("api").write(obj, cut, {"BONES"}).names
            rig, rest = obj.find_armature(), at_rest(obj)
            weights = {name: numpy.zeros(len(rest)) for name in names}
            for vertex in obj.data.vertices:
                for group in vertex.groups:
                    weights[obj.vertex_groups[group.group].name][vertex.index] = group.weight
            areas = numpy.bincount(cut.labels, [polygon.area for polygon in obj.data.polygons])
            for bone in rig.data.bones:
                if not bone.parent:
                    continue
                turn(rig, bone.name, 60)
                after = posed(obj)
                # What hangs on the bone turns with it as one, the rest stays, and the head is what it turns about.
                about = bone.matrix_local.copy()
                matrix = numpy.array(about @ Matrix.Rotation(math.radians(60), 4, "X") @ about.inverted())
                below = sum(weights[descendant.name] for descendant in [bone, *bone.children_recursive])
                size = max(obj.dimensions)
                self.assertLess((below - 1).max(), 1e-5)
                moved = rest @ matrix[:3, :3].T + matrix[:3, 3]
                inside, outside = below > 1 - 1e-6, below < 1e-6
                self.assertTrue(outside.any(), (model, bone.name))
                if areas[names.index(bone.name)] > 0.03 * areas.sum():  # of small or coarse ones all is joint
                    self.assertGreater(below.max(), 0.5, (model, bone.name))
                self.assertLess(abs(after - moved)[inside].max(initial=0), 1e-4 * size, (model, bone.name))
                self.assertLess(abs(after - rest)[outside].max(), 1e-4 * size)
                self.assertLess((Vector(matrix[:3, :3] @ bone.head_local) + Vector(matrix[:3, 3])
                                 - bone.head_local).length, 1e-4 * size)
                turn(rig, bone.name, 0)
            self.assertLess(abs(posed(obj) - rest).max(), 1e-5 * max(obj.dimensions))

    def test_the_second_time_the_same_armature(self):
        obj, cut = self.model("homer")
        names = part("api").write(obj, cut, {"BONES"}).names
        rig = obj.find_armature()
        kept_name = names[-1]
        rig.pose.bones[kept_name].constraints.new("LIMIT_ROTATION")
        turn(rig, kept_name, 30)
        split = cut.split(0)
        names = part("api").write(obj, split, {"BONES", "COLORS"}).names
        self.assertEqual(obj.find_armature(), rig)
        self.assertEqual(len([modifier for modifier in obj.modifiers if modifier.type == "ARMATURE"]), 1)
        self.assertEqual(set(rig.data.bones.keys()), set(names))
        self.assertIn(kept_name, names)
        self.assertEqual(len(rig.pose.bones[kept_name].constraints), 1)
        self.assertAlmostEqual(rig.pose.bones[kept_name].rotation_euler.x, math.radians(30), 5)
        self.assertEqual(len(obj.data.materials), len(split))
        # One that deforms a duplicate as well is left alone, and so is the user's own.
        double = self.link(obj.copy())
        double.data = obj.data.copy()
        part("api").write(double, part("api").cut(double, 3), {"BONES"})
        self.assertNotEqual(double.find_armature(), rig)
        self.assertEqual(obj.find_armature(), rig)
        own = bpy.data.objects.new("own", bpy.data.armatures.new("own"))
        bpy.context.collection.objects.link(own)
        other, cut = self.model("pig")
        other.modifiers.new("mine", "ARMATURE").object = own
        part("api").write(other, cut, {"BONES"})
        self.assertEqual((len(own.data.bones), len(other.modifiers)), (0, 2))

    def test_objects_without_the_new_armature_are_reported(self):
        """Objects get an armature that the model had before. Bones that are made in the same step don't move them."""
        obj, cut = self.model("pig")
        operator = SimpleNamespace(to={"OBJECTS", "BONES"})
        messages = part("cut.parts_to").MESH_OT_partwheel_parts._loss_messages
        self.assertIn("not the new objects", " ".join(messages(operator, obj)))
        self.assertFalse(any(created.find_armature() for created in part("api").write(obj, cut, operator.to).objects))
        self.assertEqual(messages(operator, obj), [])
        self.assertTrue(all(created.find_armature() for created in part("api").write(obj, cut, {"OBJECTS"}).objects))

    def test_a_model_with_a_rig_of_its_own_is_refused(self):
        """Before any change; also where the rig is its parent alone."""
        obj, cut = self.model("pig")
        rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
        bpy.context.collection.objects.link(rig)
        bpy.context.view_layer.objects.active = rig
        bpy.ops.object.mode_set(mode="EDIT")
        rig.data.edit_bones.new("spine").tail = 0, 0, 1
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.context.view_layer.objects.active = obj
        obj.vertex_groups.new(name="spine").add(range(len(obj.data.vertices)), 1, "REPLACE")
        before = len(bpy.data.armatures), [group.name for group in obj.vertex_groups], obj.data.attributes.keys()
        for attach in (lambda: setattr(obj.modifiers.new("rig", "ARMATURE"), "object", rig),
                       lambda: (obj.modifiers.clear(), setattr(obj, "parent", rig), setattr(obj, "parent_type", "ARMATURE"))):
            attach()
            with self.assertRaisesRegex(ValueError, "already moves with the armature rig"):
                part("api").write(obj, cut, {"BONES", "FACE_SETS"})
            self.assertEqual((len(bpy.data.armatures), [group.name for group in obj.vertex_groups],
                              obj.data.attributes.keys()), before)
