# SPDX-License-Identifier: GPL-3.0-or-later
"""What an artist has marked on a mesh becomes borders of parts."""

from pathlib import Path
import tempfile

import bmesh
import bpy
import numpy
from common import BOX, MeshTest, package, part, read_off, snapshot
import painted_figure

KINDS = {"MATERIALS", "COLORS", "FACE_SETS", "SEAMS", "SHARP", "CREASES", "DRAWN"}


class MarksTest(MeshTest):
    def setUp(self):
        super().setUp()
        self.preferences = part("preferences").preferences()
        self.defaults = set(self.preferences.use_marks), set(self.preferences.hard_marks)
        self.preferences.use_marks, self.preferences.hard_marks = KINDS, set()

    def tearDown(self):
        self.preferences.use_marks, self.preferences.hard_marks = self.defaults
        super().tearDown()

    def grid(self, n=8):
        """A flat grid; polygon n * x + y."""
        vertices = [(x, y, 0) for x in range(n + 1) for y in range(n + 1)]
        corner = [x * (n + 1) + y for x in range(n) for y in range(n)]
        return self.add(vertices, [(c, c + n + 1, c + n + 2, c + 1) for c in corner])

    def collect(self, obj):
        """{kind: Marks} of the object."""
        arrays = part("mesh.arrays")
        surface = arrays.read_surface(arrays.update_mesh(obj))
        return {kind.name: kind for kind in part("mesh.marks").collect_marks(obj, surface)}

    def middle_edges(self, obj, at=4.0):
        """The edges at x = at, as pairs of vertices."""
        return {tuple(sorted(edge.vertices)) for edge in obj.data.edges
                if all(obj.data.vertices[v].co.x == at for v in edge.vertices)}

    def is_right(self, obj):
        return [polygon.center.x > 4 for polygon in obj.data.polygons]

    def marked(self, kind):
        return {tuple(sorted(edge)) for edge in kind.edges.tolist()}


class Collecting(MarksTest):
    def mark(self, obj, kind):
        """Marks the middle of a grid."""
        mesh, right, middle = obj.data, numpy.array(self.is_right(obj)), self.middle_edges(obj)
        on_middle = [tuple(sorted(edge.vertices)) in middle for edge in mesh.edges]
        if kind == "materials":
            for name in "ab":
                mesh.materials.append(bpy.data.materials.new(name))
            mesh.polygons.foreach_set("material_index", right.astype(numpy.int32))
        elif kind == "face sets":
            mesh.attributes.new(".sculpt_face_set", "INT", "FACE").data.foreach_set("value", right.astype(numpy.int32))
        elif kind == "colors":
            colors = numpy.where(right[:, None], (0.8, 0.1, 0.1, 1), (0.1, 0.1, 0.8, 1)).repeat(4, axis=0)
            mesh.color_attributes.new("Color", "BYTE_COLOR", "CORNER").data.foreach_set("color", colors.ravel())
            mesh.color_attributes.active_color_index = 0
        elif kind == "seams":
            mesh.edges.foreach_set("use_seam", on_middle)
        elif kind == "sharp edges":
            mesh.edges.foreach_set("use_edge_sharp", on_middle)
        elif kind == "drawn borders":
            mesh.attributes.new("partwheel_border", "INT", "EDGE").data.foreach_set("value", numpy.array(on_middle, numpy.int32))
        elif bpy.app.version < (4, 0, 0):
            mesh.edges.foreach_set("crease", numpy.array(on_middle, numpy.float32))
        else:
            mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", numpy.array(on_middle, numpy.float32))

    def test_every_kind_in_both_modes(self):
        for kind in part("mesh.marks").NAMES.values():
            obj = self.grid()
            self.mark(obj, kind)
            for mode in ("OBJECT", "EDIT"):
                with self.subTest(kind=kind, mode=mode):
                    bpy.ops.object.mode_set(mode=mode)
                    found = self.collect(obj)
                    self.assertEqual(self.marked(found[kind]), self.middle_edges(obj))
                    self.assertEqual(set(found), {kind})
                    self.assertTrue(((found[kind].strengths > 0.5) & (found[kind].strengths < 1)).all())
            bpy.ops.object.mode_set(mode="OBJECT")

    def test_a_change_of_a_kind_in_use_is_a_change_of_the_fingerprint(self):
        for kind, name in part("mesh.marks").NAMES.items():
            for mode in ("OBJECT", "EDIT"):
                with self.subTest(kind=kind, mode=mode):
                    obj = self.grid()
                    plain = snapshot(obj).fingerprint
                    self.mark(obj, name)
                    bpy.ops.object.mode_set(mode=mode)
                    marked = snapshot(obj).fingerprint
                    self.assertEqual(marked.topology, plain.topology)
                    self.assertNotEqual(marked, plain)
                    self.preferences.use_marks = KINDS - {kind}
                    self.assertEqual(snapshot(obj).fingerprint, plain)
                    bpy.ops.object.mode_set(mode="OBJECT")
                    self.preferences.use_marks = KINDS

    def test_hard_marks_have_full_strength(self):
        obj = self.grid()
        self.mark(obj, "seams")
        self.mark(obj, "colors")
        self.preferences.hard_marks = {"SEAMS"}
        found = self.collect(obj)
        self.assertTrue(found["seams"].strengths is None and (found["colors"].strengths < 1).all())

    def test_slots_with_the_same_material_are_one(self):
        obj = self.grid()
        self.mark(obj, "materials")
        obj.data.materials[1] = obj.data.materials[0]
        self.assertEqual(self.collect(obj), {})

    def test_base_colors_count_as_colors(self):
        obj = self.grid()
        self.mark(obj, "materials")
        for material, color in zip(obj.data.materials, ((0.8, 0.2, 0.1, 1), (0.1, 0.2, 0.8, 1))):
            material.use_nodes = True
            shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
            shader.inputs["Base Color"].default_value = color
        self.assertEqual(self.marked(self.collect(obj)["colors"]), self.middle_edges(obj))

    def test_mapping_nodes_move_textures(self):
        """The left half is at (0.25, 0.25) of a texture of four colors, the first row at the bottom, the right half at
        (0.25, 0.75) of another material's."""
        red, green, blue, white = (1, 0, 0, 1), (0, 1, 0, 1), (0, 0, 1, 1), (1, 1, 1, 1)
        image = bpy.data.images.new("four", 2, 2)
        image.pixels = [*red, *green, *blue, *white]
        quarter = numpy.pi / 2
        for kind, values, expected in (
                ("POINT", {}, (red, blue)),
                ("POINT", {"Location": (0.5, 0, 0)}, (green, white)),
                ("POINT", {"Scale": (3, 1, 1)}, (green, white)),
                ("POINT", {"Rotation": (0, 0, quarter)}, (green, red)),  # (-0.25, 0.25), (-0.75, 0.25)
                ("POINT", {"Scale": (3, 1, 1), "Rotation": (0, 0, quarter), "Location": (0.5, 0, 0)}, (blue, white)),
                ("TEXTURE", {"Rotation": (0, 0, quarter)}, (blue, white)),  # (0.25, -0.25), (0.75, -0.25)
                ("TEXTURE", {"Location": (0.5, 0, 0)}, (green, white)),
                ("VECTOR", {"Location": (0.5, 0, 0), "Scale": (3, 1, 1)}, (green, white)),
                ("NORMAL", {"Location": (0.5, 0, 0)}, (red, blue))):
            with self.subTest(kind=kind, **values):
                obj = self.grid()
                self.mark(obj, "materials")
                right = numpy.repeat(self.is_right(obj), 4)
                obj.data.uv_layers.new(name="other")
                uvs = numpy.column_stack([numpy.full(len(right), 0.25), numpy.where(right, 0.75, 0.25)])
                obj.data.uv_layers.new(name="chosen").data.foreach_set("uv", uvs.astype(numpy.float32).ravel())
                plain = snapshot(obj).fingerprint
                for material in obj.data.materials:
                    material.use_nodes = True
                    nodes, links = material.node_tree.nodes, material.node_tree.links
                    texture, mapping, uv_map = map(nodes.new, ("ShaderNodeTexImage", "ShaderNodeMapping", "ShaderNodeUVMap"))
                    texture.image, mapping.vector_type, uv_map.uv_map = image, kind, "chosen"
                    shader = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
                    links.new(uv_map.outputs[0], mapping.inputs["Vector"])
                    links.new(mapping.outputs[0], texture.inputs["Vector"])
                    links.new(texture.outputs[0], shader.inputs["Base Color"])
                before = snapshot(obj).fingerprint
                self.assertNotEqual(before, plain)
                for material in obj.data.materials:
                    mapping = next(node for node in material.node_tree.nodes if node.type == "MAPPING")
                    for name, value in values.items():
                        next(socket for socket in mapping.inputs if socket.name == name).default_value = value  # also if it's hidden
                self.assertEqual(snapshot(obj).fingerprint != before, bool(values) and kind != "NORMAL")
                colors, _ = part("mesh.marks")._read_face_colors(obj.data)
                is_right = numpy.array(self.is_right(obj))
                self.assertTrue(numpy.allclose(colors[~is_right], expected[0]) and numpy.allclose(colors[is_right], expected[1]),
                                (colors[0], colors[-1]))

    def test_each_tile_of_a_texture_has_its_own_colors(self):
        """In files, packed, and where there is no file: white, as outside of all tiles."""
        tiles = {1001: (1, 0, 0, 1), 1002: (0, 1, 0, 1), 1012: (0, 0, 1, 1)}
        with tempfile.TemporaryDirectory() as directory:
            for name in ("<UDIM>", "<UVTILE>"):
                image = bpy.data.images.new("tiles", 2, 2, tiled=True)
                for number, color in tiles.items():
                    tile = bpy.data.images.new("tile", 2, 2)
                    tile.pixels = color * 4
                    tile.filepath_raw = str(Path(directory) / {"<UDIM>": f"{number}.png", "<UVTILE>": (
                        f"u{(number - 1001) % 10 + 1}_v{(number - 1001) // 10 + 1}.png")}[name])
                    tile.save()
                image.filepath = str(Path(directory) / f"{name}.png")
                for number in (1002, 1012, 1013):
                    image.tiles.new(number)
                image.reload()
                coordinates = numpy.array([(0.5, 0.5), (1.5, 0.5), (1.5, 1.5), (2.5, 1.5), (0.5, 1.5), (-0.5, 0.5)])
                expected = [*tiles.values(), *[(1, 1, 1, 1)] * 3]
                before = len(bpy.data.images)
                for packs in (False, True):
                    if packs:
                        image.pack()
                        for path in Path(directory).iterdir():
                            path.unlink()
                    colors = part("mesh.marks")._sample_image(image, coordinates)
                    self.assertEqual(colors.tolist(), numpy.array(expected, float).tolist(), f"{name} {packs}")
                self.assertEqual(len(bpy.data.images), before)

    def test_a_mesh_without_marks_has_none(self):
        self.assertEqual(self.collect(self.add(*BOX)), {})
        self.preferences.use_marks = set()
        obj = self.grid()
        self.mark(obj, "seams")
        self.assertEqual(self.collect(obj), {})

    def test_borders_in_a_texture(self):
        """Nearly all marked edges are at the border of two colors, and nearly the whole border is marked."""
        obj = painted_figure.create_figure()
        found, patches = self.collect(obj), painted_figure.patches(obj)
        self.assertEqual(set(found), {"colors"})
        surface = part("mesh.arrays").read_surface(obj.data)
        pairs = package("marks").find_face_pairs(*surface[:3])
        border = pairs.edges[patches[pairs.sides[:, 0]] != patches[pairs.sides[:, 1]]]
        touched = numpy.zeros(len(obj.data.vertices), bool)
        touched[border] = True
        touched[pairs.edges[touched[pairs.edges].any(axis=1)]] = True
        self.assertGreater(touched[found["colors"].edges].all(axis=1).mean(), 0.98)
        near = numpy.zeros(len(obj.data.vertices), bool)
        near[found["colors"].edges] = True
        near[pairs.edges[near[pairs.edges].any(axis=1)]] = True
        self.assertGreater(near[border].all(axis=1).mean(), 0.98)


class DrawnBorders(MarksTest):
    def setUp(self):
        super().setUp()
        self.preferences.use_marks, self.preferences.hard_marks = self.defaults
        self.drawing = part("pick.draw_border")

    def sphere(self):
        """(object in Edit Mode, its ring of vertices at a height where nothing divides it)"""
        bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
        obj = bpy.context.active_object
        low = [vertex.index for vertex in obj.data.vertices if abs(vertex.co.z - 0.5) < 0.01]
        low.sort(key=lambda index: numpy.arctan2(*obj.data.vertices[index].co[:2]))
        self.edit(obj)
        return obj, [*low, low[0]]

    def check_no_part_crosses(self, obj):
        """Leaves Edit Mode. No part crosses the ring, and one lies above it."""
        bpy.ops.object.mode_set(mode="OBJECT")
        hierarchy = part("api").build(obj)
        is_above = numpy.array([polygon.center.z > 0.5 for polygon in obj.data.polygons])
        sides = [is_above[hierarchy.faces(node)] for node in range(len(hierarchy.parent) - 1)]
        self.assertTrue(all(side.all() or not side.any() for side in sides))
        self.assertIn(is_above.sum(), [len(side) for side in sides])

    def test_no_part_crosses_a_border_and_drawing_over_it_erases_it(self):
        obj, ring = self.sphere()
        self.assertFalse(self.drawing.apply_stroke(obj, ring[:12]), "an open border divides nothing")
        self.assertTrue(self.drawing.apply_stroke(obj, ring[11:]))
        self.check_no_part_crosses(obj)
        self.edit(obj)
        self.assertTrue(self.drawing.apply_stroke(obj, ring))
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(self.collect(obj), {})

    def test_borders_can_be_cleared(self):
        obj, ring = self.sphere()
        self.assertFalse(bpy.ops.mesh.partwheel_clear_borders.poll())
        self.drawing.apply_stroke(obj, ring)
        self.assertEqual(set(self.collect(obj)), {"drawn borders"})
        self.assertEqual(bpy.ops.mesh.partwheel_clear_borders(), {"FINISHED"})
        self.assertEqual(self.collect(obj), {})

    def test_paths_lose_what_they_go_there_and_back(self):
        for path, expected in (([1, 2, 3], [1, 2, 3]), ([1, 2, 3, 2, 4], [1, 2, 4]), ([1, 2, 3, 4, 3, 2, 5], [1, 2, 5]),
                               ([1, 2, 3, 4, 2, 1], [2, 3, 4, 2]), ([1, 2, 3, 1], [1, 2, 3, 1]), ([1, 2, 1], [1])):
            self.assertEqual(self.drawing.remove_spurs(path), expected)

    def test_paths_are_shortest_and_prefer_creases_and_borders(self):
        obj = self.grid(6)
        self.edit(obj)
        mesh = bmesh.from_edit_mesh(obj.data)
        mesh.verts.ensure_lookup_table()

        def path(*corners):
            start, end = (mesh.verts[7 * x + y] for x, y in corners)
            return [start.index, *self.drawing.find_path(mesh, start, lambda vertex: vertex == end, {})]

        self.assertEqual(path((1, 1), (1, 5)), [8, 9, 10, 11, 12])
        self.assertEqual(len(path((0, 0), (6, 6))), 13)
        for vertex in mesh.verts:
            vertex.co.z = abs(vertex.co.x - 3)
        mesh.normal_update()
        self.assertEqual(path((2, 0), (2, 6)), [14, *range(21, 28), 20])
        self.drawing.apply_stroke(obj, list(range(7, 14)))
        self.assertEqual(path((0, 0), (0, 6)), [0, *range(7, 14), 6])

    def test_borders_cross_seams_at_which_importers_split_vertices(self):
        obj, ring = self.sphere()
        mesh = bmesh.from_edit_mesh(obj.data)
        mesh.verts.ensure_lookup_table()
        corners = [mesh.verts[ring[number]].co.copy() for number in (0, 8, 16, 0)]
        seam = [edge for edge in mesh.edges if all(abs(vertex.co.y) < 1e-5 and vertex.co.x > 0.1 for vertex in edge.verts)]
        bmesh.ops.split_edges(mesh, edges=seam)
        mesh.verts.index_update()
        mesh.verts.ensure_lookup_table()
        coincident = self.drawing.find_coincident_vertices(mesh)
        path = [min(mesh.verts, key=lambda vertex: (vertex.co - corners[0]).length).index]
        for end in corners[1:]:
            path += self.drawing.find_path(mesh, mesh.verts[path[-1]], lambda vertex: (vertex.co - end).length < 1e-5, coincident)
        self.assertGreater(len(path), len({mesh.verts[index].co[:] for index in path}) + 1, "there is a step between coincident vertices")
        self.assertTrue(self.drawing.apply_stroke(obj, path))
        self.check_no_part_crosses(obj)


class Building(MarksTest):
    def build(self, obj, *kinds):
        self.preferences.use_marks = set(kinds)
        part("parts.registry").forget(obj.data)
        return part("api").build(obj)

    def hand(self):
        obj = self.add(*read_off("hand"))
        self.centers = numpy.array([polygon.center for polygon in obj.data.polygons])
        return obj

    def test_marks_of_machines_leave_the_parts_as_they_are(self):
        """An atlas of small islands, edges sharp all over, face sets and colors at random."""
        plain = self.build(self.hand()).save()
        random = numpy.random.default_rng(0)
        for kind, marks in {"SEAMS": "seams", "SHARP": "sharp edges", "FACE_SETS": "face sets", "COLORS": "colors"}.items():
            with self.subTest(kind=kind):
                obj = self.hand()
                mesh, count = obj.data, len(obj.data.polygons)
                if kind in {"SEAMS", "SHARP"}:
                    cells = numpy.floor(self.centers / numpy.ptp(self.centers, axis=0).max() * 25) @ [10000, 100, 1]
                    faces = {}
                    for polygon in mesh.polygons:
                        for key in polygon.edge_keys:
                            faces.setdefault(key, set()).add(cells[polygon.index] if kind == "SEAMS" else random.integers(8))
                    field = "use_seam" if kind == "SEAMS" else "use_edge_sharp"
                    mesh.edges.foreach_set(field, [len(faces[tuple(sorted(edge.vertices))]) > 1 for edge in mesh.edges])
                elif kind == "FACE_SETS":
                    mesh.attributes.new(".sculpt_face_set", "INT", "FACE").data.foreach_set(
                        "value", random.integers(1, 50, count).astype(numpy.int32))
                else:
                    colors = random.random((count, 4)).repeat(3, axis=0).astype(numpy.float32)
                    mesh.color_attributes.new("Color", "FLOAT_COLOR", "CORNER").data.foreach_set("color", colors.ravel())
                    mesh.color_attributes.active_color_index = 0
                built = self.build(obj, kind)
                self.assertTrue(kind == "COLORS" and not built.notes or f"the {marks} are ignored" in built.notes, built.notes)
                self.assertEqual(self.tree(built), self.tree(package().Hierarchy.load(plain)))

    def tree(self, hierarchy):
        return [array.tobytes() for array in (hierarchy.order, hierarchy.parent, hierarchy.tetrahedra, hierarchy.score)]

    def test_kinds_that_are_not_in_use_leave_everything_as_it_is(self):
        plain = self.build(self.hand()).save()
        obj = self.hand()
        obj.data.polygons.foreach_set("material_index", (self.centers[:, 0] > 0).astype(numpy.int32))
        for name in "ab":
            obj.data.materials.append(bpy.data.materials.new(name))
        self.assertEqual(self.build(obj, "SEAMS", "FACE_SETS", "COLORS").save(), plain)
        self.assertNotEqual(self.build(obj, "MATERIALS").save(), plain)

    def test_changed_marks_need_no_new_build_but_the_panel_says_so(self):
        registry = part("parts.registry")
        obj = self.hand()
        self.build(obj, "SEAMS", "SHARP")
        self.assertEqual(registry.get_state(obj.data)[0], registry.State.FITS)
        self.edit(obj)
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.region_to_loop()
        bpy.ops.mesh.select_mode(type="EDGE")
        bpy.ops.mesh.select_random(ratio=0.1)
        bpy.ops.mesh.mark_seam()
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertTrue(any(edge.use_seam for edge in obj.data.edges))
        self.assertEqual(registry.get_state(obj.data)[0], registry.State.MOVED)
        self.assertIsNotNone(registry.get_hierarchy(snapshot(obj)))
        self.preferences.use_marks = {"SHARP"}
        self.assertEqual(registry.get_state(obj.data)[0], registry.State.FITS)

    def test_shirt_skin_and_hair_of_a_fused_figure_are_one_click_each(self):
        self.preferences.hard_marks = {"COLORS"}
        obj = painted_figure.create_figure()
        hierarchy = self.build(obj, "COLORS")
        areas = numpy.array([polygon.area for polygon in obj.data.polygons])
        centers = numpy.array([polygon.center for polygon in obj.data.polygons])
        for name, (_, place) in painted_figure.PLACES.items():
            with self.subTest(name=name):
                wanted = painted_figure.connected_patch(obj, name)
                face = int(numpy.linalg.norm(centers - place, axis=1).argmin())
                stops, start = hierarchy.wheel(face)
                chosen = numpy.zeros(len(areas), bool)
                chosen[hierarchy.faces(stops[start])] = True
                overlap = areas[chosen & wanted].sum() / areas[chosen | wanted].sum()
                self.assertGreater(overlap, 0.85)
