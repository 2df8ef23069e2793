# SPDX-License-Identifier: GPL-3.0-or-later
"""Rays, against one that tries every triangle in numpy."""

import numpy as np
import pytest
import shapes
from partwheel import RayTarget
from scipy.spatial import ConvexHull


def every(vertices, triangles, origin, direction, min_distance=0.0):
    """(triangle, distance) by Cramer's rule, or None."""
    a, b, c = (vertices[triangles[:, k]] - origin for k in range(3))
    normal = np.cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (normal * a).sum(1) / (normal @ direction)
        place = distance[:, None] * direction
        inside = np.all([(np.cross(q - p, place - p) * normal).sum(1) >= 0
                         for p, q in ((a, b), (b, c), (c, a))], axis=0)
    hits = np.flatnonzero(inside & (distance > min_distance))
    return (hits[np.argmin(distance[hits])], distance[hits].min()) if len(hits) else None


@pytest.mark.parametrize("shuffled", shapes.lighter((False, True), 1))
def test_hits_match_a_search_over_all_triangles(shuffled):
    draw = np.random.default_rng(1)
    vertices, triangles, *_ = shapes.off("homer")
    triangles = draw.permutation(triangles) if shuffled else triangles
    target, middle, size = RayTarget(vertices, triangles), vertices.mean(0), np.ptp(vertices, axis=0).max()
    met = 0
    for _ in range(300):
        origin = middle + draw.normal(size=3) * size * draw.choice([0.1, 2])
        direction = (middle + draw.normal(size=3) * size / 4 - origin) * 10.0 ** draw.integers(-3, 3)
        min_distance = 0.0
        for _ in range(4):  # and what is behind it
            hit, expected = target.first_hit(origin, direction, min_distance), every(vertices, triangles, origin, direction, min_distance)
            assert (hit is None) == (expected is None)
            if not hit:
                break
            assert hit == (expected[0], pytest.approx(expected[1], rel=1e-9))
            min_distance, met = hit[1] * (1 + 1e-9), met + 1
    assert met > 300


def test_no_ray_passes_between_triangles():
    """From inside a convex surface through its edges and vertices, wherever it is."""
    draw = np.random.default_rng(2)
    points = draw.normal(size=(2000, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    triangles = ConvexHull(points).simplices
    edges = np.unique(np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]]]), axis=1), axis=0)
    for middle in ((0, 0, 0), (1e3, -7, 1e-3), (0.1, 0.2, 0.3)):
        vertices = points + middle
        target = RayTarget(vertices, triangles)
        for towards in np.vstack([vertices, vertices[edges].mean(1)]):
            hit = target.first_hit(middle, towards - middle)
            assert hit and hit[1] == pytest.approx(1, rel=1e-6)
