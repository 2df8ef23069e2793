# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects made from parts, exported by Blender and imported again: names, hierarchy, skins, materials, UVs."""

import re
import tempfile
from pathlib import Path

import bpy
import numpy
from common import only_in, part
from mathutils.kdtree import KDTree
from solid_case import SolidTest

ASSETS = Path(__file__).resolve().parents[3] / "shared" / "assets" / "files"
NEAR = 1e-4  # of the size


def plain_name(name):
    """A name as USD has it."""
    return re.sub(r"\W", "_", name)


def parent_name(obj):
    """The mesh object that an object hangs on; "": none. Of a USD file, the importer makes an empty object of each transform
    that has several children, and its name gets a number, since the mesh below it has the same."""
    meshes = {other.name for other in bpy.data.objects if other.type == "MESH"}
    parent = obj.parent
    while parent:
        name = parent.name if parent.type == "MESH" or parent.name in meshes else parent.name[:-4]
        if name in meshes and name != obj.name:
            return plain_name(name)
        parent = parent.parent
    return ""


def describe(objects):
    """{name: (parent, corners)}; a corner: (place in the world at rest, UVs, material, bone with the largest weight)"""
    result = {}
    for obj in objects:
        mesh, groups = obj.data, [group.name for group in obj.vertex_groups]
        armature = obj.find_armature()
        bones = {bone.name for bone in armature.data.bones} if armature else set()
        top = []
        for vertex in mesh.vertices:
            weights = [(round(entry.weight, 3), groups[entry.group]) for entry in vertex.groups
                       if entry.group < len(groups) and groups[entry.group] in bones]
            top.append({plain_name(name) for weight, name in weights if weight > max(weights)[0] - 0.01})
        uvs = mesh.uv_layers[0].data if mesh.uv_layers else None
        corners = []
        for polygon in mesh.polygons:
            material = obj.material_slots[polygon.material_index].material if obj.material_slots else None
            for loop in polygon.loop_indices:
                vertex = mesh.loops[loop].vertex_index
                corners.append((obj.matrix_world @ mesh.vertices[vertex].co, tuple(uvs[loop].uv) if uvs else (0, 0),
                                plain_name(material.name) if material else "", top[vertex]))
        result[plain_name(obj.name)] = parent_name(obj), corners
    return result


@only_in("newest")
class Exports(SolidTest):
    def create_knight(self):
        return self.create_asset(bpy.ops.import_scene.gltf, "Knight.glb")

    def create_car(self):
        return self.create_asset(bpy.ops.import_scene.fbx, "NormalCar1.fbx")

    def create_asset(self, importer, name):
        if not ASSETS.exists():
            self.skipTest(f"{ASSETS} is not there")
        importer(filepath=str(ASSETS / name))
        return max((obj for obj in bpy.data.objects if obj.type == "MESH"), key=lambda obj: len(obj.data.polygons))

    def create_scan(self):
        """A mesh with a UV map and a texture."""
        obj, _ = self.built("dragknob")
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.smart_project()
        bpy.ops.object.mode_set(mode="OBJECT")
        material, image = bpy.data.materials.new("Scan"), bpy.data.images.new("scan", 64, 64)
        image.pixels = numpy.random.default_rng(3).random(64 * 64 * 4)
        image.pack()
        material.use_nodes = True
        texture = material.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        material.node_tree.links.new(texture.outputs[0], material.node_tree.nodes["Principled BSDF"].inputs[0])
        obj.data.materials.append(material)
        return obj

    def exported(self, create, file_format):
        """(what was described before the export, and after the import)"""
        self.setUp()
        obj = create()
        self.link_active(obj)
        api = part("api")
        objects = api.write(obj, api.cut(obj, 5), {"OBJECTS"}).objects
        bpy.context.view_layer.update()
        self.assertGreater(len(objects), 2)
        before = describe(objects)
        for other in bpy.context.view_layer.objects:
            other.select_set(other in objects or other == obj.find_armature())
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / f"parts.{file_format}")
            if file_format == "glb":
                bpy.ops.export_scene.gltf(filepath=path, use_selection=True, export_animations=False)
            elif file_format == "fbx":
                bpy.ops.export_scene.fbx(filepath=path, use_selection=True, bake_anim=False, path_mode="COPY", embed_textures=True)
            else:
                bpy.ops.wm.usd_export(filepath=path, selected_objects_only=True, export_materials=True)
            for data in (bpy.data.objects, bpy.data.meshes, bpy.data.materials, bpy.data.armatures, bpy.data.images):
                for item in list(data):
                    data.remove(item)
            if file_format == "glb":
                bpy.ops.import_scene.gltf(filepath=path)
            elif file_format == "fbx":
                bpy.ops.import_scene.fbx(filepath=path)
            else:
                bpy.ops.wm.usd_import(filepath=path)
            bpy.context.view_layer.update()
            has_images = all(image.has_data or image.packed_file or image.size[0] for image in bpy.data.images)
            self.assertTrue(has_images)
            return before, describe(imported for imported in bpy.data.objects if imported.type == "MESH")

    def link_active(self, obj):
        for other in bpy.context.view_layer.objects:
            other.select_set(other == obj)
        bpy.context.view_layer.objects.active = obj

    def compare(self, before, after, what):
        self.assertLessEqual(set(before), set(after), what)
        for name, (parent, corners) in before.items():
            found_parent, found = after[name]
            self.assertEqual(found_parent, parent, f"{what}: parent of {name}")
            tree = KDTree(len(found))
            for number, corner in enumerate(found):
                tree.insert(corner[0], number)
            tree.balance()
            # Of a mesh whose faces all use one slot, Blender's exporter of USD takes the first slot instead.
            is_lost = what.startswith("usd") and len({corner[2] for corner in corners}) == 1
            size = max(numpy.ptp([corner[0] for corner in corners], axis=0))
            faults = dict.fromkeys(("place", "UV", "material", "bone"), 0)
            for place, uv, material, bones in corners:
                near = [found[number] for _, number, _ in tree.find_range(place, NEAR * size)]
                faults["place"] += not near
                faults["UV"] += not any(abs(numpy.subtract(corner[1], uv)).max() < 1e-3 for corner in near)
                faults["material"] += not is_lost and not any(corner[2] == material for corner in near)
                faults["bone"] += bool(bones) and not any(corner[3] & bones for corner in near)
            self.assertEqual(faults, dict.fromkeys(faults, 0), f"{what}: {name}, of {len(corners)} corners")

    def check(self, create, skinned=False):
        for file_format in ("glb", "fbx", "usdc"):
            with self.subTest(format=file_format):
                before, after = self.exported(create, file_format)
                has_bones = any(corner[3] for _, corners in before.values() for corner in corners)
                self.assertEqual(has_bones, skinned)
                self.compare(before, after, file_format)

    def test_a_knight(self):
        self.check(self.create_knight, skinned=True)

    def test_a_car(self):
        self.check(self.create_car)

    def test_a_scan(self):
        self.check(self.create_scan)
