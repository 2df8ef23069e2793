# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts as solids: closed, with all layers of the source's polygons; removed, split; the user's mesh left alone."""

import bmesh
import bpy
import numpy
from common import BOX, MeshTest, package, part, read_off
from solid_case import SolidTest, arrays, caps, volume


class Copy(SolidTest):
    def test_is_closed_and_of_the_parts_volume(self):
        for name in ("dragknob", "hand", "torus"):
            obj, hierarchy = self.built(name)
            before = arrays(obj.data)
            whole = volume(obj.data)
            for node in self.nodes(hierarchy):
                copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node)
                self.assertIsNot(copy.data, obj.data)
                self.assertSolid(copy.data)
                solid = hierarchy.solid(node)
                corners = solid.vertices[solid.triangles] - hierarchy.vertices.mean(axis=0)
                expected = numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6
                self.assertLess(abs(volume(copy.data) - expected), 1e-5 * abs(whole))
                self.assertEqual(caps(copy.data).sum(), (solid.neighbor_tets >= 0).sum())
                for axis in zip(copy.matrix_world, obj.matrix_world):
                    self.assertEqual(*map(tuple, axis))
            after = arrays(obj.data)
            self.assertTrue((before[0] == after[0]).all() and before[1] == after[1])

    def test_layers_come_along(self):
        obj, hierarchy = self.built("hand")
        mesh = obj.data
        rng = numpy.random.default_rng(5)
        count = {"POINT": len(mesh.vertices), "FACE": len(mesh.polygons), "CORNER": len(mesh.loops),
                 "EDGE": len(mesh.edges)}
        for name in ("first uv", "second uv"):
            mesh.uv_layers.new(name=name).data.foreach_set("uv", rng.random(2 * count["CORNER"]))
        for name, kind, domain, field, width in (
            ("float", "FLOAT", "POINT", "value", 1), ("vector", "FLOAT_VECTOR", "POINT", "vector", 3),
            ("number", "INT", "FACE", "value", 1), ("color", "FLOAT_COLOR", "POINT", "color", 4),
            ("corner color", "BYTE_COLOR", "CORNER", "color", 4), ("along", "FLOAT", "EDGE", "value", 1),
        ):
            values = rng.random(width * count[domain]) * (100 if kind == "INT" else 1)
            mesh.attributes.new(name, kind, domain).data.foreach_set(
                field, values.astype(numpy.int32) if kind == "INT" else values.astype(numpy.float32))
        for name in ("red", "blue"):
            mesh.materials.append(bpy.data.materials.new(name))
        mesh.polygons.foreach_set("material_index", rng.integers(0, 2, count["FACE"]).astype(numpy.int32))
        mesh.polygons.foreach_set("use_smooth", rng.random(count["FACE"]) < 0.5)
        group = obj.vertex_groups.new(name="group")
        for vertex in range(count["POINT"]):
            group.add([vertex], (vertex % 97) / 97, "REPLACE")
        for node in self.nodes(hierarchy, 4):
            copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node)
            new = copy.data
            self.assertEqual([m.name for m in new.materials], [m.name for m in mesh.materials])
            self.assertEqual([g.name for g in copy.vertex_groups], ["group"])
            place = {tuple(vertex.co): vertex.index for vertex in mesh.vertices}
            polygon_at = {frozenset(polygon.vertices): polygon for polygon in mesh.polygons}
            edge_at = {frozenset(edge.vertices): edge.index for edge in mesh.edges}
            vertex_of = [place.get(tuple(vertex.co)) for vertex in new.vertices]
            is_cap = caps(new)
            compared = 0
            own_edges = set()
            for polygon in new.polygons:
                if is_cap[polygon.index]:
                    continue
                old = polygon_at[frozenset(vertex_of[v] for v in polygon.vertices)]
                compared += 1
                self.assertEqual((polygon.material_index, polygon.use_smooth), (old.material_index, old.use_smooth))
                self.assertEqual(new.attributes["number"].data[polygon.index].value,
                                 mesh.attributes["number"].data[old.index].value)
                old_loop = {mesh.loops[i].vertex_index: i for i in old.loop_indices}
                own_edges.update(map(frozenset, polygon.edge_keys))
                for loop in polygon.loop_indices:
                    vertex = vertex_of[new.loops[loop].vertex_index]
                    for name in ("first uv", "second uv"):
                        self.assertEqual(tuple(new.uv_layers[name].data[loop].uv),
                                         tuple(mesh.uv_layers[name].data[old_loop[vertex]].uv))
                    self.assertEqual(tuple(new.attributes["corner color"].data[loop].color),
                                     tuple(mesh.attributes["corner color"].data[old_loop[vertex]].color))
            self.assertEqual(compared, len(hierarchy.faces(node)))
            for vertex, old in enumerate(vertex_of):
                if old is None:  # a point inside
                    continue
                self.assertEqual(new.attributes["float"].data[vertex].value, mesh.attributes["float"].data[old].value)
                self.assertEqual(tuple(new.attributes["color"].data[vertex].color),
                                 tuple(mesh.attributes["color"].data[old].color))
                self.assertAlmostEqual(copy.vertex_groups["group"].weight(vertex), (old % 97) / 97, places=6)
            for edge in new.edges:
                if frozenset(edge.vertices) in own_edges:
                    old = edge_at[frozenset(vertex_of[v] for v in edge.vertices)]
                    self.assertEqual(new.attributes["along"].data[edge.index].value,
                                     mesh.attributes["along"].data[old].value)

    def test_custom_normals_come_along(self):
        obj, hierarchy = self.built("hand")
        mesh = obj.data
        rng = numpy.random.default_rng(6)
        if hasattr(mesh, "use_auto_smooth"):
            mesh.use_auto_smooth = True
        mesh.polygons.foreach_set("use_smooth", numpy.ones(len(mesh.polygons), bool))
        normals_set = rng.normal(size=(len(mesh.vertices), 3)) + [0, 0, 4]
        normals_set /= numpy.linalg.norm(normals_set, axis=1, keepdims=True)
        mesh.normals_split_custom_set_from_vertices(normals_set)
        place = {tuple(vertex.co): vertex.index for vertex in mesh.vertices}
        copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=self.nodes(hierarchy)[-2]).data
        self.assertTrue(copy.has_custom_normals)
        if hasattr(copy, "calc_normals_split"):
            copy.calc_normals_split()
            normals = [tuple(loop.normal) for loop in copy.loops]
        else:
            normals = [tuple(normal.vector) for normal in copy.corner_normals]
        worst = 0
        for polygon, is_cap in zip(copy.polygons, caps(copy)):
            for loop in () if is_cap else polygon.loop_indices:
                old = place[tuple(copy.vertices[copy.loops[loop].vertex_index].co)]
                worst = max(worst, numpy.abs(normals_set[old] - normals[loop]).max())
        self.assertLess(worst, 5e-3)  # Blender keeps them in 2 x 16 bits

    def test_caps_look_like_the_nearest_polygon(self):
        """The model is painted by height, in a texture, in colors and in materials; so must be its caps, nearly."""
        for name in ("hand", "torus"):
            obj, hierarchy = self.built(name)
            mesh = obj.data
            low, high = (extreme(vertex.co.z for vertex in mesh.vertices) for extreme in (min, max))
            for number in range(5):
                mesh.materials.append(bpy.data.materials.new(f"height {number}"))
            heights = [(polygon.center.z - low) / (high - low) for polygon in mesh.polygons]
            mesh.polygons.foreach_set("material_index", [min(int(5 * height), 4) for height in heights])
            heights = numpy.repeat(heights, [polygon.loop_total for polygon in mesh.polygons]).astype(numpy.float32)
            mesh.uv_layers.new(name="map").data.foreach_set("uv", numpy.column_stack([0 * heights, heights]).ravel())
            mesh.color_attributes.new("paint", "BYTE_COLOR", "CORNER").data.foreach_set(
                "color", numpy.column_stack([heights, 0 * heights, 0 * heights, 1 + 0 * heights]).ravel())
            copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=self.nodes(hierarchy)[-2]).data
            surface = [polygon for polygon, is_cap in zip(copy.polygons, caps(copy)) if not is_cap]
            for polygon in (copy.polygons[face] for face in numpy.flatnonzero(caps(copy))):
                nearest = min(surface, key=lambda other: (other.center - polygon.center).length)
                self.assertEqual(polygon.material_index, nearest.material_index)
                for loop in polygon.loop_indices:
                    self.assertEqual(copy.uv_layers["map"].data[loop].uv,
                                     copy.uv_layers["map"].data[nearest.loop_start].uv)
                    self.assertEqual(tuple(copy.color_attributes["paint"].data[loop].color),
                                     tuple(copy.color_attributes["paint"].data[nearest.loop_start].color))
            self.assertGreater(caps(copy).sum(), 0)


class Remove(SolidTest):
    def test_part_and_rest_make_the_whole(self):
        for name in ("dragknob", "hand", "torus"):
            obj, hierarchy = self.built(name)
            whole = volume(obj.data)
            for node in self.nodes(hierarchy):
                rest = obj.copy()
                rest.data = obj.data.copy()
                self.link(rest)
                copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node)
                self.run_on(rest, bpy.ops.mesh.partwheel_remove, node=node)
                self.assertSolid(rest.data)
                self.assertLess(abs(volume(rest.data) + volume(copy.data) - whole), 1e-5 * abs(whole))

    def test_holes_of_a_broken_mesh_stay_and_the_new_one_is_closed(self):
        vertices, polygons = read_off("hand")
        obj = self.add(vertices, polygons[3:])
        hierarchy = package().Hierarchy.build(*part("mesh.arrays").read_surface(obj.data), fill_methods=3)
        self.assertEqual(hierarchy.summary.fill_method, "repaired")

        def open_edges(mesh):
            count = numpy.bincount([loop.edge_index for loop in mesh.loops], minlength=len(mesh.edges))
            return {frozenset(tuple(mesh.vertices[v].co) for v in mesh.edges[edge].vertices)
                    for edge in numpy.flatnonzero(count != 2)}

        before, total = open_edges(obj.data), len(obj.data.polygons)
        self.assertGreater(len(before), 2)
        inside = {face for node in [self.nodes(hierarchy)[-3]] for face in hierarchy.faces(node)}
        around = {face for face, polygon in enumerate(obj.data.polygons)
                  if any(frozenset(tuple(vertices[v]) for v in key) in before for key in polygon.edge_keys)}
        self.assertFalse(inside & around)
        node = self.nodes(hierarchy)[-3]
        part("solid.solids").remove_from_mesh(obj, hierarchy, hierarchy.tet_slice(node))
        self.assertEqual(open_edges(obj.data), before)
        self.assertEqual((~caps(obj.data)).sum(), total - len(inside))

    def test_edit_mode_and_loose_vertices_stay(self):
        vertices, polygons = read_off("dragknob")
        obj = self.add([*vertices, (9, 9, 9)], polygons)
        hierarchy = part("api").build(obj)
        node = self.nodes(hierarchy)[-2]
        self.edit(obj)
        self.run_on(obj, bpy.ops.mesh.partwheel_remove, node=node)
        self.assertEqual(bpy.context.mode, "EDIT_MESH")
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertIn((9, 9, 9), [tuple(vertex.co) for vertex in obj.data.vertices])
        self.assertEqual((~caps(obj.data)).sum(), len(polygons) - len(hierarchy.faces(node)))

    def test_removing_the_whole_model_is_refused(self):
        obj, hierarchy = self.built()
        before = arrays(obj.data)
        with self.assertRaises(RuntimeError):
            bpy.ops.mesh.partwheel_remove(node=len(hierarchy.parent) - 1)
        self.assertEqual(before[1], arrays(obj.data)[1])

    def test_several_resolutions_are_not_lost(self):
        obj, hierarchy = self.built("hand")
        multires = obj.modifiers.new("Multires", "MULTIRES")
        before = arrays(obj.data)
        node = self.nodes(hierarchy)[-2]
        bpy.ops.object.multires_subdivide(modifier=multires.name)
        with self.assertRaisesRegex(RuntimeError, "Multiresolution"):
            bpy.ops.mesh.partwheel_remove(node=node)
        after = arrays(obj.data)
        self.assertTrue((before[0] == after[0]).all() and before[1] == after[1])
        self.assertEqual(multires.total_levels, 1)
        self.assertSolid(self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node).data)


class Split(SolidTest):
    def test_solids_fill_the_whole_and_their_caps_meet(self):
        for name in ("dragknob", "hand", "torus"):
            obj, hierarchy = self.built(name)
            self.run_on(obj, bpy.ops.mesh.partwheel_split, parts=5)
            created = bpy.context.selected_objects
            self.assertEqual(len(created), 5)
            self.assertTrue(obj.hide_get())
            total, sides = 0.0, []
            for new in created:
                self.assertSolid(new.data)
                total += volume(new.data)
                places = arrays(new.data)[0]
                for polygon, is_cap in zip(new.data.polygons, caps(new.data)):
                    if is_cap:
                        sides.append(frozenset(map(tuple, places[list(polygon.vertices)])))
            self.assertLess(abs(total - volume(obj.data)), 1e-5 * abs(total))
            self.assertEqual(len(sides), 2 * len(set(sides)))


class Closing(MeshTest):
    def test_components_that_are_inside_out_are_turned_but_exempt_ones(self):
        bm, components = bmesh.new(), []
        for number, is_inside_out in enumerate((False, True, True)):
            verts = [bm.verts.new((x + 3 * number, y, z)) for x, y, z in BOX[0]]
            components.append([bm.faces.new([verts[k] for k in polygon[::-1 if is_inside_out else 1]]) for polygon in BOX[1]])
        bm.normal_update()
        wanted = [face.normal.copy() * (-1 if number == 1 else 1) for number, faces in enumerate(components) for face in faces]
        part("solid.closing").orient_outward(bm, components[2][:1])
        self.assertEqual([face.normal for faces in components for face in faces], wanted)
        bm.free()
