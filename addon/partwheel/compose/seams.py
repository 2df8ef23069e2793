# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams of a union, where faces of different solids meet, and what blends the surface across them.

Which solid a face came from is written into a face attribute before the Boolean, which keeps it.
"""

import numpy as np

from ..mesh import arrays
from partwheel import fair_vertices, surface_distances
from partwheel.joint import edge_components

SIDE = "partwheel_side"  # while a union is made: the number of the solid that each face came from


def mark(mesh, side):
    """All faces of the mesh come from this solid."""
    unmark(mesh)
    layer = mesh.attributes.new(SIDE, "INT", "FACE")
    layer.data.foreach_set("value", np.full(len(mesh.polygons), side, np.int32))


def unmark(mesh):
    if SIDE in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[SIDE])


def blend(mesh, width):
    """Moves the vertices of a marked mesh about its seams, so that the surface goes on smoothly there. width: of the
    band on each side, times the seam's radius; at most half of what there is of that solid. Layers stay; normals set by
    hand are computed anew in the band. Whether there was a seam."""
    free = band(mesh, width)
    if not free.any():
        return False
    normals = arrays.custom_normals(mesh)
    vertices = arrays.read(mesh.vertices, "co", np.float32, 3)
    places = fair_vertices(vertices, arrays.edge_vertices(mesh), free)
    arrays.write(mesh.vertices, "co", np.where(free[:, None], places, vertices).astype(np.float32))
    if normals is not None:
        normals[free[arrays.read(mesh.loops, "vertex_index", np.int32)]] = 0
        arrays.set_custom_normals(mesh, normals)
    mesh.update()
    return True


def band(mesh, width):
    """(V,) bool: the vertices that blend() moves."""
    vertices = arrays.read(mesh.vertices, "co", np.float32, 3).astype(np.float64)
    triangles, _ = arrays.triangles(mesh)
    sides = arrays.read(mesh.attributes[SIDE].data, "value", np.int32)
    of_corner = np.repeat(sides, arrays.polygon_sizes(mesh)[1])
    of_vertex = np.zeros(len(vertices), np.int32)
    of_vertex[arrays.read(mesh.loops, "vertex_index", np.int32)] = of_corner
    free = np.zeros(len(vertices), bool)
    for seam in _seams(mesh, of_corner):
        middle = vertices[seam].mean(axis=0)
        reach = width * np.sqrt(((vertices[seam] - middle) ** 2).sum(axis=1).mean())
        # Only what may be within twice the reach is looked at, and what is beside that: a seam may be smaller than all
        # triangles about it.
        near = ((vertices >= vertices[seam].min(axis=0) - 2 * reach)
                & (vertices <= vertices[seam].max(axis=0) + 2 * reach)).all(axis=1)
        around = triangles[near[triangles].any(axis=1)]
        near[around] = True
        number = np.cumsum(near) - 1
        at = np.flatnonzero(near)
        distance = surface_distances(vertices[near], number[around], number[seam])
        for side in np.unique(of_vertex[at]):
            own = of_vertex[at] == side
            reached = distance[own & (distance <= 2 * reach)]
            free[at[own & (distance < min(reach, reached.max(initial=0) / 2))]] = True
        free[seam] = True
    return free


def _seams(mesh, of_corner):
    """The vertices of each seam: arrays of indices, one for each connected group of edges between faces of different
    solids."""
    edges = arrays.edge_vertices(mesh)
    edge = arrays.read(mesh.loops, "edge_index", np.int32)
    low = np.full(len(edges), np.iinfo(np.int32).max, np.int32)
    high = np.full(len(edges), -1, np.int32)
    np.minimum.at(low, edge, of_corner)
    np.maximum.at(high, edge, of_corner)
    edges = edges[low < high]
    group = edge_components(edges)
    return [np.unique(edges[group == each]) for each in np.unique(group)]
