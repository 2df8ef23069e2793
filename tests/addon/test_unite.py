# SPDX-License-Identifier: GPL-3.0-or-later
"""Unions of placed parts: closed, of the volume that manifold3d finds; a failure leaves the scene as it was.

PARTWHEEL_UNITES=500: so many random placements.
"""

import os
import subprocess
import tempfile
from pathlib import Path

import bpy
import numpy
from common import part, read_off
from mathutils import Matrix, Quaternion, Vector
from solid_case import SolidTest, arrays, volume

COUNT = int(os.environ.get("PARTWHEEL_UNITES") or 20)
PYTHON = Path(__file__).resolve().parents[2] / "build" / "venv" / "core" / "bin" / "python"
TOLERANCE = 1e-6


def triangles(obj):
    """(vertices in the world, triangles) as manifold3d takes them."""
    mesh = obj.data
    mesh.calc_loop_triangles()
    vertices = numpy.array([(obj.matrix_world @ vertex.co)[:] for vertex in mesh.vertices])
    return vertices, numpy.array([triangle.vertices[:] for triangle in mesh.loop_triangles])


def reference(pairs):
    """(n, 4) volumes of a, b, their intersection and their union."""
    data = {"count": len(pairs)}
    for i, (a, b) in enumerate(pairs):
        data |= {f"va{i}": a[0], f"ta{i}": a[1], f"vb{i}": b[0], f"tb{i}": b[1]}
    with tempfile.TemporaryDirectory() as directory:
        given, found = Path(directory) / "pairs.npz", Path(directory) / "result.npz"
        numpy.savez(given, **data)
        subprocess.run([PYTHON, Path(__file__).with_name("reference_union.py"), given, found], check=True,
                       env={"PATH": os.environ["PATH"]})
        return numpy.load(found)["volumes"]


class Unite(SolidTest):
    def place(self, target, source, matrix):
        other = bpy.data.objects.new("part", source)
        bpy.context.collection.objects.link(other)
        other.matrix_world = matrix
        bpy.context.view_layer.update()
        return self.ready(target, other)

    def parts(self):
        """Closed parts of real models, as meshes."""
        made = []
        for name in ("hand", "dragknob", "helmet"):
            obj, hierarchy = self.built(name)
            for node in self.nodes(hierarchy, 5)[1:]:
                made.append(part("solids").part(obj, hierarchy, int(hierarchy.tet_first[node]),
                                                int(hierarchy.tet_last[node])))
            made.append(obj.data)
        return made

    def test_random_placements(self):
        meshes = self.parts()
        rng = numpy.random.default_rng(11)
        pairs, volumes, solvers = [], [], []
        for i in range(COUNT):
            first, second = (meshes[k].copy() for k in rng.integers(len(meshes), size=2))
            for mesh in (first, second):  # both of the size 1 about the origin
                places = arrays(mesh)[0]
                middle, size = (places.max(axis=0) + places.min(axis=0)) / 2, numpy.ptp(places, axis=0).max()
                mesh.transform(Matrix.Scale(1 / size, 4) @ Matrix.Translation(-Vector(middle)))
            target = self.link(bpy.data.objects.new(f"target {i}", first))
            turn = Quaternion(rng.normal(size=4)).normalized().to_matrix().to_4x4()
            where = rng.normal(size=3) * 0.25
            other = self.place(target, second,
                               Matrix.Translation(where) @ turn @ Matrix.Scale(rng.uniform(0.3, 1.5), 4))
            pairs.append((triangles(target), triangles(other)))
            self.assertEqual(bpy.ops.object.partwheel_unite(), {"FINISHED"})
            self.assertSolid(target.data)
            volumes.append(volume(target.data))
            bpy.data.objects.remove(target)
        expected = reference(pairs)
        united = expected[:, 0] + expected[:, 1] - expected[:, 2]
        self.assertTrue(numpy.allclose(united, expected[:, 3], rtol=1e-9))
        worst = numpy.abs(numpy.array(volumes) / united - 1).max()
        print(f"{COUNT} unions; largest error of a volume: {worst:.2g}")
        self.assertLess(worst, TOLERANCE)
        overlapping = ((expected[:, 2] > 0) & (expected[:, 2] < 0.9 * expected[:, :2].min(axis=1))).sum()
        self.assertGreater(overlapping, COUNT / 2)

    def test_materials_layers_and_ngons(self):
        first = self.cube("red", "blue")
        second = self.cube("blue", "green").data
        other = self.place(first, second, Matrix.Translation((1, 0.9, 0.8)))
        target = bpy.context.view_layer.objects.active
        name = target.data.name
        self.assertEqual(bpy.ops.object.partwheel_unite(), {"FINISHED"})
        mesh = target.data
        self.assertSolid(mesh)
        self.assertEqual((mesh.name, [m.name for m in mesh.materials]), (name, ["red", "blue", "green"]))
        self.assertGreater(max(len(polygon.vertices) for polygon in mesh.polygons), 4)
        self.assertAlmostEqual(volume(mesh), 16 - 1.0 * 1.1 * 1.2, places=5)
        names = {mesh.materials[polygon.material_index].name for polygon in mesh.polygons}
        self.assertEqual(names, {"red", "blue", "green"})
        for polygon in mesh.polygons:  # red: the first's lower faces; green: the second's upper ones
            middle = polygon.center
            expected = {"red": middle.z < 0.99, "green": middle.x > 0.1, "blue": True}
            self.assertTrue(expected[mesh.materials[polygon.material_index].name])
        self.assertEqual([layer.name for layer in mesh.uv_layers], ["UVMap"])
        self.assertEqual([obj.name for obj in bpy.data.objects if obj.name.startswith("part")], [])
        del other

    def cube(self, *materials):
        bpy.ops.mesh.primitive_cube_add()
        obj = bpy.context.active_object
        for name in materials:
            obj.data.materials.append(bpy.data.materials.get(name) or bpy.data.materials.new(name))
        for polygon in obj.data.polygons:
            polygon.material_index = polygon.normal.z > 0.5
        return obj

    def test_mirrored_and_inside_and_apart(self):
        target = self.cube()
        mirror = Matrix.Translation((1, 0.5, 0.25)) @ Matrix.Scale(-1, 4, (1, 0, 0))
        self.place(target, self.cube().data.copy(), mirror)
        bpy.ops.object.partwheel_unite()
        self.assertSolid(target.data)
        self.assertAlmostEqual(volume(target.data), 16 - 1.0 * 1.5 * 1.75, places=5)
        for matrix, expected in ((Matrix.Scale(0.5, 4), 8), (Matrix.Translation((5, 0, 0)), 16),
                                 (Matrix.Scale(2, 4), 64)):
            target = self.cube()
            self.place(target, self.cube().data.copy(), matrix)
            bpy.ops.object.partwheel_unite()
            self.assertSolid(target.data)
            self.assertAlmostEqual(volume(target.data), expected, places=5)

    def test_parts_of_the_union_are_found_at_once(self):
        target = self.cube()
        self.place(target, self.cube().data.copy(), Matrix.Translation((1, 0.9, 0.8)))
        self.assertEqual(bpy.ops.object.partwheel_unite(build=True), {"FINISHED"})
        self.assertEqual(len(part("session").hierarchy(target).order), len(target.data.polygons))

    def test_what_belongs_to_the_mesh_stays(self):
        """Its settings and properties, whoever else uses it; a fake user, which only the very same mesh can keep."""
        for fake, shared in ((False, False), (True, False), (False, True), (True, True)):
            target = self.cube()
            mesh, name = target.data, target.data.name
            mesh["mine"], mesh.use_mirror_x, mesh.remesh_voxel_size, mesh.use_fake_user = "kept", True, 0.25, fake
            target.shape_key_add(name="Basis")
            if shared:
                twin = self.link(bpy.data.objects.new("twin", mesh))
            self.place(target, self.cube().data.copy(), Matrix.Translation((1, 0.9, 0.8)))
            self.assertEqual(bpy.ops.object.partwheel_unite(), {"FINISHED"})
            new = target.data
            self.assertSolid(new)
            self.assertAlmostEqual(volume(new), 16 - 1.0 * 1.1 * 1.2, places=5)
            self.assertEqual((new["mine"], new.use_mirror_x, new.remesh_voxel_size), ("kept", True, 0.25))
            self.assertEqual(len(new.materials), 0)
            if shared:
                self.assertEqual((twin.data, twin.data.name, len(twin.data.vertices)), (mesh, name, 8))
            else:
                self.assertEqual((new.name, new.use_fake_user), (name, fake))
            for obj in list(bpy.data.objects):
                bpy.data.objects.remove(obj)

    def test_what_is_no_solid_is_refused_and_nothing_changes(self):
        target = self.cube()
        sheet, _ = read_off("dragknob")
        open_mesh = bpy.data.meshes.new("open")
        vertices, polygons = read_off("dragknob")
        open_mesh.from_pydata(vertices, [], polygons[1:])
        other = self.place(target, open_mesh, Matrix.Identity(4))
        before = self.everything(target)
        with self.assertRaisesRegex(RuntimeError, "part is no solid: 3 edges"):
            bpy.ops.object.partwheel_unite()
        self.assertEqual(self.everything(target), before)
        del other

    def test_inside_out_is_refused(self):
        target = self.cube()
        turned = self.cube().data.copy()
        turned.flip_normals()
        self.place(target, turned, Matrix.Translation((1, 1, 1)))
        before = self.everything(target)
        with self.assertRaisesRegex(RuntimeError, "inside out"):
            bpy.ops.object.partwheel_unite()
        self.assertEqual(self.everything(target), before)

    def test_faces_that_only_touch(self):
        """Two cubes face to face: united, or refused with a reason, and then unchanged."""
        for shift in ((2, 0, 0), (2, 1, 0), (2, 2, 0), (2, 2, 2)):
            target = self.cube()
            self.place(target, self.cube().data.copy(), Matrix.Translation(shift))
            before = self.everything(target)
            try:
                bpy.ops.object.partwheel_unite()
            except RuntimeError as error:
                self.assertIn("can't be united", str(error))
                self.assertEqual(self.everything(target), before)
            else:
                self.assertSolid(target.data)
                self.assertAlmostEqual(volume(target.data), 16, places=5)

    def everything(self, target):
        return (sorted(obj.name for obj in bpy.data.objects), sorted(mesh.name for mesh in bpy.data.meshes),
                sorted(c.name for c in bpy.data.collections), arrays(target.data)[0].tolist(), arrays(target.data)[1])
