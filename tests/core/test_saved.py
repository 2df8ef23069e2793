# SPDX-License-Identifier: GPL-3.0-or-later
"""The saved form: it comes back whole, and nothing forged does harm. Damaged bytes: tests/native/hierarchy_test.cpp."""

import numpy as np
from partwheel import Hierarchy
from partwheel.library import Arrays


def test_saving_and_loading_round_trips(case):
    shape, h = case
    data = h.save()
    other = Hierarchy.load(data)
    for name in Arrays.POINTERS:
        assert np.array_equal(getattr(h, name), getattr(other, name)), name
    assert other.summary == h.summary and other.save() == data and other.seconds == {}
    for face in range(0, shape.face_count, 7):
        assert np.array_equal(h.wheel(face)[0], other.wheel(face)[0]) and h.wheel(face)[1] == other.wheel(face)[1]
    assert np.array_equal(h.hull(len(h.parent) - 1)[1], other.hull(len(h.parent) - 1)[1])
    for parts in (1, len(h.tetrahedra) // 2 + 1):
        assert np.array_equal(h.cut_parts(parts), other.cut_parts(parts))
        assert np.array_equal(h.cut_least_concavity(parts), other.cut_least_concavity(parts))
