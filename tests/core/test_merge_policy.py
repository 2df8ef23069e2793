# SPDX-License-Identifier: GPL-3.0-or-later
"""The merges of the merge policy and the scores, against the independent implementation in reference_merge_policy.py."""

import functools

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, Mode
from partwheel.cut import mirror_planes
from reference_merge_policy import MergedParts

# None is its own mirror image: there parts are copied from side to side, and the last bit of a volume decides ties.
MODELS = ["hand", "elephant", "helmet", "mpi", "knot", "nefertiti", "joint", "bull"]
TOLERANCE = 1e-9


def signatures(tetrahedra):
    """(T,) a number for each tetrahedron, so that sums of them tell sets of tetrahedra apart."""
    numbers = np.zeros(len(tetrahedra), np.uint64)
    for corner in np.sort(tetrahedra, axis=1).astype(np.uint64).T:
        numbers = (numbers ^ (corner + np.uint64(0x9E3779B97F4A7C15))) * np.uint64(0xBF58476D1CE4E5B9)
        numbers ^= numbers >> np.uint64(29)
    return numbers


def as_built(hierarchy):
    """Tetrahedra, merges and the places of the hierarchy's tetrahedra, in the order of the build: by their corners. The
    last ties go by it."""
    order = np.lexsort(hierarchy.tetrahedra.T[::-1])
    place = np.argsort(order)
    merges, count = hierarchy.merges, len(order)
    return hierarchy.tetrahedra[order], np.where(merges < count, place[np.minimum(merges, count - 1)], merges), place


@functools.cache
def compared(name):
    """The reference, the sets of tetrahedra that its parts are, in numbers; the build, and those of slices of it."""
    shape = shapes.off(name)
    assert mirror_planes(shape.vertices, shape.triangles) == []
    paper = Hierarchy.build(*shape, mode=Mode.PAPER)
    tetrahedra, merges, place = as_built(paper)
    reference = MergedParts(paper.vertices, tetrahedra, merges, paper.summary.components)
    numbers = signatures(tetrahedra)
    sets = [int(numbers[np.concatenate(part.tetrahedra)].sum()) for part in reference.parts]

    built = Hierarchy.build(*shape)
    assert np.array_equal(built.vertices, paper.vertices)
    total = np.zeros(len(built.tetrahedra) + 1, np.uint64)
    np.cumsum(signatures(built.tetrahedra), out=total[1:])
    return reference, sets, built, lambda first, last: (total[last] - total[first]).tolist()


@functools.cache
def both(name):
    """({set of tetrahedra: score}, {set: sets of the two that it was joined from}): the reference's, the build's."""
    reference, sets, built, sets_of = compared(name)
    wanted = (dict(zip(sets, reference.scores)),
              {sets[reference.fine + j]: {sets[a], sets[b]} for j, (a, b) in enumerate(reference.joined)})
    sets = sets_of(built.tet_first, built.tet_last)
    scored = np.flatnonzero(built.score)
    halves = {}
    for node in scored[scored != len(built.parent) - 1]:
        halves.setdefault(sets[built.parent[node]], set()).add(sets[node])
    return wanted, ({sets[node]: built.score[node] for node in scored}, halves)


ALL = shapes.lighter(MODELS, 3)


@pytest.mark.parametrize("name", ALL)
def test_parts_and_merges_match_the_reference(name):
    (wanted, halves), (found, built_halves) = both(name)
    assert len(wanted) > 10 and found.keys() == wanted.keys()
    assert built_halves == halves


@pytest.mark.parametrize("name", ALL)
def test_scores_match_the_reference(name):
    (wanted, _), (found, _) = both(name)
    assert max(abs(found[key] - wanted[key]) for key in wanted) < TOLERANCE
