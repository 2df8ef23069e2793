# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy as an index, against every tetrahedron and triangle: CGAL's exact tests, without a tree (every_pair.cpp)."""

import numpy as np
import pytest
from conftest import built
from every_pair import Everything, hulls_of, placed
from partwheel import Index

FEW, MANY = 60, 400  # queries


def spots(draw, everything, count):
    """Points about a model: anywhere, on its vertices, in the middle of its edges, on a lattice that its own may lie on."""
    low, high = everything.vertices.min(0), everything.vertices.max(0)
    margin = (high - low).max() / 5
    anywhere = draw.uniform(low - margin, high + margin, (count, 3))
    corners = draw.permutation(everything.vertices)[:count]
    facets = everything.vertices[draw.permutation(everything.facets)[:count]]
    lattice = low + draw.integers(-1, 10, (count, 3)) * (high - low) / 8
    return np.vstack([anywhere, corners, facets[:, :2].mean(1), facets.mean(1), lattice])


def check_points_and_rays(everything, index, draw, count):
    points = spots(draw, everything, count)
    size = np.ptp(everything.vertices, axis=0).max()
    located = index.locate(points)
    assert np.array_equal(located, everything.locate(points))

    parts, distances, nearest = index.nearest(points)
    inside = located >= 0
    assert np.array_equal(parts[inside], located[inside])
    assert (distances[inside] == 0).all() and np.array_equal(nearest[inside], points[inside])
    expected = everything.distances(points[~inside])
    assert distances[~inside] == pytest.approx(expected, rel=1e-9, abs=1e-12 * size)
    assert np.linalg.norm(nearest - points, axis=1) == pytest.approx(distances, rel=1e-9, abs=1e-12 * size)
    of_parts = [everything.distances(p[None], part)[0] for p, part in zip(nearest[~inside], parts[~inside])]
    assert np.max(of_parts, initial=0) <= 1e-12 * size

    origins = draw.permutation(points) + draw.normal(size=points.shape) * size * draw.choice([0, 1e-3, 3], (len(points), 1))
    directions = (draw.permutation(points) - origins) * 10.0 ** draw.integers(-3, 3, (len(points), 1))
    directions[:count, 0] = 0  # along a plane of the boxes
    directions[~directions.any(1)] = 0, 0, 1
    parts, distances = index.first_hits(origins, directions)
    bodies, expected = everything.hits(origins, directions)
    # Along a facet, or past its very edge, rounding decides: it may meet what is there, or shaken a little it has both answers.
    close = 1e-9 * size / np.linalg.norm(directions, axis=1)
    unlike = (parts < 0) != (bodies < 0)
    unlike |= ~unlike & (parts >= 0) & ~(np.abs(distances - np.where(bodies < 0, 0, expected)) <= close + 1e-9 * distances)
    for ray in np.flatnonzero(unlike & ~((parts >= 0) & (distances < expected))):
        shaken = [everything.hits(origins[ray:ray + 1] + 1e-9 * size * shake, directions[ray:ray + 1])[1][0]
                  for shake in draw.normal(size=(200, 1, 3))]
        actual = distances[ray] if parts[ray] >= 0 else np.inf
        assert np.isclose(shaken, actual, rtol=1e-5, atol=1e4 * close[ray]).any()
    assert unlike.mean() < 0.1
    hit = parts >= 0
    places = origins[hit] + distances[hit, None] * directions[hit]
    of_parts = [everything.distances(p[None], part)[0] for p, part in zip(places, parts[hit])]
    assert np.max(of_parts, initial=0) <= 1e-9 * max(size, np.abs(origins - everything.vertices.mean(0)).max())
    assert hit.sum() > count / 2


def test_points_and_rays_to_the_tetrahedra(case):
    shape, hierarchy = case
    check_points_and_rays(Everything.of_tetrahedra(hierarchy), Index(hierarchy), np.random.default_rng(1), FEW)


@pytest.mark.parametrize("name", ["L", "star", "three cubes apart", "hand.off"])
@pytest.mark.parametrize("parts", [1, 4])
def test_points_and_rays_to_the_hulls(name, parts):
    _, hierarchy = built(name)
    bounds = hierarchy.cut_parts(parts)
    check_points_and_rays(hulls_of(hierarchy, bounds), Index(hierarchy, bounds), np.random.default_rng(2), FEW)


def check_touch(first, second, index, other, draw, count):
    """At random places, most of which are near each other; some turned, scaled, mirrored, sheared."""
    matrices = placed(draw, first.vertices, second.vertices, count)
    parts, points = index.intersects(other, matrices)
    expected = first.touch(second, matrices)
    assert np.array_equal(parts[:, 0] >= 0, expected) and np.array_equal(parts[:, 1] >= 0, expected)
    assert 5 < expected.sum() < count - 5
    size = np.ptp(first.vertices, axis=0).max()
    for (a, b), point, matrix in zip(parts[expected], points[expected], matrices[expected]):
        mapped_back = np.linalg.solve(matrix[:, :3], point - matrix[:, 3])
        for everything, p, part in ((first, point, a), (second, mapped_back, b)):
            assert everything.distances(p[None], part)[0] <= 1e-9 * size or everything.holds(p, part)


@pytest.mark.parametrize("names", [("L", "jack"), ("box with a cavity", "tetrahedron"), ("three cubes apart", "star"),
                                   ("torus", "torus"), ("hand.off", "cube")])
@pytest.mark.parametrize("level", [False, True], ids=["tetrahedra", "hulls"])
def test_touching_parts_intersect_in_their_contact(names, level):
    hierarchies = [built(name)[1] for name in names]
    bounds = [h.cut_parts(min(5, len(h.tetrahedra))) if level else None for h in hierarchies]
    everything = [hulls_of(h, b) if level else Everything.of_tetrahedra(h) for h, b in zip(hierarchies, bounds)]
    index, other = (Index(h, b) for h, b in zip(hierarchies, bounds))
    check_touch(*everything, index, other, np.random.default_rng(3), MANY)


def test_touching_at_a_point_an_edge_a_face_and_inside():
    index = Index(built("cube")[1])
    matrices = np.tile(np.eye(4), (7, 1, 1))
    matrices[:, :3, 3] = [(1, 1, 1), (1, 1, 0.5), (1, 0.5, 0.25), (1 + 2e-16 * 2, 0, 0), (0.25, 0.25, 0.25), (-2, -2, -2), (0, 0, 0)]
    matrices[4, :3, :3] *= 0.5  # inside
    matrices[5, :3, :3] *= 5    # around
    parts, points = index.intersects(index, matrices)
    assert (parts[:, 0] >= 0).tolist() == (parts[:, 1] >= 0).tolist() == [True, True, True, False, True, True, True]
    assert points[0].tolist() == [1, 1, 1] and points[3].tolist() == [0, 0, 0]
    # In a cavity nothing touches, though the hull's index says so.
    hollow, hierarchy = built("box with a cavity")[1], built("cube")[1]
    small = np.array([[[0.5, 0, 0, 1.25], [0, 0.5, 0, 1.25], [0, 0, 0.5, 1.25]]])
    assert Index(hollow).intersects(Index(hierarchy), small)[0].tolist() == [[-1, -1]]
    assert Index(hollow, hollow.cut_parts(1)).intersects(Index(hierarchy), small)[0][0, 0] == 0
