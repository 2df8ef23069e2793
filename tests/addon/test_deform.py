# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_deform and api.deform without a window: what moves, what stays, shape keys, mirror, refusals."""

import bmesh
import bpy
import numpy
from common import BOX, MeshTest, package, part, read_off, snapshot

FINGER = 21  # a face of hand.off at the tip of a finger


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
        self.assertIsNotNone(part("parts.registry").get_hierarchy(snapshot(obj)))
        self.assertEqual(part("parts.registry").get_state(obj.data)[0], part("parts.registry").State.MOVED)
        bpy.ops.object.mode_set(mode="OBJECT")
        numpy.testing.assert_array_equal(stored(obj.data.vertices), after.astype(numpy.float32))

    def test_the_operator_deforms_as_the_library_does(self):
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

    def distance_from_tip(self, obj, tip):
        co = edited(obj)
        return int(numpy.linalg.norm(co - co[tip], axis=1).argmax())

    def test_loose_pieces_move_with_the_nearest_part(self):
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
