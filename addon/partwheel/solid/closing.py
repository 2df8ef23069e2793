# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders of a bmesh closed by faces, flat or going on as the surface about them does. A set of its elements is
only asked what it holds: its order is that of memory, another on every run."""

import bmesh
import numpy as np

RINGS = 4  # of faces in a smooth cap, between its border and its middle
STEPS = 200  # of fairing


def set_apart(bm):
    """Afterwards at most two faces meet at each edge, wound alike, and the faces about each vertex are one fan."""
    bad = [edge for edge in bm.edges
           if len(edge.link_faces) > 2 or (len(edge.link_faces) == 2 and not edge.is_contiguous)]
    if bad:
        bmesh.ops.split_edges(bm, edges=bad)
    for vert in [vert for vert in bm.verts if vert.is_boundary]:
        fans = _fans(vert)
        for fan in fans[1:]:
            bmesh.utils.vert_separate(vert, [edge for edge in fan if edge.is_boundary])


def _fans(vert):
    """The edges about a vertex in groups that are joined by faces."""
    return groups((edge for edge in vert.link_edges if edge.link_faces),
                  lambda edge: (other for face in edge.link_faces for other in face.edges))


def groups(items, beside):
    """The items in lists of those that are joined by steps to one that is beside(item)."""
    items = list(items)
    left = set(items)
    return [reached(first, left, beside) for first in items if first in left]


def reached(first, left, beside):
    """The list of those of a set that are joined so with the first, which it then has no more."""
    left.remove(first)
    group = [first]
    for each in group:
        new = [other for other in dict.fromkeys(beside(each)) if other in left]
        left.difference_update(new)
        group += new
    return group


def fill(bm, smooth, open_before):
    """Closes every other border by rings of faces around a new vertex in its middle; smooth: relaxed so that they go on
    as the surface about them does. The new faces."""
    caps = []
    for border in borders([edge for edge in bm.edges if edge.is_boundary and edge not in open_before]):
        caps += _fill_border(bm, border, RINGS if smooth else 0)
    return caps


def borders(edges):
    """The borders that a list of edges makes, each as its vertices in the order that new faces run along it."""
    left = set(edges)
    return list(filter(None, (_border(first, left) for first in edges if first in left)))


def _border(edge, left):
    """The vertices of a border in the order that new faces run along it: against its own faces."""
    left.remove(edge)
    loop = edge.link_loops[0]
    start, vert = loop.link_loop_next.vert, loop.vert
    border = [start]
    while vert != start:
        border.append(vert)
        edge = next((other for other in vert.link_edges if other in left), None)
        if edge is None:
            return []
        left.remove(edge)
        vert = edge.other_vert(vert)
    return border


def _fill_border(bm, border, rings):
    middle = sum((vert.co for vert in border[1:]), border[0].co.copy()) / len(border)
    rows, caps = [border], []
    for ring in range(rings):
        share = (ring + 1) / (rings + 1)
        rows.append([new_vert(bm, vert.co.lerp(middle, share)) for vert in border])
    top = new_vert(bm, middle)
    count = len(border)
    for outer, inner in zip(rows, rows[1:]):
        caps += [bm.faces.new((outer[i], outer[(i + 1) % count], inner[(i + 1) % count], inner[i]))
                 for i in range(count)]
    caps += [bm.faces.new((rows[-1][i], rows[-1][(i + 1) % count], top)) for i in range(count)]
    for face in caps:
        face.smooth = rings > 0
    if rings:
        _fair(rows, top)
    return caps


def turn_outwards(bm, told):
    """Turns those pieces of a closed bmesh that are inside out, but for pieces with one of the faces told: what was
    open has no outside before it is closed."""
    told = set(told)
    for piece in groups(bm.faces, around):
        if told.isdisjoint(piece) and _volume(piece) < 0:
            for face in piece:
                face.normal_flip()


def around(face):
    """Those that it has a vertex in common with."""
    return (other for corner in face.verts for other in corner.link_faces)


def _volume(faces):
    """Six times that of closed faces."""
    about, volume = faces[0].verts[0].co, 0.0
    for face in faces:
        first, *others = (vert.co - about for vert in face.verts)
        volume += sum(first.dot(one.cross(other)) for one, other in zip(others, others[1:]))
    return volume


def new_vert(bm, place):
    """There in all shape keys."""
    vert = bm.verts.new(place)
    for key in bm.verts.layers.shape.values():
        vert[key] = vert.co
    return vert


def _fair(rows, top):
    """Moves the new vertices until the discrete bi-Laplacian vanishes (Kobbelt et al. 1998), so that the cap leaves the
    border as the surface arrives there. Rows of vertices from the border inwards; the border and what lies outside it
    stay."""
    border = rows[0]
    count = len(border)
    inside = np.array([[vert.co[:] for vert in row] for row in rows[1:]])
    fixed = np.array([vert.co[:] for vert in border])
    # One row outside the border: where the surface comes from.
    new = {vert for row in rows[1:] for vert in row} | {top}
    beside = []
    for vert in border:
        around = [edge.other_vert(vert).co for edge in vert.link_edges
                  if edge.other_vert(vert) not in new and edge.other_vert(vert) not in border]
        beside.append(sum(around[1:], around[0].copy()) / len(around) if around else vert.co)
    beside = np.array([co[:] for co in beside])
    size = np.linalg.norm(inside[0] - fixed, axis=1).mean()
    away = beside - fixed
    length = np.linalg.norm(away, axis=1, keepdims=True)
    beside = fixed + away * (size / np.maximum(length, 1e-30))
    grid = np.concatenate([beside[None], fixed[None], inside])
    peak = np.array(top.co[:])
    for _ in range(STEPS):
        full = np.concatenate([grid, np.broadcast_to(peak, (1, count, 3))])
        umbrella = np.zeros_like(full)
        umbrella[1:-1] = (full[:-2] + full[2:] + np.roll(full[1:-1], 1, axis=1) + np.roll(full[1:-1], -1, axis=1)
                          ) / 4 - full[1:-1]
        umbrella[-1] = grid[-1].mean(axis=0) - peak
        second = np.zeros_like(full)
        second[2:-1] = (umbrella[1:-2] + umbrella[3:] + np.roll(umbrella[2:-1], 1, axis=1)
                        + np.roll(umbrella[2:-1], -1, axis=1)) / 4 - umbrella[2:-1]
        grid[2:] -= 0.4 * second[2:-1]
        peak = peak - 0.4 * (umbrella[-2].mean(axis=0) - umbrella[-1][0])
    for row, places in zip(rows[1:], grid[2:]):
        for vert, place in zip(row, places):
            vert.co = place
    top.co = peak
