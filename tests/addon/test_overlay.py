# SPDX-License-Identifier: GPL-3.0-or-later
"""What is tinted in which color. Without a graphics card: which triangles would be handed to it."""


from types import SimpleNamespace

import bpy
import numpy as np
from common import BOX, MeshTest, part, read_off


class Tints(MeshTest):
    def setUp(self):
        super().setUp()
        self.obj = self.add(*read_off("homer"))
        self.h = part("api").build(self.obj)
        self.overlay = part("view.overlay")
        self.colors = self.overlay.get_theme_colors()
        self.parts = self.overlay.PartTriangles(part("view.visible_surface").compute_visible_surface(self.obj), self.h)
        self.obj.data.calc_loop_triangles()
        self.face_of = {frozenset(loop_triangle.vertices): loop_triangle.polygon_index for loop_triangle in self.obj.data.loop_triangles}

    def tinted(self, *what):
        """{color: the faces that have it, a list with each as often as it is drawn}"""
        faces_by_color = {}

        def draw(_context, _obj, layers):
            for layer in layers:
                if not layer.width:
                    faces_by_color[layer.color] = sorted(faces_by_color.get(layer.color, []) + layer.drawable[1])

        self.replace(self.overlay.layers, "draw_layers", draw)
        self.replace(self.overlay.layers, "create_line_batch", lambda _positions, edges: (None, edges))
        self.replace(self.parts, "slice_batch", lambda piece: (None, self.faces(self.parts.triangles[slice(*piece)])))
        self.replace(self.parts, "face_batch", lambda _name, faces: (None, sorted(faces.tolist())))
        self.overlay.draw_picked_part(bpy.context, self.obj, self.parts, *what)
        return faces_by_color

    def replace(self, owner, name, value):
        self.addCleanup(setattr, owner, name, getattr(owner, name))
        setattr(owner, name, value)

    def faces(self, triangles):
        return [self.face_of[frozenset(triangle)] for triangle in triangles.tolist()]

    def test_the_part_and_what_the_next_notch_adds(self):
        for face in (100, 3000):
            stops, _ = self.h.wheel(face)
            for node, larger in zip(stops, stops[1:]):
                inside, whole = (set(self.h.faces(stop).tolist()) for stop in (node, larger))
                self.assertEqual(self.tinted(node, larger, None), {
                    self.colors.part: sorted(inside), self.colors.next: sorted(whole - inside)})
            self.assertEqual(self.tinted(stops[-1], stops[-1], None), {
                self.colors.part: list(range(len(self.h.order)))})

    def test_colors_are_stored_as_the_card_takes_them(self):
        """Three corners of each triangle have its color: converting them there took most of a notch's time."""
        self.assertEqual(self.overlay.make_distinct_colors(np.arange(5)).dtype, np.float32)

    def test_whole_objects_have_the_colors_of_parts(self):
        other, drawn = self.add(*BOX, "other"), {}
        triangles = {obj.name_full: SimpleNamespace(drawable=None, fits=lambda _obj: True) for obj in (self.obj, other)}
        self.replace(self.overlay.layers, "draw_layers", lambda _context, obj, layers: drawn.update({obj: layers[0].color}))
        self.replace(self.overlay, "is_visible", lambda _context, _obj: True)
        self.overlay.draw_whole_objects(bpy.context, triangles, frozenset({self.obj.name_full}), frozenset(triangles))
        self.assertEqual(drawn, {self.obj: self.colors.part, other: self.colors.next})

    def test_the_same_with_its_border_in_creases(self):
        stops, start = self.h.wheel(100)
        node, larger = stops[start], stops[start + 1]
        snapped = np.setdiff1d(self.h.faces(larger), self.h.faces(larger)[:5])
        self.assertEqual(self.tinted(node, larger, snapped), {
            self.colors.part: sorted(snapped.tolist()), self.colors.next: sorted(self.h.faces(larger)[:5].tolist())})

    def test_what_is_selected_already_is_not_added(self):
        stops, start = self.h.wheel(100)
        node, larger = stops[start], stops[start + 1]
        inside, added = self.h.faces(node), np.setdiff1d(self.h.faces(larger), self.h.faces(node))
        for snapped in (None, inside):
            self.assertEqual(self.tinted(node, larger, snapped, np.r_[inside[:3], added[:5]]), {
                self.colors.part: sorted(inside.tolist()), self.colors.next: added[5:].tolist()})

    def test_the_outline_is_where_the_part_ends(self):
        """Edges of the mesh that one face of the part has, and one beyond."""
        stops, start = self.h.wheel(100)
        for node in stops[start:start + 2]:
            part_of, triangles_of_edge = set(self.h.faces(node).tolist()), {}
            for polygon in self.obj.data.polygons:
                for edge in polygon.edge_keys:
                    triangles_of_edge.setdefault(edge, []).append(polygon.index in part_of)
            expected = {edge for edge, inside in triangles_of_edge.items() if len(set(inside)) == 2}
            for edges in (self.parts.border_edges(node), self.parts.border_edges(node, self.h.faces(node)[::-1])):
                self.assertEqual({tuple(sorted(edge)) for edge in edges.tolist()}, expected)
                self.assertEqual(len(edges), len(expected))
        self.assertEqual(len(self.parts.border_edges(stops[-1])), 0)  # the model is closed

    def test_neighbors_of_any_triangles(self):
        """Sheets, edges of three and four triangles, none at all: by counting."""
        layers, rng = part("view.layers"), np.random.default_rng(1)
        for corners, number in ((4, 1), (5, 9), (9, 40), (30, 40), (3, 0)):
            triangles = np.array([rng.permutation(corners)[:3] for _ in range(number)], np.int32).reshape(-1, 3)
            *_, beyond = layers.find_neighbor_triangles(triangles)
            self.assertEqual(beyond.shape, (number, 3))
            of_edge = {}
            for triangle in range(number):
                for edge in range(3):
                    ends = frozenset((triangles[triangle, edge], triangles[triangle, (edge + 1) % 3]))
                    of_edge.setdefault(ends, []).append((triangle, beyond[triangle, edge]))
            for own in of_edge.values():
                mine, led_to = zip(*own)
                self.assertEqual(sorted(led_to), sorted(mine) if len(mine) > 1 else [number])
                self.assertTrue(len(mine) == 1 or all(one != other for one, other in own))
            mine = rng.permutation(number)[:number // 2]
            own_edges = [frozenset(edge) for edge in layers.find_border_edges(triangles, beyond, mine).tolist()]
            self.assertLessEqual({edge for edge, own in of_edge.items() if len({owner for owner, _ in own} & {*mine}) == 1},
                                 set(own_edges))
