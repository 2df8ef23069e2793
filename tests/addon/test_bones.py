# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole model in parts, as bones: what is written is read back and posed, on five real models, three of them
broken."""

import math
from unittest.mock import patch

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


def world(obj):
    """(V,3) the same in world space."""
    return posed(obj) @ numpy.array(obj.matrix_world)[:3, :3].T + numpy.array(obj.matrix_world)[:3, 3]


def at_rest_in_world(obj):
    return at_rest(obj) @ numpy.array(obj.matrix_world)[:3, :3].T + numpy.array(obj.matrix_world)[:3, 3]


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

    def test_objects_and_bones_in_one_step(self):
        """The armature moves each vertex of the objects to where it moves the model's; the second time as well, by the same
        bones."""
        obj, cut = self.model("homer")
        obj.location, obj.rotation_euler = (3, 1, 2), (0.3, 0.2, 1)
        driver = obj.data.driver_add("use_auto_texspace").driver
        driver.variables.new().targets[0].id_type = "MESH"
        driver.variables[0].targets[0].id = obj.data
        mesh, created, rig = obj.data, [], None
        for times in (1, 2):
            names, created, again = part("api").write(obj, cut, {"OBJECTS", "BONES"})
            self.assertEqual((obj.find_armature(), obj.data, len(created)), (again, mesh, len(cut)))
            self.assertTrue(rig is None or again == rig)
            rig = again
            bone = next(bone for bone in rig.data.bones if bone.parent and not bone.children)
            turn(rig, bone.name, 40 * times)
            moved = {place.tobytes(): after for place, after in zip(at_rest(obj).astype("f"), world(obj))}
            for name, new in zip(names, created):
                with self.subTest(name=name, times=times):
                    self.assertEqual((new.name.split(".0")[0], new.find_armature()), (name.split(".0")[0], rig))
                    self.assertEqual(new.data.animation_data.drivers[0].driver.variables[0].targets[0].id, new.data)
                    after = world(new)
                    shared = [(moved[place.tobytes()], at) for place, at in zip(at_rest(new).astype("f"), after)
                              if place.tobytes() in moved]
                    self.assertGreater(len(shared), 0)
                    self.assertLess(abs(numpy.diff(shared, axis=1)).max(), 1e-4 * max(obj.dimensions))
            self.assertGreater(abs(world(obj) - at_rest_in_world(obj)).max(), 0.02 * max(obj.dimensions))
            for new in created if times == 1 else ():
                bpy.data.objects.remove(new)

    def test_nothing_changes_if_rigged_objects_fail(self):
        obj, cut = self.model("pig")
        obj.vertex_groups.new(name="mine").add([0], 1, "REPLACE")
        mesh, counts = obj.data, (len(bpy.data.meshes), len(bpy.data.objects), len(bpy.data.armatures))
        with patch.object(part("cut.objects"), "create_part_objects", side_effect=MemoryError):
            with self.assertRaises(MemoryError):
                part("api").write(obj, cut, {"OBJECTS", "BONES"})
        self.assertEqual((len(bpy.data.meshes), len(bpy.data.objects), len(bpy.data.armatures)), counts)
        self.assertEqual((obj.data, obj.parent, len(obj.modifiers), obj.vertex_groups.keys()), (mesh, None, 0, ["mine"]))

    def test_caps_inside_a_broken_model_move_with_its_surface(self):
        obj, cut = self.model("pig")
        for new in part("api").write(obj, cut, {"OBJECTS", "BONES"}).objects:
            weights = [sum(group.weight for group in vertex.groups) for vertex in new.data.vertices]
            self.assertLess(abs(numpy.array(weights) - 1).max(), 1e-5, new.name)

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
