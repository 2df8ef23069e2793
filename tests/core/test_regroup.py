# SPDX-License-Identifier: GPL-3.0-or-later
"""The regrouped top of the tree and its scores, against the independent implementation in reference_regroup.py."""

import functools

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, Mode
from reference_regroup import NODE_NAMES, PAIR_NAMES, Regrouped

# Without the symmetries by which costs tie: there the last bit of a hull's volume decides.
MODELS = ["P", "hand", "elephant", "helmet", "femur", "blobby", "mpi", "double-torus-example", "dragknob", "cross"]
OF_SEVERAL_PIECES = {
    "helmet, P": lambda: shapes.merged(of_length_1("helmet", 0), of_length_1("P", 1.5)),
    "P, mpi, hand": lambda: shapes.merged(of_length_1("P", 0), of_length_1("mpi", 1.5), of_length_1("hand", 4)),
}
TOLERANCE = 1e-9


def of_length_1(name, x):
    """A model of length 1, at x."""
    shape = shapes.off(name)
    shape = shapes.moved(shape, scale=1 / np.ptp(shape.vertices, axis=0).max())
    return shapes.moved(shape, np.array([x, 0, 0]) - shape.vertices.min(axis=0))


def signatures(tetrahedra):
    """(T,) a number for each tetrahedron, so that sums of them tell sets of tetrahedra apart."""
    numbers = np.zeros(len(tetrahedra), np.uint64)
    for corner in np.sort(tetrahedra, axis=1).astype(np.uint64).T:
        numbers = (numbers ^ (corner + np.uint64(0x9E3779B97F4A7C15))) * np.uint64(0xBF58476D1CE4E5B9)
        numbers ^= numbers >> np.uint64(29)
    return numbers


@functools.cache
def both(name):
    """({set of tetrahedra: score}, {set: the sets of the two that it was joined from}): the reference's, the build's."""
    shape = OF_SEVERAL_PIECES[name]() if name in OF_SEVERAL_PIECES else shapes.off(name)
    paper = Hierarchy.build(*shape, mode=Mode.PAPER)
    reference = Regrouped(paper.vertices, paper.tetrahedra, paper.merges, paper.summary.components)
    numbers = signatures(paper.tetrahedra)
    sets = [int(numbers[np.concatenate(part.tetrahedra)].sum()) for part in reference.parts]
    wanted = (dict(zip(sets, reference.scores)),
              {sets[reference.fine + j]: {sets[a], sets[b]} for j, (a, b) in enumerate(reference.joined)})

    built = Hierarchy.build(*shape)
    assert np.array_equal(built.vertices, paper.vertices)
    total = np.zeros(len(built.tetrahedra) + 1, np.uint64)
    np.cumsum(signatures(built.tetrahedra), out=total[1:])
    sets = (total[built.tet_last] - total[built.tet_first]).tolist()
    scored = np.flatnonzero(built.score)
    halves = {}
    for node in scored[scored != len(built.parent) - 1]:
        halves.setdefault(sets[built.parent[node]], set()).add(sets[node])
    return wanted, ({sets[node]: built.score[node] for node in scored}, halves)


ALL = [*MODELS, *OF_SEVERAL_PIECES]


@pytest.mark.parametrize("name", ALL)
def test_parts_and_what_is_joined(name):
    (wanted, halves), (found, built_halves) = both(name)
    assert len(wanted) > 10 and found.keys() == wanted.keys()
    assert built_halves == halves


@pytest.mark.parametrize("name", ALL)
def test_scores(name):
    (wanted, _), (found, _) = both(name)
    assert max(abs(found[key] - wanted[key]) for key in wanted) < TOLERANCE


def test_the_measures_are_all_named():
    assert len(set(PAIR_NAMES)) == 28 and len(set(NODE_NAMES)) == 32
