# SPDX-License-Identifier: GPL-3.0-or-later
"""The two sides of a model that is its own mirror image get the same parts."""

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy
from partwheel.marks import find_face_pairs, marks_of_labels
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


def painted(shape, label_of):
    """The hierarchy with the borders of these labels as hints, and the faces with each label. label_of: from a face's middle."""
    first = np.unique(shape.faces, return_index=True)[1]
    labels = np.array([label_of(*middle) for middle in shape.vertices[shape.triangles[first]].mean(axis=1)])
    marks = marks_of_labels(find_face_pairs(*shape[:3]), labels, "materials")
    return Hierarchy.build(*shape, marks=[marks]), [set(np.flatnonzero(labels == label)) for label in np.unique(labels)]


def test_marks_that_are_symmetric_keep_the_symmetry(mirrored_pair):
    """Trousers, a shirt, two gloves, skin."""
    hierarchy, _ = painted(figure(), lambda x, y, z: 3 if abs(x - 3.5) > 2.6 else 2 if z > 8 else z > 3.2)
    share, count = nodes_with_an_image(hierarchy, mirrored_pair[1])
    assert count > 10 and share > 0.9


def test_a_mark_on_one_side_stays_there():
    """One glove; two pockets that are no part together. The rest is symmetric."""
    def label(x, y, z):
        return 1 if x > 6.1 else 2 if 2 < x < 3 and 5 < z < 6 else 3 if 4 < x < 5 and 5 < z < 6 else 0
    hierarchy, (_, glove, *pockets) = painted(figure(), label)
    nodes = [faces_of(hierarchy, n) for n in np.flatnonzero(hierarchy.score)]
    assert all(max(overlap(patch, node) for node in nodes) > 0.95 for patch in (glove, *pockets))
    assert nodes_with_an_image(hierarchy, mirror_faces(figure(), 3.5))[0] > 0.6


def test_the_automatic_cut_is_its_own_mirror_image(mirrored_pair):
    hierarchy, mirror = mirrored_pair
    labels = hierarchy.face_labels(hierarchy.cut_automatic())
    parts = [set(np.flatnonzero(labels == label).tolist()) for label in np.unique(labels)]
    parts = [part for part in parts if len(part) > 0.03 * len(mirror)]
    assert len(parts) > 3
    for part in parts:
        assert max(overlap({int(mirror[f]) for f in part}, other) for other in parts) > 0.9
