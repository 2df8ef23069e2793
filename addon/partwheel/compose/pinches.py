# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits edges and vertices at which a closed surface only touches itself: afterward it is manifold and looks the
same. What partwheel's solids do, for meshes from Blender's Boolean."""

from collections.abc import Iterator
from typing import Any

import bmesh
import numpy as np

from partwheel.deform import orthonormal_pair
from ..solid.closing import connected_components


def split_pinches(bm: bmesh.types.BMesh) -> bool:
    """Splits the bmesh where needed. Returns whether each edge then has two faces, wound alike.

    Vertices are duplicated, one for each umbrella. If that is not enough, because the ends of two coincident edges
    are connected elsewhere, one of these edges gets a vertex in its middle."""
    pinched = [edge for edge in bm.edges if len(edge.link_faces) > 2]
    pinched_faces = {face for edge in pinched for face in edge.link_faces}
    if len({frozenset(face.verts) for face in pinched_faces}) < len(pinched_faces):
        return False  # duplicate faces
    across = {}  # loop -> the other loop of its edge on the same wedge of the solid
    for edge in pinched:
        pairs = _wedge_pairs(edge)
        if pairs is None:
            return False
        for first, second in pairs:
            across[first], across[second] = second, first
    ends = {vert for edge in pinched for vert in edge.verts}  # for membership tests only: sets have no fixed order
    new_verts = {}  # loop -> new vertex of its umbrella
    for vert in [vert for vert in bm.verts if vert in ends or not vert.is_manifold]:
        for umbrella in _umbrellas(vert, across)[1:]:
            new = bm.verts.new(vert.co, vert)
            new_verts.update(dict.fromkeys(umbrella, new))
    mid_verts = {}  # loop -> new vertex in the middle of its edge
    for edge in pinched:
        paired = set()
        for loop in edge.link_loops:
            if loop in paired:
                continue
            paired |= {loop, across[loop]}
            ends = [new_verts.get(corner, corner.vert) for corner in (loop, loop.link_loop_next)]
            coincident = [corner for corner in edge.link_loops if corner not in paired and corner not in mid_verts
                          and {new_verts.get(end, end.vert) for end in (corner, corner.link_loop_next)} == set(ends)]
            if coincident:
                new = bm.verts.new((ends[0].co + ends[1].co) / 2, ends[0])
                new.copy_from_vert_interp((edge.verts[0], edge.verts[1]), 0.5)
                mid_verts[loop] = mid_verts[across[loop]] = new
    changed = {loop.face for loop in (*new_verts, *mid_verts)}
    faces = [face for face in bm.faces if face in changed]
    for face in faces:
        corners = []
        for loop in face.loops:
            corners.append((new_verts.get(loop, loop.vert), loop))
            if loop in mid_verts:
                corners.append((mid_verts[loop], (loop, loop.link_loop_next)))
        _copy_face(bm, face, corners)
    bmesh.ops.delete(bm, geom=faces, context="FACES")
    return all(edge.is_contiguous for edge in bm.edges)


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


def _umbrellas(vert: bmesh.types.BMVert, across: dict) -> list[list[bmesh.types.BMLoop]]:
    """The loops at a vertex, grouped by the umbrellas (fans of faces connected across edges) that they belong to."""
    def neighbors(loop: bmesh.types.BMLoop) -> Iterator[bmesh.types.BMLoop]:
        for edge_loop in (loop, loop.link_loop_prev):  # its two edges at the vertex
            other = across.get(edge_loop) or edge_loop.link_loop_radial_next
            yield other if other.vert == vert else other.link_loop_next  # of the face beyond, the loop at this vertex

    return connected_components(vert.link_loops, neighbors)


def _copy_face(bm: bmesh.types.BMesh, old: bmesh.types.BMFace, corners: list[tuple]) -> None:
    """A new face with the attributes of an old one. corners: (its vertex, the loop that it copies; or two loops, for
    a vertex midway between them)."""
    # copy_from() would also copy Blender's pointer from an element to its Python object, and crash later.
    for (vert, source), (next_vert, next_source) in zip(corners, corners[1:] + corners[:1]):
        if isinstance(source, tuple):
            source = source[0]
        following = next_source[1] if isinstance(next_source, tuple) else next_source
        if source.link_loop_next == following and not bm.edges.get((vert, next_vert)):
            bm.edges.new((vert, next_vert), source.edge)
    new = bm.faces.new([vert for vert, _ in corners], old)
    new.smooth, new.material_index = old.smooth, old.material_index
    for loop, (_, source) in zip(new.loops, corners):
        if isinstance(source, tuple):
            _mix_layers(bm.loops.layers, *source, loop)
        else:
            _copy_layers(bm.loops.layers, source, loop)


def _copy_layers(layers: Any, old: bmesh.types.BMLoop, new: bmesh.types.BMLoop) -> None:
    for kind in ("bool", "int", "float", "string", "float_vector", "color", "float_color"):
        for layer in getattr(layers, kind).values() if hasattr(layers, kind) else ():
            new[layer] = old[layer]
    for layer in layers.uv.values():
        new[layer].uv, new[layer].pin_uv = old[layer].uv, old[layer].pin_uv


def _mix_layers(layers: Any, first: bmesh.types.BMLoop, second: bmesh.types.BMLoop, new: bmesh.types.BMLoop) -> None:
    """The mean of two loops' attributes; of values without a mean, the first."""
    _copy_layers(layers, first, new)
    for kind in ("float", "float_vector", "color", "float_color"):
        for layer in getattr(layers, kind).values() if hasattr(layers, kind) else ():
            new[layer] = (first[layer] + second[layer]) / 2
    for layer in layers.uv.values():
        new[layer].uv = (first[layer].uv + second[layer].uv) / 2
