# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts as solids: closed, with all layers of the source's polygons; removed, split; the user's mesh left alone."""


import bmesh
import bpy
import numpy
from common import package, part, read_off
from mathutils import Vector
from solid_case import SolidTest, arrays, caps, volume


def angles(mesh):
    """The angle between the caps of a mesh and its own surface, on average over their borders; and what it would be if
    each were a cone around the mean of its border."""
    bm = bmesh.new()
    bm.from_mesh(mesh)
    bm.faces.ensure_lookup_table()
    marks = caps(mesh)
    border = [edge for edge in bm.edges if len({marks[face.index] for face in edge.link_faces}) == 2]
    angles = [numpy.mean([edge.calc_face_angle() for edge in border])]
    cone = []
    while border:
        loop, todo = [], [border[0]]
        while todo:
            edge = todo.pop()
            if edge in border:
                border.remove(edge)
                loop.append(edge)
                todo += [other for vertex in edge.verts for other in vertex.link_edges]
        tip = sum((vertex.co for edge in loop for vertex in edge.verts), Vector()) / (2 * len(loop))
        for edge in loop:
            own, = [corner for corner in edge.link_loops if not marks[corner.face.index]]
            start, end = own.vert.co, own.link_loop_next.vert.co
            cone.append(own.face.normal.angle((start - end).cross(tip - end)))
    angles.append(numpy.mean(cone))
    bm.free()
    return angles


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

    def test_polygons_of_the_part_stay_whole(self):
        obj, hierarchy = self.built("torus")
        vertices, polygons = arrays(obj.data)
        whole = 0
        for node in self.nodes(hierarchy, 12):
            copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node)
            places, polygons_of_copy = arrays(copy.data)
            polygons_of_copy = {frozenset(map(tuple, places[list(polygon)])) for polygon in polygons_of_copy}
            remaining = [frozenset(map(tuple, vertices[list(polygons[face])])) in polygons_of_copy for face in hierarchy.faces(node)]
            whole += sum(remaining)
            self.assertGreater(sum(remaining), 0.5 * len(remaining) - 2)
        self.assertGreater(whole, 150)

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

    def test_smooth_caps(self):
        obj, hierarchy = self.built("hand")
        for node in self.nodes(hierarchy):
            flat = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node).data
            smooth = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node, smooth=True).data
            self.assertSolid(smooth)
            self.assertEqual((~caps(smooth)).sum(), (~caps(flat)).sum())

    def test_smooth_caps_go_on_as_the_surface_does(self):
        """They meet it at a far smaller angle than a plain cone over the same border does."""
        for name in ("hand", "dragknob", "torus"):
            obj, hierarchy = self.built(name)
            copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=self.nodes(hierarchy)[-1], smooth=True).data
            angle, cone = angles(copy)
            self.assertLess(angle, 0.9 * cone, name)

    def test_cap_material(self):
        obj, hierarchy = self.built("hand")
        copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=self.nodes(hierarchy)[-2], material=True).data
        slots = numpy.array([polygon.material_index for polygon in copy.polygons])
        self.assertTrue((slots[caps(copy)] == slots.max()).all() and (slots[~caps(copy)] == 0).all())
        self.assertEqual(copy.materials[slots.max()].name, "Partwheel Cap")
        self.assertEqual(len(obj.data.materials), 0)

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

    def test_from_edit_mode_and_of_the_picked_part(self):
        obj, hierarchy = self.built()
        self.edit(obj)
        self.assertEqual(bpy.ops.mesh.partwheel_select(face_index=10, level=2), {"FINISHED"})
        node = part("parts.picks").get_pick(obj).node
        copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy)
        self.assertEqual((bpy.context.mode, bpy.context.selected_objects), ("OBJECT", [copy]))
        self.assertEqual((~caps(copy.data)).sum(), len(hierarchy.faces(node)))

    def test_its_border_is_in_creases_by_default(self):
        obj, hierarchy = self.built("hand")
        whole, api, moved, wrong = volume(obj.data), part("api"), 0, 0
        place = {tuple(polygon.center): polygon.index for polygon in obj.data.polygons}
        for node in self.nodes(hierarchy, 12):
            own, snapped = set(api.faces(obj, node).tolist()), set(api.faces(obj, node, snap=True).tolist())
            rest = obj.copy()
            rest.data = obj.data.copy()
            self.link(rest)
            copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=node, snap=True)
            self.run_on(rest, bpy.ops.mesh.partwheel_remove, node=node, snap=True)
            self.assertSolid(copy.data)
            self.assertSolid(rest.data)
            self.assertLess(abs(volume(rest.data) + volume(copy.data) - whole), 1e-5 * abs(whole))
            cap_places = {place[tuple(polygon.center)] for polygon, cap in zip(copy.data.polygons, caps(copy.data))
                     if not cap and tuple(polygon.center) in place}
            moved, wrong = moved + len(own ^ snapped), wrong + len(cap_places ^ snapped)
            self.assertEqual(len(cap_places), (~caps(copy.data)).sum())
            again = api.copy_part(obj, node, snap=True)
            self.assertEqual(arrays(again.data)[1], arrays(copy.data)[1])
            bpy.context.view_layer.objects.active = obj
            self.assertEqual(bpy.ops.mesh.partwheel_copy(node=node), {"FINISHED"})  # the default
            self.assertEqual(arrays(bpy.context.active_object.data)[1], arrays(copy.data)[1])
        self.assertEqual(len(obj.data.polygons), len(place))
        self.assertGreater(moved, 15)
        self.assertLess(wrong, 0.4 * moved)

    def test_blenders_clipboard_takes_it_to_another_file(self):
        obj, hierarchy = self.built()
        obj.data.materials.append(bpy.data.materials.new("skin"))
        copy = self.run_on(obj, bpy.ops.mesh.partwheel_copy, node=self.nodes(hierarchy)[-2], material=True)
        before, marks = arrays(copy.data), caps(copy.data)
        bpy.ops.view3d.copybuffer()
        bpy.ops.wm.read_homefile(use_empty=True)
        self.assertEqual(len(bpy.data.meshes), 0)
        bpy.ops.view3d.pastebuffer()
        pasted = bpy.data.objects["model part"]
        after = arrays(pasted.data)
        self.assertTrue((before[0] == after[0]).all() and before[1] == after[1])
        self.assertTrue((caps(pasted.data) == marks).all())
        self.assertEqual([material.name for material in pasted.data.materials], ["skin", "Partwheel Cap"])


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
        part("solid.solids").remove_from_mesh(obj, hierarchy, int(hierarchy.tet_first[node]), int(hierarchy.tet_last[node]))
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

    def test_nothing_is_left_of_the_whole(self):
        obj, hierarchy = self.built()
        before = arrays(obj.data)
        with self.assertRaises(RuntimeError):
            bpy.ops.mesh.partwheel_remove(node=len(hierarchy.parent) - 1)
        self.assertEqual(before[1], arrays(obj.data)[1])

    def test_shape_keys_stay(self):
        obj, hierarchy = self.built()
        obj.shape_key_add(name="Basis")
        key = obj.shape_key_add(name="up")
        for point in key.data:
            point.co.z += 100
        self.run_on(obj, bpy.ops.mesh.partwheel_remove, node=self.nodes(hierarchy)[-2])
        keys = obj.data.shape_keys.key_blocks
        self.assertEqual([key.name for key in keys], ["Basis", "up"])
        moved = numpy.array([b.co[2] - a.co[2] for a, b in zip(keys[0].data, keys[1].data)])
        self.assertTrue(numpy.allclose(moved, 100, atol=1e-3))

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

    def test_layers_that_only_a_bmesh_makes_stay(self):
        obj, hierarchy = self.built("hand")
        mesh = obj.data
        mesh.attributes.new("number", "INT", "POINT").data.foreach_set("value", numpy.arange(len(mesh.vertices)))
        mesh.attributes.new("number of face", "INT", "FACE").data.foreach_set("value", numpy.arange(len(mesh.polygons)))
        layers = {"skin_vertices": ("verts", "skin", "radius", 2), "vertex_creases": ("verts", "crease", "value", 1),
                  "vertex_paint_masks": ("verts", "paint_mask", "value", 1),
                  "face_maps": ("faces", "face_map", "value", 1)}
        bm = bmesh.new()
        bm.from_mesh(mesh)
        created = []
        for name, (elements, layer, _, _) in layers.items():
            access = getattr(getattr(bm, elements).layers, layer, None)  # newer Blenders have attributes instead
            if access is not None:
                access.verify()
                created.append(name)
        bm.to_mesh(mesh)
        bm.free()
        self.assertIn("skin_vertices", created)
        rng = numpy.random.default_rng(8)
        written = {}
        for name in created:
            _, _, field, width = layers[name]
            data = getattr(mesh, name)[0].data
            values = rng.integers(0, 9, len(data) * width) if name == "face_maps" else rng.random(len(data) * width)
            data.foreach_set(field, values.astype(numpy.int32 if name == "face_maps" else numpy.float32))
            written[name] = values.reshape(-1, width)
        self.run_on(obj, bpy.ops.mesh.partwheel_remove, node=self.nodes(hierarchy)[-2])
        for name in created:
            _, _, field, width = layers[name]
            data = getattr(mesh, name)[0].data
            actual = numpy.empty(len(data) * width, numpy.int32 if name == "face_maps" else numpy.float32)
            data.foreach_get(field, actual)
            origin = numpy.empty(len(data), numpy.int32)
            number = "number of face" if name == "face_maps" else "number"
            mesh.attributes[number].data.foreach_get("value", origin)
            if name == "face_maps":
                own = ~caps(mesh)
                self.assertTrue((actual[~own] == -1).all())
            else:
                corners = [v for polygon, cap in zip(mesh.polygons, caps(mesh)) if not cap for v in polygon.vertices]
                own = numpy.zeros(len(data), bool)
                own[corners] = True
            self.assertGreater(own.sum(), 100)
            self.assertTrue(numpy.allclose(actual.reshape(-1, width)[own], written[name][origin[own]]))


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

    def test_by_height_and_exploded(self):
        obj, hierarchy = self.built("hand")
        height = float(numpy.unique(hierarchy.height)[-4:-2].mean())  # between two: Blender rounds it
        self.run_on(obj, bpy.ops.mesh.partwheel_split, by="HEIGHT", height=height, explode=1.0)
        created = bpy.context.selected_objects
        self.assertEqual(len(created), len(hierarchy.cut_height(height)) - 1)
        away = [new.matrix_world.translation.length for new in created]
        self.assertGreater(min(away), 0)

    def test_into_the_parts_of_least_concavity(self):
        obj, hierarchy = self.built("hand")
        self.assertNotEqual(hierarchy.cut_least_concavity(5).tolist(), hierarchy.cut_parts(5).tolist())
        self.run_on(obj, bpy.ops.mesh.partwheel_split, by="LEAST_CONCAVITY", parts=5)
        bounds = hierarchy.cut_least_concavity(5)
        volumes = [hierarchy.volume[first:last].sum() for first, last in zip(bounds, bounds[1:])]
        actual = sorted(volume(new.data) for new in bpy.context.selected_objects)
        self.assertEqual(len(actual), 5)
        for one, other in zip(actual, sorted(volumes)):
            self.assertAlmostEqual(one, other, delta=1e-3 * sum(volumes))
