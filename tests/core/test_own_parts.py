# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts made by hand with their mirror images and similar parts: sets of faces, any two nested or disjoint."""

import importlib.util
import sys

import numpy as np
import pytest
import shapes
from conftest import ROOT
from partwheel import Context, Hierarchy, PartwheelError, meshes
from partwheel.cut import Cut
from partwheel.likeness import MAX_OWN_PARTS, are_nested, extend_own_parts, with_own_parts


def mask_of(hierarchy, faces):
    mask = np.zeros(len(hierarchy.order), bool)
    mask[list(faces)] = True
    return mask


def is_stop(hierarchy, mask):
    faces = np.flatnonzero(mask)
    return any(np.array_equal(np.sort(hierarchy.faces(stop)), faces) for stop in hierarchy.wheel(faces[0])[0])


@pytest.fixture(scope="module")
def cross():
    """A body with four equal arms, and faces that are two thirds of one arm."""
    shape = shapes.polycube([(0, 0, 0)] + [tuple(step * sign * (axis == a) for axis in range(3))
                                           for step in (1, 2, 3) for sign in (-1, 1) for a in range(2)])
    centers = np.array([shape.vertices[shape.triangles[shape.faces == f]].reshape(-1, 3).mean(axis=0) for f in range(shape.face_count)])
    outer = centers - centers.mean(axis=0)
    return shape, Hierarchy.build(*shape), outer


def test_a_part_takes_its_mirror_images_along(cross):
    shape, h, centers = cross
    part = centers[:, 0] > 1.5
    assert not is_stop(h, part) or h.score[h.wheel(int(np.flatnonzero(part)[0]))[0]].max() < 1
    parts = extend_own_parts(h, *shape[:3], [], [part])
    for axis, sign in ((0, 1), (0, -1)):
        image = sign * centers[:, axis] > 1.5
        assert any((known == image).all() for known in parts)
    tree = with_own_parts(h, parts)
    assert all(is_stop(tree, known) for known in parts)
    assert all(are_nested(one, other) for one in parts for other in parts)


def test_a_new_part_replaces_those_that_it_crosses(build_shape):
    shape, h = build_shape("hand.off")
    order = h.order
    a, b, c = (mask_of(h, order[first:last]) for first, last in ((100, 300), (200, 400), (120, 180)))
    assert not are_nested(a, b) and are_nested(a, c)
    known = extend_own_parts(h, *shape[:3], [], [a])
    known = extend_own_parts(h, *shape[:3], known, [c])
    assert (known[0] == c).all() and any((mask == a).all() for mask in known)
    known = extend_own_parts(h, *shape[:3], known, [b])
    assert (known[0] == b).all() and not any((mask == a).all() for mask in known)
    assert all(are_nested(one, other) for one in known for other in known) and len(known) <= MAX_OWN_PARTS


def test_what_can_be_no_node_is_left_out(build_shape):
    shape, h = build_shape("three cubes apart")
    across = np.zeros(shape.face_count, bool)
    across[[0, 7]] = True
    assert extend_own_parts(h, *shape[:3], [], [across]) == []
    assert with_own_parts(h, [across]) is h


def test_it_can_be_canceled(build_shape):
    shape, h = build_shape("hand.off")
    context = Context()
    context.cancel()
    with pytest.raises(PartwheelError, match="canceled"):
        extend_own_parts(h, *shape[:3], [], [mask_of(h, h.order[:50])], context)


def test_a_symmetric_model_gets_the_part_on_both_sides(meshes_directory):
    mesh = meshes.read(meshes_directory / "pig.off")
    h = Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count)
    leaves = [node for node in np.flatnonzero(h.score > 0.3) if 0.01 < h.area[node] / h.area[-1] < 0.1]
    counts = []
    for part in (mask_of(h, h.faces(leaf)) for leaf in leaves):
        parts = extend_own_parts(h, mesh.vertices, mesh.triangles, mesh.faces, [], [part])
        assert (parts[0] == part).all()
        counts.append(len(parts))
    assert np.mean(np.array(counts) >= 2) > 0.8  # a part in the middle has no image


def load_states():
    """The one file of Parts to... that needs neither Blender nor the add-on's other files."""
    spec = importlib.util.spec_from_file_location("cut_states", ROOT / "addon" / "partwheel" / "cut" / "states.py")
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_only_parts_that_clicks_and_drags_made_are_own(build_shape):
    _, h = build_shape("hand.off")
    states = load_states()
    start = states.CutState(Cut.into(h, 6))
    assert start.turn(2).turn(-3).with_digit("7").own_parts_so_far == frozenset()
    face = int(np.flatnonzero(start.cut.labels == 2)[0])
    clicked = start.click(face)
    split = clicked.turn(-1)
    assert split.own_parts_so_far == set(split.cut.parts) - set(start.cut.parts) and len(split.own_parts_so_far) == 2
    assert split.turn(1).own_parts_so_far == frozenset()
    merged = split.merge(*(int(np.flatnonzero(split.cut.labels == part)[0]) for part in (0, 1)))
    new = set(merged.cut.parts) - set(split.cut.parts)
    assert merged.own_parts_so_far == split.own_parts_so_far | new and len(new) == 1
    typed = merged.with_digit("9")
    assert typed.own_parts_so_far == typed.without_digit().own_parts_so_far == merged.own_parts_so_far
