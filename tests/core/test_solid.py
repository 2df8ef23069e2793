# SPDX-License-Identifier: GPL-3.0-or-later
"""Solids of nodes and of cuts: closed, manifold, outward, free of crossings, of the volume of their tetrahedra, with
their faces.

PARTWHEEL_SOLIDS=all: ten random nodes of every clean model of libcgal-demo, and of the directory of models that
PARTWHEEL_MODELS names.
"""

import os
from pathlib import Path

import numpy as np
import pytest
import shapes
from partwheel import Creases, Hierarchy, Mode, PartwheelError, meshes
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from solid_checks import TOLERANCE, check_solid, crossings, tetrahedra_volume, volume

EVERYTHING = os.environ.get("PARTWHEEL_SOLIDS") == "all"
SOME = shapes.lighter(["hand.off", "elephant.off", "femur.off", "anchor_dense.off"], 2)
NODES = 10


def some_nodes(hierarchy, count, seed=0):
    """Random nodes that have faces: half of them anywhere, half of them among the larger ones."""
    rng = np.random.default_rng(seed)
    filled = np.flatnonzero(hierarchy.last > hierarchy.first)
    inner = filled[filled >= len(hierarchy.tetrahedra)]
    pools = [filled, inner if len(inner) else filled]
    return [int(rng.choice(pools[i % 2])) for i in range(count)]


def faces_of(solid):
    return np.unique(solid.source_faces[solid.source_faces >= 0])


def check_node(hierarchy, shape, node):
    solid = hierarchy.solid(node)
    check_solid(solid)
    assert np.array_equal(solid.vertices, hierarchy.vertices[solid.source_vertices])
    solid_volume = volume(solid.vertices, solid.triangles)
    whole = tetrahedra_volume(hierarchy)
    if len(shape.triangles) == shape.face_count:
        tets = slice(hierarchy.tet_first[node], hierarchy.tet_last[node])
        assert abs(solid_volume - tetrahedra_volume(hierarchy, tets)) <= TOLERANCE * whole
        assert np.array_equal(faces_of(solid), np.sort(hierarchy.faces(node)))
    # The triangles of a face are the source's own, wound as there.
    is_outer = solid.source_faces >= 0
    corners = hierarchy.source[solid.source_vertices[solid.triangles[is_outer]]]
    faces = solid.source_faces[is_outer]
    if volume(shape.vertices, shape.triangles) < 0:
        corners = corners[:, ::-1]
    known = _numbers(shape.faces, shape.triangles)
    assert np.isin(_numbers(faces, corners), known).all()
    return solid_volume


def _numbers(faces, triangles):
    """(m,) face and corners of each triangle, from the least corner on, as values that can be compared."""
    triangles = np.asarray(triangles, np.int64)
    first_corner = triangles.argmin(axis=1)[:, None]
    a, b, c = np.take_along_axis(triangles, (first_corner + np.arange(3)) % 3, axis=1).T
    key = np.stack([faces, a, b, c], axis=1)
    return np.ascontiguousarray(key, np.int64).view([("", np.int64)] * 4).ravel()


def check_copy_and_rest(hierarchy, node):
    first, last = hierarchy.tet_first[node], hierarchy.tet_last[node]
    return check_slices(hierarchy, [(first, last), (last, first)])


def check_slices(hierarchy, slices):
    """Solids that make the whole: their volumes add up, none crosses itself, and each cap is there from both sides."""
    total, caps = 0.0, []
    for solid in hierarchy.solids(list(slices)):
        if solid is None:  # a part without faces whose tetrahedra went with their polygons
            continue
        check_solid(solid)
        assert crossings(solid) == 0
        total += volume(solid.vertices, solid.triangles)
        for corners in solid.vertices[solid.triangles[solid.neighbor_tets >= 0]].tolist():
            points = [tuple(point) for point in corners]
            first_corner = points.index(min(points))
            caps.append(tuple(points[first_corner:] + points[:first_corner]))
    assert abs(total - tetrahedra_volume(hierarchy)) <= TOLERANCE * tetrahedra_volume(hierarchy)
    assert sorted(caps) == sorted((a, c, b) for a, b, c in caps)


def test_copy_and_rest_make_the_whole(case):
    _, hierarchy = case
    for node in some_nodes(hierarchy, 6):
        check_copy_and_rest(hierarchy, node)


def test_polygons_stay_whole_but_where_two_parts_share_a_tetrahedron():
    shape, hierarchy = build("torus")
    triangles = np.bincount(shape.faces)
    outer = {}
    for face, triangle in zip(shape.faces.tolist(), shape.triangles.tolist()):
        outer[frozenset(triangle)] = face
    shared = set()  # faces of tetrahedra that have triangles of several
    for tet in hierarchy.source[hierarchy.tetrahedra].tolist():
        at = {outer[key] for skip in range(4) if (key := frozenset(tet[:skip] + tet[skip + 1:])) in outer}
        if len(at) > 1:
            shared |= at
    whole = 0
    for node in some_nodes(hierarchy, 60):
        solid = hierarchy.solid(node)
        counts = np.bincount(solid.source_faces[solid.source_faces >= 0], minlength=shape.face_count)
        for face in hierarchy.faces(node).tolist():
            if face not in shared:
                assert counts[face] == triangles[face]
                whole += 1
        other_faces = np.setdiff1d(np.flatnonzero(counts), hierarchy.faces(node))
        assert set(other_faces.tolist()) <= shared
    assert whole > 100


def build(name):
    shape = shapes.SHAPES[name]()
    return shape, Hierarchy.build(*shape)


def test_where_tetrahedra_touch_the_surface_is_cut_apart():
    """Random slices of the tetrahedra, which are no nodes, touch at vertices and edges."""
    rng = np.random.default_rng(1)
    copies = 0
    for name, count in (("3torus.off", 30), ("box with a cavity", 30)):
        _, hierarchy = build(name)
        tets = len(hierarchy.tetrahedra)
        for _ in range(count):
            first = rng.integers(0, tets - 1)
            last = rng.integers(first + 1, tets + 1)
            try:
                solid = hierarchy.solid_of_slice(first, last)
            except PartwheelError as error:
                assert "no face of the surface" in str(error)
                assert not ((hierarchy.leaf >= first) & (hierarchy.leaf < last)).any()
                continue
            check_solid(solid)
            check_slices(hierarchy, [(first, last), (last, first)])
            copies += len(solid.vertices) - len(np.unique(solid.source_vertices))
    assert copies > 0


def test_repaired_sources_and_points_give_closed_solids():
    box = shapes.cube()
    for keep, fill_methods in ((np.arange(len(box.triangles)) != 0, 2), (np.arange(len(box.triangles)) != 0, 4)):
        shape = shapes.Shape(box.vertices, box.triangles[keep], np.arange(keep.sum(), dtype=np.int32), int(keep.sum()))
        hierarchy = Hierarchy.build(*shape, fill_methods=fill_methods)
        for node in some_nodes(hierarchy, 20):
            solid = hierarchy.solid(node)
            check_solid(solid)
            tets = slice(hierarchy.tet_first[node], hierarchy.tet_last[node])
            expected, whole = tetrahedra_volume(hierarchy, tets), tetrahedra_volume(hierarchy)
            assert abs(volume(solid.vertices, solid.triangles) - expected) <= TOLERANCE * whole
            check_copy_and_rest(hierarchy, node)
        whole = hierarchy.solid(len(hierarchy.parent) - 1)
        assert set(faces_of(whole)) == set(range(shape.face_count))


@pytest.mark.parametrize("height, n_around, limit", [(0.06, 48, 1 / 100), (0.15, 48, 1 / 100), (0.06, 40, 1 / 200)])
def test_a_repair_may_lose_a_hundredth_of_the_diagonal_of_a_small_model_half_of_it(height, n_around, limit):
    shape = shapes.folded_torus(height, n_around)
    summary = Hierarchy.build(*shape).summary
    diagonal = np.linalg.norm(np.ptp(shape.vertices, axis=0))
    assert summary.fill_method == ("points" if height > limit * diagonal else "repaired")


def models():
    names = sorted(path.name for path in shapes.MESHES.iterdir()) if EVERYTHING else SOME
    paths = [shapes.MESHES / name for name in names]
    if EVERYTHING and "PARTWHEEL_MODELS" in os.environ:
        paths += sorted(Path(os.environ["PARTWHEEL_MODELS"]).rglob("*.off"))
    return paths


@pytest.mark.parametrize("path", models(), ids=lambda path: path.name)
def test_real_models(path):
    try:
        mesh = meshes.read(path)
        shape = shapes.Shape(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count)
        hierarchy = Hierarchy.build(*shape, fill_methods=1)
    except (PartwheelError, meshes.MeshFileError) as error:
        pytest.skip(f"not clean: {error}")
    for node in some_nodes(hierarchy, NODES):
        check_node(hierarchy, shape, node)
        check_copy_and_rest(hierarchy, node)


def test_walls_within_the_solid_are_no_surface_of_it():
    """A box inside another that is wound the same way, in mode paper: the winding number is 2 there, so it is all solid."""
    inner = shapes.moved(shapes.cube(), (0.25, 0.25, 0.25), 0.5)
    h = Hierarchy.build(*shapes.merged(shapes.cube(), inner), mode=Mode.PAPER)
    assert h.summary.is_exact
    solid = h.solid(len(h.parent) - 1)
    check_solid(solid)
    assert np.isclose(volume(solid.vertices, solid.triangles), 1) and len(faces_of(solid)) == 6


@pytest.mark.parametrize("name, otherwise", shapes.lighter([("hand", 0.6), ("dragknob", 0.75), ("elephant", 0.25)], 2))
def test_of_snapped_parts(name, otherwise):
    """Part and rest are solids that make the whole, in no more pieces than before; and their faces are nearly those of
    the snapped part: less so where long tetrahedra of a machine part reach across the border, and in the hand, whose
    borders lie in creases already, so that little moves."""
    shape = shapes.off(name)
    hierarchy, creases = Hierarchy.build(*shape), Creases(*shape)
    moved = wrong = 0
    for face in range(0, shape.face_count, shape.face_count // 4):
        for stop in hierarchy.wheel(face)[0][:-1].tolist():
            part = np.isin(np.arange(shape.face_count), hierarchy.faces(stop))
            snapped = creases.snap(part)
            first, last = int(hierarchy.tet_first[stop]), int(hierarchy.tet_last[stop])
            solids = [hierarchy.solid_of_slice(*tets, snapped) for tets in ((first, last), (last, first))]
            for solid, before in zip(solids, (hierarchy.solid(stop), hierarchy.rest(stop))):
                check_solid(solid)
                assert pieces(solid) <= pieces(before)
            both = [faces_of(solid) for solid in solids]
            volumes = [volume(solid.vertices, solid.triangles) for solid in solids]
            assert abs(sum(volumes) - tetrahedra_volume(hierarchy)) <= TOLERANCE * tetrahedra_volume(hierarchy)
            differing = len(np.setxor1d(both[0], np.flatnonzero(snapped)))
            moved, wrong = moved + int((snapped != part).sum()), wrong + differing
            assert np.array_equal(np.union1d(*both), np.arange(shape.face_count))
    print(f"{name}: {moved} faces moved, {wrong} otherwise")
    assert wrong < otherwise * moved


def pieces(solid):
    sides = np.vstack([solid.triangles[:, :2], solid.triangles[:, 1:]])
    graph = coo_matrix((np.ones(len(sides)), (sides[:, 0], sides[:, 1])), (len(solid.vertices),) * 2)
    return connected_components(graph, directed=False)[0]
