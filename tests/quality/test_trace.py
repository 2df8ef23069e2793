# SPDX-License-Identifier: GPL-3.0-or-later
"""What fitting sees, by quality_trace, against the independent implementation of tests/core: the features that the networks
get of each pair and node, in the order in which pairs come up."""

import functools
import subprocess

import numpy as np
import pytest
from fit import ROOT, Hierarchy, Mode, Traced
from reference_merge_policy import NODE_NAMES, PAIR_NAMES, MergedParts
from test_merge_policy import TOLERANCE, shape_of

# A few of those whose whole trees tests/core compares; one is of several pieces.
MODELS = ("hand", "P, mpi, hand", "nefertiti", "joint")
# The logarithm of next to nothing makes a rounding error larger.
WIDER = {name: 1e-8 for name in ("excess_to_s", "excess_to_all")}
PROGRAM = ROOT / "build" / "bench" / "quality_trace"


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    directory = tmp_path_factory.mktemp("traces")

    @functools.cache
    def build(name):
        paper = Hierarchy.build(*shape_of(name), mode=Mode.PAPER)
        (directory / "model.hierarchy").write_bytes(paper.save())
        subprocess.run([PROGRAM, "-", directory, directory / "model.hierarchy"], check=True)
        return (MergedParts(paper.vertices, paper.tetrahedra, paper.merges, paper.summary.components),
                Traced(directory / "model.trace"))

    return build


def agree(found, wanted, names):
    assert found.shape == (len(wanted), len(names))
    furthest = np.abs(found - np.array(wanted)).max(axis=0)
    assert {name: far for name, far in zip(names, furthest) if not far < WIDER.get(name, TOLERANCE)} == {}


@pytest.mark.parametrize("name", MODELS)
def test_pairs(name, both):
    reference, traced = both(name)
    pairs = reference.at_first + reference.priced
    assert traced.pairs.tolist() == [[a, b] for a, b, _ in pairs]
    agree(traced.pair_measures, [measures for _, _, measures in pairs], PAIR_NAMES)


@pytest.mark.parametrize("name", MODELS)
def test_nodes(name, both):
    reference, traced = both(name)
    _, parts, joined = traced.last
    assert parts == reference.fine and np.array_equal(np.sort(joined), np.sort(reference.joined))
    agree(traced.node_measures, reference.node_measures, NODE_NAMES)
