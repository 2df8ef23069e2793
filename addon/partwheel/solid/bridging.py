# SPDX-License-Identifier: GPL-3.0-or-later
"""Caps for a part of a mesh that was filled from points: the facets that divide it inside. They end on its surface, near
the borders of the mesh's own polygons, and strips of triangles join the two."""

import bmesh
import numpy as np

from . import closing

NEAR = 1.0  # of a border's radius: borders are joined if they are no farther apart, in the mean, from either side
MOST = 0.5  # of the length of its borders that is to be joined, for a group of facets to be of use


def bridge(bm, facets):
    """Adds facets, (vertices (n,3), triangles (m,3) wound outwards), to a bmesh: each group of them of which most of the
    border has one of the bmesh's own to itself nearby. What its polygons there are a part of is turned as the facets
    are. The new faces. Other borders stay open: those of holes that only the filling closes are there, too."""
    own = closing.borders([edge for edge in bm.edges if edge.is_boundary])
    places, triangles = facets
    if not own or not len(triangles):
        return []
    groups = _groups(bm, places, triangles)
    rings = [(group, ring) for group, (_, borders) in enumerate(groups) for ring in borders]
    pairs = _pairs([_places(ring) for _, ring in rings], [_places(ring) for ring in own])
    joints, lengths = [[] for _ in groups], np.zeros((len(groups), 2))
    for (group, ring), border in zip(rings, pairs):
        lengths[group] += np.array([1, border is not None]) * _length(ring)
        if border is not None:
            joints[group].append((ring, own[border]))
    used = lengths[:, 1] > MOST * lengths[:, 0]
    _turn_pieces(bm, [joint for each, use in zip(joints, used) if use for joint in each])
    caps = []
    for (faces, _), each, use in zip(groups, joints, used):
        if not use or any(_run_alike(*joint) for joint in each):
            verts = dict.fromkeys(vert for face in faces for vert in face.verts)
            bmesh.ops.delete(bm, geom=list(verts), context="VERTS")
            continue
        caps += faces
        for ring, border in each:
            caps += _strip(bm, border, ring[::-1])
    return caps


def _turn_pieces(bm, joints):
    """Turns those pieces of the mesh of which most borders run as the facets' do: two that a strip can join never do.
    The borders, lists of vertices, are turned too."""
    pieces = {}  # the number of the first border of each piece -> (its faces, borders, votes)
    of, left = {}, set(bm.faces)
    for number, (ring, border) in enumerate(joints):
        if border[0] not in of:
            faces = closing.reached(border[0].link_faces[0], left, closing.around)
            pieces[number] = faces, [], []
            of.update((vert, number) for face in faces for vert in face.verts)
        _, borders, votes = pieces[of[border[0]]]
        borders.append(border)
        votes.append(len(border) if _run_alike(ring, border) else -len(border))
    for faces, borders, votes in pieces.values():
        if sum(votes) > 0:
            for face in faces:
                face.normal_flip()
            for border in borders:
                border.reverse()


def _groups(bm, places, triangles):
    """[(faces, borders), ...] of the new faces, those that are joined across edges together."""
    used, triangles = np.unique(triangles, return_inverse=True)
    verts = [closing.new_vert(bm, place) for place in places[used].tolist()]
    new = [bm.faces.new([verts[k] for k in triangle]) for triangle in triangles.reshape(-1, 3).tolist()]
    closing.set_apart(bm)
    return [(faces, closing.borders([edge for face in faces for edge in face.edges if edge.is_boundary]))
            for faces in closing.groups(new, closing.around)]


def _places(ring):
    return np.array([vert.co[:] for vert in ring])


def _length(ring):
    places = _places(ring)
    return np.linalg.norm(places - np.roll(places, 1, axis=0), axis=1).sum()


def _pairs(rings, own):
    """For each ring (n,3) which of the others it is to be joined with, or None; none with two."""
    chosen = []
    for ring in rings:
        apart = [_apart(ring, other) for other in own]
        best = int(np.argmin(apart))
        chosen.append(best if apart[best] < NEAR else None)
    return [None if choice is None or chosen.count(choice) > 1 else choice for choice in chosen]


def _apart(one, other):
    """Mean distance from each point of either to the nearest of the other, whichever is more, by the first's radius."""
    radius = np.linalg.norm(one - one.mean(axis=0), axis=1).mean()
    distance = np.linalg.norm(one[:, None] - other[None], axis=2)
    return max(distance.min(axis=0).mean(), distance.min(axis=1).mean()) / max(radius, 1e-30)


def _run_alike(one, other):
    """Whether two rings of vertices run the same way."""
    one, other = _places(one), _places(other)
    nearest = np.linalg.norm(one[:, None] - other[None], axis=2).argmin(axis=1)
    ahead, beyond = (np.roll(ring, -1, axis=0) - np.roll(ring, 1, axis=0) for ring in (one, other))
    return float(np.einsum("ij,ij->", ahead, beyond[nearest])) > 0


def _strip(bm, one, other):
    """Triangles between two rings of vertices that run the same way, along the first: those whose edges across are the
    shortest, together, of all that have the one between the nearest two (by dynamic programming, as Fuchs, Kedem and
    Uselton 1977 find those of least area)."""
    a, b = _places(one), _places(other)
    start = np.unravel_index(np.linalg.norm(a[:, None] - b[None], axis=2).argmin(), (len(a), len(b)))
    one, other = ([*ring[at:], *ring[:at], ring[at]] for ring, at in zip((one, other), start))
    faces, i, j = [], 0, 0
    for along in _along(np.linalg.norm(_places(one)[:, None] - _places(other)[None], axis=2)):
        if along:
            faces.append(bm.faces.new((one[i], one[i + 1], other[j])))
            i += 1
        else:
            faces.append(bm.faces.new((one[i], other[j + 1], other[j])))
            j += 1
    return faces


def _along(across):
    """The steps from the first to the last of across (n+1,m+1), True along the first axis and False along the second,
    for which the sum of what is passed is least."""
    n, m = np.array(across.shape) - 1
    # No edge across is there twice, though both rings end where they began: at most half of either lies before it.
    across = across.copy()
    across[0, m // 2 + 1:] = across[n, :m // 2 + 1] = np.inf
    across[n // 2 + 1:, 0] = across[:n // 2 + 1, m] = np.inf
    across[n, m] = 0
    least = np.full((n + 2, m + 2), np.inf)  # with a row and a column before
    least[1, 1] = 0
    for step in range(1, n + m + 1):  # all that are so many steps from the first
        i = np.arange(max(step - m, 0), min(step, n) + 1)
        j = step - i
        least[i + 1, j + 1] = np.minimum(least[i, j + 1], least[i + 1, j]) + across[i, j]
    steps, i, j = [], n, m
    while i or j:
        steps.append(bool(least[i, j + 1] <= least[i + 1, j]))
        i, j = (i - 1, j) if steps[-1] else (i, j - 1)
    return steps[::-1]
