# SPDX-License-Identifier: GPL-3.0-or-later
"""Fairing: against the same sum of squares by dense algebra, on planes and spheres, and across a seam."""

import manifold3d
import numpy as np
import pytest
from partwheel import PartwheelError, fair_vertices
from partwheel.hierarchy import Solid
from solid_checks import crossings


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


def test_is_the_least_sum_of_squares():
    rng = np.random.default_rng(3)
    vertices, triangles = grid()
    vertices[:, 2] = rng.normal(0, 0.5, len(vertices))
    edges = edges_of(triangles)
    free = np.hypot(*(vertices[:, :2] - 7).T) < 4.5
    actual = fair_vertices(vertices, edges, free)
    assert np.abs(actual - by_dense_algebra(vertices, edges, free)).max() < 1e-8
    assert np.array_equal(actual[~free], vertices[~free])


def test_a_bump_on_a_plane_is_gone():
    vertices, triangles = grid()
    free = np.hypot(*(vertices[:, :2] - 7).T) < 4.5
    bumpy = vertices.copy()
    bumpy[free, 2] = 1
    assert np.abs(fair_vertices(bumpy, edges_of(triangles), free)[:, 2]).max() < 1e-9


def test_neither_unit_nor_place_matter():
    vertices, triangles = grid()
    vertices[:, 2] = np.sin(vertices[:, 0])
    edges, free = edges_of(triangles), np.hypot(*(vertices[:, :2] - 7).T) < 4.5
    actual = fair_vertices(vertices, edges, free)
    assert np.abs(fair_vertices(vertices * 1000 + 50, edges, free) - actual * 1000 - 50).max() < 1e-6


def test_what_nothing_holds_stays():
    vertices, triangles = grid()
    vertices[:, 2] = np.sin(vertices[:, 0])
    everywhere = np.ones(len(vertices), bool)
    assert np.array_equal(fair_vertices(vertices, edges_of(triangles), everywhere), vertices)
    assert np.array_equal(fair_vertices(vertices, edges_of(triangles), ~everywhere), vertices)


@pytest.mark.parametrize("distance", [0.8, 1.2, 1.6])
def test_across_the_seam_of_a_union(distance):
    """Two spheres united by another library, with the slivers of a union: a crease becomes a neck."""
    one, other = sphere(), sphere(0.8, (distance, 0.1, 0.05))
    both = (one.as_original() + other.as_original()).to_mesh()
    vertices, triangles = both.vert_properties[:, :3].astype(float), both.tri_verts.astype(np.int64)
    on_one = np.abs(np.linalg.norm(vertices, axis=1) - 1)
    on_other = np.abs(np.linalg.norm(vertices - [distance, 0.1, 0.05], axis=1) - 0.8)
    seam = np.maximum(on_one, on_other) < 2e-3
    middle = vertices[seam].mean(axis=0)
    radius = np.linalg.norm(vertices[seam] - middle, axis=1).mean()
    near = np.linalg.norm(vertices[:, None] - vertices[seam], axis=2).min(axis=1) < 0.3 * radius
    actual = fair_vertices(vertices, edges_of(triangles), near)
    # Slivers aside, that is; none of them turns over, or the surface would cross itself.
    assert sharpest(actual, triangles, 1e-4) < 0.5 * sharpest(vertices, triangles, 1e-4)
    ends = np.repeat(np.arange(len(actual))[:, None], 2, axis=1)
    solid = Solid(actual, triangles.astype(np.int32), ends, np.zeros(len(triangles)), np.full(len(triangles), -1))
    assert crossings(solid) == 0


def sharpest(vertices, triangles, area=0.0):
    """The largest angle, in degrees, between triangles at an edge, of those that have at least this area."""
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normals, axis=1) / 2
    edge = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    order = np.lexsort(edge.T)
    a, b = (order.reshape(-1, 2) // 3).T
    large = (size[a] > area) & (size[b] > area)
    cosine = np.einsum("ij,ij->i", normals[a], normals[b]) / np.maximum(4 * size[a] * size[b], 1e-300)
    return np.degrees(np.arccos(np.clip(cosine[large], -1, 1))).max()


def test_errors():
    vertices, triangles = grid()
    edges, free = edges_of(triangles), np.zeros(len(vertices), bool)
    with pytest.raises(PartwheelError, match="edge"):
        fair_vertices(vertices, edges + len(vertices), free)
    vertices[0, 0] = np.nan
    with pytest.raises(PartwheelError, match="finite"):
        fair_vertices(vertices, edges, free)
    with pytest.raises(ValueError, match="free"):
        fair_vertices(vertices, edges, free[1:])
