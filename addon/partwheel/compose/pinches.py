# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits edges and vertices at which a closed surface only touches itself: afterward it is manifold and looks the
same. What partwheel's solids do, for meshes from Blender's Boolean."""

from collections.abc import Iterator

import bmesh
import numpy as np

from partwheel.deform import orthonormal_pair
from ..solid.closing import connected_components


def split_pinches(bm: bmesh.types.BMesh) -> bool:
    """Splits the bmesh where needed. Returns whether each edge then has two faces, wound alike.

    Vertices are duplicated, one for each umbrella. Where that is not enough, because the ends of two coincident edges are
    connected elsewhere, these edges first get a vertex in their middle."""
    pinched = [edge for edge in bm.edges if len(edge.link_faces) > 2]
    pinched_faces = {face for edge in pinched for face in edge.link_faces}
    if len({frozenset(face.verts) for face in pinched_faces}) < len(pinched_faces):
        return False  # duplicate faces
    umbrellas = _find_umbrellas(bm, pinched)
    if umbrellas is None:
        return False
    number = {loop: (vert, i) for vert, fans in umbrellas.items() for i, fan in enumerate(fans) for loop in fan}
    halves = []
    for edge in pinched:
        wedges = {frozenset(number[corner] for corner in (loop, loop.link_loop_next)) for loop in edge.link_loops}
        if 2 * len(wedges) < len(edge.link_loops):
            halves.append(bmesh.utils.edge_split(edge, edge.verts[0], 0.5)[0])
    if halves:
        umbrellas = _find_umbrellas(bm, pinched + halves)
        if umbrellas is None:
            return False
    targets = {}
    for fans in umbrellas.values():
        for fan in fans[1:]:
            first, *others = (bmesh.utils.loop_separate(loop) for loop in fan)
            targets.update(dict.fromkeys(others, first))
    bmesh.ops.weld_verts(bm, targetmap=targets)
    return all(edge.is_contiguous for edge in bm.edges)


def _find_umbrellas(bm: bmesh.types.BMesh, pinched: list[bmesh.types.BMEdge]) -> dict | None:
    """For the vertices at which the surface touches itself, the loops of each umbrella, a fan of faces connected across edges; None
    if the faces at an edge don't bound wedges."""
    across = {}  # loop -> the other loop of its edge on the same wedge of the solid
    for edge in pinched:
        pairs = _wedge_pairs(edge)
        if pairs is None:
            return None
        for first, second in pairs:
            across[first], across[second] = second, first

    def neighbors(loop: bmesh.types.BMLoop) -> Iterator[bmesh.types.BMLoop]:
        for edge_loop in (loop, loop.link_loop_prev):  # its two edges at the vertex
            other = across.get(edge_loop) or edge_loop.link_loop_radial_next
            yield other if other.vert == loop.vert else other.link_loop_next  # of the face beyond, the loop at this vertex

    ends = {vert for edge in pinched for vert in edge.verts}  # for membership tests only: sets have no fixed order
    return {vert: connected_components(vert.link_loops, neighbors)
            for vert in bm.verts if vert in ends or not vert.is_manifold}


def _wedge_pairs(edge: bmesh.types.BMEdge) -> list[tuple[bmesh.types.BMLoop, bmesh.types.BMLoop]] | None:
    """The loops of an edge with four or more faces, in pairs that bound one wedge of the solid each; or None."""
    start = edge.verts[0]
    axis = np.array(edge.verts[1].co - start.co, float)
    length = np.linalg.norm(axis)
    if not length:
        return None
    axis /= length
    first_normal, second_normal = orthonormal_pair(axis)
    by_angle = []
    for loop in edge.link_loops:
        normal = np.array(loop.face.normal, float)
        inwards = np.cross(normal, axis if loop.vert == start else -axis)
        by_angle.append((np.arctan2(inwards @ second_normal, inwards @ first_normal), loop))
    by_angle.sort(key=lambda item: item[0])
    loops = [loop for _, loop in by_angle]
    # Normals point outward: of a loop that runs along the axis, the outside is on the side of larger angles.
    runs_along = [loop.vert == start for loop in loops]
    if any(is_along == next_is_along for is_along, next_is_along in zip(runs_along, runs_along[1:] + runs_along[:1])):
        return None
    if runs_along[0]:
        loops = loops[1:] + loops[:1]
    return list(zip(loops[::2], loops[1::2]))
