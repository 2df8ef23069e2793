# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts that are alike, and parts on the other side, of shapes whose parts are known."""

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, likeness
from test_symmetry import figure, mirror_faces

ARM = 2  # length of an arm in cells
SIDES = [(axis, sign) for axis in range(3) for sign in (-1, 1)]


def arms(lengths=6 * (ARM,)):
    """A cube with an arm on each of its sides, of these lengths in cells, nine faces to a cell's side: (Shape, (F,) the
    number of each face's arm, -1 for the cube)."""
    cells = [(0, 0, 0)] + [tuple(sign * step * (k == axis) for k in range(3))
                           for (axis, sign), length in zip(SIDES, lengths) for step in range(1, length + 1)]
    finer = {tuple(3 * np.array(cell) + corner) for cell in cells for corner in np.ndindex(3, 3, 3)}
    shape = shapes.polycube(finer)
    middles = np.zeros((shape.face_count, 3))
    np.add.at(middles, shape.faces, shape.vertices[shape.triangles].mean(axis=1))
    middles = middles / np.bincount(shape.faces)[:, None] - 1.5
    of = np.full(shape.face_count, -1)
    for number, (axis, sign) in enumerate(SIDES):
        of[sign * middles[:, axis] > 1.5] = number
    return shape, of


def moved(shape, seed):
    """The same, turned and moved: nothing lies along an axis."""
    random = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    return shape._replace(vertices=shape.vertices @ turn.T + random.normal(size=3))


def arm(hierarchy, of, number):
    """The node that is an arm, but for few faces."""
    expected = set(np.flatnonzero(of == number).tolist())
    overlaps = [len(expected & faces) / len(expected | faces)
                for faces in (set(hierarchy.faces(node).tolist()) for node in range(len(hierarchy.parent)))]
    assert max(overlaps) > 0.8
    return int(np.argmax(overlaps))


def of_nodes(hierarchy, of, nodes):
    """The number of the arm that each node is, but for few faces."""
    values = [np.unique(of[hierarchy.faces(node)], return_counts=True) for node in nodes]
    assert all(counts.max() > 0.8 * counts.sum() for _, counts in values)
    return [int(numbers[counts.argmax()]) for numbers, counts in values]


def similar(shape, hierarchy, node):
    return likeness.similar_parts(hierarchy, likeness.measure_nodes(hierarchy, *shape[:3]), node)


@pytest.fixture(scope="module", params=[None, 3])
def six(request):
    shape, of = arms()
    shape = shape if request.param is None else moved(shape, request.param)
    return shape, of, Hierarchy.build(*shape)


def test_similar_parts_of_another_model_are_found(six):
    """Turned, moved, or twice as large but compared where both are of one size."""
    shape, of, hierarchy = six
    other_shape, of_there = arms((2, 2, 4, 2, 2, 2))
    measures = likeness.measure_nodes(hierarchy, *shape[:3])
    node = arm(hierarchy, of, 3)

    def match_in_copy(scale, matrix):
        large = moved(other_shape, 8)._replace(vertices=scale * moved(other_shape, 8).vertices)
        built = Hierarchy.build(*large)
        ranked = likeness.similar_parts(hierarchy, measures, node, (built, likeness.measure_nodes(built, *large[:3], matrix)))
        selections = [set(built.faces(similar).tolist()) for similar, value in ranked if value >= likeness.THRESHOLD]
        whole = [set(np.flatnonzero(of_there == number).tolist()) for number in range(6)]
        return [number for number, expected in enumerate(whole)
                if any(len(expected & selection) > 0.8 * len(expected | selection) for selection in selections)]

    assert match_in_copy(1, np.eye(4)) == match_in_copy(2, np.diag([0.5, 0.5, 0.5, 1])) == [0, 1, 3, 4, 5]  # not the one twice as long
    assert match_in_copy(2, np.eye(4)) == []


def test_equal_parts_are_similar_at_any_position():
    """Knobs on a long beam, the first at its end."""
    cells = {(x, y, z) for x in range(40) for y in range(4) for z in range(4)}
    knobs = [{(x + begin, y + 1, z) for x in range(2) for y in range(2) for z in range(4, 12)} for begin in (1, 13, 25)]
    shape = shapes.polycube(cells.union(*knobs))
    middles = np.zeros((shape.face_count, 3))
    np.add.at(middles, shape.faces, shape.vertices[shape.triangles].mean(axis=1))
    middles /= np.bincount(shape.faces)[:, None]
    of = np.where(middles[:, 2] > 4, (middles[:, 0] // 12).astype(int), -1)
    hierarchy = Hierarchy.build(*shape)
    for number, expected in ((0, [1, 2]), (1, [0, 2])):
        ranked = similar(shape, hierarchy, arm(hierarchy, of, number))
        assert sorted(of_nodes(hierarchy, of, [node for node, _ in ranked[:2]])) == expected
        assert ranked[1][1] >= likeness.THRESHOLD


def test_the_best_node_has_the_largest_overlap(build_shape):
    shape, hierarchy = build_shape("hand.off")
    random = np.random.default_rng(0)
    for node in random.choice(np.flatnonzero(hierarchy.last - hierarchy.first > 20), 20).tolist():
        inside = np.zeros(shape.face_count, bool)
        inside[hierarchy.faces(node)] = True
        found, overlap = likeness.best_node(hierarchy, inside)
        assert overlap == 1 and set(hierarchy.faces(found).tolist()) == set(hierarchy.faces(node).tolist())
        inside ^= random.random(len(inside)) < 0.05
        faces = set(np.flatnonzero(inside).tolist())
        overlaps = [len(faces & other) / len(faces | other)
                    for other in (set(hierarchy.faces(index).tolist()) for index in range(len(hierarchy.parent)))]
        found, overlap = likeness.best_node(hierarchy, inside)
        assert overlap == pytest.approx(max(overlaps)) == overlaps[found]


def test_the_arm_on_the_other_side():
    shape, of = arms((2, 2, 3, 4, 1, 0))  # x = 1.5, the middle of the cube, is the only plane of symmetry but for y and z
    hierarchy = Hierarchy.build(*shape)
    for number, other in ((0, 1), (1, 0)):
        (image, *_) = likeness.mirrored_parts(hierarchy, *shape[:3], arm(hierarchy, of, number))
        assert of_nodes(hierarchy, of, [image.node]) == [other] and image.overlap > 0.9
        assert abs(image.normal[0]) > 0.999 and abs(abs(image.offset) - 1.5) < 0.02


def test_both_sides_of_a_figure():
    shape = figure()
    hierarchy, mirror = Hierarchy.build(*shape), mirror_faces(shape, 3.5)
    hits, count = 0, 0
    for face in range(0, shape.face_count, 23):
        stops, at = hierarchy.wheel(face)
        inside = set(hierarchy.faces(stops[at]).tolist())
        expected = {int(mirror[each]) for each in inside}
        if expected & inside:  # across the plane
            continue
        count += 1
        images = likeness.mirrored_parts(hierarchy, *shape[:3], int(stops[at]))
        got = set(hierarchy.faces(images[0].node).tolist()) if images else set()
        hits += len(got & expected) > 0.9 * len(got | expected)
    assert count > 10 and hits >= 0.95 * count
