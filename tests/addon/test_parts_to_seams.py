# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams of parts, and what Blender unwraps by them: read back and measured, on five real models, three of them broken."""

import bpy
import numpy
from common import only_in, part
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
    def test_polygons_of_more_corners(self):
        for add in (bpy.ops.mesh.primitive_torus_add, bpy.ops.mesh.primitive_cylinder_add,
                    bpy.ops.mesh.primitive_uv_sphere_add, bpy.ops.mesh.primitive_monkey_add):
            add()
            obj = bpy.context.active_object
            self.assertGreater(max(len(polygon.vertices) for polygon in obj.data.polygons), 3)
            for count in (1, 4):
                part("api").write(obj, part("api").cut(obj, count), {"SEAMS"}, unwrap=True)
                euler, own = islands_by_seams(obj.data)
                self.assertEqual({*euler}, {1}, (obj.name, count))
                self.assertGreaterEqual(len(euler), count)

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

    def test_other_uv_maps_stay(self):
        obj, cut = self.model("pig")
        mesh = obj.data
        mine = mesh.uv_layers.new(name="mine")
        values = numpy.random.default_rng(1).random(2 * len(mesh.loops), numpy.float32)
        mine.data.foreach_set("uv", values)
        for candidate in (cut, cut.split(0)):  # the second time in place of the first
            part("api").write(obj, candidate, {"SEAMS"}, unwrap=True)
            self.assertEqual([layer.name for layer in mesh.uv_layers], ["mine", "Parts"])
            self.assertTrue((read(mesh.uv_layers["mine"].data, "uv", numpy.float32, 2) == values).all())
            self.assertTrue(mesh.uv_layers["mine"].active_render)
            self.assertEqual(mesh.uv_layers.active.name, "Parts")
            own = islands_by_seams(mesh)[1]
            self.assertEqual(len({*zip(own.tolist(), islands(surface(mesh)[1], corner_uvs(mesh)).tolist())}),
                             own.max() + 1)

    def test_nothing_else_changes(self):
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

    @only_in("oldest", "newest")
    def test_objects_made_at_once_have_the_new_map(self):
        obj, cut = self.model("homer")
        created = part("api").write(obj, cut, {"SEAMS", "OBJECTS"}, unwrap=True).objects
        known = {tuple(numpy.round(place, 5)) for place in corner_uvs(obj.data).reshape(-1, 2)}
        for new in created:
            own = numpy.repeat(~read(new.data.attributes["partwheel_cap"].data, "value", bool), 3)
            places = numpy.round(corner_uvs(new.data).reshape(-1, 2)[own], 5)
            self.assertGreater(numpy.mean([tuple(place) in known for place in places]), 0.9)  # some faces are cut

    def test_errors_change_nothing(self):
        obj, cut = self.model("pig")
        obj.data.edges[3].use_seam = True

        def state():
            return seams(obj.data).tolist(), [layer.name for layer in obj.data.uv_layers], obj.data.uv_layers.active_index

        obj.data.uv_layers.new(name="first")
        before, objects = state(), part("cut.objects")
        create_part_objects = objects.create_part_objects

        def fails(*_):
            self.assertEqual(len(obj.data.uv_layers), 2)
            raise ValueError("no")

        objects.create_part_objects = fails
        try:
            with self.assertRaises(ValueError):
                part("api").write(obj, cut, {"SEAMS", "OBJECTS"}, unwrap=True)
        finally:
            objects.create_part_objects = create_part_objects
        self.assertEqual(state(), before)
        for number in range(7):
            obj.data.uv_layers.new(name=f"map {number}")
        before = state()
        with self.assertRaisesRegex(ValueError, "UV maps"):
            part("api").write(obj, cut, {"SEAMS"}, unwrap=True)
        self.assertEqual(state(), before)
        self.assertIsNone(part("api").load_cut(obj))

    def test_the_operator_in_all_modes(self):
        obj, cut = self.model("elephant")
        bpy.context.view_layer.objects.active = obj
        for mode in ("OBJECT", "EDIT", "SCULPT"):
            bpy.ops.object.mode_set(mode=mode)
            self.assertEqual(bpy.ops.mesh.partwheel_parts(to={"SEAMS"}), {"FINISHED"})
            self.assertEqual(obj.mode, mode)
            bpy.ops.object.mode_set(mode="OBJECT")
            self.assertEqual(({*islands_by_seams(obj.data)[0]}, len(obj.data.uv_layers)), ({1}, 1))
            while obj.data.uv_layers:
                obj.data.uv_layers.remove(obj.data.uv_layers[0])
            obj.data.edges.foreach_set("use_seam", numpy.zeros(len(obj.data.edges), bool))
        bpy.ops.mesh.partwheel_parts(to={"SEAMS"}, unwrap=False)
        self.assertTrue(seams(obj.data).any() and not obj.data.uv_layers)
