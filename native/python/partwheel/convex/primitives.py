# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes, spheres, capsules and cylinders in place of convex hulls: engines are several times faster on them.

Each is fitted around its hull, which it contains. How far it reaches beyond it is exact, but for a cylinder's, which is at
most 0.2 % of its radius too much. Capsules and cylinders are searched for from a few directions: good ones, not the best."""

from functools import cached_property
from itertools import combinations
from typing import NamedTuple

import numpy as np

KINDS = "sphere", "capsule", "box", "cylinder"  # the one that engines are fastest on first
AS_GOOD = 0.1  # of what is allowed: a kind that is so much worse than the best is taken where it is faster
WORTH_A_SEARCH = 4  # times what is allowed: where directions begin that are improved
STEPS = 8  # of such a search, each half as far as the one before
MOST_SIDES = 200  # of a hull that are tried as a box's
SIDES, RINGS = 16, 8  # of round meshes
ON_CIRCLE = 64  # points that a cylinder's edge is bounded by


class Primitive(NamedTuple):
    """kind: one of KINDS. center (3,). axes (3,3): its own x, y and z as columns, a rotation; capsules and cylinders lie
    along z. half (3,): half its lengths along them, a capsule's with its ends."""

    kind: str
    center: np.ndarray
    axes: np.ndarray
    half: np.ndarray

    def matrix(self):
        """(4,4) its own space in the hull's."""
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = self.axes, self.center
        return matrix

    def mesh(self):
        """(vertices, triangles) in its own space, closed, outward, of the same bounding box."""
        if self.kind == "box":
            vertices = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * self.half
            sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
            return vertices, np.array([three for a, b, c, d in sides for three in ((a, b, c), (a, c, d))])
        radius, half = self.half[0], self.half[2]
        if self.kind == "cylinder":
            rings = [(radius, -half), (radius, half)]
        else:
            turns = np.linspace(-np.pi / 2, np.pi / 2, RINGS + 1)[1:-1]
            straight = half - radius
            rings = [(radius * np.cos(turn), radius * np.sin(turn) + (straight if turn > 0 else -straight))
                     for turn in turns]
            if straight > 0:
                rings.insert(RINGS // 2, (radius, straight))
        around = _circle(SIDES)
        vertices = np.vstack([(0, 0, -half), *(np.column_stack([ring * around, np.full(SIDES, z)]) for ring, z in rings),
                              (0, 0, half)])
        i, j = np.arange(SIDES), np.roll(np.arange(SIDES), -1)
        last = len(vertices) - 1
        triangles = [np.column_stack([0 * i, 1 + j, 1 + i]), np.column_stack([last + 0 * i, last - SIDES + i, last - SIDES + j])]
        for ring in range(len(rings) - 1):
            low, high = 1 + ring * SIDES, 1 + (ring + 1) * SIDES
            triangles += [np.column_stack([low + i, low + j, high + j]), np.column_stack([low + i, high + j, high + i])]
        return vertices, np.vstack(triangles)

    def volume(self):
        radius, half = self.half[0], self.half[2]
        return {"box": 8 * self.half.prod(), "sphere": 4 / 3 * np.pi * radius ** 3,
                "capsule": np.pi * radius ** 2 * (2 * half - 2 / 3 * radius),
                "cylinder": 2 * np.pi * radius ** 2 * half}[self.kind]


def around(vertices, triangles, most, kinds=KINDS):
    """The Primitive, one of these kinds, to be taken in place of a convex hull: one that contains it and reaches beyond
    it by no more than most; the nearest to it, or a faster one that is hardly worse. None if there is none."""
    hull = _Hull(np.asarray(vertices, float), np.asarray(triangles))
    found = []
    for kind in KINDS:
        if kind in kinds:
            found.append(_FITS[kind](hull, most))
            if found[-1][0] <= AS_GOOD * most:
                break
    good = min(min((reach for reach, _ in found), default=0) + AS_GOOD * most, most)
    return next((made for reach, made in found if reach <= good), None)


def kind_of(shape):
    """Of a Primitive; "hull" of any other."""
    return getattr(shape, "kind", "hull")


class _Hull:
    """vertices (n,3), triangles (m,3) of a convex hull."""

    def __init__(self, vertices, triangles):
        self.vertices, self.size = vertices, np.ptp(vertices, axis=0).max()
        a, b, c = vertices[triangles].transpose(1, 0, 2)
        normals = np.cross(b - a, c - a)
        doubled = np.linalg.norm(normals, axis=1)
        kept = doubled > 1e-12 * doubled.max()  # others have no direction to speak of
        self.triangles, self.areas, self.normals = triangles[kept], doubled[kept] / 2, normals[kept] / doubled[kept, None]
        self.corners = vertices[self.triangles]
        self.offsets = (self.normals * self.corners[:, 0]).sum(axis=1)

    def beyond(self, points):
        """(n,) how far points are from the hull; inside, how far from its surface, negative."""
        heights = points @ self.normals.T - self.offsets
        found = heights.max(axis=1)
        # What is nearest to a point outside is on a facet that faces it; of facets in a plane rounding may turn some away.
        outside, facing = np.nonzero((found > 0)[:, None] & (heights > -1e-9 * self.size))
        if len(outside):
            away = _distances(points[outside], self.corners[facing], self.normals[facing])
            first = np.flatnonzero(np.diff(outside, prepend=-1))
            found[outside[first]] = np.minimum.reduceat(away, first)
        return found

    def axes(self):
        """(n,3) directions in which something long or round may lie."""
        middle = np.average(self.corners.mean(axis=1), axis=0, weights=self.areas)
        moments = np.einsum("t,tci,tcj->ij", self.areas, self.corners - middle, self.corners - middle)
        return np.vstack([np.linalg.eigh(moments)[1].T, self.box.T])

    @cached_property
    def box(self):
        """(3,3) the axes, as columns, of the smallest box of those that have a side in a facet."""
        return min(map(self._box_on, self._directions()), key=lambda found: found[0])[1]

    def _directions(self):
        """[(3,), ...] across the largest facets, none twice."""
        kept = []
        for normal in self.normals[np.argsort(-self.areas, kind="stable")[:MOST_SIDES]]:
            if not kept or np.abs(np.array(kept) @ normal).max() < 1 - 1e-9:
                kept.append(normal)
        return kept

    def _box_on(self, normal):
        """(volume, axes): the smallest with a side across the normal. Another side is along an edge of the outline."""
        flat = np.column_stack(_across(normal))
        facing = self.triangles[self.normals @ normal > 0]
        edges, counts = np.unique(np.sort(np.vstack([facing[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1), axis=0,
                                  return_counts=True)
        sides = np.diff(self.vertices[edges[counts == 1]], axis=1)[:, 0] @ flat
        lengths = np.linalg.norm(sides, axis=1)
        sides = sides[lengths > 1e-9 * lengths.max()] / lengths[lengths > 1e-9 * lengths.max(), None]
        seen = self.vertices @ flat
        areas = np.ptp(seen @ sides.T, axis=0) * np.ptp(seen @ (sides @ [[0, 1], [-1, 0]]).T, axis=0)
        best = int(areas.argmin())
        first = flat @ sides[best]
        return areas[best] * np.ptp(self.vertices @ normal), np.column_stack([first, np.cross(normal, first), normal])


# ---- Each answers (how far it reaches beyond the hull, the Primitive)


def _sphere(hull, _most):
    center, radius = _ball(hull.vertices)
    return radius + hull.beyond(center[None])[0], Primitive("sphere", center, np.eye(3), np.full(3, radius))


def _box(hull, _most):
    axes = hull.box
    own = hull.vertices @ axes
    low, high = own.min(axis=0), own.max(axis=0)
    made = Primitive("box", axes @ (low + high) / 2, axes, (high - low) / 2)
    corners = made.mesh()[0] @ axes.T + made.center
    return max(hull.beyond(corners).max(), 0.0), made


def _capsule(hull, most):
    return _searched(hull, most, _capsule_along)


def _cylinder(hull, most):
    return _searched(hull, most, _cylinder_along)


_FITS = {"sphere": _sphere, "capsule": _capsule, "box": _box, "cylinder": _cylinder}


def _searched(hull, most, along):
    """The best from some directions, and if that is promising, from others nearer and nearer about it."""
    best = min((along(hull, axis) for axis in hull.axes()), key=lambda found: found[0])
    step = 0.2
    for _ in range(STEPS if best[0] <= WORTH_A_SEARCH * most else 0):
        axis = best[1].axes[:, 2]
        x, y = _across(axis)
        for way in (x, y, -x, -y):
            turned = axis + step * way
            best = min(best, along(hull, turned / np.linalg.norm(turned)), key=lambda found: found[0])
        step /= 2
    return best


def _capsule_along(hull, axis):
    axes, middle, radius, heights, away = _about(hull, axis)
    short = np.sqrt(np.maximum(radius ** 2 - away ** 2, 0))  # how far its round end reaches beyond its middle there
    low, high = (heights + short).min(), (heights - short).max()
    if low > high:
        low = high = (low + high) / 2
    center = axes @ np.array([*middle, (low + high) / 2])
    ends = center + np.outer([-1, 1], (high - low) / 2 * axis)
    half = np.array([radius, radius, radius + (high - low) / 2])
    return radius + hull.beyond(ends).max(), Primitive("capsule", center, axes, half)


def _cylinder_along(hull, axis):
    axes, middle, radius, heights, _ = _about(hull, axis)
    low, high = heights.min(), heights.max()
    edge = middle + radius / np.cos(np.pi / ON_CIRCLE) * _circle(ON_CIRCLE)
    points = np.vstack([np.column_stack([edge, np.full(ON_CIRCLE, z)]) for z in (low, high)]) @ axes.T
    made = Primitive("cylinder", axes @ np.array([*middle, (low + high) / 2]), axes,
                     np.array([radius, radius, (high - low) / 2]))
    return max(hull.beyond(points).max(), 0.0), made


def _about(hull, axis):
    """(axes, where the smallest circle about all as seen along the axis has its middle, its radius, heights (n,), how far
    away from the middle (n,))"""
    axes = np.column_stack([*_across(axis), axis])
    own = hull.vertices @ axes
    middle, radius = _ball(own[:, :2])
    return axes, middle, radius, own[:, 2], np.linalg.norm(own[:, :2] - middle, axis=1)


# ---- Geometry


def _across(axis):
    """Two directions that make a right-handed frame with it."""
    x = np.cross(np.eye(3)[np.abs(axis).argmin()], axis)
    x /= np.linalg.norm(x)
    return x, np.cross(axis, x)


def _circle(count):
    turns = 2 * np.pi * np.arange(count) / count
    return np.column_stack([np.cos(turns), np.sin(turns)])


def _ball(points):
    """(center, radius) of the smallest ball, or circle, about points (n,d). The farthest point joins those that it
    stands on, of which the smallest ball is tried out, as long as one is outside: it grows each time."""
    held = points[:1]
    center, radius = held[0], 0.0
    while True:
        away = np.linalg.norm(points - center, axis=1)
        far = int(away.argmax())
        if away[far] <= radius * (1 + 1e-12):
            return center, radius
        held = np.vstack([held, points[far]])
        best = None
        for count in range(2, points.shape[1] + 2):
            for chosen in combinations(range(len(held) - 1), count - 1):
                on = held[[*chosen, -1]]
                middle = _equally_far(on)
                most = np.linalg.norm(held - middle, axis=1).max()
                if best is None or most < best[1]:
                    best = middle, most, on
        if best[1] <= radius:  # no more than rounding
            return center, away[far]
        center, radius, held = best


def _equally_far(points):
    """The point between these that is as far from each."""
    sides = points[1:] - points[0]
    products = sides @ sides.T
    return points[0] + np.linalg.lstsq(2 * products, np.diag(products), rcond=None)[0] @ sides


def _distances(points, corners, normals):
    """(n,) from points (n,3) to triangles (n,3,3), one each."""
    found = np.full(len(points), np.inf)
    inside = np.ones(len(points), bool)
    for k in range(3):
        start, side = corners[:, k], corners[:, (k + 1) % 3] - corners[:, k]
        away = points - start
        share = np.clip((away * side).sum(axis=1) / (side * side).sum(axis=1), 0, 1)
        found = np.minimum(found, np.linalg.norm(away - share[:, None] * side, axis=1))
        inside &= (np.cross(side, away) * normals).sum(axis=1) >= 0
    return np.where(inside, ((points - corners[:, 0]) * normals).sum(axis=1), found)
