# SPDX-License-Identifier: GPL-3.0-or-later
"""The saved form: it comes back whole, and nothing forged does harm. Damaged bytes: tests/native/hierarchy_test.cpp."""

import numpy as np
import pytest
import shapes
from partwheel import Hierarchy, PartwheelError, Status
from partwheel.library import Arrays


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
    for parts in (1, len(h.tetrahedra) // 2 + 1):
        assert np.array_equal(h.cut_parts(parts), other.cut_parts(parts))
        assert np.array_equal(h.cut_least_concavity(parts), other.cut_least_concavity(parts))


def test_other_bytes_like_objects_load(build_shape):
    data = build_shape("cube")[1].save()
    for form in (bytearray(data), memoryview(data), np.frombuffer(data, np.uint8)):
        assert Hierarchy.load(form).save() == data


def hash_of(data):
    """As the saved form ends: FNV-1a by words of 8 bytes, then by bytes, each word's product rotated."""
    prime, mask = 0x100000001B3, 2**64 - 1
    value, whole = 0xCBF29CE484222325, len(data) // 8 * 8
    for word in np.frombuffer(data[:whole], "<u8").tolist():
        value = (value ^ word) * prime & mask
        value = (value << 29 | value >> 35) & mask
    for byte in data[whole:]:
        value = (value ^ byte) * prime & mask
    return value.to_bytes(8, "little")


def check_header(h):
    """What the header promises of any hierarchy."""
    faces, nodes, tets = len(h.order), len(h.parent), len(h.tetrahedra)
    assert np.array_equal(np.sort(h.order), np.arange(faces))
    assert h.parent[-1] == -1 and (h.parent[:-1] > np.arange(nodes - 1)).all() and h.parent.max(initial=-1) < nodes
    assert (h.first[:-1] >= h.first[h.parent[:-1]]).all() and (h.last[:-1] <= h.last[h.parent[:-1]]).all()
    assert (h.first[-1], h.last[-1], h.tet_first[-1], h.tet_last[-1]) == (0, faces, 0, tets)
    for values in (h.cost, h.height, h.volume, h.area, h.score, h.vertices):
        assert np.isfinite(values).all()
    stops, start = h.wheel(faces // 2)
    assert 0 <= start < len(stops) and stops[-1] == nodes - 1
    for bounds in (h.cut_parts(1), h.cut_parts(tets), h.cut_automatic(), h.cut_height(0)):
        assert (bounds[0], bounds[-1]) == (0, tets) and (np.diff(bounds) > 0).all()
    h.hull(nodes - 1)
    try:
        h.solid(nodes - 1)
    except PartwheelError as error:
        assert error.status in {Status.DATA, Status.EMPTY}


@pytest.mark.parametrize("name", shapes.lighter(["star", "cube", "L", "three cubes apart"], 1))
def test_forged_bytes_are_refused_or_harmless(name, build_shape):
    sound = build_shape(name)[1].save()
    assert hash_of(sound[:-8]) == sound[-8:]
    random = np.random.default_rng(5)
    loaded = 0
    for _ in range(1500):
        forged = np.frombuffer(sound[:-8], np.uint8).copy()
        for place in random.integers(8, len(forged), random.integers(1, 4)):
            forged[place] = random.choice([random.integers(256), 0, 1, 255, forged[place] ^ 1 << random.integers(8)])
        if random.random() < 0.2:
            forged = np.delete(forged, random.integers(8, len(forged), random.integers(1, 9)))
        forged = forged.tobytes()
        try:
            h = Hierarchy.load(forged + hash_of(forged))
        except PartwheelError as error:
            assert error.status == Status.DATA
            continue
        loaded += 1
        check_header(h)
        saved_again = h.save()
        assert Hierarchy.load(saved_again).save() == saved_again
    assert loaded > 20, "nothing got behind the first checks"
