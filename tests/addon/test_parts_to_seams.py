# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams of parts, and what Blender unwraps by them: read back and measured, on five real models, three of them broken."""

import bpy
import numpy
from common import only_in, part
from partwheel.cut import Cut
from test_parts_to import PartsCase, read
from uv_measures import islands, measured


def corner_uvs(mesh, layer=None):
    """(T,3,2) of a mesh of triangles."""
    return read((layer or mesh.uv_layers.active).data, "uv", numpy.float32, 2).reshape(-1, 3, 2).astype(float)


def surface(mesh):
    """((V,3), (T,3)) of a mesh of triangles."""
    return (read(mesh.vertices, "co", numpy.float32, 3).reshape(-1, 3).astype(float),
            read(mesh.loops, "vertex_index", numpy.int32).reshape(-1, 3))


def seams(mesh):
    return read(mesh.edges, "use_seam", bool)


def islands_by_seams(mesh):
    """([the Euler characteristic of each island that seams leave, ...], (F,) its number of each face): corners are joined
    across each edge that two faces share and that is no seam."""
    at, joined = {}, list(range(len(mesh.loops)))
    group = list(range(len(mesh.polygons)))

    def find(of, one):
        while of[one] != one:
            of[one] = one = of[of[one]]
        return one

    for polygon in mesh.polygons:
        for loop in polygon.loop_indices:
            at.setdefault(mesh.loops[loop].edge_index, []).append(polygon)
    own = []
    for edge, faces in at.items():
        if len(faces) == 2 and not mesh.edges[edge].use_seam:
            one, other = faces
            group[find(group, one.index)] = find(group, other.index)
            for vertex in mesh.edges[edge].vertices:
                ends = [face.loop_indices[list(face.vertices).index(vertex)] for face in faces]
                joined[find(joined, ends[0])] = find(joined, ends[1])
            own.append(one.index)
        else:
            own += [face.index for face in faces]
    euler = {}
    for polygon in mesh.polygons:
        number = find(group, polygon.index)
        euler[number] = euler.get(number, 0) + 1
    for face in own:
        euler[find(group, face)] -= 1
    for number in {(find(joined, loop), find(group, polygon.index)) for polygon in mesh.polygons
                   for loop in polygon.loop_indices}:
        euler[number[1]] += 1
    names = {number: place for place, number in enumerate(euler)}
    return [*euler.values()], numpy.array([names[find(group, face)] for face in range(len(group))])


class Seams(PartsCase):
    @only_in("newest")
    def test_each_island_is_a_disk(self):
        for name, obj, cut in self.each():
            obj.data.edges.foreach_set("use_seam", numpy.arange(len(obj.data.edges)) % 7 == 0)  # the artist's, that go
            part("api").write(obj, cut, {"SEAMS"})
            euler, _ = islands_by_seams(obj.data)
            self.assertEqual({*euler}, {1}, name)
            self.assertEqual(len(obj.data.uv_layers), 0)
            before = seams(obj.data)
            part("api").write(obj, cut, {"SEAMS"})
            self.assertTrue((seams(obj.data) == before).all())

    @only_in("newest")
    def test_unwrapped_as_the_seams_say_with_fewer_islands_than_smart_uv(self):
        for name, obj, cut in self.each():
            part("api").write(obj, cut, {"SEAMS"}, unwrap=True)
            mesh = obj.data
            self.assertEqual([(layer.name, layer.active, layer.active_render) for layer in mesh.uv_layers],
                             [("UVMap", True, True)])
            vertices, triangles = surface(mesh)
            ours = measured(vertices, triangles, corner_uvs(mesh))
            own = islands_by_seams(mesh)[1]
            together = {*zip(own.tolist(), islands(triangles, corner_uvs(mesh)).tolist())}
            self.assertEqual(len(together), own.max() + 1, name)
            mesh.uv_layers.new(name="smart").active = True
            mesh.edges.foreach_set("use_seam", numpy.zeros(len(mesh.edges), bool))
            self.edit(obj)
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.uv.smart_project()
            bpy.ops.object.mode_set(mode="OBJECT")
            smart = measured(vertices, triangles, corner_uvs(mesh))
            self.assertLessEqual(ours.islands, smart.islands / 4, name)
            self.assertLess(ours.angle, smart.angle, name)
            self.assertLess(ours.area, smart.area, name)
            self.assertLess(ours.covered, 0.0005, name)
            self.assertGreaterEqual(corner_uvs(mesh).min(), -1e-6)
            self.assertLessEqual(corner_uvs(mesh).max(), 1 + 1e-6)

    def test_vertices_that_are_split_make_no_islands(self):
        """As in every glb: half of the faces have vertices of their own."""
        obj, cut = self.model("mushroom")
        vertices, triangles = surface(obj.data)
        part("api").write(obj, cut, {"SEAMS"}, unwrap=True)
        is_right = numpy.arange(len(triangles)) % 2 == 1
        used, split = numpy.unique(triangles + len(vertices) * is_right[:, None], return_inverse=True)
        other = self.add(vertices[used % len(vertices)].tolist(), split.reshape(-1, 3).tolist(), "split")
        part("api").write(other, Cut.from_labels(part("api").hierarchy(other), cut.labels), {"SEAMS"}, unwrap=True)
        numbers = [len(set(islands(triangles, corner_uvs(mesh)).tolist())) for mesh in (obj.data, other.data)]
        self.assertEqual(*numbers)

    def test_writing_seams_changes_nothing_else(self):
        obj, cut = self.model("mushroom")
        obj.shape_key_add(name="Basis")
        obj.shape_key_add(name="Other").data[0].co.x += 1
        hidden = numpy.arange(len(obj.data.polygons)) % 3 == 0
        obj.data.polygons.foreach_set("hide", hidden)
        other = self.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], "edited")
        self.edit(other)
        obj.select_set(True)

        def state():
            return ([(each.name, each.select_get(), each.mode) for each in bpy.context.view_layer.objects],
                    bpy.context.view_layer.objects.active.name, len(bpy.data.objects), len(bpy.data.meshes),
                    len(bpy.data.scenes), bpy.context.scene.name, read(obj.data.polygons, "hide", bool).tolist(),
                    len(obj.data.shape_keys.key_blocks), len(bpy.data.shape_keys))

        before = state()
        part("api").write(obj, cut, {"SEAMS"}, unwrap=True)
        self.assertEqual(state(), before)
        self.assertGreater(numpy.ptp(corner_uvs(obj.data)[hidden]), 0.5)  # hidden faces are unwrapped, too
