# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy as an index, against every tetrahedron and triangle: CGAL's exact tests, without a tree (every_pair.cpp)."""

import numpy as np
import pytest
import shapes
from conftest import built
from every_pair import Everything, hulls_of, placed
from partwheel import Hierarchy, Index, Mode, PartwheelError, Status

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
def test_where_two_touch(names, level):
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


@pytest.mark.parametrize("scale, offset", [(1e-60, 0), (1e60, 0), (1.0, 1e6)])
def test_units_and_places_do_not_matter(scale, offset):
    shape = shapes.moved(shapes.off("hand"), (offset, -offset, offset / 2), scale)
    hierarchy, plain = Hierarchy.build(*shape, mode=Mode.PAPER), built("hand.off", Mode.PAPER)[1]
    draw = np.random.default_rng(4)
    points = draw.uniform(plain.vertices.min(0), plain.vertices.max(0), (500, 3))
    moved = points * scale + (offset, -offset, offset / 2)
    index, plain_index = Index(hierarchy), Index(plain)
    (parts, distances, _), (_, expected, _) = index.nearest(moved), plain_index.nearest(points)
    assert ((parts >= 0) & (distances == 0)).tolist() == (expected == 0).tolist()
    assert distances / scale == pytest.approx(expected, rel=1e-6, abs=1e-9)
    directions = draw.normal(size=points.shape)
    hits, expected = index.first_hits(moved, directions * scale), plain_index.first_hits(points, directions)
    assert (hits[0] >= 0).tolist() == (expected[0] >= 0).tolist() and hits[1] == pytest.approx(expected[1], rel=1e-6, abs=1e-9)


def test_the_same_on_each_run_with_threads_and_after_saving():
    _, hierarchy = built("hand.off")
    draw = np.random.default_rng(5)
    points, directions = draw.uniform(-1, 1, (5000, 3)), draw.normal(size=(5000, 3))
    matrices = placed(draw, hierarchy.vertices, hierarchy.vertices, 600)
    answers = []
    for index in (Index(hierarchy, threads=1), Index(Hierarchy.load(hierarchy.save()), threads=3)):
        answers.append([index.locate(points), *index.first_hits(points, directions), *index.nearest(points),
                        *index.intersects(index, matrices)])
    for one, other in zip(*answers):
        assert np.array_equal(one, other)


def test_parts_of_a_cut_by_their_tetrahedra():
    """What an exact answer is in: the nodes above its leaf, and a part of any cut."""
    _, hierarchy = built("hand.off")
    draw = np.random.default_rng(6)
    low, high = hierarchy.vertices.min(0), hierarchy.vertices.max(0)
    middles = hierarchy.vertices[hierarchy.tetrahedra].mean(axis=1)  # of small parts, too
    points = np.concatenate([draw.uniform(low, high, (2000, 3)), middles])
    tetrahedra = Index(hierarchy).locate(points)
    points, tetrahedra = points[tetrahedra >= 0], tetrahedra[tetrahedra >= 0]
    bounds = hierarchy.cut_automatic()
    parts = np.searchsorted(bounds, tetrahedra, "right") - 1
    hulls = Index(hierarchy, bounds).locate(points)
    assert (hulls <= parts).all() and (hulls >= 0).all()  # a part's hull holds what the part does
    assert len(np.unique(parts)) == len(bounds) - 1


def test_nothing_and_nonsense():
    _, hierarchy = built("L")
    index = Index(hierarchy)
    none = np.empty((0, 3))
    assert len(index.locate(none)) == len(index.first_hits(none, none)[0]) == len(index.nearest(none)[0]) == 0
    assert len(index.intersects(index, np.empty((0, 4, 4)))[0]) == 0
    good = np.zeros((2, 3))
    for bad in (np.nan, np.inf, 1e101):
        wrong = np.array([[0, 0, 0], [0, bad, 0]])
        matrix = np.eye(4)[None].copy()
        matrix[0, 1, 3] = bad
        for ask in (lambda: index.locate(wrong), lambda: index.nearest(wrong), lambda: index.first_hits(wrong, good + 1),
                    lambda: index.first_hits(good, wrong), lambda: index.intersects(index, matrix)):
            with pytest.raises(PartwheelError) as refused:
                ask()
            assert refused.value.status == Status.NOT_FINITE and str(refused.value).endswith(".")
    for ask in (lambda: index.first_hits(good, good), lambda: index.intersects(index, np.zeros((1, 4, 4)))):
        with pytest.raises(PartwheelError) as refused:
            ask()
        assert refused.value.status == Status.NOT_FINITE
    count = len(hierarchy.tetrahedra)
    for bounds in ([0], [0, count + 1], [0, count, count], [1, count], [0, -1, count], [0, 2, 1, count], [5]):
        with pytest.raises(PartwheelError) as refused:
            Index(hierarchy, np.array(bounds))
        assert refused.value.status == Status.ARGUMENT
    with pytest.raises(ValueError):
        index.locate(np.zeros(3))
    with pytest.raises(ValueError):
        index.first_hits(good, good[:1])
    with pytest.raises(ValueError):
        index.intersects(index, np.eye(4))
