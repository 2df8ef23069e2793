# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy's arrays and answers against what numpy and scipy compute from the input alone."""

import math

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, PartwheelError
from partwheel.cut import Cut
from scipy.spatial import ConvexHull
from solid_checks import triangle_areas

EXACT = 1e-9  # relative tolerance of sums of volumes


def tet_volumes(vertices, tetrahedra):
    a, b, c, d = (vertices[tetrahedra[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def enclosed_volume(shape):
    center = shape.vertices.mean(0)
    a, b, c = (shape.vertices[shape.triangles[:, i]] - center for i in range(3))
    return np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6


def slice_sums(values, first, last):
    total = np.concatenate([[0], np.cumsum(values)])
    return total[last] - total[first]


def hull_volume(h, first, last):
    return ConvexHull(h.vertices[np.unique(h.tetrahedra[first:last])]).volume


def merge_slices(h):
    """The slice of tetrahedra of each cluster of the unpruned tree: (2T - 1, 2). Fails if one is not contiguous."""
    count = len(h.tetrahedra)
    slices = [(i, i + 1) for i in range(count)]
    for a, b in h.merges:
        (low, middle), (other, high) = sorted((slices[a], slices[b]))
        assert middle == other
        slices.append((low, high))
    return np.array(slices)


def test_arrays_are_views_that_outlive_the_hierarchy(case):
    shape, _ = case
    h = Hierarchy.build(*shape)
    order, expected = h.order, h.order.copy()
    assert not order.flags.owndata and not order.flags.writeable
    with pytest.raises(ValueError):
        order[0] = 0
    with pytest.raises(ValueError):
        order.flags.writeable = True
    faces = h.faces(len(h.parent) - 1)
    del h
    assert np.array_equal(order, expected) and np.array_equal(faces, expected)


def test_tetrahedra_fill_the_surface(case):
    shape, h = case
    volumes = tet_volumes(h.vertices, h.tetrahedra)
    assert volumes.min() > 0
    solid = enclosed_volume(shape)
    assert math.isclose(volumes.sum(), solid, rel_tol=EXACT)
    assert math.isclose(h.summary.volume, solid, rel_tol=EXACT)
    assert math.isclose(h.volume[-1], solid, rel_tol=EXACT)
    assert math.isclose(h.summary.hull_volume, ConvexHull(shape.vertices).volume, rel_tol=EXACT)
    assert h.summary.added_vertices == (h.source == -1).sum()


def test_surface_is_kept_exactly(case):
    shape, h = case
    is_source = h.source >= 0
    assert np.array_equal(h.vertices[is_source], shape.vertices[h.source[is_source]])
    assert set(h.source[is_source]) == set(shape.triangles.ravel())
    facets = np.sort(h.source[h.tetrahedra][:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3))
    unique, counts = np.unique(facets, axis=0, return_counts=True)
    owners = dict(zip(map(tuple, unique), counts))
    assert all(owners[tuple(triangle)] == 1 for triangle in np.sort(shape.triangles))


def test_a_face_belongs_to_the_tetrahedron_behind_most_of_it(case):
    shape, h = case
    behind = {}
    for tet, corners in enumerate(h.source[h.tetrahedra]):
        for i in range(4):
            behind.setdefault(tuple(sorted(np.delete(corners, i))), []).append(tet)
    area = np.zeros((shape.face_count, len(h.tetrahedra)))
    for triangle, face, size in zip(shape.triangles, shape.faces, triangle_areas(*shape[:2])):
        (tet,) = behind[tuple(sorted(triangle))]
        area[face, tet] += size
    best = area.max(1)
    assert np.allclose(area[np.arange(shape.face_count), h.leaf], best, rtol=EXACT, atol=0)


def test_tree_is_nested_slices(case):
    shape, h = case
    nodes, tets = len(h.parent), len(h.tetrahedra)
    assert np.array_equal(np.sort(h.order), np.arange(shape.face_count))
    assert h.parent[-1] == -1 and (h.parent[:-1] > np.arange(nodes - 1)).all()
    assert (h.tet_first[-1], h.tet_last[-1], h.first[-1], h.last[-1]) == (0, tets, 0, shape.face_count)
    assert np.array_equal(h.tet_first[:tets], np.arange(tets)) and (h.tet_last[:tets] == np.arange(tets) + 1).all()
    for first, last in ((h.tet_first, h.tet_last), (h.first, h.last)):
        parent = h.parent[:-1]
        assert (first[:-1] >= first[parent]).all() and (last[:-1] <= last[parent]).all()
        inside = np.zeros(nodes, int)
        np.add.at(inside, parent, (last - first)[:-1])
        assert np.array_equal(inside[tets:], (last - first)[tets:])  # children fill their parent
    leaf_of_order = h.leaf[h.order]
    assert (np.diff(leaf_of_order) >= 0).all()
    assert np.array_equal(h.first, np.searchsorted(leaf_of_order, h.tet_first))
    assert np.array_equal(h.last, np.searchsorted(leaf_of_order, h.tet_last))


def test_children_are_the_nodes_whose_parent_it_is(case):
    _, h = case
    root = len(h.parent) - 1
    for node in {0, root // 2, max(root - 1, 0), root}:
        children = h.children(node)
        assert sorted(children) == np.flatnonzero(h.parent == node).tolist()
        assert list(children) == sorted(children, key=lambda child: h.tet_first[child])
        assert h.find_node(h.tet_first[node], h.tet_last[node]) == node
    for wrong in (-1, root + 1):
        with pytest.raises(PartwheelError):
            h.children(wrong)
    assert h.find_node(0, 0) is None


def test_repr_tells_sizes(build_shape):
    _, h = build_shape("cube")
    assert repr(h) == f"<Hierarchy of 6 faces: {len(h.parent)} nodes, {len(h.tetrahedra)} tetrahedra, exact>"
    cut = Cut.into(h, 2)
    assert repr(cut) == f"<Cut of {h!r} into 2 parts>" and repr(cut[1]) == f"<part 1 of {cut!r}>"


def test_volumes_and_areas_of_nodes(case):
    shape, h = case
    volumes = slice_sums(tet_volumes(h.vertices, h.tetrahedra), h.tet_first, h.tet_last)
    assert np.allclose(h.volume, volumes, rtol=1e-7, atol=EXACT * volumes[-1])
    face_area = np.bincount(shape.faces, triangle_areas(*shape[:2]), shape.face_count)
    areas = slice_sums(face_area[h.order], h.first, h.last)
    assert np.allclose(h.area, areas, rtol=1e-7, atol=EXACT * areas[-1])


def test_costs_are_equation_3(paper_case):
    _, h = paper_case
    tets = len(h.tetrahedra)
    assert not h.cost_class[:tets].any() and not h.cost[:tets].any() and not h.height[:tets].any()
    slices = merge_slices(h)
    merge_of = {tuple(bounds): merge for merge, bounds in enumerate(slices[tets:])}
    scale = h.summary.hull_volume
    for node in range(tets, len(h.parent)):
        bounds = h.tet_first[node], h.tet_last[node]
        concavity = hull_volume(h, *bounds) - h.volume[node]
        assert concavity >= -EXACT * scale
        assert abs(h.height[node] - concavity) <= 1e-7 * scale
        if h.cost_class[node]:
            assert h.cost[node] == h.height[node] > 0
        else:
            a, b = slices[h.merges[merge_of[bounds]]]
            assert h.height[node] == 0
            assert math.isclose(h.cost[node], (np.diff(a) ** 2 + np.diff(b) ** 2).item() / tets**2, rel_tol=1e-12)


def test_merges_are_one_binary_tree_and_the_dendrogram_prunes_it(case):
    _, h = case
    tets = len(h.tetrahedra)
    assert len(h.merges) == tets - 1
    assert np.array_equal(np.sort(h.merges.ravel()), np.arange(2 * tets - 2))
    assert (h.merges.max(1, initial=-1) < np.arange(tets - 1) + tets).all()
    clusters = set(map(tuple, merge_slices(h)))
    assert clusters >= set(zip(h.tet_first, h.tet_last))


def test_cutting_into_parts_undoes_the_last_merges(case):
    _, h = case
    slices, tets = merge_slices(h), len(h.tetrahedra)
    parts = {2 * tets - 2}
    for count in range(1, min(50, tets) + 1):
        if count > 1:  # what the last merge but count - 2 made
            cluster = 2 * tets - count
            parts = parts - {cluster} | set(h.merges[cluster - tets].tolist())
        assert h.cut_parts(count).tolist() == sorted({0} | {int(slices[part][1]) for part in parts})


@pytest.mark.parametrize("name", shapes.SHAPES)
def test_wheel_stops_grow_visibly_along_the_path(name, build_shape):
    shape, h = build_shape(name)
    for face in range(shape.face_count):
        stops, start = h.wheel(face)
        path = h.path(face).tolist()
        places = [path.index(stop) for stop in stops]
        assert places == sorted(set(places)) and stops[-1] == len(h.parent) - 1
        assert 0 <= start < len(stops)
        areas = h.area[stops]
        assert (areas[1:-1] >= 1.1 * areas[:-2] * (1 - EXACT)).all()
        assert all(face in h.faces(stop) for stop in stops)


@pytest.mark.parametrize("name", shapes.SHAPES)
def test_a_view_chooses_among_the_stops_by_score_and_extent(name, build_shape):
    shape, h = build_shape(name)
    size = np.linalg.norm(np.ptp(h.vertices, axis=0))
    for face in range(0, shape.face_count, 1 + shape.face_count // 40):
        stops, start = h.wheel(face)
        corners = [h.vertices[np.unique(h.tetrahedra[h.tet_first[n]:h.tet_last[n]])] for n in stops]
        extents = np.array([np.linalg.norm(np.ptp(points, axis=0)) for points in corners])
        for view in (0, -1, math.nan, math.inf, -math.inf):
            assert h.wheel(face, view)[1] == start
        for view in size * np.array([0.01, 0.1, 0.5, 1, 3, 100]):
            seen, at = h.wheel(face, view)
            assert np.array_equal(seen, stops)
            value = h.score[stops] - 0.6 * (np.log(extents / view) - math.log(0.5)) ** 2
            if h.summary.shells == 1:  # else only stops within the shell count
                is_candidate = h.score[stops] >= 0.3 * h.score[stops].max()
                assert is_candidate[at] and value[at] > value[is_candidate].max() - 1e-9


@pytest.mark.parametrize("name", ("homer", "dino", "camel"))
def test_no_view_takes_a_few_faces(name):
    """At any zoom, on a finely sampled mesh: at least twelve faces and a thousandth of the area."""
    vertices, triangles, *_ = shapes.off(name)
    h = Hierarchy.build(vertices, triangles)
    size = np.linalg.norm(np.ptp(vertices, axis=0))
    taken = {int(stops[start]) for face in range(0, len(triangles), 31) for view in size * 2.0 ** np.arange(-9, 2)
             for stops, start in [h.wheel(face, view)]}
    shares = {node: (len(h.faces(node)), h.area[node] / h.area[-1]) for node in taken}
    assert min(faces for faces, _ in shares.values()) >= 12 and min(area for _, area in shares.values()) >= 0.001


def test_hulls_are_convex_closed_and_as_large_as_scipys(case):
    _, h = case
    nodes = np.unique(np.concatenate([np.linspace(0, len(h.parent) - 1, 40).astype(int), [len(h.parent) - 1]]))
    for node in nodes:
        points, triangles = h.hull(node)
        own = h.vertices[np.unique(h.tetrahedra[h.tet_first[node]:h.tet_last[node]])]
        assert {tuple(point) for point in points} <= {tuple(point) for point in own}
        edges = [(a, b) for t in triangles.tolist() for a, b in zip(t, t[1:] + t[:1])]
        assert len(set(edges)) == len(edges) and {(b, a) for a, b in edges} == set(edges)
        assert np.array_equal(np.unique(triangles), np.arange(len(points)))
        a, b, c = (points[triangles[:, i]] for i in range(3))
        normals = np.cross(b - a, c - a)
        size = np.ptp(own, axis=0).max()
        outside = np.einsum("tj,ntj->nt", normals, own[:, None] - a) / (np.linalg.norm(normals, axis=1) * size)
        assert outside.max() < 1e-9
        volume = np.einsum("ij,ij->i", normals, a - own.mean(0)).sum() / 6
        assert math.isclose(volume, ConvexHull(own).volume, rel_tol=1e-7)


def test_cut_at_a_height_takes_the_largest_nodes_below(case):
    shape, h = case
    top = h.height.max()
    for height in [0.0, *np.unique(h.height)[:: max(1, len(np.unique(h.height)) // 8)], top / 3, top, math.inf]:
        bounds = h.cut_height(height)
        is_below = h.height <= height
        reach = {}  # first tetrahedron -> end of the largest low enough node that starts there
        for node in np.flatnonzero(is_below):
            reach[h.tet_first[node]] = max(reach.get(h.tet_first[node], 0), h.tet_last[node])
        expected = [0]
        while expected[-1] < len(h.tetrahedra):
            expected.append(reach[expected[-1]])
        assert bounds.tolist() == expected
        labels = h.face_labels(bounds)
        assert labels.shape == (shape.face_count,)
        assert (bounds[labels] <= h.leaf).all() and (h.leaf < bounds[labels + 1]).all()
    assert h.cut_height(math.inf).tolist() == [0, len(h.tetrahedra)]


def test_faces_may_be_left_out():
    shape = shapes.cube()
    h = Hierarchy.build(shape.vertices, shape.triangles)
    assert len(h.order) == 12
    assert len(Hierarchy.build(shape.vertices, shape.triangles, shape.faces).order) == 6
    assert Hierarchy.build(shape.vertices.tolist(), shape.triangles.tolist()).merges.tolist() == h.merges.tolist()


@pytest.mark.parametrize("name", ["cube", "L", "jack"])
def test_coordinates_whose_products_are_no_numbers(name):
    """As a transform leaves them where there should be 0: the tree is the one with 0."""
    shape = shapes.SHAPES[name]()
    vertices = shape.vertices - shape.vertices.min(axis=0)
    almost = np.where(vertices == 0, np.random.default_rng(1).random(vertices.shape) * 1e-319, vertices)
    plain, tiny = (Hierarchy.build(*shape._replace(vertices=positions), fill_methods=1) for positions in (vertices, almost))
    for array in ("order", "parent", "tetrahedra", "merges", "height"):
        np.testing.assert_array_equal(getattr(tiny, array), getattr(plain, array))
    for node in range(len(plain.parent)):
        np.testing.assert_array_equal(tiny.hull(node)[1], plain.hull(node)[1])
