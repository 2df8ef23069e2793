# SPDX-License-Identifier: GPL-3.0-or-later
"""What a UV map is worth, computed from places and UVs alone: islands, how much angles and areas differ, how much lies on
something else. numpy alone."""

from typing import NamedTuple

import numpy as np

WORST = 10.0  # a triangle counts at most so much
PIXELS = 2048  # of the map's longer side


class Measures(NamedTuple):
    """islands: how many. angle, area: by which factor a length differs from one across it, and an area from the others,
    on average over the surface; 1 at best. covered: the share of what the map covers that is covered more than once."""

    islands: int
    angle: float
    area: float
    covered: float


def measured(vertices, triangles, uv):
    """Measures. vertices (V,3), triangles (T,3), uv (T,3,2) of their corners."""
    angle, area = stretch(vertices, triangles, uv)
    return Measures(int(islands(triangles, uv).max()) + 1, angle, area, covered(uv))


def islands(triangles, uv):
    """(T,) the number of the island that each triangle is in: two that share an edge are in one if its ends have the same
    UVs in both."""
    sides = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    places = uv[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2, 2)
    turned = sides[:, 0] > sides[:, 1]
    sides = np.where(turned[:, None], sides[:, ::-1], sides)
    places = np.where(turned[:, None, None], places[:, ::-1], places)
    keys = np.column_stack([sides, np.round(places.reshape(-1, 4) * 2 ** 20)])
    of = np.unique(keys, axis=0, return_inverse=True)[1].ravel()
    order = np.argsort(of, kind="stable")
    same = np.flatnonzero(of[order][1:] == of[order][:-1])
    one, other = order[same] // 3, order[same + 1] // 3
    lowest = np.arange(len(triangles))
    while (lowest[one] != lowest[other]).any():
        least = np.minimum(lowest[one], lowest[other])
        for ends in (one, other):
            np.minimum.at(lowest, lowest[ends], least)
            np.minimum.at(lowest, ends, least)
        lowest = lowest[lowest]
    return np.unique(lowest, return_inverse=True)[1].ravel()


def stretch(vertices, triangles, uv):
    """(angle, area) of Measures: by the singular values of what takes each triangle to its UVs."""
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    ab, ac = b - a, c - a
    length, double = np.linalg.norm(ab, axis=1), np.linalg.norm(np.cross(ab, ac), axis=1)
    real = double > 1e-9 * double.max()
    ab, ac, length, double, uv = ab[real], ac[real], length[real], double[real], uv[real]
    plane = np.zeros((len(ab), 2, 2))
    plane[:, 0, 0], plane[:, 0, 1] = length, np.einsum("ij,ij->i", ab, ac) / length
    plane[:, 1, 1] = double / length
    flat = np.stack([uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]], axis=2)
    long, short = np.linalg.svd(flat @ np.linalg.inv(plane), compute_uv=False).T
    share = double / double.sum()
    factor = long * short / (share @ (long * short))
    angle = np.minimum(long / np.maximum(short, 1e-12), WORST)
    area = np.minimum(np.maximum(factor, 1 / np.maximum(factor, 1e-12)), WORST)
    return float(share @ angle), float(share @ area)


def covered(uv, pixels=PIXELS):
    """The share of covered pixels that have their middle in more than one triangle."""
    corners = (uv - uv.min(axis=(0, 1))) / np.ptp(uv, axis=(0, 1)).max() * pixels
    low, high = np.ceil(corners.min(axis=1) - 0.5).astype(int), np.floor(corners.max(axis=1) - 0.5).astype(int)
    count = np.zeros((pixels + 1, pixels + 1), np.int32)
    for (a, b, c), (x0, y0), (x1, y1) in zip(corners, low, high):
        x, y = np.arange(x0, x1 + 1)[:, None] + 0.5, np.arange(y0, y1 + 1)[None] + 0.5
        left = [(q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]) for p, q in ((a, b), (b, c), (c, a))]
        count[x0:x1 + 1, y0:y1 + 1] += np.all([signed > 0 for signed in left], axis=0) | np.all(
            [signed < 0 for signed in left], axis=0)
    return float((count > 1).sum() / max((count > 0).sum(), 1))
