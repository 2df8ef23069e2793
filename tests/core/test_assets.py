# SPDX-License-Identifier: GPL-3.0-or-later
"""Six assets as artists have them, of several shells: what is made of their parts adds up. They are not in the repository:
without them these tests are skipped."""

import functools
import os
import tarfile
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from partwheel import Hierarchy, Index
from partwheel.cut import Cut, seams
from partwheel.marks import find_face_pairs, marks_of_labels
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull
from solid_checks import check_solid, tetrahedra_volume, triangle_areas, volume

ASSETS = Path(os.environ.get("PARTWHEEL_ASSETS", ROOT.parent / "shared" / "assets")) / "tune.tar.xz"
NAMES = "kaykit_Knight", "Robot", "Tank", "Sail_ship", "NormalCar1", "Female_Casual"

pytestmark = pytest.mark.skipif(not ASSETS.exists(), reason=f"{ASSETS} is not there (set PARTWHEEL_ASSETS)")


def read(name):
    """(vertices, triangles, material of each)"""
    with tarfile.open(ASSETS) as archive, archive.extractfile(f"tune/{name}.npz") as file:
        arrays = np.load(file)
        return arrays["V"].astype(float), arrays["F"].astype(np.int32), arrays["material"]


@functools.cache
def model(name, is_marked=False):
    """(vertices, triangles, Hierarchy). is_marked: with the borders of materials as marks."""
    vertices, triangles, materials = read(name)
    marks = [marks_of_labels(find_face_pairs(vertices, triangles), materials, "materials")] if is_marked else []
    return vertices, triangles, Hierarchy.build(vertices, triangles, marks=marks)


def welded_shells(vertices, triangles):
    """(T,) the shell of each triangle as the scores have it: places that are connected by triangles."""
    size = np.ptp(vertices, axis=0).max()
    _, place = np.unique(np.round((vertices - vertices.min(0)) / size * 1e6).astype(np.int64), axis=0, return_inverse=True)
    corners = place.ravel()[triangles]
    edges = np.concatenate([corners[:, :2], corners[:, 1:]])
    return connected_components(coo_matrix((np.ones(len(edges)), edges.T), (len(place),) * 2), directed=False)[1][corners[:, 0]]


def best_overlap(hierarchy, area, mask):
    """Of these triangles with a stop of the wheel at the largest of them."""
    face = np.flatnonzero(mask)[area[mask].argmax()]
    overlaps = []
    for stop in hierarchy.wheel(int(face))[0]:
        part = np.zeros(len(area), bool)
        part[hierarchy.faces(int(stop))] = True
        overlaps.append(area[part & mask].sum() / area[part | mask].sum())
    return max(overlaps)


@pytest.mark.parametrize("name", NAMES)
def test_every_large_shell_is_on_the_wheel(name):
    vertices, triangles, hierarchy = model(name)
    shell, area = welded_shells(vertices, triangles), triangle_areas(vertices, triangles)
    best = []
    for number in np.unique(shell):
        mask = shell == number
        if area[mask].sum() >= 0.002 * area.sum():
            best.append(best_overlap(hierarchy, area, mask))
    # Closed shells that only touch are one by their places, and each a shell of its own on the wheel.
    assert np.mean(np.array(best) > 0.95) > 0.95


def test_symmetry_costs_no_window_its_part():
    """On this bus, a symmetric tree has better nodes of the large patches of a material, and none of some windows."""
    vertices, triangles, hierarchy = model("Bus", is_marked=True)
    materials, area = read("Bus")[2], triangle_areas(vertices, triangles)
    pairs = find_face_pairs(vertices, triangles).sides
    pairs = pairs[materials[pairs[:, 0]] == materials[pairs[:, 1]]]
    patch = connected_components(coo_matrix((np.ones(len(pairs)), pairs.T), (len(area),) * 2), directed=False)[1]
    windows = [patch == p for p in np.unique(patch) if 0.004 < area[patch == p].sum() / area.sum() < 0.04]
    assert len(windows) > 15 and min(best_overlap(hierarchy, area, window) for window in windows) > 0.9


def outer_triangles(solid):
    """[(source face, its corners' places)] of the triangles with a face."""
    is_outer = solid.source_faces >= 0
    places = [tuple(sorted(map(tuple, corners))) for corners in solid.vertices[solid.triangles[is_outer]].tolist()]
    return list(zip(solid.source_faces[is_outer].tolist(), places))


@pytest.mark.parametrize("is_marked", [False, True], ids=["plain", "marked"])
@pytest.mark.parametrize("name", NAMES)
def test_solids_of_the_parts_add_up(name, is_marked):
    vertices, triangles, hierarchy = model(name, is_marked)
    assert sorted(hierarchy.order.tolist()) == list(range(len(triangles)))
    bounds = hierarchy.cut_automatic()
    whole, outer = 0.0, []
    for solid in hierarchy.solids(list(zip(bounds, bounds[1:]))):
        if solid is None:
            continue
        check_solid(solid)
        whole += volume(solid.vertices, solid.triangles)
        outer += outer_triangles(solid)
    assert np.isclose(whole, hierarchy.summary.volume, rtol=1e-6)
    assert np.isclose(tetrahedra_volume(hierarchy), hierarchy.summary.volume, rtol=1e-6)
    # Each triangle of the surface once, undivided. Where a face is, its triangle has that face, or a duplicate.
    assert sorted(outer) == sorted(outer_triangles(hierarchy.solid_of_slice(0, len(hierarchy.tetrahedra))))
    faces_at = {}
    for face, corners in enumerate(vertices[triangles].tolist()):
        faces_at.setdefault(tuple(sorted(map(tuple, corners))), set()).add(face)
    wrong = [face for face, place in outer if face not in faces_at.get(place, {face})]
    # In shells that are filled from points, what isn't connected with the rest of its patch goes to other faces.
    assert len(wrong) <= (4 if name == "Sail_ship" else 0)
    own = triangle_areas(vertices, triangles).sum()
    assert hierarchy.area[-1] <= own * (1 + 1e-9)
    assert hierarchy.area[-1] > 0.97 * own  # less what is there twice


@pytest.mark.parametrize("name", NAMES)
def test_hulls_index_and_seams(name):
    vertices, triangles, hierarchy = model(name)
    index = Index(hierarchy, hierarchy.cut_automatic())
    corners = hierarchy.vertices[hierarchy.tetrahedra]
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    centers = corners.mean(axis=1)[volumes > 1e-9 * volumes.max()]  # others are flat, but for rounding
    centers = centers[:: max(1, len(centers) // 200)]
    equations = [ConvexHull(hull.vertices).equations for hull in hierarchy.convex_parts(40)]
    outside = np.min([(centers @ sides[:, :3].T + sides[:, 3]).max(axis=1) for sides in equations], axis=0)
    assert (outside < 0.01 * np.ptp(vertices, axis=0).max()).all()  # every place inside is in one of the hulls, nearly
    assert (index.locate(centers) >= 0).all()
    edges = seams(vertices, triangles, np.arange(len(triangles)), len(triangles), Cut.automatic(hierarchy))
    assert len(edges) and np.isin(edges, triangles).all()
