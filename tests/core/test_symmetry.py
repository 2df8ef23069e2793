# SPDX-License-Identifier: GPL-3.0-or-later
"""The two sides of a model that is its own mirror image get the same parts."""

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy
from scipy.spatial import cKDTree

FINER = 3  # cells along the side of one of the figure's


def figure():
    """A body with two arms, two legs and a head, bent so that nothing is flat: its own mirror image in x = 3.5, but not
    cut into triangles and tetrahedra so."""
    cells = {(x, 1, z) for x in (2, 3, 4) for z in range(3, 8)}
    cells |= {(x, 1, 7) for x in (0, 1, 5, 6)} | {(x, 1, z) for x in (2, 4) for z in range(3)} | {(3, 1, 8), (3, 1, 9)}
    finer = {tuple(FINER * c + np.array(corner)) for c in map(np.array, cells) for corner in np.ndindex(3 * (FINER,))}
    shape = shapes.moved(shapes.polycube(finer), scale=1 / FINER)
    x, y, z = shape.vertices.T
    bent = np.column_stack([x + 0.05 * (x - 3.5) * np.sin(z), y + 0.3 * np.sin(z / 2) + 0.05 * (x - 3.5) ** 2, z])
    return shape._replace(vertices=bent)


def mirror_faces(shape, plane):
    """The face at the mirror image of each face's middle, in x = plane."""
    sums = np.zeros((shape.face_count, 3))
    np.add.at(sums, shape.faces, shape.vertices[shape.triangles].mean(axis=1))
    middles = sums / np.bincount(shape.faces, minlength=shape.face_count)[:, None]
    distance, face = cKDTree(middles).query(middles * (-1, 1, 1) + (2 * plane, 0, 0))
    assert distance.max() < 0.05  # a quad may be cut along its other diagonal
    return face


@pytest.fixture(scope="module")
def mirrored_pair():
    shape = figure()
    return Hierarchy.build(*shape), mirror_faces(shape, 3.5)


def overlap(faces, other_faces):
    return len(faces & other_faces) / len(faces | other_faces)


def faces_of(hierarchy, node):
    return set(hierarchy.faces(node).tolist())


def test_a_click_takes_the_mirror_image_on_the_other_side(mirrored_pair):
    hierarchy, mirror = mirrored_pair
    overlaps = []
    for face in range(0, len(mirror), 5):
        (stops, at), (other_stops, other_start) = hierarchy.wheel(face), hierarchy.wheel(int(mirror[face]))
        reflected = {int(mirror[f]) for f in faces_of(hierarchy, stops[at])}
        overlaps.append(overlap(reflected, faces_of(hierarchy, other_stops[other_start])) > 0.9)
    assert np.mean(overlaps) > 0.95


def nodes_with_an_image(hierarchy, mirror):
    """(share of the scored nodes of 3 to 80 % of the faces that overlap an image by 0.9, their number)"""
    sets = [faces_of(hierarchy, n) for n in np.flatnonzero(hierarchy.score)]
    sets = [faces for faces in sets if 0.03 < len(faces) / len(mirror) < 0.8]
    best = [max(overlap({int(mirror[f]) for f in faces}, other) for other in sets) for faces in sets]
    return np.mean(np.array(best) > 0.9), len(sets)


def test_nodes_have_their_mirror_image(mirrored_pair):
    share, count = nodes_with_an_image(*mirrored_pair)
    assert count > 10 and share > 0.75


def test_the_automatic_cut_is_its_own_mirror_image(mirrored_pair):
    hierarchy, mirror = mirrored_pair
    labels = hierarchy.face_labels(hierarchy.cut_automatic())
    parts = [set(np.flatnonzero(labels == label).tolist()) for label in np.unique(labels)]
    parts = [part for part in parts if len(part) > 0.03 * len(mirror)]
    assert len(parts) > 3
    for part in parts:
        assert max(overlap({int(mirror[f]) for f in part}, other) for other in parts) > 0.9
