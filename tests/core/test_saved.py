# SPDX-License-Identifier: GPL-3.0-or-later
"""The saved form: it comes back whole, and nothing damaged comes back at all."""

import numpy as np
import pytest
from partwheel.core import Hierarchy, PartwheelError, Status
from partwheel.core.library import Arrays


def refused(data):
    with pytest.raises(PartwheelError) as error:
        Hierarchy.load(data)
    return error.value.status == Status.DATA


def test_round_trip(case):
    shape, h = case
    data = h.save()
    other = Hierarchy.load(data)
    for name in Arrays.POINTERS:
        assert np.array_equal(getattr(h, name), getattr(other, name)), name
    assert other.summary == h.summary and other.save() == data and other.seconds == {}
    for face in range(0, shape.face_count, 7):
        assert np.array_equal(h.wheel(face)[0], other.wheel(face)[0]) and h.wheel(face)[1] == other.wheel(face)[1]
    assert np.array_equal(h.hull(len(h.parent) - 1)[1], other.hull(len(h.parent) - 1)[1])
    assert np.array_equal(h.cut_parts(1), other.cut_parts(1))


def test_other_bytes_like_objects_load(build_shape):
    data = build_shape("cube")[1].save()
    for form in (bytearray(data), memoryview(data), np.frombuffer(data, np.uint8)):
        assert Hierarchy.load(form).save() == data


def test_every_shorter_piece_is_refused(build_shape):
    data = build_shape("cube")[1].save()
    assert all(refused(data[:length]) for length in range(len(data)))
    assert refused(data + b"\0") and refused(data + data)


def test_foreign_bytes_are_refused():
    random = np.random.default_rng(3)
    for length in (1, 8, 64, 1000, 100000):
        assert refused(b"\0" * length) and refused(b"\xff" * length) and refused(random.bytes(length))


@pytest.mark.parametrize("name", ["cube", "L", "three cubes apart", "star"])
def test_damaged_bytes_are_refused(name, build_shape):
    data = np.frombuffer(build_shape(name)[1].save(), np.uint8)
    random = np.random.default_rng(4)
    places = range(len(data)) if name == "cube" else random.integers(0, len(data), 500)
    for place in places:
        for change in (1 << random.integers(8), 0xFF):
            damaged = data.copy()
            damaged[place] ^= change
            assert refused(damaged), (place, change)
    for _ in range(500):
        damaged = data.copy()
        low, high = np.sort(random.integers(0, len(data) + 1, 2))
        damaged[low:high] = random.integers(0, 256, high - low)
        assert np.array_equal(damaged, data) or refused(damaged)
