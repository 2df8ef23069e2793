# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges and vertices at which a closed surface only touches itself, set apart: afterwards it is manifold and looks the
same. What partwheel's solids do, for a mesh of Blender's own making."""

import bmesh
import numpy as np

from ..solid.closing import connected_components


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
    ends = {vert for edge in pinched for vert in edge.verts}  # sets are only asked: their order is that of memory
    own = {}  # loop -> the vertex that its umbrella gets
    for vert in [vert for vert in bm.verts if vert in ends or not vert.is_manifold]:
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
    changed = {loop.face for loop in (*own, *middle)}
    faces = [face for face in bm.faces if face in changed]
    for face in faces:
        corners = []
        for loop in face.loops:
            corners.append((own.get(loop, loop.vert), loop))
            if loop in middle:
                corners.append((middle[loop], (loop, loop.link_loop_next)))
        _copy_face(bm, face, corners)
    bmesh.ops.delete(bm, geom=faces, context="FACES")
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
    def beside(loop):
        for edge_loop in (loop, loop.link_loop_prev):  # its two edges at the vertex
            other = across.get(edge_loop) or edge_loop.link_loop_radial_next
            yield other if other.vert == vert else other.link_loop_next  # of the face beyond, the loop at this vertex

    return connected_components(vert.link_loops, beside)


def _copy_face(bm, old, corners):
    """A new face with the attributes of an old one. corners: (its vertex, the loop of old that it copies; or two, for a
    vertex midway between them)."""
    # Never copy_from(): it also copies Blender's link from an element to its Python object, and crashes later.
    for (vert, source), (after, source_after) in zip(corners, corners[1:] + corners[:1]):
        if isinstance(source, tuple):
            source = source[0]
        following = source_after[1] if isinstance(source_after, tuple) else source_after
        if source.link_loop_next == following and not bm.edges.get((vert, after)):
            bm.edges.new((vert, after), source.edge)
    new = bm.faces.new([vert for vert, _ in corners], old)
    new.smooth, new.material_index = old.smooth, old.material_index
    for loop, (_, source) in zip(new.loops, corners):
        if isinstance(source, tuple):
            _mix_layers(bm.loops.layers, *source, loop)
        else:
            _copy_layers(bm.loops.layers, source, loop)


def _copy_layers(layers, old, new):
    for kind in ("bool", "int", "float", "string", "float_vector", "color", "float_color"):
        for layer in getattr(layers, kind).values() if hasattr(layers, kind) else ():
            new[layer] = old[layer]
    for layer in layers.uv.values():
        new[layer].uv, new[layer].pin_uv = old[layer].uv, old[layer].pin_uv


def _mix_layers(layers, one, other, new):
    _copy_layers(layers, one, new)
    for kind in ("float", "float_vector", "color", "float_color"):
        for layer in getattr(layers, kind).values() if hasattr(layers, kind) else ():
            new[layer] = (one[layer] + other[layer]) / 2
    for layer in layers.uv.values():
        new[layer].uv = (one[layer].uv + other[layer].uv) / 2
