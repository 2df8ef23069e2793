# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_deform and api.deform without a window: what moves, what stays, shape keys, mirror, refusals."""

import bmesh
import bpy
import numpy
from common import BOX, MeshTest, package, part, read_off

FINGER = 21  # a face of hand.off at the tip of a finger
SNAPPED = 700  # one of a part whose border snapping moves


def shift(x, y, z):
    matrix = numpy.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def edited(obj):
    """(V,3) what Edit Mode shows."""
    return numpy.array([vertex.co[:] for vertex in bmesh.from_edit_mesh(obj.data).verts])


def stored(collection):
    return numpy.array([element.co[:] for element in collection])


def handle(vertex, matrix, radius=0.0):
    """One of the operator's handles."""
    return {"name": "", "turn": 0, "vertex": vertex, "radius": radius, "matrix": matrix.ravel().tolist()}


def inner(obj, faces):
    """The vertices all of whose faces are among these."""
    faces = set(faces)
    inside, outside = set(), set()
    for polygon in obj.data.polygons:
        (inside if polygon.index in faces else outside).update(polygon.vertices)
    return sorted(inside - outside)


class Deform(MeshTest):
    def hand(self, face=FINGER):
        """(object in Edit Mode, node of a finger, its faces, its inner vertices, the farthest of them from the rest)"""
        obj = self.add(*read_off("hand"))
        self.edit(obj)
        api = part("api")
        hierarchy = api.hierarchy(obj)
        stops, start = hierarchy.wheel(face)
        # The finger is the largest part that is no more than a fifth of the hand.
        finger = sum(hierarchy.area[stop] <= 0.2 * hierarchy.area[-1] for stop in stops) - 1
        node = api.part(obj, face, finger - start).node
        api.select(obj, node)
        faces = api.faces(obj, node).tolist()
        free = inner(obj, faces)
        co = stored(obj.data.vertices)
        rest = numpy.delete(co, free, axis=0).mean(axis=0)
        tip = max(free, key=lambda vertex: numpy.linalg.norm(co[vertex] - rest))
        return obj, node, faces, free, tip

    def run_operator(self, **arguments):
        return bpy.ops.mesh.partwheel_deform("EXEC_DEFAULT", **arguments)

    def refusal(self, **arguments):
        with self.assertRaises(RuntimeError) as refused:
            self.run_operator(**arguments)
        return str(refused.exception)

    def test_a_part_picked_with_a_snapped_border_is_deformed_so(self):
        obj, node, faces, free, tip = self.hand(SNAPPED)
        snapped = part("api").faces(obj, node, snap=True).tolist()
        self.assertNotEqual(set(snapped), set(faces))
        before = edited(obj)
        move = shift(0.1 * numpy.ptp(before, axis=0).max(), 0, 0)
        start = part("pick.states").pick_face(part("api").hierarchy(obj), SNAPPED)
        level = start.stops.index(node) - start.start
        for picked, arguments, expected in ((True, {}, snapped), (False, {}, faces), (True, {"snap": False}, faces),
                                          (False, {"snap": True}, snapped)):
            part("api").select(obj, part("api").part(obj, SNAPPED, level), snap=picked)
            self.assertEqual(self.run_operator(handles=[handle(tip, move, 0)], **arguments), {"FINISHED"})
            moved = numpy.flatnonzero((edited(obj) != before).any(axis=1))
            self.assertLessEqual(set(moved.tolist()), set(inner(obj, expected)))
            self.assertGreater(len(moved), 0.9 * len(inner(obj, expected)))
            self.restore(obj, before)

    def restore(self, obj, positions):
        bm = bmesh.from_edit_mesh(obj.data)
        for vertex, place in zip(bm.verts, positions):
            vertex.co = place
        bmesh.update_edit_mesh(obj.data)

    def test_the_part_follows_and_nothing_else_moves(self):
        obj, node, faces, free, tip = self.hand()
        before = edited(obj)
        size = numpy.ptp(before, axis=0).max()
        move = shift(0.1 * size, 0.05 * size, 0)
        # Of the part picked last.
        self.assertEqual(self.run_operator(handles=[handle(tip, move, 0.01 * size)]), {"FINISHED"})
        after = edited(obj)
        moved = (after != before).any(axis=1)
        self.assertFalse(moved[numpy.setdiff1d(numpy.arange(len(before)), free)].any())
        self.assertGreater(moved[free].mean(), 0.9)
        numpy.testing.assert_allclose(after[tip] - before[tip], move[:3, 3], atol=1e-5 * size)
        self.assertIsNotNone(part("parts.registry").get_hierarchy(obj))
        self.assertEqual(part("parts.registry").get_state(obj.data)[0], part("parts.registry").State.MOVED)
        bpy.ops.object.mode_set(mode="OBJECT")
        numpy.testing.assert_array_equal(stored(obj.data.vertices), after.astype(numpy.float32))

    def test_the_same_as_the_core(self):
        """The mesh of a part: its inner vertices free, all others fixed, and the core's Deformation of the whole."""
        obj, node, faces, free, tip = self.hand()
        deform = package("deform")
        rest = edited(obj)
        triangles = numpy.array([polygon.vertices[:] for polygon in obj.data.polygons])
        roles = numpy.full(len(rest), deform.FIXED)
        roles[free] = deform.FREE
        roles[tip] = 0
        expected = deform.Deformation(rest, triangles, roles)
        expected.move_in_steps([shift(0, 0.1, 0.05)])
        part("api").deform(obj, node, [tip], shift(0, 0.1, 0.05))
        numpy.testing.assert_allclose(edited(obj), expected.positions(), atol=2e-5)

    def test_hidden_vertices_stay(self):
        obj, node, faces, free, tip = self.hand()
        bm = bmesh.from_edit_mesh(obj.data)
        bm.verts.ensure_lookup_table()
        hidden = [vertex for vertex in free if vertex != tip][::7]
        for vertex in hidden:
            bm.verts[vertex].hide_set(True)
        before = edited(obj)
        part("api").deform(obj, node, [tip], shift(0.05, 0, 0))
        after = edited(obj)
        self.assertTrue((after[hidden] == before[hidden]).all())
        self.assertTrue((after[tip] != before[tip]).any())
        bpy.ops.mesh.reveal(select=False)

    def test_the_active_shape_key_alone_changes(self):
        obj, node, faces, free, tip = self.hand()
        bpy.ops.object.mode_set(mode="OBJECT")
        for name in ("Basis", "smile", "frown"):
            obj.shape_key_add(name=name)
        keys = obj.data.shape_keys.key_blocks
        for key_point in keys[1].data:
            key_point.co.z += 0.01
        obj.active_shape_key_index = 1
        before = [stored(key.data) for key in keys]
        for mode in ("EDIT", "OBJECT"):
            bpy.ops.object.mode_set(mode=mode)
            part("api").deform(obj, node, [tip], shift(0.05, 0, 0))
            bpy.ops.object.mode_set(mode="OBJECT")
            after = [stored(key.data) for key in keys]
            self.assertTrue((after[0] == before[0]).all() and (after[2] == before[2]).all(), mode)
            numpy.testing.assert_allclose((after[1] - before[1])[tip], (0.05, 0, 0), atol=1e-6)
            before = after

    def test_mirror(self):
        """Two copies of a hand, one mirrored: what one finger does its image does mirrored."""
        vertices, polygons = read_off("hand")
        apart = max(abs(x) for x, _, _ in vertices) * 1.5
        count = len(vertices)
        both = [(x + apart, y, z) for x, y, z in vertices] + [(-x - apart, y, z) for x, y, z in vertices]
        obj = self.add(both, polygons + [tuple(count + v for v in reversed(polygon)) for polygon in polygons])
        obj.data.use_mirror_x = True
        api = part("api")
        node = next(node for node in api.path(obj, FINGER) if len(inner(obj, api.faces(obj, node).tolist())) > 20)
        free = inner(obj, api.faces(obj, node).tolist())
        self.assertLess(max(free), count)
        before = stored(obj.data.vertices)
        api.deform(obj, node, free[:1], shift(0.05, 0.02, 0))
        after = stored(obj.data.vertices)
        moved = numpy.flatnonzero((after != before).any(axis=1))
        self.assertTrue((moved >= count).any() and (moved < count).any())
        numpy.testing.assert_array_equal((after - before)[count:], (after - before)[:count] * (-1, 1, 1))

    def test_mirror_in_the_middle(self):
        """A part that is its own image stays symmetric, and a handle on one side has its image on the other."""
        bpy.ops.mesh.primitive_cube_add(size=2)
        obj = bpy.context.active_object
        self.edit(obj)
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide(number_cuts=7)
        bpy.ops.object.mode_set(mode="OBJECT")
        obj.data.use_mirror_x = True
        top = [polygon.index for polygon in obj.data.polygons if polygon.center.z > 0.01]
        co = stored(obj.data.vertices)
        region = part("deform.region").Region(obj, top, 0, True)
        patch = region.patch(region.nearest_free(int(numpy.abs(co - (0.5, 0, 1)).sum(axis=1).argmin())), 0.3)
        shape = part("deform.methods").AsRigidAsPossible(region, [patch])
        shape.solve([shift(0.2, 0, 0.5)])
        part("deform.vertex_writer").VertexWriter(obj, region).write(obj, shape.points())
        after = stored(obj.data.vertices)
        self.assertGreater(after[:, 2].max(), 1.4)
        image = after * (-1, 1, 1)
        nearest = numpy.linalg.norm(image[:, None] - after, axis=2).min(axis=1)
        self.assertLess(nearest.max(), 1e-6)

    def test_quads_and_ngons_and_their_layers(self):
        bpy.ops.mesh.primitive_cylinder_add(vertices=16, depth=6)
        obj = bpy.context.active_object
        self.edit(obj)
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide(number_cuts=4)
        bpy.ops.object.mode_set(mode="OBJECT")
        uvs = [tuple(loop_uv.uv) for loop_uv in obj.data.uv_layers.active.data]
        faces = [polygon.index for polygon in obj.data.polygons if polygon.center.z > 0]
        self.assertTrue(any(len(polygon.vertices) > 4 for polygon in obj.data.polygons))
        top = [vertex.index for vertex in obj.data.vertices if vertex.co.z > 2.9]
        region = part("deform.region").Region(obj, faces)
        shape = part("deform.methods").AsRigidAsPossible(region, [numpy.searchsorted(region.vertices, top)])
        shape.solve([shift(1, 0, 0)])
        part("deform.vertex_writer").VertexWriter(obj, region).write(obj, shape.points())
        self.assertAlmostEqual(max(vertex.co.x for vertex in obj.data.vertices), 2, places=4)
        self.assertEqual(uvs, [tuple(loop_uv.uv) for loop_uv in obj.data.uv_layers.active.data])

    def test_restoring_is_exact(self):
        obj, node, faces, free, tip = self.hand()
        before = edited(obj)
        region = part("deform.region").Region(obj, faces)
        shape = part("deform.methods").AsRigidAsPossible(region, [[region.nearest_free(tip)]])
        for step in range(5):
            shape.follow([shift(0.02 * step, 0, 0)])
            part("deform.vertex_writer").VertexWriter(obj, region).write(obj, shape.points())
        self.assertTrue((edited(obj) != before).any())
        part("deform.vertex_writer").VertexWriter(obj, region).restore(obj)
        self.assertTrue((edited(obj) == before).all())

    def distance_from_tip(self, obj, tip):
        co = edited(obj)
        return int(numpy.linalg.norm(co - co[tip], axis=1).argmax())

    def test_refusals_change_nothing(self):
        obj, node, faces, free, tip = self.hand()
        before = edited(obj)
        hierarchy = part("parts.registry").get_hierarchy(obj)
        root = len(hierarchy.parent) - 1
        here = handle(tip, shift(0.1, 0, 0))
        self.assertIn("no handle", self.refusal())
        self.assertIn("whole mesh", self.refusal(node=root, handles=[here]))
        self.assertIn("no part", self.refusal(node=root + 1, handles=[here]))
        self.assertIn("handle covers the whole part", self.refusal(handles=[{**here, "radius": 1e6}]))
        self.assertIn("doesn't have", self.refusal(handles=[{**here, "vertex": 10**6}]))
        self.assertIn("not on the part", self.refusal(handles=[{**here, "vertex": self.distance_from_tip(obj, tip)}]))
        with self.assertRaises(ValueError):
            part("api").deform(obj, node, [self.distance_from_tip(obj, tip)], shift(1, 0, 0))
        with self.assertRaises(ValueError):
            part("api").deform(obj, node, [], shift(1, 0, 0))
        with self.assertRaises(package().PartwheelError):
            part("api").deform(obj, node, [tip], shift(numpy.nan, 0, 0))
        self.assertTrue((edited(obj) == before).all())

    def test_normals_while_it_moves(self):
        """Those that are seen are right at once, flat or smooth; at the end all are Blender's own."""
        for smooth in (False, True):
            obj, node, faces, free, tip = self.hand()
            bm = bmesh.from_edit_mesh(obj.data)
            for face in bm.faces:
                face.smooth = smooth
            region = part("deform.region").Region(obj, faces)
            middle = region.nearest_free(tip)  # of a handle as large as users have it: no thorn
            patch = region.patch(middle, region.default_radius(middle))
            shape, pen = part("deform.methods").AsRigidAsPossible(region, [patch]), part("deform.vertex_writer").VertexWriter(obj, region)
            shape.follow([shift(0.05, 0.02, 0)])

            def normals(elements):
                return numpy.array([element.normal[:] for element in elements])

            pen.write_draft(obj, shape.points())
            seen = normals(bm.verts if smooth else bm.faces)
            pen.write(obj, shape.points())
            final = normals(bm.verts if smooth else bm.faces)
            bm.normal_update()
            numpy.testing.assert_array_equal(final, normals(bm.verts if smooth else bm.faces))
            cosine = (seen * final).sum(axis=1)
            self.assertGreater(numpy.median(cosine[free] if smooth else cosine[faces]), 0.999)
            if smooth:  # where faces meet in a spike or are folded, as here and there in this mesh, the weights matter
                plain = [all(face.normal.dot(vertex.normal) > 0.5 for face in vertex.link_faces) for vertex in bm.verts]
                self.assertGreater(numpy.mean(plain), 0.9)
                cosine = cosine[plain]
            self.assertGreater(cosine.min(), 0.8 if smooth else 0.99999)
            self.setUp()

    def test_a_part_turned_at_its_joint(self):
        """The finger keeps its shape, and bends at its root on either side; operator, api and redo are one."""
        obj, node, faces, free, tip = self.hand()
        before = edited(obj)
        region = part("deform.region").Region(obj, faces, reach=2.0)
        limb = region.vertices[region.limb]
        self.assertTrue(set(limb) < set(free) and tip in limb)
        self.assertTrue(set(region.vertices[region.free]) - set(free))  # the bend has two sides
        turn = numpy.eye(4)
        turn[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
        turn[:3, 3] = region.center - turn[:3, :3] @ region.center
        self.assertEqual(self.run_operator(method="JOINT", handles=[handle(tip, turn)]), {"FINISHED"})
        after = edited(obj)
        numpy.testing.assert_allclose(after[limb], before[limb] @ turn[:3, :3].T + turn[:3, 3], atol=1e-5)
        still = numpy.setdiff1d(numpy.arange(len(before)), region.vertices[region.free])
        self.assertTrue((after[still] == before[still]).all())
        self.assertTrue((after[free] != before[free]).any(axis=1).all())
        for vertex, point in zip(bmesh.from_edit_mesh(obj.data).verts, before):
            vertex.co = point
        part("api").bend(obj, node, turn[:3, :3])
        numpy.testing.assert_allclose(edited(obj), after, atol=1e-5)  # the operator's matrix has single precision

    def test_loose_pieces_go_along(self):
        """Two beads beside a finger keep their shape and their places beside it; one beside the palm stays."""
        vertices, polygons = read_off("hand")
        obj, node, faces, free, tip = self.hand()
        co = edited(obj)
        self.setUp()
        size = 0.02 * numpy.ptp(co, axis=0).max()
        middle = co[free].mean(axis=0)
        distance_from_tip = co[int(numpy.linalg.norm(co - middle, axis=1).argmax())]
        count, bead = len(vertices), numpy.array(BOX[0]) * size
        for number, place in enumerate((co[tip], middle, distance_from_tip)):
            vertices = vertices + [tuple(point + place) for point in bead]
            polygons = polygons + [tuple(count + 8 * number + v for v in polygon) for polygon in BOX[1]]
        obj = self.add(vertices, polygons)
        before = stored(obj.data.vertices)
        faces = faces + list(range(len(polygons) - 18, len(polygons) - 6))
        region = part("deform.region").Region(obj, faces)
        shape = part("deform.methods").AsRigidAsPossible(region, [region.patch(region.nearest_free(tip), 4 * size)])
        turn = package("deform").interpolate_transform(numpy.diag([1.0, -1, -1, 1]), 40 / 180)
        turn[:3, 3] = middle - turn[:3, :3] @ middle
        shape.solve([turn])
        part("deform.vertex_writer").VertexWriter(obj, region).write(obj, shape.points())
        after = stored(obj.data.vertices)
        beads, moved = after[count:].reshape(3, 8, 3), numpy.linalg.norm(after - before, axis=1)
        for index in range(3):
            for way in (lambda points: points - points[0], lambda points: points[4:] - points[:4]):
                numpy.testing.assert_allclose(numpy.linalg.norm(way(beads[index]), axis=1),
                                              numpy.linalg.norm(way(bead), axis=1), atol=1e-5)
        self.assertGreater(moved[count:count + 8].min(), 2 * size)
        self.assertLess(numpy.linalg.norm(beads[0][0] - after[tip]), 0.5 * size)
        self.assertGreater(moved[count + 8:count + 16].max(), 0)
        self.assertEqual(moved[count + 16:].max(), 0)
