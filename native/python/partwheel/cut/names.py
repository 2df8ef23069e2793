# SPDX-License-Identifier: GPL-3.0-or-later
"""Names for the parts of a cut: mirror images of each other get .L and .R, parts that are alike a number in order."""

from __future__ import annotations

import ctypes
import hashlib
from typing import TYPE_CHECKING, List, Optional, Tuple

import numpy as np

from ..compatible import sample_triangles
from ..hierarchy import surface
from ..library import check, load

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

SAMPLES = 2048  # points on the surface
MIRRORED = 0.5  # of a part's points whose mirror images are on its counterpart
ALIKE = 0.2  # lengths differ by at most a fifth, nearly
# The surface that mirror_planes() was last called with, and its planes: one tuple, so threads never see half of a change.
_last: Tuple[Optional[List[bytes]], np.ndarray] = (None, np.empty((0, 4)))


def mirror_planes(vertices: ArrayLike, triangles: ArrayLike) -> List[Tuple[np.ndarray, float]]:
    """[(normal (3,), offset), ...] the planes in which a surface is its own mirror image, at most three, the best
    first: see pw_mirror_planes in partwheel_edit.h. vertices (V,3), triangles (T,3). Raises PartwheelError."""
    global _last
    given = surface(vertices, triangles)[:4]
    key = [hashlib.blake2b(each).digest() for each in (given[0], given[2])]
    last = _last
    if last[0] != key:  # names and bones ask for the same
        planes, count = np.empty((3, 4)), ctypes.c_size_t()
        check(load().pw_mirror_planes(*given, planes, ctypes.byref(count)))
        last = _last = key, planes[:count.value]
    return [(plane[:3].copy(), float(plane[3])) for plane in last[1]]


def named(cut, vertices, triangles, faces, word="Part"):
    """[name, ...] of a cut's parts, each another one: "Part 2.L" and "Part 2.R" are mirror images of each other,
    "Part 3.001" and "Part 3.002" alike, "Part 4.L.001" both. Numbers go by size. L is the side towards +x; or, of a
    plane that faces another axis, the one towards the + of that.

    vertices (V,3), triangles (T,3), faces (T,) the source face of each: the surface that the hierarchy is of."""
    vertices, triangles = np.asarray(vertices, np.float64), np.asarray(triangles)
    labels = cut.labels[faces]
    corners = vertices[triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    size = np.bincount(labels, areas, len(cut))
    measures = np.array([_measures(corners[labels == part]) for part in range(len(cut))])
    middles = np.array([np.average(corners[labels == part].mean(axis=1), axis=0, weights=areas[labels == part] + 1e-300)
                        for part in range(len(cut))])
    image, normal = images(vertices, triangles, labels)
    image = {part: other for part, other in image.items() if part != other}
    names = [None] * len(cut)
    for number, kind in enumerate(_kinds(measures, size, image), 1):
        base = f"{word} {number}"
        units = _in_order([(part,) if part not in image else
                           tuple(sorted((part, image[part]), key=lambda each: -middles[each] @ normal))
                           for part in kind if part not in image or part < image[part]], middles)
        for place, unit in enumerate(units, 1):
            end = f".{place:03}" if len(units) > 1 else ""
            for part, side in zip(unit, (".L", ".R") if len(unit) == 2 else ("",)):
                names[part] = base + side + end
    return names


def images(vertices, triangles, labels):
    """({part: the part that is its mirror image}, the normal towards the left) by the plane across which the parts of the
    most area have another one as theirs. One that lies on both sides is its own. labels (T,) the part of each triangle."""
    corners = np.asarray(vertices, np.float64)[triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    size = np.bincount(labels, areas)
    points, chosen = sample_triangles(corners, areas, SAMPLES)
    labels = labels[chosen]
    best, most = ({}, np.zeros(3)), 0.0
    for normal, offset in mirror_planes(vertices, triangles):
        votes = np.zeros((len(size), len(size)))
        reflected = points - 2 * np.outer(points @ normal - offset, normal)
        np.add.at(votes, (labels, labels[_nearest(reflected, points)]), 1)
        likely = votes.argmax(axis=1).tolist()
        image = {part: other for part, other in enumerate(likely) if likely[other] == part
                 and all(votes[a, b] > MIRRORED * votes[a].sum() for a, b in ((part, other), (other, part)))}
        area = sum(size[part] for part, other in image.items() if part != other)
        if area > most:
            best, most = (image, normal * np.sign(normal[abs(normal).argmax()])), area
    return best


def _nearest(points, others):
    """(n,) of each point the nearest of the others; by products of matrices, some at a time."""
    middle = others.mean(axis=0)
    points, others = (np.asarray(each - middle, np.float32) for each in (points, others))
    lengths = (others ** 2).sum(axis=1)
    return np.concatenate([(lengths - 2 * some @ others.T).argmin(axis=1) for some in np.array_split(points, 8)])


def _kinds(measures, size, image):
    """Lists of parts that are alike, the largest first. Mirror images always are."""
    kinds, seen = [], set()
    for part in sorted(range(len(size)), key=lambda part: (-size[part], part)):
        if part in seen:
            continue
        kind = np.flatnonzero(abs(measures - measures[part]).max(axis=1) < ALIKE).tolist()
        kind = {*kind, *(image[each] for each in kind if each in image)} - seen
        seen.update(kind)
        kinds.append(sorted(kind))
    return kinds


def _measures(corners):
    """(4,) logarithms of lengths by which the surfaces of two parts differ: the root of the area, and how far it
    extends along its principal axes. Unlike what partwheel.compatible measures they don't hang on the border, which in
    one cut ends each of two like parts a little elsewhere. corners (T,3,3)."""
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    total = max(areas.sum(), 1e-300)
    away = corners - (areas @ corners.mean(axis=1)) / total
    sums = away.sum(axis=1)
    moments = np.einsum("t,tki,tkj->ij", areas, away, away) + np.einsum("t,ti,tj->ij", areas, sums, sums)
    return np.log(np.sqrt(np.maximum([total, *np.linalg.eigvalsh(moments / (12 * total))], 1e-300)))


def _in_order(units, middles):
    """Along the line on which they lie."""
    places = np.array([middles[list(unit)].mean(axis=0) for unit in units])
    along = np.linalg.svd(places - places.mean(axis=0))[2][0] if len(units) > 1 else np.ones(3)
    along = along * np.sign(along[abs(along).argmax()])
    return [units[number] for number in np.argsort(places @ along, kind="stable")]
