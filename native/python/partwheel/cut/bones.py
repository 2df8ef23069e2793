# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones for the parts of a cut: where each begins and ends."""

from typing import NamedTuple

import numpy as np

from ..deform import surface_distances
from ..weld import weld_surface
from .borders import Link, from_root
from .hinges import hinge

END = 0.9  # what lies beyond this share of the way to a part's farthest point is its end
BESIDE = 0.5  # borders nearer than this share, or so much smaller than another one, don't end a bone
LEAST = 1e-3  # of the model's size: no bone is shorter
NEAR, ALONG = 0.1, 0.5  # a root's bone is put into a mirror plane that is so near, in its lengths, and so nearly along it


class Bone(NamedTuple):
    """head, tail (3,); parent: the part whose bone it hangs on, -1 for the root's; connected: it begins where that
    ends."""

    head: np.ndarray
    tail: np.ndarray
    parent: int
    connected: bool


def bones(vertices, triangles, labels, tree, weights, planes=()):
    """[Bone, ...] for each part. It begins in the middle of the border by which the part hangs on another, where its
    hinge is best, a loose piece's in its own middle; and ends in the next border, in the middle of those that end the
    part together (the fingers' of a hand), or where the part is farthest away. The root's goes through the part from end
    to end, up or towards the + of the axis that it follows most; with one part alone that hangs on it, towards that.

    vertices (V,3), triangles (T,3), labels (T,) the part of each triangle, tree: the parts' Links. weights: theirs, with
    which they are to be bent, as weights() gives them. planes: the model's mirror_planes(), in which the root's bone lies
    if it may."""
    vertices = np.asarray(vertices, np.float64)
    tree = _with_hinges(vertices, triangles, tree, weights)
    _, triangles = weld_surface(vertices, triangles)
    low, high = (end(vertices[triangles], axis=(0, 1)) for end in (np.min, np.max))
    least = LEAST * np.linalg.norm(high - low)
    shapes = [_Shape(vertices, triangles[labels == part]) for part in range(len(tree))]
    ends = []
    for part, (shape, link) in enumerate(zip(shapes, tree)):
        below = [other.border for other in tree if other.parent == part and other.border]
        if link.border:
            head, tail = link.border.center, shape.beyond(link.border, below)
        elif link.parent >= 0:
            head, tail = shape.middle, shape.along(shape.middle, shape.middle - shapes[link.parent].middle)
        elif len(below) == 1:
            head, tail = shape.beyond(below[0], []), below[0].center
        else:
            head, tail = _in_plane(*shape.through(), planes)
        length = np.linalg.norm(tail - head)
        if length < least:
            tail = head + ((tail - head) / length if length > 0 else np.array([0.0, 0.0, 1.0])) * least
        ends.append((head, tail))
    joined = [link.parent >= 0 and bool(np.linalg.norm(ends[link.parent][1] - head) < least)
              for (head, _), link in zip(ends, tree)]
    return [Bone(*each, link.parent, connected) for each, link, connected in zip(ends, tree, joined)]


def _with_hinges(vertices, triangles, tree, weights):
    """The Links, whose borders have their hinges as their centers."""
    shares = np.zeros((len(tree), len(vertices)))  # what turns with each part: its own weights, and of all that hangs on it
    found = list(tree)
    for part in from_root(tree)[::-1]:
        own, values = weights[part]
        shares[part, own] += values
        parent, border = tree[part]
        if parent >= 0:
            shares[parent] += shares[part]
        if border:
            found[part] = Link(parent, border._replace(center=hinge(vertices, triangles, border, shares[part])))
    return found


def _in_plane(head, tail, planes):
    """The bone, put into the first plane that it nearly lies in. What is left on the root of a limb leads it astray."""
    way, middle = tail - head, (head + tail) / 2
    length = np.linalg.norm(way)
    for normal, offset in planes:
        if abs(middle @ normal - offset) <= NEAR * length and abs(way @ normal) <= ALONG * length:
            return tuple(end - (end @ normal - offset) * normal for end in (head, tail))
    return head, tail


class _Shape:
    """The surface of one part."""

    def __init__(self, vertices, triangles):
        used, self.triangles = np.unique(triangles, return_inverse=True)
        self.number = {vertex: place for place, vertex in enumerate(used.tolist())}
        self.vertices, self.triangles = vertices[used], self.triangles.reshape(-1, 3)
        self.corners = self.vertices[self.triangles]
        sides = self.corners[:, 1:] - self.corners[:, :1]
        self.areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) + 1e-300
        self.middle = np.average(self.corners.mean(axis=1), axis=0, weights=self.areas)

    def along(self, start, way):
        """The farthest that the part reaches from there on a way."""
        length = np.linalg.norm(way)
        return start if length == 0 else start + way / length * max(((self.vertices - start) @ way).max() / length, 0)

    def beyond(self, border, others):
        """Where a bone ends that begins at a border: at others that lie that far, or at the part's end."""
        away = surface_distances(self.vertices, self.triangles, self._of(border))
        known = np.isfinite(away)
        if not known.all():  # loose pieces, by the straight way
            away = np.where(known, away, np.linalg.norm(self.vertices - border.center, axis=1))
        far = [other for other in others if away[self._of(other)].mean() >= BESIDE * away.max()]
        wide = [other for other in far if other.radius >= BESIDE * max(each.radius for each in far)]
        if wide:
            return np.average([other.center for other in wide], axis=0, weights=[other.length for other in wide])
        reach = away[self.triangles].mean(axis=1)
        end = reach >= END * reach.max()
        middle = np.average(self.corners[end].mean(axis=1), axis=0, weights=self.areas[end])
        return self.along(border.center, middle - border.center)

    def through(self):
        """(head, tail): its two ends, by the way on which it is longest."""
        away = self.corners - self.middle
        sums = away.sum(axis=1)
        moments = np.einsum("t,tki,tkj->ij", self.areas, away, away) + np.einsum("t,ti,tj->ij", self.areas, sums, sums)
        way = np.linalg.eigh(moments)[1][:, -1]
        way = way * np.sign(way[abs(way).argmax()])
        return self.along(self.middle, -way), self.along(self.middle, way)

    def _of(self, border):
        return [self.number[vertex] for vertex in border.vertices.tolist()]
