# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts made by hand as nodes of a hierarchy: compared with sets of faces, and with hulls by scipy."""

import numpy as np
import pytest
from partwheel import Hierarchy, Mode, PartwheelError
from scipy.spatial import ConvexHull
from solid_checks import check_solid


def face_sets(hierarchy):
    """{faces: scores} of all nodes with a score."""
    sets = {}
    for node in np.flatnonzero(hierarchy.score > 0):
        sets.setdefault(frozenset(hierarchy.faces(node).tolist()), set()).add(hierarchy.score[node])
    return sets


def random_part(hierarchy, seed):
    """Faces of one random node or of another but not of both. Half of the nodes are scored ones, that is, large."""
    rng = np.random.default_rng(seed)
    filled = np.flatnonzero((hierarchy.last > hierarchy.first) & (hierarchy.parent >= 0))
    pools = filled[hierarchy.score[filled] > 0], filled
    one, other = (set(hierarchy.faces(rng.choice(pools[(seed >> k) % 2])).tolist()) for k in range(2))
    return one ^ other or one


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("name", ["hand.off", "torus", "three cubes apart"])
def test_the_part_is_a_node_and_others_stay(build_shape, name, seed):
    _, before = build_shape(name)
    part = random_part(before, seed)
    try:
        after = before.with_part(sorted(part))
    except PartwheelError as error:
        assert name == "three cubes apart" and "only some faces of a shell" in str(error)
        return
    sets = face_sets(after)
    assert 1 in sets[frozenset(part)]
    for faces, scores in face_sets(before).items():
        if faces != part and (faces <= part or faces >= part or not faces & part):
            assert scores <= sets[faces]
    for node in np.flatnonzero(after.score == 1):
        assert before.summary.shells > 1 or set(after.faces(node).tolist()) == part
    for face in sorted(part)[::7]:
        stops, _ = after.wheel(face)
        assert frozenset(part) in {frozenset(after.faces(stop).tolist()) for stop in stops}
        assert (np.diff(after.area[stops]) > 0).all()
    assert np.array_equal(np.sort(after.order), np.arange(len(before.order)))
    assert np.isclose(after.volume[-1], before.volume[-1], rtol=1e-12) and np.allclose(after.area[-1], before.area[-1])
    saved = after.save()
    assert Hierarchy.load(saved).save() == saved
    assert len(after.with_part(sorted(part)).merges) == len(after.merges)


@pytest.mark.parametrize("seed", range(6))
def test_pieces_have_the_concavity_of_their_hulls_and_are_closed_solids(build_shape, seed):
    _, before = build_shape("hand.off")
    after = before.with_part(sorted(random_part(before, 4 * seed)))
    for node in np.flatnonzero((after.score > 0) & (after.last > after.first)):
        corners = after.vertices[np.unique(after.tetrahedra[after.tet_first[node]:after.tet_last[node]])]
        concavity = ConvexHull(corners).volume - after.volume[node]
        expected = concavity if after.cost_class[node] else 0
        assert abs((after.cost[node] if after.cost_class[node] else 0) - expected) < 1e-6 * after.summary.hull_volume
    part = int(np.flatnonzero(after.score == 1)[0])
    check_solid(after.solid(part))
    check_solid(after.rest(part))


@pytest.mark.parametrize("seed", range(4))
def test_pieces_score_by_their_share_of_the_area(build_shape, seed):
    _, before = build_shape("hand.off")
    part, known = frozenset(random_part(before, seed)), face_sets(before)
    after = before.with_part(sorted(part))
    originals = [(set(before.faces(node).tolist()), before.score[node] / before.area[node])
                 for node in np.flatnonzero(before.score * before.area)]
    pieces = [node for node in np.flatnonzero(after.score) if frozenset(after.faces(node).tolist()) not in {part, *known}]
    assert pieces
    for node in pieces:
        faces = set(after.faces(node).tolist())
        expected = [after.area[node] * density for original, density in originals if faces < original]
        assert np.abs(np.array(expected) - after.score[node]).min() < 1e-6


def test_two_parts_that_are_nested_or_apart_are_both_stops(build_shape):
    _, h = build_shape("hand.off")
    large, small = (set(h.faces(h.wheel(100)[0][k]).tolist()) for k in (-2, 1))
    far = next(face for face in h.order if face not in large)
    outside = set(h.faces(h.wheel(int(far))[0][1]).tolist()) - large
    h = h.with_part(sorted(large)).with_part(sorted(outside)).with_part(sorted(small))
    for part in (large, small, outside):
        face = min(small) if part is not outside else min(outside)
        assert part in [set(h.faces(stop).tolist()) for stop in h.wheel(face)[0]]


def test_whole_shells_can_be_one_part_but_pieces_of_two_cannot(build_shape):
    _, h = build_shape("three cubes apart")
    shell = [set(h.faces(node).tolist()) for node in np.flatnonzero(h.score > 0) if len(h.faces(node)) == 6]
    both = shell[0] | shell[2]
    assert frozenset(both) in face_sets(h.with_part(sorted(both)))
    with pytest.raises(PartwheelError, match="only some faces of a shell"):
        h.with_part([min(shell[0]), min(shell[1]), *shell[2]])


def test_parts_that_cannot_be_added_say_why(build_shape):
    _, h = build_shape("torus")
    for faces, message in (([], "smaller than the tetrahedra"), ([h.order.size], "no face"), ([-1], "negative")):
        with pytest.raises(PartwheelError, match=message):
            h.with_part(faces)
    _, paper = build_shape("torus", Mode.PAPER)
    with pytest.raises(PartwheelError, match="default mode"):
        paper.with_part([0])
