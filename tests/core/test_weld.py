# SPDX-License-Identifier: GPL-3.0-or-later
"""Coincident vertices are one vertex: a closed model, the same model with its vertices split, and one with every triangle
separate give the same results, to the last bit."""

import functools
import os
from pathlib import Path

import numpy as np
import pytest
import shapes
from partwheel import Deformation, Hierarchy, surface_distances
from partwheel.cut import (
    Cut, bones, mirror_planes, name_parts, part_borders, part_tree, refine_seams, seams, skin_weights,
)
from partwheel.deform import FIXED, FREE
from partwheel.weld import weld_coincident_vertices
from test_deform import turn
from test_seams import islands

KNIGHT = Path(os.environ.get("PARTWHEEL_ASSETS", "/work/shared/assets")) / "files" / "Knight.glb"
SPLITS = {"by direction": shapes.split_by_direction, "everywhere": shapes.split_everywhere}


@functools.cache
def model():
    return shapes.off("homer")


@functools.cache
def knight():
    """(Shape of the GLB as it is split, Shape welded by trimesh)"""
    trimesh = pytest.importorskip("trimesh")
    if not KNIGHT.exists():
        pytest.skip(f"{KNIGHT} is not there: set PARTWHEEL_ASSETS to the folder of the real assets.")
    scene = trimesh.load(KNIGHT, process=False, force="scene", skip_materials=True)
    mesh = max(scene.geometry.values(), key=lambda candidate: len(candidate.faces))
    return shapes.Shape(np.array(mesh.vertices, float), np.array(mesh.faces, np.int32), np.arange(len(mesh.faces)),
                        len(mesh.faces))


@functools.cache
def parts():
    return Cut.automatic(Hierarchy.build(*model()))


@pytest.fixture(params=SPLITS)
def both(request):
    """(Shape, Shape split, the vertex that each of its vertices was)"""
    return model(), *SPLITS[request.param](model())


def test_only_split_vertices_are_welded(both):
    whole, split, was = both
    assert len(split.vertices) > 1.05 * len(whole.vertices)
    np.testing.assert_array_equal(weld_coincident_vertices(whole.vertices, whole.triangles), np.arange(len(whole.vertices)))
    old_to_new = weld_coincident_vertices(split.vertices, split.triangles)
    np.testing.assert_array_equal(old_to_new, np.unique(was, return_index=True)[1][np.unique(was, return_inverse=True)[1]])


def welded_points(points):
    """The number of distinct vertices of triangles that share none, (T,3,3), after welding."""
    points = np.array(points, float)
    return len(np.unique(weld_coincident_vertices(points.reshape(-1, 3), np.arange(3 * len(points)).reshape(-1, 3))))


def test_closed_solids_and_point_contacts_are_not_welded():
    a, b, c, d, e = (0, 0, 0), (1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)
    assert welded_points([(a, b, c), (a, d, e)]) == 6  # a point alone
    assert welded_points([(a, b, c), (a, c, d)]) == 4  # an edge
    assert welded_points([(a, b, c), (a, b, e), (a, b, d)]) == 5  # an edge of three
    assert welded_points([(a, a, b), (c, d, e)]) == 6  # an edge without length
    assert welded_points([(a, b, c), ((-0.0, 0, 0), c, d)]) == 4  # -0.0 is 0.0
    assert welded_points([(a, b, c), (np.nextafter(a, 1), np.nextafter(c, 1), d)]) == 6  # exactly, or not
    cubes = shapes.merged(shapes.cube(), shapes.moved(shapes.cube(), (1, 0, 0)))
    np.testing.assert_array_equal(weld_coincident_vertices(cubes.vertices, cubes.triangles), np.arange(16))


def grid(size, at=(0, 0, 0), flipped=False):
    """(vertices, triangles) of a square of 2 * size * size triangles, whose diagonals differ if it is flipped."""
    x, y = np.meshgrid(np.arange(size + 1.0), np.arange(size + 1.0), indexing="ij")
    corner = (np.arange(size)[:, None] * (size + 1) + np.arange(size)).ravel()[:, None]
    quads = corner + [0, size + 1, size + 2, 1]
    quads = quads[:, ::-1] if flipped else quads
    return np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1) + at, np.vstack([quads[:, :3], quads[:, [0, 2, 3]]])


def joined(*surfaces):
    """(vertices, triangles) of several surfaces."""
    starts = np.cumsum([0, *(len(points) for points, _ in surfaces)])
    return (np.vstack([points for points, _ in surfaces]),
            np.vstack([triangles + start for (_, triangles), start in zip(surfaces, starts)]).astype(np.int32))


def test_sides_of_a_sheet_are_welded_on_request():
    sheet = joined(grid(4), grid(4, flipped=True))
    inner = [6, 7, 8, 11, 12, 13, 16, 17, 18]
    old_to_new = weld_coincident_vertices(*sheet)
    assert sorted(set(old_to_new) & {25 + vertex for vertex in inner}) == [25 + vertex for vertex in inner]
    np.testing.assert_array_equal(weld_coincident_vertices(*sheet, sheets=True), np.tile(np.arange(25), 2))


def test_closed_sheets_are_welded_and_touching_solids_are_not():
    box = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    triangles = np.vstack([quads[:, :3], quads[:, [0, 2, 3]]])
    other_diagonals = np.vstack([quads[:, [1, 3, 2]], quads[:, [1, 0, 3]]])
    double = joined((box, triangles), (box, other_diagonals))
    np.testing.assert_array_equal(weld_coincident_vertices(*double, sheets=True), np.tile(np.arange(8), 2))
    touching = joined((box, triangles), (box + [1, 0, 0], triangles))
    np.testing.assert_array_equal(weld_coincident_vertices(*touching, sheets=True), np.arange(16))


def test_deformation_opens_no_crack(both):
    whole, split, was = both
    distance = surface_distances(whole.vertices, whole.triangles, [whole.vertices[:, 0].argmax()])
    roles = np.where(distance < 0.05 * distance.max(), 0, np.where(distance < 0.4 * distance.max(), FREE, FIXED))

    def deformed(shape, roles):
        deformation = Deformation(shape.vertices, shape.triangles, roles)
        deformation.move_in_steps([turn((1, 2, 3), 40, whole.vertices.mean(axis=0))])
        return deformation.positions()

    expected = deformed(whole, roles)
    assert (expected[roles == FREE] != whole.vertices[roles == FREE]).any(axis=1).mean() > 0.9
    np.testing.assert_array_equal(deformed(split, roles[was]), expected[was])
    # A role that only one of the coincident vertices has is all of theirs.
    first = np.unique(was, return_index=True)[1]
    alone = np.full(len(was), FREE)
    alone[first] = roles
    np.testing.assert_array_equal(deformed(split, alone), expected[was])


def test_borders_tree_weights_bones_and_names_are_the_same(both):
    whole, split, was = both
    labels, cut = parts().labels[whole.faces], parts()
    first = np.unique(was, return_index=True)[1]
    results = []
    for shape in (whole, split):
        surface = shape.vertices, shape.triangles, labels
        weights = skin_weights(*surface, len(cut))
        links = part_tree(cut, *surface)
        planes = mirror_planes(shape.vertices, shape.triangles)
        results.append((part_borders(*surface), weights, links, bones(*surface, links, weights, planes), planes,
                        name_parts(cut, shape.vertices, shape.triangles, shape.faces)))
    (edges, weights, links, made, planes, names), (other, other_weights, hanging, made_of_split, planes_of_split, names_of_split) = results
    assert [edge.parts for edge in edges] == [each.parts for each in other] and len(edges) > 5
    for one, two in zip(edges, other):
        np.testing.assert_array_equal(np.sort(first[one.vertices]), two.vertices)
        assert two.length == pytest.approx(one.length, rel=1e-12)
    for (vertices, shares), (split_vertices, split_shares) in zip(weights, other_weights):
        dense, split_dense = np.zeros(len(whole.vertices)), np.zeros(len(was))
        dense[vertices], split_dense[split_vertices] = shares, split_shares
        np.testing.assert_array_equal(split_dense, dense[was])
    assert [link.parent for link in links] == [link.parent for link in hanging]
    for one, two in zip(made, made_of_split):
        np.testing.assert_allclose(np.array(two[:2]), np.array(one[:2]), atol=1e-9)
    np.testing.assert_allclose(np.array([normal for normal, _ in planes_of_split]), np.array([normal for normal, _ in planes]))
    assert names == names_of_split


def on_whole(ends, was):
    return np.unique(np.sort(was[ends], axis=1), axis=0)


def test_seams_are_the_same(both):
    whole, split, was = both
    expected, actual = (seams(*shape, parts()) for shape in (whole, split))
    np.testing.assert_array_equal(on_whole(actual, was), np.unique(expected, axis=0))
    assert (islands(was[split.triangles], on_whole(actual, was)) == 1).all()
    # Every edge of the split mesh that lies there is one.
    sides = np.sort(split.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    known = {*map(tuple, expected.tolist())}
    wanted = {side for side, at in zip(map(tuple, sides.tolist()), map(tuple, np.sort(was[sides], axis=1).tolist()))
              if at in known}
    assert {*map(tuple, actual.tolist())} == wanted
    # Where an unwrapping failed, here everywhere, the same parts are divided once more.
    uv = np.random.default_rng(1).random((len(whole.triangles), 3, 2)) ** 8
    refined, more_of_split = (refine_seams(*shape, parts(), ends, uv) for shape, ends in ((whole, expected), (split, actual)))
    assert len(refined) > len(expected)
    np.testing.assert_array_equal(on_whole(more_of_split, was), np.unique(refined, axis=0))


def test_a_real_model_is_one_surface():
    """Knight.glb comes split: after welding no edge is open that has a coincident one."""
    split = knight()
    old_to_new = weld_coincident_vertices(split.vertices, split.triangles)
    assert (old_to_new != np.arange(len(old_to_new))).sum() > 0.05 * len(old_to_new)
    np.testing.assert_array_equal(split.vertices[old_to_new], split.vertices)
    triangles = np.unique(split.vertices, axis=0, return_inverse=True)[1].ravel()[split.triangles]  # by place alone

    def open_edges(triangles):
        sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        return (np.unique(sides[sides[:, 0] != sides[:, 1]], axis=0, return_counts=True)[1] == 1).sum()

    assert open_edges(old_to_new[split.triangles]) == open_edges(triangles) < open_edges(split.triangles)
