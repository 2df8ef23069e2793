# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies that earlier versions saved: tests/core/saved/FORMAT-MODEL.partwheel, never written anew. A format that is still
read gives the same hierarchy for ever; others are refused in words that say whether they are older or newer."""

import struct
from pathlib import Path

import numpy as np
import pytest
from partwheel import Hierarchy, PartwheelError, Status

SAVED = Path(__file__).with_name("saved")
FORMAT = 7  # that this version writes; when it grows, files of the one before stay here
# File -> faces, nodes, tetrahedra, way taken.
READ = {
    "5-first_tripod": (44, 84, 43, "exact"),  # by the first commit that wrote the format
    "5-open_cube": (10, 7, 6, "repaired"),
    "5-star": (12, 56, 31, "exact"),
    "5-tripod": (44, 84, 43, "exact"),
    "6-open_cube": (10, 7, 6, "repaired"),
    "6-tripod": (44, 84, 43, "exact"),
    "7-assembly": (42, 212, 138, "sheet"),
    "7-open_cube": (10, 7, 6, "repaired"),
    "7-tripod": (44, 84, 43, "exact"),
}


REFUSED = ("4-tripod",)  # by the last commit before that


def data(name):
    return (SAVED / f"{name}.partwheel").read_bytes()


def refusal(saved):
    with pytest.raises(PartwheelError) as refused:
        Hierarchy.load(saved)
    assert refused.value.status == Status.DATA
    return str(refused.value)


@pytest.mark.parametrize("name", READ)
def test_saves_of_this_version_load(name):
    h = Hierarchy.load(data(name))
    assert (len(h.order), len(h.parent), len(h.tetrahedra), h.summary.fill_method) == READ[name]
    assert np.array_equal(np.sort(h.order), np.arange(len(h.order)))
    stops, start = h.wheel(0)
    assert stops[-1] == len(h.parent) - 1 and 0 <= start < len(stops)
    assert h.solid(len(h.parent) - 1).triangles.shape[1] == 3


def test_newer_saves_are_refused_by_version():
    for later in (FORMAT + 1, 2**32 - 1):
        newer = bytearray(data("7-tripod"))
        newer[8:12] = struct.pack("<I", later)
        for saved in (newer, newer[:12], newer + b"what no one knows"):
            assert "by a newer version of Partwheel" in refusal(bytes(saved))


@pytest.mark.parametrize("name", REFUSED)
def test_older_saves_are_refused_by_version(name):
    message = refusal(data(name))
    assert "by an older version of Partwheel" in message and "Build it again" in message
