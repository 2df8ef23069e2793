# SPDX-License-Identifier: GPL-3.0-or-later
"""Closes boundary loops of a bmesh by flat or smooth caps.

Sets of bmesh elements are used for membership tests only: their order depends on addresses and changes from run to
run."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import bmesh
import numpy as np

from partwheel import fair_vertices
from partwheel.components import edge_components

CAP_RINGS = 4  # rings of faces in a smooth cap, between its boundary and its center


def split_non_manifold(bm: bmesh.types.BMesh) -> None:
    """Splits edges and vertices until at most two faces, wound alike, meet at an edge, and one fan at a vertex."""
    bad = [edge for edge in bm.edges
           if len(edge.link_faces) > 2 or (len(edge.link_faces) == 2 and not edge.is_contiguous)]
    if bad:
        bmesh.ops.split_edges(bm, edges=bad)
    for vert in [vert for vert in bm.verts if vert.is_boundary]:
        fans = connected_components((edge for edge in vert.link_edges if edge.link_faces),
                                    lambda edge: (other for face in edge.link_faces for other in face.edges))
        for fan in fans[1:]:
            bmesh.utils.vert_separate(vert, [edge for edge in fan if edge.is_boundary])


def connected_components(items: Iterable, neighbors: Callable[[Any], Iterable]) -> list[list]:
    """The items as lists, one for each connected component of the graph given by neighbors(item). In the order of the
    items. For few items: see label_components() for faces."""
    items = list(items)
    remaining, components = set(items), []
    for first in items:
        if first not in remaining:
            continue
        remaining.remove(first)
        component = [first]
        for item in component:
            new = [other for other in dict.fromkeys(neighbors(item)) if other in remaining]
            remaining.difference_update(new)
            component += new
        components.append(component)
    return components


def label_components(bm: bmesh.types.BMesh, faces: Sequence[bmesh.types.BMFace]) -> np.ndarray:
    """(n,) the connected component of each of these faces, from 0; a common vertex connects."""
    bm.verts.index_update()
    sizes = np.array([len(face.verts) for face in faces], int)
    corners = np.array([vert.index for face in faces for vert in face.verts], int)
    begin = np.cumsum(sizes) - sizes
    return edge_components(np.stack([np.repeat(corners[begin], sizes), corners], axis=1))[begin]


def fill_boundary_loops(bm: bmesh.types.BMesh, smooth: bool,
                        excluded_edges: set[bmesh.types.BMEdge]) -> list[bmesh.types.BMFace]:
    """Closes every boundary loop, except those of excluded edges, by a fan around a new vertex in its center. Returns
    the new faces. smooth: with rings of faces between, faired to continue the surface."""
    caps = []
    for loop in boundary_loops([edge for edge in bm.edges if edge.is_boundary and edge not in excluded_edges]):
        caps += _fill_loop(bm, loop, CAP_RINGS if smooth else 0)
    return caps


def boundary_loops(edges: list[bmesh.types.BMEdge]) -> list[list[bmesh.types.BMVert]]:
    """The closed loops of these boundary edges, each as its vertices in the order in which new faces run along it."""
    remaining = set(edges)
    return list(filter(None, (_trace_boundary_loop(first, remaining) for first in edges if first in remaining)))


def _trace_boundary_loop(edge: bmesh.types.BMEdge, remaining: set[bmesh.types.BMEdge]) -> list[bmesh.types.BMVert]:
    """The vertices of the loop with this edge, in the order in which new faces run along it, against its own faces;
    [] if it is not closed. Removes its edges from the remaining ones."""
    remaining.remove(edge)
    corner = edge.link_loops[0]
    start, vert = corner.link_loop_next.vert, corner.vert
    boundary = [start]
    while vert != start:
        boundary.append(vert)
        edge = next((other for other in vert.link_edges if other in remaining), None)
        if edge is None:
            return []
        remaining.remove(edge)
        vert = edge.other_vert(vert)
    return boundary


def _fill_loop(bm: bmesh.types.BMesh, loop: list[bmesh.types.BMVert], n_rings: int) -> list[bmesh.types.BMFace]:
    """Closes one loop of vertices by n_rings rings of quads and a fan of triangles. Returns the new faces."""
    center = sum((vert.co for vert in loop[1:]), loop[0].co.copy()) / len(loop)
    rows, caps = [loop], []
    for ring in range(n_rings):
        fraction = (ring + 1) / (n_rings + 1)
        rows.append([add_vertex(bm, vert.co.lerp(center, fraction)) for vert in loop])
    apex = add_vertex(bm, center)
    count = len(loop)
    for outer, inner in zip(rows, rows[1:]):
        caps += [bm.faces.new((outer[i], outer[(i + 1) % count], inner[(i + 1) % count], inner[i]))
                 for i in range(count)]
    caps += [bm.faces.new((rows[-1][i], rows[-1][(i + 1) % count], apex)) for i in range(count)]
    for face in caps:
        face.smooth = n_rings > 0
    if n_rings:
        _fair_cap(loop, [*(vert for row in rows[1:] for vert in row), apex])
    return caps


def orient_outward(bm: bmesh.types.BMesh, exempt_faces: Iterable[bmesh.types.BMFace]) -> None:
    """Turns components of a closed bmesh that are inside out, except those with exempt faces, whose side is known."""
    faces = bm.faces[:]
    bm.faces.index_update()
    label = label_components(bm, faces)
    is_exempt = np.isin(label, label[[face.index for face in exempt_faces]])
    bmesh.ops.recalc_face_normals(bm, faces=[face for face, exempt in zip(faces, is_exempt.tolist()) if not exempt])


def add_vertex(bm: bmesh.types.BMesh, position: Sequence[float]) -> bmesh.types.BMVert:
    """A new vertex that has this position in all shape keys."""
    vert = bm.verts.new(position)
    for key in bm.verts.layers.shape.values():
        vert[key] = vert.co
    return vert


def _fair_cap(loop: list[bmesh.types.BMVert], new: list[bmesh.types.BMVert]) -> None:
    """Moves the new vertices of a cap to where it continues the surface around the loop smoothly."""
    edges = list({edge: None for vert in (*loop, *new) for edge in vert.link_edges})
    number = {vert: i for i, vert in enumerate(dict.fromkeys((*new, *(vert for edge in edges for vert in edge.verts))))}
    positions = fair_vertices([vert.co[:] for vert in number], [[number[vert] for vert in edge.verts] for edge in edges],
                              np.arange(len(number)) < len(new))
    for vert, position in zip(new, positions):
        vert.co = position
