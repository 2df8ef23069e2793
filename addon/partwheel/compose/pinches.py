# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits edges and vertices at which a closed surface only touches itself: afterward it is manifold and looks the
same. The library does this to its solids; here it is done to meshes from Blender's Boolean."""

from collections.abc import Iterator

import bmesh
import numpy as np

from partwheel.deform import orthonormal_pair
from ..solid.closing import connected_components


def split_pinches(bm: bmesh.types.BMesh, may_overlap: bool = False) -> bool:
    """Splits the bmesh where needed. Returns whether each edge then has two faces, wound alike. may_overlap: also where faces
    seem to cross at an edge, as rounding makes it look.

    Vertices are duplicated, one for each umbrella. Where that is not enough, because the ends of two coincident edges are
    connected elsewhere, these edges first get a vertex in their middle."""
    pinched = [edge for edge in bm.edges if len(edge.link_faces) > 2]
    pinched_faces = {face for edge in pinched for face in edge.link_faces}
    if len({frozenset(face.verts) for face in pinched_faces}) < len(pinched_faces):
        return False  # duplicate faces
    wedges = {edge: _find_wedges(edge, may_overlap) for edge in pinched}
    if None in wedges.values():
        return False
    umbrellas = _find_umbrellas(bm, wedges)
    number = {loop: (vert, i) for vert, fans in umbrellas.items() for i, fan in enumerate(fans) for loop in fan}
    for edge in pinched:
        ends = {frozenset(number[corner] for corner in (loop, loop.link_loop_next)) for loop in edge.link_loops}
        if 2 * len(ends) < len(edge.link_loops):
            half = bmesh.utils.edge_split(edge, edge.verts[0], 0.5)[0]
            wedges[half] = wedges[edge]
    if len(wedges) > len(pinched):
        umbrellas = _find_umbrellas(bm, wedges)
    targets = {}
    for fans in umbrellas.values():
        for fan in fans[1:]:
            first, *others = (bmesh.utils.loop_separate(loop) for loop in fan)
            targets.update(dict.fromkeys(others, first))
    bmesh.ops.weld_verts(bm, targetmap=targets)
    return all(edge.is_contiguous for edge in bm.edges)


def cancel_coincident_faces(bm: bmesh.types.BMesh) -> None:
    """Deletes pairs of faces with the same edges and opposite winding where the surface touches itself: they enclose nothing.
    Blender's Boolean leaves them where two solids touch."""
    faces_by_edges = {}
    for face in {face for vert in bm.verts if not vert.is_manifold for face in vert.link_faces}:
        faces_by_edges.setdefault(frozenset(face.edges), []).append(face)
    pairs = [pair for pair in faces_by_edges.values() if len(pair) == 2 and len(
        {loop.vert for face in pair for loop in face.loops if loop.edge == pair[0].edges[0]}) == 2]
    bmesh.ops.delete(bm, geom=[face for pair in pairs for face in pair], context="FACES")


def _find_umbrellas(bm: bmesh.types.BMesh, wedges: dict[bmesh.types.BMEdge, list]) -> dict:
    """For the vertices at which the surface touches itself, the loops of each umbrella, a fan of faces connected across edges.
    wedges: of edges with more than two faces, see _find_wedges()."""
    across = {}  # loop -> the other loop of its edge on the same wedge of the solid
    for edge, pairs in wedges.items():
        loops = {loop.face: loop for loop in edge.link_loops}
        for first, second in pairs:
            across[loops[first]], across[loops[second]] = loops[second], loops[first]

    def neighbors(loop: bmesh.types.BMLoop) -> Iterator[bmesh.types.BMLoop]:
        for edge_loop in (loop, loop.link_loop_prev):  # its two edges at the vertex
            other = across.get(edge_loop) or edge_loop.link_loop_radial_next
            yield other if other.vert == loop.vert else other.link_loop_next  # of the face beyond, the loop at this vertex

    ends = {vert for edge in wedges for vert in edge.verts}  # for membership tests only: sets have no fixed order
    return {vert: connected_components(vert.link_loops, neighbors)
            for vert in bm.verts if vert in ends or not vert.is_manifold}


def _find_wedges(edge: bmesh.types.BMEdge,
                 may_overlap: bool) -> list[tuple[bmesh.types.BMFace, bmesh.types.BMFace]] | None:
    """The faces of an edge with four or more, in pairs that bound one wedge of the solid each; or None. may_overlap: also
    wedges inside each other, which rounding makes of narrow ones."""
    start = edge.verts[0]
    axis = np.array(edge.verts[1].co - start.co, float)
    length = np.linalg.norm(axis)
    if not (length or may_overlap):
        return None
    axis = axis / length if length else np.array([1.0, 0.0, 0.0])
    first_normal, second_normal = orthonormal_pair(axis)
    by_angle = []
    for loop in edge.link_loops:
        normal = np.array(loop.face.normal, float)
        inwards = np.cross(normal, axis if loop.vert == start else -axis)
        by_angle.append((np.arctan2(inwards @ second_normal, inwards @ first_normal), loop))
    by_angle.sort(key=lambda item: item[0])
    loops = [loop for _, loop in by_angle]
    # Normals point outward: at a loop that runs along the axis, a wedge ends, in the direction of larger angles.
    depths = np.cumsum([-1 if loop.vert == start else 1 for loop in loops])
    if depths[-1] or not (may_overlap or np.ptp(depths) == 1):
        return None
    first = int(depths.argmin()) + 1
    pairs, open_faces = [], []
    for loop in loops[first:] + loops[:first]:
        if loop.vert == start:
            pairs.append((open_faces.pop(), loop.face))
        else:
            open_faces.append(loop.face)
    return pairs
