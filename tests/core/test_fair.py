# SPDX-License-Identifier: GPL-3.0-or-later
"""Fairing: against the same sum of squares by dense algebra, on planes and spheres, and across a seam."""

import manifold3d
import numpy as np
from partwheel import fair_vertices


def edges_of(triangles):
    return np.unique(np.sort(np.asarray(triangles)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)


def grid(count=15, seed=0):
    """A flat square of triangles, its inner vertices moved about in the plane: (vertices, triangles)."""
    rng = np.random.default_rng(seed)
    x, y = np.divmod(np.arange(count * count), count)
    inner = (np.minimum(x, y) > 0) & (np.maximum(x, y) < count - 1)
    plane = np.stack([x, y], axis=1) + 0.25 * inner[:, None] * rng.uniform(-1, 1, (count * count, 2))
    a = np.arange(count * (count - 1)).reshape(-1, count)[:, :-1].ravel()
    triangles = np.concatenate([np.stack([a, a + count, a + 1], 1), np.stack([a + 1, a + count, a + count + 1], 1)])
    return np.column_stack([plane, np.zeros(count * count)]), triangles


def sphere(radius=1.0, place=(0, 0, 0), segments=96):
    return manifold3d.Manifold.sphere(radius, segments).translate(place)


def by_dense_algebra(vertices, edges, free):
    """The same least squares by numpy: one row a vertex, all of them."""
    rows = np.zeros((len(vertices), len(vertices)))
    degree = np.bincount(edges.ravel(), minlength=len(vertices))
    for a, b in edges.tolist():
        weight = 1 / np.linalg.norm(vertices[a] - vertices[b])
        for one, other in ((a, b), (b, a)):
            rows[one, other] += 2 * weight / degree[one]
            rows[one, one] -= 2 * weight / degree[one]
    places = vertices.copy()
    places[free] = np.linalg.lstsq(rows[:, free], -rows[:, ~free] @ vertices[~free], rcond=None)[0]
    return places


def test_fairing_minimizes_the_sum_of_squares():
    rng = np.random.default_rng(3)
    vertices, triangles = grid()
    vertices[:, 2] = rng.normal(0, 0.5, len(vertices))
    edges = edges_of(triangles)
    free = np.hypot(*(vertices[:, :2] - 7).T) < 4.5
    actual = fair_vertices(vertices, edges, free)
    assert np.abs(actual - by_dense_algebra(vertices, edges, free)).max() < 1e-8
    assert np.array_equal(actual[~free], vertices[~free])


def test_fairing_is_independent_of_unit_and_position():
    vertices, triangles = grid()
    vertices[:, 2] = np.sin(vertices[:, 0])
    edges, free = edges_of(triangles), np.hypot(*(vertices[:, :2] - 7).T) < 4.5
    actual = fair_vertices(vertices, edges, free)
    assert np.abs(fair_vertices(vertices * 1000 + 50, edges, free) - actual * 1000 - 50).max() < 1e-6
