# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges and vertices at which a closed surface only touches itself, set apart: afterwards it is manifold and looks the
same. What core's solids do, for a mesh of Blender's own making."""

import bmesh
import numpy as np

from .solids import copy_face


def set_apart(bm):
    """Changes the bmesh where it must; whether its edges have now two faces each, wound alike. Several vertices then
    stand at one place; where that is not enough, since both ends of an edge are joined otherwise, one of the two edges
    gets a vertex in its middle."""
    pinched = [edge for edge in bm.edges if len(edge.link_faces) > 2]
    across = {}  # loop -> the loop on the other side of its edge, with the solid between them
    for edge in pinched:
        pairs = _pairs(edge)
        if pairs is None:
            return False
        for one, other in pairs:
            across[one], across[other] = other, one
    verts = {vert for edge in pinched for vert in edge.verts} | {vert for vert in bm.verts if not vert.is_manifold}
    own = {}  # loop -> the vertex that its umbrella gets
    for vert in verts:
        for umbrella in _umbrellas(vert, across)[1:]:
            new = bm.verts.new(vert.co, vert)
            own.update(dict.fromkeys(umbrella, new))
    middle = {}  # loop -> the vertex in the middle of its edge
    for edge in pinched:
        seen = set()
        for loop in edge.link_loops:
            if loop in seen:
                continue
            seen |= {loop, across[loop]}
            ends = [own.get(each, each.vert) for each in (loop, loop.link_loop_next)]
            taken = [each for each in edge.link_loops if each not in seen and each not in middle
                     and {own.get(e, e.vert) for e in (each, each.link_loop_next)} == set(ends)]
            if taken:
                new = bm.verts.new((ends[0].co + ends[1].co) / 2, ends[0])
                new.copy_from_vert_interp((edge.verts[0], edge.verts[1]), 0.5)
                middle[loop] = middle[across[loop]] = new
    faces = {loop.face for loop in own} | {loop.face for loop in middle}
    for face in faces:
        corners = []
        for loop in face.loops:
            corners.append((own.get(loop, loop.vert), loop))
            if loop in middle:
                corners.append((middle[loop], (loop, loop.link_loop_next)))
        copy_face(bm, face, corners)
    bmesh.ops.delete(bm, geom=list(faces), context="FACES")
    return all(edge.is_contiguous for edge in bm.edges)


def _pairs(edge):
    """The loops of an edge of four or more faces in pairs that have the solid between them; None if they have none."""
    start = edge.verts[0]
    axis = np.array(edge.verts[1].co - start.co, float)
    length = np.linalg.norm(axis)
    if not length:
        return None
    axis /= length
    aside = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    aside /= np.linalg.norm(aside)
    third = np.cross(axis, aside)
    around = []
    for loop in edge.link_loops:
        normal = np.array(loop.face.normal, float)
        inwards = np.cross(normal, axis if loop.vert == start else -axis)
        around.append((np.arctan2(inwards @ third, inwards @ aside), loop))
    around.sort(key=lambda item: item[0])
    loops = [loop for _, loop in around]
    # Outside is where the normal points: for a loop that runs along the axis, on the side of larger angles.
    along = [loop.vert == start for loop in loops]
    if any(here == after for here, after in zip(along, along[1:] + along[:1])):
        return None
    if along[0]:
        loops = loops[1:] + loops[:1]
    return list(zip(loops[::2], loops[1::2]))


def _umbrellas(vert, across):
    """The loops at a vertex in groups that are joined by steps across edges."""
    groups, left = [], set(vert.link_loops)
    while left:
        group, todo = [], [left.pop()]
        while todo:
            loop = todo.pop()
            group.append(loop)
            for edge_loop in (loop, loop.link_loop_prev):  # its two edges at the vertex
                other = across.get(edge_loop) or edge_loop.link_loop_radial_next
                # Of the face beyond, the loop at this vertex.
                beyond = other if other.vert == vert else other.link_loop_next
                if beyond in left:
                    left.remove(beyond)
                    todo.append(beyond)
        groups.append(group)
    return groups
