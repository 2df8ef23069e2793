# SPDX-License-Identifier: GPL-3.0-or-later
"""Coincident vertices are one vertex: a hand whose vertices are split, as every GLB has them, is edited like the same hand
in one piece, to the last bit."""

import bmesh
import bpy
import numpy
from common import MeshTest, part, read_off
from test_deform import FINGER, edited, inner, shift, stored

ROWS = ("along the axes", "everywhere")


def split(vertices, polygons, where):
    """(vertices, polygons, the vertex that each was): one of its own for each chart at a vertex. Charts are polygons that
    face the same axis, or single ones."""
    points, numbers, was, new_polygons = numpy.array(vertices), {}, [], []
    for index, polygon in enumerate(polygons):
        a, b, c = points[list(polygon[:3])]
        chart = index if where == "everywhere" else int(abs(numpy.cross(b - a, c - a)).argmax())
        corners = []
        for vertex in polygon:
            if (vertex, chart) not in numbers:
                numbers[vertex, chart] = len(was)
                was.append(vertex)
            corners.append(numbers[vertex, chart])
        new_polygons.append(tuple(corners))
    return [vertices[vertex] for vertex in was], new_polygons, numpy.array(was)


class Coincident(MeshTest):
    def split_and_whole(self, where):
        """(hand, hand split, the vertex that each of its vertices was, the faces of a finger, its tip)"""
        whole = self.add(*read_off("hand"), "whole")
        hierarchy = part("api").hierarchy(whole)
        stops, _ = hierarchy.wheel(FINGER)
        node = [stop for stop in stops if hierarchy.area[stop] <= 0.2 * hierarchy.area[-1]][-1]
        faces = hierarchy.faces(node)
        vertices, polygons, was = split(*read_off("hand"), where)
        co = stored(whole.data.vertices)
        free = inner(whole, faces.tolist())
        rest = numpy.delete(co, free, axis=0).mean(axis=0)
        tip = max(free, key=lambda vertex: numpy.linalg.norm(co[vertex] - rest))
        return whole, self.add(vertices, polygons, "split"), was, faces, tip

    def deform(self, obj, faces, method, rings, tip, matrix):
        session_module = part("deform.session")
        session_module.deform(obj, faces, method, rings, 1.0, [[session_module.DeformHandle(int(tip), 0.05 * self.size, matrix)]])

    def compare(self, method, rings=0, mirror=False, mode="OBJECT"):
        for where in ROWS:
            with self.subTest(where=where, method=method, rings=rings, mirror=mirror, mode=mode):
                whole, obj, was, faces, tip = self.split_and_whole(where)
                before = stored(whole.data.vertices)
                self.size = numpy.ptp(before, axis=0).max()
                whole.data.use_mirror_x = obj.data.use_mirror_x = mirror
                if mirror:  # the finger lies on both sides of the plane then
                    for model, own in ((whole, numpy.arange(len(before))), (obj, was)):
                        model.data.vertices.foreach_set("co", (before - before[faces_vertices(whole, faces)].mean(axis=0))[
                            own].astype(numpy.float32).ravel())
                    before = stored(whole.data.vertices)
                matrix = shift(0.07 * self.size, 0.05 * self.size, 0)
                matrix[:3, :3] = [[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]]
                results = []
                for model, handle in ((whole, tip), (obj, numpy.flatnonzero(was == tip)[-1])):
                    bpy.context.view_layer.objects.active = model
                    if mode == "EDIT":
                        bpy.ops.object.mode_set(mode="EDIT")
                    self.deform(model, faces, method, rings, handle, matrix)
                    if mode == "EDIT":
                        bpy.ops.object.mode_set(mode="OBJECT")
                    results.append(stored(model.data.vertices))
                self.assertGreater((results[0] != before).any(axis=1).sum(), 20)
                numpy.testing.assert_array_equal(results[1], results[0][was])
                self.setUp()

    def test_a_dragged_handle_opens_no_crack(self):
        self.compare("RIGID")

    def test_rings_grow_across_splits(self):
        self.compare("RIGID", rings=2)

    def test_a_joint_bends_without_a_crack(self):
        self.compare("JOINT", mode="EDIT")

    def test_proportional_goes_across_splits(self):
        self.compare("PROPORTIONAL", rings=1, mode="EDIT")

    def test_mirrored_vertices_open_no_crack(self):
        self.compare("RIGID", mirror=True)

    def test_drafts_have_no_crack_and_the_normals_of_blender(self):
        whole, obj, was, faces, tip = self.split_and_whole(ROWS[0])
        self.size = numpy.ptp(stored(whole.data.vertices), axis=0).max()
        for polygon in obj.data.polygons:
            polygon.use_smooth = True
        self.edit(obj)
        session_module, region = part("deform.session"), part("deform.region").Region(obj, faces)
        shape = part("deform.methods").METHODS["RIGID"](region, session_module.handle_patches(
            region, "RIGID", [session_module.DeformHandle(int(numpy.flatnonzero(was == tip)[0]), 0.05 * self.size)]))
        shape.follow([shift(0.1 * self.size, 0, 0)])
        part("deform.vertex_writer").VertexWriter(obj, region).write_draft(obj, shape.points())
        bm = bmesh.from_edit_mesh(obj.data)
        places, normals = edited(obj), numpy.array([vertex.normal[:] for vertex in bm.verts])
        first = numpy.unique(was, return_index=True)[1]
        numpy.testing.assert_array_equal(places, places[first][was])
        bm.normal_update()  # by angles, where the draft's are by Max's weights: a little different
        self.assertGreater(numpy.einsum("ij,ij->i", normals, [vertex.normal[:] for vertex in bm.verts]).min(), 0.95)

    def test_vertices_that_a_shape_key_separates_stay_separate(self):
        _, obj, was, faces, tip = self.split_and_whole(ROWS[1])
        self.size = numpy.ptp(stored(obj.data.vertices), axis=0).max()
        obj.shape_key_add(name="Basis")
        key = obj.shape_key_add(name="Open")
        obj.active_shape_key_index = 1
        basis = stored(obj.data.vertices)
        # All triangles a little smaller: none shares a place with another.
        co = basis.copy()
        for polygon in obj.data.polygons:
            own = list(polygon.vertices)
            co[own] = 0.5 * basis[own] + 0.5 * basis[own].mean(axis=0)
        key.data.foreach_set("co", co.astype(numpy.float32).ravel())
        with self.assertRaises(part("mesh.errors").Refused):  # each triangle is a loose piece
            self.deform(obj, faces[:1], "RIGID", 0, int(numpy.flatnonzero(was == tip)[0]), shift(1, 0, 0))
        obj.active_shape_key_index = 0
        self.deform(obj, faces, "RIGID", 0, int(numpy.flatnonzero(was == tip)[0]), shift(0.1 * self.size, 0, 0))
        after = stored(obj.data.shape_keys.key_blocks[0].data)
        first = numpy.unique(was, return_index=True)[1]
        numpy.testing.assert_array_equal(after, after[first][was])
        self.assertGreater((after != basis).any(axis=1).sum(), 20)

    def test_masks_and_vertex_groups_include_coincident_vertices(self):
        for where in ROWS:
            whole, obj, was, faces, _ = self.split_and_whole(where)
            writers = part("pick.writers")
            results = []
            for model in (whole, obj):
                writers.WRITERS["MASK"](model, faces, 1, False, False)
                values = numpy.zeros(len(model.data.vertices), numpy.float32)
                writers.find_mask(model.data).foreach_get("value", values)
                writers.WRITERS["VERTEX_GROUP"](model, faces, 1, False, False)
                grouped = numpy.array([len(vertex.groups) for vertex in model.data.vertices])
                numpy.testing.assert_array_equal(values, grouped)
                results.append(values)
            self.assertGreater(results[0].sum(), 20)
            numpy.testing.assert_array_equal(results[1], results[0][was])
            self.setUp()


def faces_vertices(obj, faces):
    return sorted({vertex for face in faces for vertex in obj.data.polygons[face].vertices})
