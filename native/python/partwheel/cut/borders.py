# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the parts of a surface meet: their borders, the tree of parts that hangs together by them, and weights that go
from one part to the next across them."""

from typing import NamedTuple

import numpy as np

from ..deform import surface_distances
from ..joint import MAX_REACH_FRACTION, edge_components
from ..weld import weld_surface
from .names import images

REACH = 2.0  # radii of a border in which weights fall, on either side: joints bend best so, see docs/bones.md


class Border(NamedTuple):
    """One connected group of edges between two parts, parts[0] < parts[1]. vertices (n,) of it; center (3,); radius:
    the mean distance from there; length of its edges."""

    parts: tuple
    vertices: np.ndarray
    center: np.ndarray
    radius: float
    length: float


class Link(NamedTuple):
    """What a part hangs on: another part, -1 for the root's; and by which Border, None for a loose piece."""

    parent: int
    border: Border


def borders(vertices, triangles, labels):
    """The Borders of a surface's parts, sorted by parts, the longest first. vertices (V,3), triangles (T,3); labels
    (T,) the part of each triangle. Coincident vertices are welded."""
    vertices, (_, triangles) = np.asarray(vertices), weld_surface(vertices, triangles)
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    sides = np.unique(np.column_stack([edges, np.repeat(labels, 3)]), axis=0)  # ends of an edge, a part at it
    sides = sides[sides[:, 0] != sides[:, 1]]
    shared = np.flatnonzero((sides[1:, :2] == sides[:-1, :2]).all(axis=1))
    edges, pairs = sides[shared, :2], np.column_stack([sides[shared, 2], sides[shared + 1, 2]])
    found = []
    for pair in np.unique(pairs, axis=0):
        own = edges[(pairs == pair).all(axis=1)]
        loop = edge_components(own)
        found += [_border(vertices, pair, own[loop == number]) for number in range(loop.max() + 1)]
    return sorted(found, key=lambda border: (border.parts, -border.length))


def _border(vertices, pair, edges):
    a, b = vertices[edges[:, 0]], vertices[edges[:, 1]]
    length = np.linalg.norm(b - a, axis=1)
    weight = length if length.sum() > 0 else None
    center = np.average((a + b) / 2, axis=0, weights=weight)
    radius = np.average(np.linalg.norm((a + b) / 2 - center, axis=1), weights=weight)
    return Border(tuple(pair.tolist()), np.unique(edges), center, float(radius), float(length.sum()))


def tree(cut, vertices, triangles, labels, middles=None):
    """The Links of a cut's parts on the surface that it is of. labels (T,) the part of each triangle. middles
    (parts,3): see links(); the means of their triangles unless given."""
    if middles is None:
        middles = np.array([vertices[triangles[labels == part]].mean(axis=(0, 1)) for part in range(len(cut))])
    central = {part for part, image in images(vertices, triangles, labels)[0].items() if part == image}
    return links(cut, borders(vertices, triangles, labels), middles, central)


def links(cut, found, middles, central=()):
    """The tree of parts, a Link for each: what the cut's own tree joins first hangs together, by the longest of the
    Borders found there. But first, parts on the plane of a symmetric model, central, hang together: neck and head on the
    trunk, not on an arm; and are as one for what hangs on them, on the one with the longest border. The root is the part
    with the most volume. middles (parts,3): a loose piece goes with the nearest of what it was joined with."""
    joined = list(range(len(cut)))

    def at(part):
        while joined[part] != part:
            part = joined[part]
        return part

    beside = [[] for _ in joined]

    def join(ways):
        for *_, (one, other), border in ways:
            if at(one) != at(other):
                joined[at(one)] = at(other)
                beside[one].append((other, border))
                beside[other].append((one, border))

    def apart(one, other):
        return float(np.linalg.norm(middles[one] - middles[other]))

    levels = [cut.joined_at(*border.parts) for border in found]
    sides = [frozenset(border.parts).difference(central) for border in found]  # of which none, one or two are not central
    first = {}
    for side, level in zip(sides, levels):
        first[side] = min(first.get(side, level), level)
    join(sorted(((bool(side), first[side] if len(side) == 1 else level, -border.length, number, border.parts, border)
                 for number, (border, side, level) in enumerate(zip(found, sides, levels))), key=lambda way: way[:4]))
    if len({at(part) for part in joined}) > 1:
        pairs = [(one, other) for one in range(len(cut)) for other in range(one) if at(one) != at(other)]
        join(sorted((cut.joined_at(*pair), apart(*pair), pair, None) for pair in pairs))
    root = max(range(len(cut)), key=cut.volume)
    tree, todo = {root: Link(-1, None)}, [root]
    for part in todo:
        for other, border in beside[part]:
            if other not in tree:
                tree[other] = Link(part, border)
                todo.append(other)
    return [tree[part] for part in range(len(cut))]


def from_root(hung):
    """The parts of a tree, each after what it hangs on."""
    order = [part for part, link in enumerate(hung) if link.parent < 0]
    for part in order:
        order += [other for other, link in enumerate(hung) if link.parent == part]
    return order


def weights(vertices, triangles, labels, count, reach=REACH):
    """[(vertices (n,), weights (n,)), ...] for each part, as groups for an armature: 1 within the part, falling
    smoothly to 0 beyond its borders, from as far on this side of each as on the other, within so many of its radii; but
    at most half way to the farthest point of either part. A vertex's weights add up to 1; those without a triangle have
    none. Coincident vertices are welded: each has the weights of the one.

    vertices (V,3), triangles (T,3), labels (T,) the part, of so many, of each triangle."""
    places, (same, triangles) = np.asarray(vertices, np.float64), weld_surface(vertices, triangles)
    own = np.full(len(places), -1)
    own[triangles.ravel()] = np.repeat(labels, 3)
    # Of each border: how much of the weight the other side has, on either side: a half at the border.
    beyond = []
    for border in borders(places, triangles, labels):
        start = np.zeros(len(places), bool)
        start[border.vertices] = True
        distance = surface_distances(places, triangles, start)
        depths = [distance[(own == part) & np.isfinite(distance)].max(initial=0) for part in border.parts]
        far = min(reach * border.radius, MAX_REACH_FRACTION * min(depths))
        near = np.flatnonzero(distance <= far)
        way = distance[near] / far if far > 0 else np.zeros(len(near))
        beyond.append((border.parts, near, 0.5 - way * way * (1.5 - way)))
    raw, total = [], np.zeros(len(places))
    for part in range(count):
        share = (own == part).astype(np.float64)
        for parts, near, other in beyond:
            if part in parts:
                ours = own[near] == part
                share[near] = np.where(ours, np.minimum(share[near], 1 - other), np.maximum(share[near], other))
        raw.append(share)
        total += share
    result = []
    for share in raw:
        share = (share / np.where(total > 0, total, 1))[same]
        chosen = np.flatnonzero(share)
        result.append((chosen, share[chosen]))
    return result
