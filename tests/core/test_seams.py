# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams: what a surface falls into along them is counted here corner by corner, by scipy; scales and outlines are
compared with shapes that are known."""

import functools
import sys

import numpy as np
import pytest
import trimesh
from conftest import ROOT
from partwheel import Hierarchy, meshes
from partwheel.cut import Cut, refine_seams, seams
from partwheel.cut.patches import Patch, SeamMesh, cut_to_disk
from partwheel.cut.stretch import ConformalMap
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


def islands(triangles, cut):
    """[Euler characteristic, ...] of what triangles fall into along edges; corners are joined across each other edge that
    has two triangles."""
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
    island, corner = groups(len(triangles), faces), groups(3 * len(triangles), pairs)
    vertices = np.unique(np.column_stack([corner, np.repeat(island, 3)]), axis=0)[:, 1]
    return np.bincount(vertices) - np.bincount(island[edges]) + np.bincount(island)


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


def test_seams_are_the_same_again_and_prefer_creases():
    mesh, cut = model("homer")
    assert (seams(*mesh[:4], cut) == seams_of("homer")).all()
    whole = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    angle = dict(zip(map(tuple, np.sort(whole.face_adjacency_edges, axis=1).tolist()), whole.face_adjacency_angles))
    plain = np.sort(whole.face_adjacency_edges[np.diff(cut.labels[whole.face_adjacency], axis=1)[:, 0] != 0], axis=1)
    seam_angle, borders, all_of_them = (np.mean([angle[tuple(edge)] for edge in edges]) for edges in (
        seams_of("homer").tolist(), plain.tolist(), list(angle)))
    assert seam_angle > 1.3 * all_of_them and seam_angle > borders


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


def test_less_stretch_takes_more_seams():
    mesh, cut = model("elephant")
    assert len(seams(*mesh[:4], cut, max_distortion=1.3)) < len(seams_of("elephant")) < len(seams(*mesh[:4], cut, max_distortion=1.05))


@pytest.mark.parametrize("spikes", [40, 80])
def test_the_work_for_fur_is_bounded(monkeypatch, spikes):
    """Each spike of a ball may need a cut, and patches with many spikes can't be merged. Without a bound the triangles of all
    patches tried were 256 times those of the ball with 80 spikes."""
    ball = trimesh.creation.icosphere(4)
    vertices, triangles = np.array(ball.vertices), np.array(ball.faces)
    tips = vertices[np.random.default_rng(1).choice(len(vertices), spikes, replace=False)]
    angle = np.arccos(np.clip(vertices @ tips.T, -1, 1)).min(axis=1)
    vertices *= (1 + 0.5 * np.clip(1 - angle / 0.12, 0, 1))[:, None]
    faces = np.arange(len(triangles))
    cut = Cut.into(Hierarchy.build(vertices, triangles), 1)
    sizes, module = [], sys.modules["partwheel.cut.seams"]
    cut_patch = module._cut_patch
    monkeypatch.setattr(module, "_cut_patch", lambda mesh, *rest: sizes.append(len(mesh.triangles)) or cut_patch(mesh, *rest))
    edges = seams(vertices, triangles, faces, len(faces), cut)
    assert (islands(triangles, edges) == 1).all()
    assert sum(sizes) < 20 * len(triangles)


def test_parts_that_are_flat_get_no_other_seams_than_their_borders():
    box = trimesh.creation.box((1, 1, 1)).subdivide().subdivide()
    hierarchy = Hierarchy.build(box.vertices, box.faces)
    sides = np.unique(box.face_normals.round(), axis=0, return_inverse=True)[1]
    ends = seams(box.vertices, box.faces, np.arange(len(box.faces)), len(box.faces),
                 Cut.from_labels(hierarchy, sides.ravel()))
    places = box.vertices[ends]
    assert ((abs(places) == 0.5).all(axis=1).sum(axis=1) >= 2).all()  # along the box's edges
    assert len(islands(np.array(box.faces), ends)) in range(1, 7)


def opened_shape(vertices, triangles, faces=None):
    mesh = SeamMesh(vertices, triangles, np.arange(len(triangles)) if faces is None else faces)
    return mesh, cut_to_disk(mesh)


def tube(height=3.0, n_around=24, rings=12, radius=np.ones(24), twist=0):
    """Quads, as triangles, and the quad of each; without ends. twist: each ring is turned by so many quads, back."""
    angle, z = np.meshgrid(np.arange(n_around) * 2 * np.pi / n_around, np.linspace(0, height, rings + 1))
    angle -= twist * np.arange(rings + 1)[:, None] * 2 * np.pi / n_around
    radius = np.tile(radius, rings + 1)
    vertices = np.column_stack([radius * np.cos(angle).ravel(), radius * np.sin(angle).ravel(), z.ravel()])
    a = (np.arange(rings)[:, None] * n_around + np.arange(n_around)).ravel()
    b = (np.arange(rings)[:, None] * n_around + (np.arange(n_around) + 1) % n_around).ravel()
    triangles = np.stack([np.column_stack([a, b, b + n_around]), np.column_stack([a, b + n_around, a + n_around])], axis=1)
    return vertices, triangles.reshape(-1, 3), np.repeat(np.arange(len(a)), 2)


def test_a_tube_is_cut_straight_along_sides_of_its_polygons():
    vertices, triangles, faces = tube()
    mesh, cut = opened_shape(vertices, triangles, faces)
    ends = vertices[mesh.edges[mesh.interior_edges[cut]]]
    assert len(ends) == 12 and np.ptp(ends[..., :2].reshape(-1, 2), axis=0).max() == 0
    assert not mesh.is_diagonal[cut].any() and (islands(triangles, mesh.edges[mesh.interior_edges[cut]]) == 1).all()


def test_a_tube_that_is_twisted_is_not_cut_along_diagonals():
    vertices, triangles, faces = tube(twist=1)  # these are straight, and the shortest way
    mesh, cut = opened_shape(vertices, triangles, faces)
    assert mesh.is_diagonal.any() and not mesh.is_diagonal[cut].any()
    assert islands(triangles, mesh.edges[mesh.interior_edges[cut]]).tolist() == [1]
    mesh, cut = opened_shape(vertices, triangles)
    assert np.ptp(vertices[mesh.edges[mesh.interior_edges[cut]]][..., :2].reshape(-1, 2), axis=0).max() < 1e-9
    # Of a closed one, a ring, neither.
    ring = triangles.reshape(12, -1, 3)
    welded = np.where(ring >= 12 * 24, ring - 12 * 24, ring).reshape(-1, 3)
    turned = vertices.copy()
    turned[:, 0], turned[:, 2] = (3 + vertices[:, 0]) * np.cos(vertices[:, 2] * 2 * np.pi / 3), (
        3 + vertices[:, 0]) * np.sin(vertices[:, 2] * 2 * np.pi / 3)
    mesh, cut = opened_shape(turned, welded, faces)
    assert not mesh.is_diagonal[cut].any() and islands(welded, mesh.edges[mesh.interior_edges[cut]]).tolist() == [1]


@pytest.mark.parametrize("radius", [0.6, 1.4])
def test_a_tube_is_cut_where_it_can_be_seen_least(radius):
    profile = np.ones(24)
    profile[7] = radius  # a groove, or a ridge, along it
    profile[15] = 2 - radius
    vertices, triangles, faces = tube(radius=profile)
    mesh, cut = opened_shape(vertices, triangles, faces)
    ends = mesh.edges[mesh.interior_edges[cut]]
    assert len(ends) == 12 and len({*(ends % 24).ravel().tolist()}) == 1
    assert profile[ends[0, 0] % 24] < 1


@pytest.mark.parametrize("shape, longest", [
    (trimesh.creation.icosphere(3), 1.2 * np.pi),  # half way around
    (trimesh.creation.torus(2, 0.7, 48, 24), 1.05 * 2 * np.pi * (0.7 + 1.3)),  # around it and around the hole
    (trimesh.creation.annulus(1, 2, 0.5), 1.05 * (2 * np.pi * 1 + 3))])
def test_closed_shapes_are_cut_to_disks_by_short_ways(shape, longest):
    mesh, cut = opened_shape(shape.vertices, shape.faces)
    ends = mesh.edges[mesh.interior_edges[cut]]
    assert islands(np.array(shape.faces), ends).tolist() == [1]
    assert 0 < np.linalg.norm(np.diff(shape.vertices[ends], axis=1)[:, 0], axis=1).sum() < longest


def test_a_band_with_one_side_becomes_a_disk_too():
    turn = np.arange(40) * 2 * np.pi / 40
    across = np.array([-0.3, 0, 0.3])[None, :] * np.cos(turn / 2)[:, None], \
        np.array([-0.3, 0, 0.3])[None, :] * np.sin(turn / 2)[:, None]
    vertices = np.stack([(1 + across[0]) * np.cos(turn)[:, None], (1 + across[0]) * np.sin(turn)[:, None], across[1]],
                        axis=2).reshape(-1, 3)
    triangles = []
    for k in range(40):
        start_side, end_side = [3 * k + j for j in range(3)], [3 * ((k + 1) % 40) + j for j in range(3)]
        end_side = end_side if k < 39 else end_side[::-1]
        triangles += [(start_side[j], start_side[j + 1], end_side[j]) for j in range(2)] + [
            (start_side[j + 1], end_side[j + 1], end_side[j]) for j in range(2)]
    mesh, cut = opened_shape(vertices, np.array(triangles))
    assert islands(np.array(triangles), np.zeros((0, 2), int)).tolist() == [0]
    assert islands(np.array(triangles), mesh.edges[mesh.interior_edges[cut]]).tolist() == [1]


def disk(place, rings=24, n_around=96, to=1.0, closed=True):
    """A Patch of rings around a middle, or of a sector: place(radius 0..1, angle) -> (n,3)."""
    count = n_around if closed else n_around + 1
    radius, angle = np.meshgrid(np.linspace(0, 1, rings + 1), np.arange(count) * 2 * np.pi * to / n_around,
                                indexing="ij")
    vertices = place(radius.ravel(), angle.ravel())
    step = np.arange(n_around)
    a = (np.arange(rings)[:, None] * count + step).ravel()
    b = (np.arange(rings)[:, None] * count + (step + 1) % count).ravel()
    triangles = np.concatenate([np.column_stack([a, a + count, b + count]), np.column_stack([a, b + count, b])])
    if closed:
        triangles = np.where(triangles < count, 0, triangles)
        triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    mesh = SeamMesh(vertices, triangles, np.arange(len(triangles)))
    return Patch(mesh, np.zeros(len(mesh.interior_edges), bool))


@pytest.mark.parametrize("polar_angle", [0.4, 1.0, 1.5])
def test_a_cap_of_a_sphere_is_scaled_as_the_stereographic_projection_does(polar_angle):
    patch = disk(lambda radius, angle: np.column_stack([np.sin(polar_angle * radius) * np.cos(angle), np.sin(
        polar_angle * radius) * np.sin(angle), np.cos(polar_angle * radius)]))
    flat = ConformalMap(patch)
    places = np.empty((patch.vertex_count, 3))
    places[patch.triangles] = patch.mesh.positions[patch.mesh.triangles]
    expected = np.cos(polar_angle / 2) ** 2 / np.cos(np.arccos(np.clip(places[:, 2], -1, 1)) / 2) ** 2
    assert abs(np.exp(flat.log_scale) / expected - 1).max() < 0.01
    # And so are areas: by the factor's square, in the mean over the cap.
    at = np.linspace(0, polar_angle, 2001)
    share, factor = np.sin(at), 1 / np.cos(at / 2) ** 4
    factor /= np.average(factor, weights=share)
    assert flat.area_distortion() == pytest.approx(np.average(np.maximum(factor, 1 / factor), weights=share), rel=0.01)
    assert flat.overlap_fraction() == 0


@pytest.mark.parametrize("turns, expected", [(0.5, 0), (0.95, 0), (1.5, 0.5), (1.25, 0.25)])
def test_a_ramp_that_goes_around_more_than_once_covers_itself(turns, expected):
    patch = disk(lambda radius, angle: np.column_stack([(1 + radius) * np.cos(angle), (1 + radius) * np.sin(angle),
                                                        1e-3 * angle]), to=turns, closed=False)
    assert ConformalMap(patch).overlap_fraction() == pytest.approx(expected, abs=0.01)
