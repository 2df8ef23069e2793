# SPDX-License-Identifier: GPL-3.0-or-later
"""The two sides of a model that is its own mirror image get the same parts."""

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, Mode
from scipy.spatial import cKDTree


def figure():
    """A body with two arms, two legs and a head, seven cells wide, bent so that nothing is flat: its own mirror
    image in x = 3.5, but not cut into triangles and tetrahedra so."""
    cells = {(x, 1, z) for x in (2, 3, 4) for z in range(3, 8)}
    cells |= {(x, 1, 7) for x in (0, 1, 5, 6)} | {(x, 1, z) for x in (2, 4) for z in range(3)} | {(3, 1, 8), (3, 1, 9)}
    shape = shapes.polycube(cells)
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
def both():
    shape = figure()
    return Hierarchy.build(*shape), mirror_faces(shape, 3.5)


def test_a_click_takes_the_mirror_image_on_the_other_side(both):
    hierarchy, mirror = both
    for face in range(len(mirror)):
        (stops, at), (others, there) = hierarchy.wheel(face), hierarchy.wheel(int(mirror[face]))
        here, beyond = (set(hierarchy.faces(n).tolist()) for n in (stops[at], others[there]))
        assert {int(mirror[f]) for f in here} == beyond


def test_every_node_of_some_size_has_its_mirror_image(both):
    hierarchy, mirror = both
    sets = {frozenset(hierarchy.faces(n).tolist()) for n in np.flatnonzero(hierarchy.score)}
    sets = {faces for faces in sets if len(faces) >= 8}
    assert len(sets) > 6
    assert sets == {frozenset(int(mirror[f]) for f in faces) for faces in sets}


def test_the_automatic_cut_is_its_own_mirror_image(both):
    hierarchy, mirror = both
    labels = hierarchy.face_labels(hierarchy.cut_automatic())
    pairs = set(zip(labels.tolist(), labels[mirror].tolist()))
    assert len(pairs) == len(set(labels.tolist())) > 1


def test_the_papers_mode_knows_of_no_symmetry(both):
    shape = figure()
    hierarchy, mirror = Hierarchy.build(*shape, mode=Mode.PAPER), both[1]
    sets = {frozenset(hierarchy.faces(n).tolist()) for n in range(len(hierarchy.parent))}
    assert sets != {frozenset(int(mirror[f]) for f in faces) for faces in sets}
