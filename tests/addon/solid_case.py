# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of parts as solids share: what a solid is, counted from its polygons; models with parts."""

import bpy
import numpy
from common import MeshTest, part, read_off


def arrays(mesh):
    """(vertices, polygons as tuples) of a mesh."""
    return (numpy.array([vertex.co[:] for vertex in mesh.vertices], float),
            [tuple(polygon.vertices) for polygon in mesh.polygons])


def volume(mesh):
    """By Blender's own triangles, about the mesh's middle."""
    mesh.calc_loop_triangles()
    vertices = numpy.array([vertex.co[:] for vertex in mesh.vertices], float)
    vertices -= vertices.mean(axis=0)
    corners = vertices[numpy.array([triangle.vertices[:] for triangle in mesh.loop_triangles])]
    return numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6


def caps(mesh):
    """(F,) which faces are caps."""
    marks = numpy.empty(len(mesh.polygons), bool)
    mesh.attributes["partwheel_cap"].data.foreach_get("value", marks)
    return marks


def polygons_at(mesh):
    """{its corners' places, in no order: the polygons there}"""
    places = [tuple(vertex.co) for vertex in mesh.vertices]
    at = {}
    for polygon in mesh.polygons:
        at.setdefault(frozenset(places[vertex] for vertex in polygon.vertices), []).append(polygon)
    return at


def look(obj, polygon):
    """(a polygon's material, {place: UV})"""
    mesh = obj.data
    uv = mesh.uv_layers[0].data
    return (obj.material_slots[polygon.material_index].material.name,
            {tuple(mesh.vertices[mesh.loops[loop].vertex_index].co): tuple(uv[loop].uv) for loop in polygon.loop_indices})


class SolidTest(MeshTest):
    def check_polygons(self, obj, created, expected=None):
        """Each polygon of the object, or each expected one, is one of theirs with its UVs and its material, and no other but
        caps. Duplicates are there once in each shell."""
        source, count = polygons_at(obj.data), {}
        for new in created:
            marks = caps(new.data)
            for place, polygons in polygons_at(new.data).items():
                for polygon in polygons:
                    if not marks[polygon.index]:
                        count[place] = count.get(place, 0) + 1
                        self.assertIn(look(new, polygon), [look(obj, old) for old in source.get(place, ())])
        expected = polygons_at(obj.data) if expected is None else expected
        self.assertEqual(count.keys(), expected.keys())
        self.assertTrue(all(number <= len(source[place]) for place, number in count.items()))

    def assertSolid(self, mesh):
        """Every directed edge once and its opposite once; no vertex or edge without a face; valid for Blender."""
        directed = [pair for polygon in mesh.polygons
                    for pair in zip(polygon.vertices, [*polygon.vertices[1:], polygon.vertices[0]])]
        self.assertEqual(len(directed), len(set(directed)))
        self.assertEqual(set(directed), {(b, a) for a, b in directed})
        self.assertEqual(len(mesh.edges), len(directed) // 2)
        self.assertEqual({vertex for pair in directed for vertex in pair}, set(range(len(mesh.vertices))))
        self.assertFalse(mesh.validate())

    def assertSameShape(self, mesh, matrix, other_mesh, other_matrix):
        """Moved by their matrices, two meshes with the same vertices differ by one factor: in all distances of neighbors."""
        def distances(mesh, matrix):
            places = numpy.array([matrix @ vertex.co for vertex in mesh.vertices])
            return numpy.linalg.norm(numpy.diff(places, axis=0), axis=1)
        factors = distances(mesh, matrix) / distances(other_mesh, other_matrix)
        self.assertLess(numpy.ptp(factors), 1e-3 * factors.max())

    def built(self, name="dragknob"):
        if name == "torus":  # of quads that are not flat
            bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=10)
            obj = bpy.context.active_object
        else:
            obj = self.add(*read_off(name))
        hierarchy = part("api").build(obj)
        self.assertEqual(hierarchy.summary.fill_method, "exact")
        return obj, hierarchy

    def nodes(self, hierarchy, count=6):
        """Some parts, from small to large."""
        filled = numpy.flatnonzero(hierarchy.last - hierarchy.first >= 4)[:-1]
        return [int(node) for node in filled[numpy.linspace(0, len(filled) - 1, count).astype(int)]]

    def run_on(self, obj, operator, **options):
        """snap: not unless it is asked for, so that a part is its node."""
        if operator.idname_py() in {"mesh.partwheel_copy", "mesh.partwheel_remove"}:
            options = {"snap": False} | options
        bpy.context.view_layer.objects.active = obj
        self.assertEqual(operator(**options), {"FINISHED"})
        return bpy.context.view_layer.objects.active

    def ready(self, target, other):
        """Selects both, the target active, as uniting wants it."""
        for obj in bpy.context.view_layer.objects:
            obj.select_set(obj in (target, other))
        bpy.context.view_layer.objects.active = target
        return other
