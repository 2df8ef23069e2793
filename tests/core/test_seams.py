# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams: what a surface falls into along them is counted here corner by corner, by scipy. Cuts, scales and outlines of single
patches: tests/native/seams_test.cpp."""

import functools

import numpy as np
import pytest
import shapes
import trimesh
from conftest import ROOT
from partwheel import Hierarchy, PartwheelError, meshes
from partwheel.cut import Cut, refine_seams, seams
from partwheel.library import Context, Status
from partwheel.marks import find_face_pairs, marks_of_labels
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components


@functools.cache
def model(name):
    """(Mesh, Cut): of homer and the elephant, which are used exactly, the cow, which is filled from points and has holes,
    and the double torus."""
    mesh = meshes.read(ROOT / "build" / "deps" / "meshes" / f"{name}.off")
    hierarchy = Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count)
    return mesh, Cut.automatic(hierarchy)


MODELS = "homer", "elephant", "cow", "double-torus-example"
seams_of = functools.cache(lambda name: seams(*model(name)[0][:4], model(name)[1]))


def groups(count, pairs):
    pairs = np.array(pairs, int).reshape(-1, 2)
    return connected_components(coo_matrix((np.ones(len(pairs)), pairs.T), (count, count)), directed=False)[1]


def split_along(triangles, cut):
    """((T,) the island of each triangle along edges, the corners that are joined, a triangle of each edge of an island): corners
    are joined across each other edge that has two triangles."""
    cut = {*map(tuple, np.sort(cut, axis=1).tolist())}
    at = {}
    for triangle, corners in enumerate(triangles.tolist()):
        for k in range(3):
            at.setdefault(tuple(sorted((corners[k], corners[(k + 1) % 3]))), []).append(triangle)
    faces, pairs, edges = [], [], []
    for edge, sides in at.items():
        is_joined = len(sides) == 2 and edge not in cut
        if is_joined:
            one, other = sides
            faces.append((one, other))
            pairs += [(3 * one + triangles[one].tolist().index(end), 3 * other + triangles[other].tolist().index(end))
                       for end in edge]
        edges += sides[:1] if is_joined else sides
    return groups(len(triangles), faces), pairs, edges


def islands(triangles, cut):
    """[Euler characteristic, ...] of what triangles fall into along edges."""
    island, pairs, edges = split_along(triangles, cut)
    corner = groups(3 * len(triangles), pairs)
    vertices = np.unique(np.column_stack([corner, np.repeat(island, 3)]), axis=0)[:, 1]
    return np.bincount(vertices) - np.bincount(island[edges]) + np.bincount(island)


def test_no_island_covers_itself():
    """A ramp of two and a half turns can be laid flat without any distortion, but would cover itself."""
    angles = np.linspace(0, 5 * np.pi, 121)
    vertices = [(r * np.cos(angle), r * np.sin(angle), 0.15 * angle) for angle in angles for r in (1, 1.15, 1.3)]
    ramp = shapes.polygons(vertices, [(3 * i + k, 3 * i + k + 1, 3 * i + k + 4, 3 * i + k + 3) for i in range(120) for k in (0, 1)])
    edges = seams(*ramp, Cut.into(Hierarchy.build(*ramp), 1))
    island, corners = split_along(ramp.triangles, edges)[0], np.repeat(angles, 3)[ramp.triangles]
    for number in np.unique(island):
        assert np.ptp(corners[island == number]) < 2 * np.pi


@pytest.mark.parametrize("name", MODELS)
def test_every_island_is_a_disk(name):
    mesh, cut = model(name)
    before = islands(mesh.triangles, np.zeros((0, 2), int))
    after = islands(mesh.triangles, seams_of(name))
    assert (before != 1).any() and (after == 1).all()
    assert len(before) <= len(after) < max(4 * len(cut), 2 * len(before))


@pytest.mark.parametrize("name", MODELS)
def test_seams_are_edges_of_the_mesh_each_once(name):
    mesh, ends = model(name)[0], seams_of(name)
    edges = {*map(tuple, np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1).tolist())}
    assert len({*map(tuple, ends.tolist())} & edges) == len(ends)


def pieces(triangles, cut):
    """(T,) the island of each triangle along edges."""
    cut = {*map(tuple, np.sort(cut, axis=1).tolist())}
    shape = trimesh.Trimesh(np.zeros((triangles.max() + 1, 3)), triangles, process=False)
    return groups(len(triangles), [pair for pair, edge in zip(shape.face_adjacency, np.sort(
        shape.face_adjacency_edges, axis=1).tolist()) if tuple(edge) not in cut])


def test_an_island_that_a_solver_has_failed_on_is_divided_and_no_other():
    mesh, cut = model("homer")
    # Each triangle laid flat by itself, as it is; then half of the largest island ten times as large.
    a, b, c = mesh.vertices[mesh.triangles].transpose(1, 0, 2)
    length = np.linalg.norm(b - a, axis=1)
    along = np.einsum("ij,ij->i", c - a, b - a) / length
    high = np.linalg.norm(np.cross(b - a, c - a), axis=1) / length
    zero = np.zeros(len(a))
    uv = np.stack([np.column_stack(column) for column in ((zero, zero), (length, zero), (along, high))], axis=1)
    assert (refine_seams(*mesh[:4], cut, seams_of("homer"), uv) == seams_of("homer")).all()
    island = pieces(mesh.triangles, seams_of("homer"))
    failed = np.flatnonzero(island == np.bincount(island).argmax())
    uv[failed[::2]] *= 10
    after = refine_seams(*mesh[:4], cut, seams_of("homer"), uv)
    divided = pieces(mesh.triangles, after)
    assert len({*divided[failed].tolist()}) > 1 and (islands(mesh.triangles, after) == 1).all()
    remaining = np.setdiff1d(np.arange(len(island)), failed)
    assert len({*zip(island[remaining].tolist(), divided[remaining].tolist())}) == island.max()
    assert not {*divided[failed].tolist()} & {*divided[remaining].tolist()}


def test_borders_that_somebody_chose_are_seams():
    mesh = model("homer")[0]
    pairs = find_face_pairs(*mesh[:2])
    height = mesh.vertices[mesh.triangles].mean(axis=1)[:, 1]
    labels = np.digitize(height, np.quantile(height, [0.3, 0.7]))
    hierarchy = Hierarchy.build(*mesh[:2], marks=[marks_of_labels(pairs, labels, "labels", chosen=True)])

    def borders_off_seams(cut):
        borders = pairs.edges[np.ptp(cut.labels[pairs.sides], axis=1) > 0]
        edges = seams(*mesh[:4], cut)
        assert set(islands(mesh.triangles, edges)) == {1}
        return len({*map(tuple, np.sort(borders, axis=1).tolist())} - {*map(tuple, edges.tolist())})

    kept = Cut.from_labels(hierarchy, labels, keeps_borders=True)
    assert (kept.labels == labels).all()
    assert borders_off_seams(kept) == borders_off_seams(kept.split(0)) == 0
    assert borders_off_seams(Cut.from_labels(hierarchy, labels)) > 10  # snapped to creases


def test_edges_of_more_than_two_triangles_are_seams():
    """Here also with a flipped triangle and a degenerate one."""
    box = trimesh.creation.box((1, 1, 1)).subdivide()
    fin = np.array([[0, 1, len(box.vertices)]])
    vertices = np.vstack([box.vertices, [[9, 9, 9]]])
    triangles = np.vstack([box.faces, fin, [[2, 2, 3]], box.faces[:1, ::-1]])
    hierarchy = Hierarchy.build(vertices, triangles)
    edges = seams(vertices, triangles, None, None, Cut.automatic(hierarchy))
    sides = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    several, count = np.unique(sides, axis=0, return_counts=True)
    assert {*map(tuple, several[count > 2].tolist())} <= {*map(tuple, edges.tolist())}


def test_seams_can_be_canceled_and_report_their_progress():
    mesh, cut = model("homer")
    context = Context()
    context.cancel()
    with pytest.raises(PartwheelError) as error:
        seams(*mesh[:4], cut, context=context)
    assert error.value.status == Status.CANCELED
    assert (seams(*mesh[:4], cut, context=context) == seams_of("homer")).all() and context.progress()[0] == 1
    context.cancel()
    with pytest.raises(PartwheelError, match="canceled"):
        refine_seams(*mesh[:4], cut, seams_of("homer"), np.zeros((len(mesh.triangles), 3, 2)), context=context)
