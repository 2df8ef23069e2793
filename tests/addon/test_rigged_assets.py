# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten assets as artists have them, rigged, animated, mirrored, with materials of the object, through every command:
nothing is lost of what RNA knows, polygons, UVs and materials; vertices move as before; what a command refuses
stays as it was. The assets are not in the repository."""

import math
import tarfile

import bpy
import numpy
from common import BOX, part
from mathutils import Matrix
from mathutils.kdtree import KDTree
from solid_case import SolidTest, caps, polygons_at
from test_assets import ASSETS
from test_object_data import arrays_of, differences, evaluated, object_data, own_vertices

FILES = "Animated_Woman.fbx", "Stegosaurus.fbx", "Knight.glb", "Robot.fbx", "NormalCar1.fbx"
RIGGED = "Pig", "Shark", "Horse", "Velociraptor", "KnightCharacter"
NOT_SWAPPED = {"Robot.fbx": "no border"}  # its part is a shell
RIGS = dict.fromkeys({*FILES, *RIGGED} - {"Robot.fbx", "NormalCar1.fbx"}, "already moves with the armature")
NAMES = FILES + RIGGED
FRAMES = 1, 12
NEAR = 1e-5  # of the size


class RiggedAssets(SolidTest):
    def imported(self, name):
        """The largest object of a file, with the animation of the file."""
        if not hasattr(numpy, "bool"):
            numpy.bool = bool  # Blender 3.4's importer of glTF asks a newer numpy for it
        importer = bpy.ops.import_scene.gltf if name.endswith("glb") else bpy.ops.import_scene.fbx
        importer(filepath=str(ASSETS.parent / "files" / name))
        return max((obj for obj in bpy.data.objects if obj.type == "MESH"), key=lambda obj: len(obj.data.polygons))

    def rigged(self, name):
        """An asset whose bones are those of its triangles: each at their middle, with weights that fall off, and turning."""
        with tarfile.open(ASSETS) as archive, archive.extractfile(f"tune/{name}.npz") as file:
            arrays = numpy.load(file)
            vertices, triangles, materials, bones = (arrays[key] for key in ("V", "F", "material", "bone"))
        obj = self.add(vertices.tolist(), triangles.tolist(), name)
        for number in range(materials.max() + 1):
            obj.data.materials.append(bpy.data.materials.new(f"paint {number}"))
        obj.data.polygons.foreach_set("material_index", materials.astype(numpy.int32))
        uvs = numpy.random.default_rng(1).random(2 * len(obj.data.loops)).astype(numpy.float32)
        obj.data.uv_layers.new(name="map").data.foreach_set("uv", uvs)
        rig = self.link(bpy.data.objects.new("rig", bpy.data.armatures.new("rig")))
        bpy.ops.object.mode_set(mode="EDIT")
        for number in numpy.unique(bones):
            bone = rig.data.edit_bones.new(f"bone {number}")
            bone.head = vertices[triangles[bones == number]].mean(axis=(0, 1))
            bone.tail = bone.head + bone.head.__class__((0, 0, 0.1 * numpy.ptp(vertices)))
        bpy.ops.object.mode_set(mode="OBJECT")
        degree = numpy.bincount(triangles.ravel(), minlength=len(vertices))
        for number in numpy.unique(bones):
            group = obj.vertex_groups.new(name=f"bone {number}")
            weights = numpy.bincount(triangles[bones == number].ravel(), minlength=len(vertices)) / degree
            for vertex in numpy.flatnonzero(weights).tolist():
                group.add([vertex], weights[vertex], "REPLACE")
            bone = rig.pose.bones[f"bone {number}"]
            bone.rotation_mode = "XYZ"
            for frame, angle in zip(FRAMES, (0, 40)):
                bone.rotation_euler.x = math.radians(angle)
                bone.keyframe_insert("rotation_euler", frame=frame)
        obj.modifiers.new("rig", "ARMATURE").object = obj.parent = rig
        return obj

    def assets(self):
        """(name, object) of each, mirrored, animated, with a material of the object."""
        if not ASSETS.exists():
            self.skipTest(f"{ASSETS} is not there")
        for name in NAMES:
            self.setUp()
            bpy.context.scene.frame_set(FRAMES[0])
            obj = self.imported(name) if name in FILES else self.rigged(name)
            obj.modifiers.new("mirror", "MIRROR").use_mirror_merge = False
            obj.material_slots[0].link = "OBJECT"
            obj.material_slots[0].material = bpy.data.materials.new("of the object")
            obj["by"] = 2.0
            obj.driver_add("pass_index").driver.expression = "7"
            if not obj.parent:  # the others' bones move them
                for frame in FRAMES:
                    obj.location.x = frame
                    obj.keyframe_insert("location", frame=frame)
                bpy.context.scene.frame_set(FRAMES[0])
            if not obj.data.uv_layers:
                obj.data.uv_layers.new(name="map")
            bpy.context.view_layer.objects.active = obj
            obj.update_tag()
            bpy.context.view_layer.update()  # the driver
            yield name, obj

    def duplicate(self, obj):
        copy = obj.copy()
        copy.data = obj.data.copy()
        return self.link(copy)

    def check_motion(self, obj, new):
        """At each frame, a vertex that is at one of the object's at rest is at one of these."""
        rest = self.tree([vertex.co for vertex in obj.data.vertices])
        size = max(obj.data.vertices[0].co.length, *numpy.ptp([vertex.co for vertex in obj.data.vertices], axis=0))
        kept = numpy.array([rest.find(vertex.co)[2] < NEAR * size for vertex in new.data.vertices]) & own_vertices(new.data)
        self.assertTrue(kept.any())
        places = []
        for frame in FRAMES:
            bpy.context.scene.frame_set(frame)
            places.append(evaluated(obj))
            tree, now = self.tree(places[-1]), evaluated(new)
            self.assertEqual(len(now), 2 * len(kept), "mirrored")
            away = max(tree.find(place)[2] for place in now[numpy.tile(kept, 2)])
            self.assertLess(away, 10 * NEAR * numpy.ptp(places[-1], axis=0).max(), f"{new.name}, frame {frame}")
        self.assertGreater(abs(places[1] - places[0]).max(), 0.01 * numpy.ptp(places[0], axis=0).max(), "nothing moved")
        bpy.context.scene.frame_set(FRAMES[0])

    def tree(self, places):
        tree = KDTree(len(places))
        for number, place in enumerate(places):
            tree.insert(place, number)
        tree.balance()
        return tree

    def test_every_command(self):
        for name, obj in self.assets():
            hierarchy = part("api").build(obj)
            sizes = (hierarchy.last - hierarchy.first) * (hierarchy.score > 0)
            self.node = int(numpy.where(sizes < len(obj.data.polygons) / 4, sizes, 0).argmax())  # a limb, a wheel
            with self.subTest(name):
                self.check_new_objects(obj, hierarchy)
            for command in (self.removed, self.united, self.swapped, self.labeled, self.convex, self.printed, self.boned):
                refusal = {"boned": RIGS, "swapped": NOT_SWAPPED}.get(command.__name__, {}).get(name)
                with self.subTest(f"{name}, {command.__name__}"):
                    duplicate = self.duplicate(obj)
                    before = object_data(duplicate)
                    if refusal:
                        with self.assertRaisesRegex(ValueError, refusal):
                            command(obj, duplicate, hierarchy, before)
                        self.check_unchanged(obj, duplicate, before)
                    else:
                        command(obj, duplicate, hierarchy, before)

    def check_new_objects(self, obj, hierarchy):
        api, before = part("api"), object_data(obj)
        self.assertEqual(part("solid.composition").loss_messages(obj), [])
        inside = set(hierarchy.faces(self.node).tolist())
        of_part = {place: polygons for place, polygons in polygons_at(obj.data).items() if inside & {each.index for each in polygons}}
        for how, objects, polygons in (
                ("copy", [api.copy_part(obj, self.node)], of_part),
                ("split", api.split(obj, parts=3), None),
                ("objects", api.write(self.duplicate(obj), api.cut(obj, 3), {"OBJECTS"}).objects, None)):
            bpy.context.view_layer.update()
            for new in objects:
                self.assertEqual(differences(before, new, objects), {}, how)
                self.check_motion(obj, new)
            self.check_polygons(obj, objects, polygons)

    def removed(self, obj, duplicate, hierarchy, before):
        part("api").remove(duplicate, self.node)
        self.assertEqual(differences(before, duplicate, []), {})
        self.check_motion(obj, duplicate)
        self.assertEqual((~caps(duplicate.data)).sum(), len(obj.data.polygons) - len(hierarchy.faces(self.node)))

    def united(self, obj, duplicate, _, before):
        top = max(obj.data.vertices, key=lambda vertex: vertex.co.z).co
        side = 0.3 * max(numpy.ptp([vertex.co for vertex in obj.data.vertices], axis=0))
        cube = self.add((numpy.array(BOX[0]) - 0.5) * side, BOX[1], "cube")
        cube.matrix_world = duplicate.matrix_world @ Matrix.Translation(top)
        cube.data.materials.append(bpy.data.materials.new("cube"))
        bpy.context.view_layer.update()
        part("api").unite(duplicate, [cube])
        before["slots"].append(("DATA", cube.data.materials[0].name))
        self.assertEqual(differences(before, duplicate, []), {})
        self.check_motion(obj, duplicate)

    def swapped(self, obj, duplicate, _, before):
        part("api").swap(duplicate, self.node, self.duplicate(obj))
        self.assertEqual(differences(before, duplicate, []), {})
        self.check_motion(obj, duplicate)

    def labeled(self, obj, duplicate, _, before):
        """Groups and slots are added; each polygon is seen with its material."""
        materials = [self.material(duplicate, polygon) for polygon in duplicate.data.polygons]
        part("api").write(duplicate, part("api").cut(duplicate, 3), {"SEAMS", "FACE_SETS", "VERTEX_GROUPS", "MATERIALS"})
        different = differences(before, duplicate, [])
        self.assertLessEqual(set(different), {"groups", "slots", "layers", "object active_material"})
        self.assertEqual(different["groups"][1][:len(before["groups"])], before["groups"])
        self.assertEqual([self.material(duplicate, polygon) for polygon in duplicate.data.polygons], materials)
        self.assertEqual(arrays_of(duplicate), arrays_of(obj))
        self.check_motion(obj, duplicate)

    def material(self, obj, polygon):
        slot = obj.material_slots[polygon.material_index]
        return slot.link, slot.material

    def convex(self, obj, duplicate, _, before):
        hulls = part("api").convex(duplicate, hulls=2)
        self.assertEqual([hull.parent for hull in hulls], [duplicate] * len(hulls))
        self.check_unchanged(obj, duplicate, before)

    def printed(self, obj, duplicate, _, before):
        for piece in part("api").print_parts(duplicate, part("api").cut(duplicate, 3)).objects:
            self.assertSolid(piece.data)
        self.check_unchanged(obj, duplicate, before)

    def boned(self, obj, duplicate, _, before):
        """The new armature moves as the object did."""
        part("api").write(duplicate, part("api").cut(duplicate, 3), {"BONES"})
        self.check_motion(obj, duplicate)

    def check_unchanged(self, obj, duplicate, before):
        self.assertEqual((differences(before, duplicate, []), arrays_of(duplicate)), ({}, arrays_of(obj)))
