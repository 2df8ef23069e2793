# SPDX-License-Identifier: GPL-3.0-or-later
"""Unions of placed parts: closed, of the volume that manifold3d finds; a failure leaves the scene as it was.

PARTWHEEL_UNITES=500: so many random placements. PARTWHEEL_UNITES_SEED=12: others than those of 11.
"""

import os
import subprocess
import tempfile
from pathlib import Path

import bmesh
import bpy
import numpy
from common import BOX, only_in, part
from mathutils import Matrix, Quaternion, Vector
from partwheel.components import edge_components
from solid_case import SolidTest, arrays, volume

COUNT = int(os.environ.get("PARTWHEEL_UNITES") or 20)
SEED = int(os.environ.get("PARTWHEEL_UNITES_SEED") or 11)
PYTHON = Path(__file__).resolve().parents[2] / "build" / "venv" / "core" / "bin" / "python"
TOLERANCE = 5e-6  # of a volume: coordinates have 24 bits


def unite(**options):
    """The operator, but that it does not look for the parts of the result."""
    return bpy.ops.object.partwheel_unite(build=False, **options)


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
        given, result_path = Path(directory) / "pairs.npz", Path(directory) / "result.npz"
        numpy.savez(given, **data)
        subprocess.run([PYTHON, Path(__file__).with_name("reference_union.py"), given, result_path], check=True,
                       env={"PATH": os.environ["PATH"]})
        return numpy.load(result_path)["volumes"]


class Unite(SolidTest):
    def place(self, target, source, matrix):
        other = bpy.data.objects.new("part", source)
        bpy.context.collection.objects.link(other)
        other.matrix_world = matrix
        bpy.context.view_layer.update()
        return self.ready(target, other)

    def parts(self):
        """Closed parts of real models, as meshes; in one piece: one that hangs on by a vertex alone comes inside out from
        the Boolean of Blender 3.4 and 4.2."""
        results = []
        for name in ("hand", "dragknob", "helmet"):
            obj, hierarchy = self.built(name)
            for node in self.nodes(hierarchy, 5)[1:]:
                results += part("solid.solids").create_meshes(obj, hierarchy, [hierarchy.tet_slice(node)])
            results.append(obj.data)
        return [mesh for mesh in results if len({*edge_components(part("mesh.arrays").read_edge_vertices(mesh)).tolist()}) == 1]

    @only_in("oldest", "newest")
    def test_random_placements(self):
        meshes = self.parts()
        rng = numpy.random.default_rng(SEED)
        pairs, volumes = [], []
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
            self.assertEqual(unite(), {"FINISHED"})
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
        self.assertEqual(unite(), {"FINISHED"})
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

    def test_solids_that_are_mirrored_nested_or_apart_unite(self):
        target = self.cube()
        mirror = Matrix.Translation((1, 0.5, 0.25)) @ Matrix.Scale(-1, 4, (1, 0, 0))
        self.place(target, self.cube().data.copy(), mirror)
        unite()
        self.assertSolid(target.data)
        self.assertAlmostEqual(volume(target.data), 16 - 1.0 * 1.5 * 1.75, places=5)
        for matrix, expected in ((Matrix.Scale(0.5, 4), 8), (Matrix.Translation((5, 0, 0)), 16),
                                 (Matrix.Scale(2, 4), 64)):
            target = self.cube()
            self.place(target, self.cube().data.copy(), matrix)
            unite()
            self.assertSolid(target.data)
            self.assertAlmostEqual(volume(target.data), expected, places=5)

    def test_settings_and_users_of_the_mesh_stay(self):
        """Its settings and properties, whoever else uses it; a fake user, which only the very same mesh can keep."""
        for fake, shared in ((False, False), (True, False), (False, True), (True, True)):
            target = self.cube()
            mesh, name = target.data, target.data.name
            mesh["mine"], mesh.use_mirror_x, mesh.remesh_voxel_size, mesh.use_fake_user = "kept", True, 0.25, fake
            target.shape_key_add(name="Basis")
            if shared:
                twin = self.link(bpy.data.objects.new("twin", mesh))
            self.place(target, self.cube().data.copy(), Matrix.Translation((1, 0.9, 0.8)))
            self.assertEqual(unite(), {"FINISHED"})
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

    def remove_bottom(self, mesh):
        bm = bmesh.new()
        bm.from_mesh(mesh)
        bmesh.ops.delete(bm, geom=[face for face in bm.faces if face.normal.z < -0.5], context="FACES_ONLY")
        bm.to_mesh(mesh)
        bm.free()

    def test_open_meshes_are_cut_where_they_cross(self):
        """A cube on one without a bottom, either of them first: of each, only what is inside the other is gone."""
        for open_first in (True, False):
            cubes = self.cube("red"), self.cube("blue")
            hollow, solid = cubes
            self.remove_bottom(hollow.data)
            solid.location = 0.5, 0.25, 1.5
            target, other = cubes if open_first else cubes[::-1]
            self.ready(target, other)
            self.assertEqual(unite(), {"FINISHED"})
            # Of each, the overlap, a box of 1.5 by 1.75 by 0.5, lacks one face and two sides that meet in an edge.
            overlap = 1.5 * 1.75 + 0.5 * (1.5 + 1.75)
            areas = {"red": 5 * 4 - overlap, "blue": 6 * 4 - overlap}
            for name, area in areas.items():
                slot = target.data.materials.find(name)
                self.assertAlmostEqual(sum(polygon.area for polygon in target.data.polygons if polygon.material_index == slot),
                                       area, 4)
            self.setUp()

    def test_open_meshes_that_cross_lose_nothing_that_is_outside(self):
        """Bowls, tubes and grids, each with its copy: their area stays; it is cut at the seam, which both share."""
        tilt = Matrix.Rotation(1.2, 4, "X")
        for add, options, matrix in ((bpy.ops.mesh.primitive_uv_sphere_add, {"segments": 16, "ring_count": 8}, Matrix.Translation((.7, .2, .1))),
                                     (bpy.ops.mesh.primitive_cylinder_add, {"end_fill_type": "NOTHING"}, tilt @ Matrix.Translation((.1, 0, 0))),
                                     (bpy.ops.mesh.primitive_grid_add, {}, tilt)):
            add(**options)
            target = bpy.context.active_object
            if "segments" in options:  # a bowl
                with part("mesh.assembly").edit_as_bmesh(target.data, into=target.data) as bm:
                    bmesh.ops.delete(bm, geom=[face for face in bm.faces if face.calc_center_median().z > 0], context="FACES")
            area, largest = sum(polygon.area for polygon in target.data.polygons), max(max(d.uv) for d in target.data.uv_layers[0].data)
            self.place(target, target.data.copy(), matrix)
            self.assertEqual(unite(), {"FINISHED"})
            self.assertAlmostEqual(sum(polygon.area for polygon in target.data.polygons), 2 * area, 3)
            corners = numpy.bincount([loop.edge_index for loop in target.data.loops])
            self.assertGreater((corners == 4).sum(), 1)
            self.assertAlmostEqual(max(max(d.uv) for d in target.data.uv_layers[0].data), largest, 5)
            self.assertEqual([name for name in target.data.attributes.keys() if "partwheel" in name], [])

    def test_a_piece_that_leaves_through_an_opening_stays(self):
        """A ball in a box without a lid. Most of its faces are outside, but those inside are larger. Loose vertices don't count."""
        target, ball = self.cube(), bpy.data.meshes.new("ball")
        self.remove_bottom(target.data)
        target.data.vertices.add(2)
        target.data.vertices[-1].co = 0, 0, 5
        with part("mesh.assembly").edit_as_bmesh(ball, into=ball) as bm:
            bmesh.ops.create_icosphere(bm, subdivisions=2, radius=0.9, matrix=Matrix.Translation((0, 0, -1)))
            bmesh.ops.subdivide_edges(bm, edges=[edge for edge in bm.edges if all(vert.co.z < -1.1 for vert in edge.verts)], cuts=2)
        area = sum(polygon.area for mesh in (target.data, ball) for polygon in mesh.polygons)
        self.place(target, ball, Matrix())
        self.assertEqual(unite(), {"FINISHED"})
        self.assertAlmostEqual(sum(polygon.area for polygon in target.data.polygons), area, 4)

    def test_a_mesh_that_touches_itself_or_has_loose_vertices_counts_as_closed(self):
        loose = self.cube("red", "blue").data
        loose.vertices.add(1)
        pinched = self.cube("red", "blue").data.copy()
        bm = bmesh.new()
        bm.from_mesh(pinched)
        bmesh.ops.create_cube(bm, size=2, matrix=Matrix.Translation((2, 2, 0)))
        bmesh.ops.remove_doubles(bm, verts=bm.verts, dist=1e-4)
        bm.normal_update()
        for face in bm.faces:
            face.material_index = face.normal.z > 0.5
        bm.to_mesh(pinched)
        bm.free()
        for mesh, expected in ((loose, 16 - 0.5 * 2 * 2), (pinched, 24 - 0.5 * 2 * 2)):
            target = self.link(bpy.data.objects.new("target", mesh))
            self.place(target, self.cube("red", "blue").data.copy(), Matrix.Translation((-1.5, 0, 0.1)))
            self.assertEqual(unite(), {"FINISHED"})
            self.assertSolid(target.data)
            self.assertAlmostEqual(volume(target.data), expected + 0.5 * 2 * 0.1, places=4)
            for polygon in target.data.polygons:  # blue on top, as before
                self.assertEqual(target.data.materials[polygon.material_index].name, "blue" if polygon.normal.z > 0.5 else "red")

    def test_no_vertex_is_missed_inside_another_shell_of_its_own_mesh(self):
        """Two overlapping cubes and one across; a union as Exact with Self Intersection gives it, and one without a cube."""
        union, bm = part("compose.union"), bmesh.new()
        for height in (-0.8, 0.8):
            bmesh.ops.create_cube(bm, size=2, matrix=Matrix.Translation((0.3 * height, 0.2 * height, height)))
        shells = bpy.data.meshes.new("shells")
        bm.to_mesh(shells)
        bm.free()
        cube = self.cube().data
        cube.transform(Matrix.Translation((1.7, 0.1, 0.05)))
        result = union._apply_boolean(shells, cube, "EXACT", {"use_self": True}, [None])
        self.assertIsNone(union._surface_defect((shells, cube), result, True, 0))
        self.assertIsNotNone(union._surface_defect((shells, cube), cube, True, 0))

    def test_no_vertex_is_missed_inside_a_shell_that_touches_another(self):
        """A cube in the lower or the upper one of two that share a wall: a ray from there meets both sides of the wall at once."""
        union = part("compose.union")
        for order in ((0, 2), (2, 0)):
            bm = bmesh.new()
            for height in order:
                bmesh.ops.create_cube(bm, size=2, matrix=Matrix.Translation((0, 0, height)))
            stack = bpy.data.meshes.new("stack")
            bm.to_mesh(stack)
            bm.free()
            for height in (0, 2):
                small = self.cube().data.copy()
                small.transform(Matrix.Translation((0, 0, height - 0.5)) @ Matrix.Scale(0.1, 4))
                self.assertIsNone(union._surface_defect((stack, small), stack, True, 0))

    def test_the_inside_of_an_open_mesh_is_where_it_takes_up_half_of_the_view(self):
        """A union without the cube in the middle of an open tube, whose ends take up 1 - cos(angle) of the view from there."""
        union = part("compose.union")
        original = union.unite_open
        union.unite_open = lambda *meshes: meshes[0].copy()
        self.addCleanup(setattr, union, "unite_open", original)
        for axis in "XYZ":
            for degrees, is_inside in ((50, True), (57, True), (63, False), (80, False)):
                bpy.ops.mesh.primitive_cylinder_add(end_fill_type="NOTHING", depth=2 / numpy.tan(numpy.radians(degrees)))
                tube = bpy.context.active_object
                tube.data.transform({"X": Matrix.Rotation(numpy.pi / 2, 4, "Y"), "Y": Matrix.Rotation(numpy.pi / 2, 4, "X"),
                                     "Z": Matrix()}[axis])
                self.place(tube, self.cube().data, Matrix.Scale(1e-3, 4))
                with self.subTest(axis, degrees=degrees):
                    if is_inside:
                        self.assertEqual(unite(), {"FINISHED"})
                    else:
                        self.assertRaisesRegex(RuntimeError, "one of them is missing", unite)

    def test_a_scale_of_0_is_refused_without_changes(self):
        target = self.cube()
        self.place(target, self.cube().data.copy(), Matrix())
        target.scale.x = 0
        before = self.everything(target)
        self.assertRaisesRegex(RuntimeError, "scale is 0", unite)
        self.assertEqual(self.everything(target), before)

    def test_a_union_of_open_meshes_that_lacks_one_is_refused_without_changes(self):
        union = part("compose.union")
        original = union.unite_open
        for left in range(2):
            target = self.cube()
            open_mesh = self.cube().data.copy()
            self.remove_bottom(open_mesh)
            self.place(target, open_mesh, Matrix.Translation((1, 0.9, 0.8)))
            before = self.everything(target)
            union.unite_open = lambda *meshes: meshes[left].copy()
            try:
                with self.assertRaisesRegex(RuntimeError, "one of them is missing.*Ctrl J"):
                    unite()
            finally:
                union.unite_open = original
            self.assertEqual(self.everything(target), before)

    def test_a_mesh_without_faces_is_refused(self):
        target = self.cube()
        self.place(target, bpy.data.meshes.new("empty"), Matrix())
        before = self.everything(target)
        with self.assertRaisesRegex(RuntimeError, "part has no faces"):
            unite()
        self.assertEqual(self.everything(target), before)

    def test_bones_move_seams_with_what_they_are_on(self):
        target = self.add(*BOX, "target")
        group = target.vertex_groups.new(name="upper")
        for vertex in target.data.vertices:
            if vertex.co.z:
                group.add([vertex.index], 1, "REPLACE")
        other = self.add([(1 + (x - 0.5) / 2, 0.3 + y / 4, 0.2 + z / 2) for x, y, z in BOX[0]], BOX[1], "other")
        self.ready(target, other)
        self.assertEqual(unite(), {"FINISHED"})
        weights = {tuple(round(c, 4) for c in vertex.co): sum(each.weight for each in vertex.groups) for vertex in target.data.vertices}
        seam = {place: weight for place, weight in weights.items() if place[0] == 1 and 0 < place[1] < 1 and 0 < place[2] < 1}
        self.assertGreaterEqual(len(seam), 4)
        for (x, y, z), weight in weights.items():
            self.assertAlmostEqual(weight, 0 if x > 1 else z, 5, (x, y, z))

    def test_groups_are_matched_by_name(self):
        """As Blender's Join does: a group that the target lacks is added."""
        target = self.add(*BOX, "target")
        other = self.add([(x + 0.5, y / 2 + 0.2, z / 2 + 0.2) for x, y, z in BOX[0]], BOX[1], "other")
        for obj, names in ((target, ("arm", "leg")), (other, ("tail", "leg", "unused"))):
            for name in names:
                obj.vertex_groups.new(name=name)
            for name in names[:2]:
                obj.vertex_groups[name].add(range(8), 0.25 if name == "leg" else 0.75, "REPLACE")
        self.ready(target, other)
        self.assertEqual(unite(), {"FINISHED"})
        self.assertEqual(target.vertex_groups.keys(), ["arm", "leg", "tail"])
        for vertex in target.data.vertices:
            weights = {target.vertex_groups[each.group].name: each.weight for each in vertex.groups}
            self.assertEqual(weights.keys(), {"tail" if vertex.co.x > 1.001 else "arm", "leg"}, vertex.co)
            self.assertAlmostEqual(weights["leg"], 0.25, 5)

    def test_vertices_that_are_split_as_in_every_glb_are_welded(self):
        """With UVs, materials and normals set by hand, as Blender's own Boolean has them of the welded mesh."""
        for modified in (False, True):
            target, other = (self.cube("red", "blue") for _ in range(2))
            other.location = 1, 0.9, 0.8
            for obj in (target, other):
                bpy.context.view_layer.objects.active = obj
                obj.shape_key_add(name="Basis")
                normals = [tuple(polygon.normal) for polygon in obj.data.polygons for _ in polygon.vertices]
                bpy.ops.object.mode_set(mode="EDIT")
                bpy.ops.mesh.select_all(action="SELECT")
                bpy.ops.uv.smart_project()
                bpy.ops.mesh.edge_split(type="EDGE")
                bpy.ops.object.mode_set(mode="OBJECT")
                part("mesh.arrays").write_custom_normals(obj.data, normals)
                obj.select_set(True)
                self.assertEqual(len(obj.data.vertices), 24)
            if modified:
                other.modifiers.new("move", "DISPLACE").strength = 0
            bpy.context.view_layer.objects.active = target
            bpy.context.view_layer.update()
            self.assertEqual(unite(), {"FINISHED"})
            self.assertSolid(target.data)
            self.assertAlmostEqual(volume(target.data), 16 - 1 * 1.1 * 1.2, places=5)
            self.assertEqual({material.name for material in target.data.materials}, {"red", "blue"})
            for polygon in target.data.polygons:
                normals = part("mesh.arrays").read_custom_normals(target.data)[list(polygon.loop_indices)]
                self.assertLess(abs(normals - polygon.normal).max(), 1e-2)
            uvs = numpy.array([corner.uv for corner in target.data.uv_layers[0].data])
            self.assertGreater(numpy.ptp(uvs, axis=0).min(), 0.5)
            self.setUp()

    def test_the_users_scene_never_has_temporary_objects(self):
        """Even with a modifier that both have, which acts on the union: the operand is evaluated without it."""
        target = self.cube()
        other = self.place(target, self.cube().data.copy(), Matrix.Translation((1, 0.9, 0.8)))
        for obj in (target, other):
            obj.modifiers.new("round", "SUBSURF").levels = 1
        scene, seen = bpy.context.scene, set()

        def note(updated_scene, _depsgraph):
            if updated_scene == scene:
                seen.update(obj.name for obj in scene.objects)

        expected = {obj.name for obj in scene.objects}
        bpy.app.handlers.depsgraph_update_post.append(note)
        self.addCleanup(bpy.app.handlers.depsgraph_update_post.remove, note)
        self.assertEqual(unite(keep=True), {"FINISHED"})
        self.assertSolid(target.data)
        self.assertAlmostEqual(volume(target.data), 16 - 1 * 1.1 * 1.2, places=5)  # of cubes, not of rounded ones
        bpy.context.view_layer.update()
        self.assertEqual(seen, expected)

    def test_inside_out_is_refused(self):
        target = self.cube()
        turned = self.cube().data.copy()
        turned.flip_normals()
        self.place(target, turned, Matrix.Translation((1, 1, 1)))
        before = self.everything(target)
        with self.assertRaisesRegex(RuntimeError, "inside out"):
            unite()
        self.assertEqual(self.everything(target), before)

    def test_faces_that_only_touch(self):
        """Two cubes face to face: united, or refused with a reason, and then unchanged."""
        for shift in ((2, 0, 0), (2, 1, 0), (2, 2, 0), (2, 2, 2)):
            target = self.cube()
            self.place(target, self.cube().data.copy(), Matrix.Translation(shift))
            before = self.everything(target)
            try:
                unite()
            except RuntimeError as error:
                self.assertIn("can't be united", str(error))
                self.assertEqual(self.everything(target), before)
            else:
                self.assertSolid(target.data)
                self.assertAlmostEqual(volume(target.data), 16, places=5)

    def test_a_union_without_one_operand_is_rejected(self):
        """Also where the other's faces were cut before. The result of the solver is replaced by one that leaves an object out,
        as solvers do now and then."""
        union = part("compose.union")
        base = self.cube().data
        cut = self.cube()
        self.edit(cut)
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide(number_cuts=2)
        bpy.ops.object.mode_set(mode="OBJECT")
        for matrix, left_out in ((Matrix.Translation((1.2, 0.1, 0.2)), True), (Matrix.Translation((9, 0, 0)), True),
                                 (Matrix(), False)):
            other = self.cube().data
            other.transform(matrix @ Matrix.Scale(0.5, 4))
            for meshes in ((base, other), (other, base)):
                wrong = union._volume_defect(meshes, [volume(mesh) for mesh in meshes], cut.data)
                self.assertEqual(wrong, "one of them is missing" if left_out else None)

    def everything(self, target):
        return (sorted(obj.name for obj in bpy.data.objects), sorted(mesh.name for mesh in bpy.data.meshes),
                sorted(c.name for c in bpy.data.collections), arrays(target.data)[0].tolist(), arrays(target.data)[1])



class Pinches(SolidTest):
    """What the Boolean leaves where solids touch, by hand."""

    def bmesh_of(self, vertices, faces):
        mesh = bpy.data.meshes.new("pinched")
        mesh.from_pydata(vertices, [], faces)
        bm = bmesh.new()
        self.addCleanup(bm.free)
        bm.from_mesh(mesh)
        return bm

    def tetrahedron(self, *corners):
        a, b, c, d = corners
        return [(a, c, b), (a, b, d), (b, c, d), (c, a, d)]

    def assertManifold(self, bm, volume, pieces):
        self.assertTrue(all(edge.is_contiguous for edge in bm.edges))
        self.assertTrue(all(vert.is_manifold for vert in bm.verts))
        self.assertAlmostEqual(bm.calc_volume(signed=True), volume, 6)
        self.assertEqual(len(bm.verts) - len(bm.edges) + len(bm.faces), 2 * pieces)

    def test_a_double_wall_is_removed_but_no_card_with_two_sides(self):
        pinches, (corners, faces) = part("compose.pinches"), BOX
        stacked = numpy.array(corners, float)[:, 2] > 0.5
        second = {old: old + 8 for old in range(8)}
        upper = numpy.flatnonzero(stacked).tolist()
        for old in upper:  # the upper box's bottom is the lower one's top
            below = next(number for number in range(8) if number != old and corners[number][:2] == corners[old][:2])
            second[below] = old
        vertices = [*map(tuple, corners), *((x, y, z + 1) for x, y, z in corners), (5, 0, 0), (6, 0, 0), (5, 1, 0)]
        bm = self.bmesh_of(vertices, [*faces, *(tuple(second[v] for v in face) for face in faces), (16, 17, 18), (18, 17, 16)])
        pinches.cancel_coincident_faces(bm)
        bmesh.ops.delete(bm, geom=[vert for vert in bm.verts if not vert.link_faces], context="VERTS")
        self.assertEqual(len(bm.faces), 5 + 5 + 2)
        self.assertTrue(pinches.split_pinches(bm))
        self.assertManifold(bm, 2, 2)

    def test_wedges_that_rounding_put_inside_each_other_part_on_demand(self):
        split_pinches = part("compose.pinches").split_pinches
        vertices = [(0, 0, 0), (0, 0, 1), (2, -1, 0), (2, 1, 0), (1, -0.2, 0), (1, 0.2, 0)]
        faces = self.tetrahedron(0, 2, 3, 1) + self.tetrahedron(0, 4, 5, 1)  # both have edge 0 1
        self.assertFalse(split_pinches(self.bmesh_of(vertices, faces)))
        bm = self.bmesh_of(vertices, faces)
        self.assertTrue(split_pinches(bm, may_overlap=True))
        self.assertManifold(bm, (4 + 0.4) / 6, 2)

    def test_an_edge_without_length_parts_on_demand(self):
        split_pinches = part("compose.pinches").split_pinches
        vertices = [(0, 0, 0), (0, 0, 0), (2, -1, 0), (2, 1, 1), (-2, -1, 0), (-2, 1, 1)]
        faces = self.tetrahedron(0, 2, 3, 1) + self.tetrahedron(0, 5, 4, 1)
        self.assertFalse(split_pinches(self.bmesh_of(vertices, faces)))
        bm = self.bmesh_of(vertices, faces)
        self.assertTrue(split_pinches(bm, may_overlap=True))
        self.assertManifold(bm, 0, 2)


class Blend(SolidTest):
    """Two balls united with and without a blend: the same mesh but for the places of vertices near the seam."""

    def united(self, blend, distance=1.3, radius=0.7, prepare=lambda obj: None):
        results = []
        for place, size, name in ((0, 1, "red"), (distance, radius, "blue")):
            bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=32, radius=size, location=(place, 0.05, 0.1))
            obj = bpy.context.active_object
            bpy.ops.object.transform_apply()
            obj.data.materials.append(bpy.data.materials.get(name) or bpy.data.materials.new(name))
            prepare(obj)
            results.append(obj)
        self.ready(*results)
        self.assertEqual(unite(blend=blend), {"FINISHED"})
        self.assertSolid(results[0].data)
        return results[0]

    def steepest(self, mesh):
        """The largest angle between polygons at an edge, of those that are not tiny."""
        bm = bmesh.new()
        bm.from_mesh(mesh)
        sharpest = max(edge.calc_face_angle() for edge in bm.edges if min(face.calc_area() for face in edge.link_faces)
                    > 1e-4)
        bm.free()
        return sharpest

    # Blender's Boolean gives the same vertices and polygons each time, but in an order of its own.

    def test_moves_only_what_is_near_the_seam(self):
        plain, blended = self.united(0).data, self.united(0.4).data
        before, polygons = arrays(plain)
        self.assertEqual((len(before), len(polygons)), (len(blended.vertices), len(blended.polygons)))
        is_kept = numpy.isin(*(numpy.ascontiguousarray(places.round(5)).view("f8,f8,f8").ravel()
                            for places in (before, arrays(blended)[0])))
        material = {v: set() for v in range(len(before))}
        for polygon in plain.polygons:
            for vertex in polygon.vertices:
                material[vertex].add(polygon.material_index)
        seam = before[[vertex for vertex, slots in material.items() if len(slots) == 2]]
        self.assertGreater(len(seam), 20)
        radius = numpy.linalg.norm(seam - seam.mean(axis=0), axis=1).mean()
        from_seam = numpy.linalg.norm(before[:, None] - seam, axis=2).min(axis=1)
        self.assertTrue(is_kept[from_seam > 0.45 * radius].all())
        self.assertFalse(is_kept[from_seam < 0.2 * radius].any())
        self.assertGreater((from_seam < 0.2 * radius).sum(), 100)
        self.assertLess(self.steepest(blended), 0.5 * self.steepest(plain))
        # A crease gets filled: there is a little more solid now.
        self.assertGreater(volume(blended), volume(plain) * 1.001)
        self.assertLess(volume(blended), volume(plain) * 1.05)

    def test_layers_and_materials_stay(self):
        plain, blended = self.united(0).data, self.united(0.4).data
        self.assertEqual([layer.name for layer in blended.uv_layers], [layer.name for layer in plain.uv_layers])
        self.assertNotIn("partwheel_side", blended.attributes)
        uvs = []
        for mesh in (plain, blended):
            uv = numpy.array([loop_uv.uv[:] for loop_uv in mesh.uv_layers[0].data])
            material = numpy.array([polygon.material_index for polygon in mesh.polygons])
            rows = numpy.column_stack([uv, numpy.repeat(material, [polygon.loop_total for polygon in mesh.polygons])])
            uvs.append(rows[numpy.lexsort(rows.round(4).T)])
        self.assertTrue(numpy.allclose(*uvs, atol=1e-3))

    def test_normals_set_by_hand_are_kept_beyond_the_band(self):
        def upwards(obj):
            if hasattr(obj.data, "use_auto_smooth"):
                obj.data.use_auto_smooth = True
            obj.data.polygons.foreach_set("use_smooth", numpy.ones(len(obj.data.polygons), bool))
            obj.data.normals_split_custom_set([(0, 0.6, 0.8)] * len(obj.data.loops))

        mesh = self.united(0.3, prepare=upwards).data
        if mesh.has_custom_normals:  # Blender's Boolean keeps them in some versions
            normals = part("mesh.arrays").read_custom_normals(mesh)
            far = numpy.array([mesh.vertices[loop.vertex_index].co.x < 0 for loop in mesh.loops])
            self.assertTrue(numpy.allclose(normals[far], (0, 0.6, 0.8), atol=1e-2))

    def test_a_seam_may_be_smaller_than_all_triangles_about_it(self):
        bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 1))
        tip = bpy.context.active_object
        tip.rotation_euler = (0.6155, 0.7854, 0.3)  # on a corner, nearly, which is just inside the other
        bpy.context.view_layer.update()
        tip.location.z += 0.48 - min((tip.matrix_world @ vertex.co).z for vertex in tip.data.vertices)
        bpy.ops.mesh.primitive_cube_add(size=1)
        target = bpy.context.active_object
        tip.select_set(True)
        self.assertEqual(unite(blend=0.3), {"FINISHED"})
        self.assertSolid(target.data)
