# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams of a union, where faces of different solids meet, and the smooth blend across them.

Before the Boolean, a face attribute stores which solid each face comes from; the Boolean preserves it."""

import bpy
import numpy as np

from ..mesh import arrays
from partwheel import fair_vertices, surface_distances
from partwheel.components import edge_components

SOLID_ATTRIBUTE = "partwheel_side"  # temporary face attribute: index of the solid that the face comes from


def mark_solid(mesh: bpy.types.Mesh, solid: int) -> None:
    remove_marks(mesh)
    layer = mesh.attributes.new(SOLID_ATTRIBUTE, "INT", "FACE")
    layer.data.foreach_set("value", np.full(len(mesh.polygons), solid, np.int32))


def remove_marks(mesh: bpy.types.Mesh) -> None:
    if SOLID_ATTRIBUTE in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[SOLID_ATTRIBUTE])


def blend_seams(mesh: bpy.types.Mesh, width: float) -> bool:
    """Fairs the vertices of a marked mesh around its seams, so that the surface continues smoothly. width: of the
    band on each side, in radii of the seam; at most half the extent of that solid. Layers stay; custom normals in the
    band are reset. Returns whether there was a seam."""
    is_free = blend_band(mesh, width)
    if not is_free.any():
        return False
    normals = arrays.read_custom_normals(mesh)
    vertices = arrays.read_positions(mesh)
    positions = fair_vertices(vertices, arrays.read_edge_vertices(mesh), is_free)
    arrays.write(mesh.vertices, "co", np.where(is_free[:, None], positions, vertices).astype(np.float32))
    if normals is not None:
        normals[is_free[arrays.read_corner_vertices(mesh)]] = 0
        arrays.write_custom_normals(mesh, normals)
    mesh.update()
    return True


def blend_band(mesh: bpy.types.Mesh, width: float) -> np.ndarray:
    """(V,) bool: the vertices that blend_seams() moves."""
    vertices = arrays.read_positions(mesh).astype(np.float64)
    triangles, _ = arrays.read_triangles(mesh)
    face_solids = arrays.read(mesh.attributes[SOLID_ATTRIBUTE].data, "value", np.int32)
    corner_solids = np.repeat(face_solids, arrays.read_polygon_sizes(mesh)[1])
    vertex_solids = np.zeros(len(vertices), np.int32)
    vertex_solids[arrays.read_corner_vertices(mesh)] = corner_solids
    is_free = np.zeros(len(vertices), bool)
    for seam in _seam_vertices(mesh, corner_solids):
        center = vertices[seam].mean(axis=0)
        reach = width * np.sqrt(((vertices[seam] - center) ** 2).sum(axis=1).mean())
        # Only vertices that may be within twice the reach, and those of their triangles: a seam may be smaller than
        # all triangles around it.
        is_near = ((vertices >= vertices[seam].min(axis=0) - 2 * reach)
                   & (vertices <= vertices[seam].max(axis=0) + 2 * reach)).all(axis=1)
        near_triangles = triangles[is_near[triangles].any(axis=1)]
        is_near[near_triangles] = True
        to_near = np.cumsum(is_near) - 1
        near_vertices = np.flatnonzero(is_near)
        distance = surface_distances(vertices[is_near], to_near[near_triangles], to_near[seam])
        for solid in np.unique(vertex_solids[near_vertices]):
            is_of_solid = vertex_solids[near_vertices] == solid
            reached_distances = distance[is_of_solid & (distance <= 2 * reach)]
            is_free[near_vertices[is_of_solid & (distance < min(reach, reached_distances.max(initial=0) / 2))]] = True
        is_free[seam] = True
    return is_free


def _seam_vertices(mesh: bpy.types.Mesh, corner_solids: np.ndarray) -> list[np.ndarray]:
    """The vertices of each seam, a connected component of the edges between faces of different solids."""
    edges = arrays.read_edge_vertices(mesh)
    loop_edges = arrays.read(mesh.loops, "edge_index", np.int32)
    low = np.full(len(edges), np.iinfo(np.int32).max, np.int32)
    high = np.full(len(edges), -1, np.int32)
    np.minimum.at(low, loop_edges, corner_solids)
    np.maximum.at(high, loop_edges, corner_solids)
    edges = edges[low < high]
    component = edge_components(edges)
    return [np.unique(edges[component == number]) for number in np.unique(component)]
