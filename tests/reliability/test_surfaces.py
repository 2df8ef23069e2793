# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact test of two triangles, on cases small enough to see."""

import numpy as np
import pytest
import surfaces

BASE = [(0, 0, 0), (4, 0, 0), (0, 4, 0)]
CASES = {
    "apart": ([(9, 9, 9), (10, 9, 9), (9, 10, 9)], False),
    "through": ([(1, 1, -1), (1, 1, 1), (2, 2, 1)], True),
    "a corner on it": ([(1, 1, 0), (1, 1, 1), (2, 2, 1)], True),
    "an edge on it": ([(1, 1, 0), (2, 1, 0), (2, 2, 1)], True),
    "flat beside it": ([(5, 5, 0), (6, 5, 0), (5, 6, 0)], False),
    "flat within it": ([(1, 1, 0), (2, 1, 0), (1, 2, 0)], True),
    "flat around it": ([(-9, -9, 0), (40, -9, 0), (-9, 40, 0)], True),
    "flat across it": ([(1, -1, 0), (1, 9, 0), (2, 9, 0)], True),
    "above": ([(1, 1, 0.001), (2, 1, 0.001), (1, 2, 0.001)], False),
    "sharing a vertex, apart": ([0, (-1, -1, 1), (-1, -2, 1)], False),
    "sharing a vertex, through": ([0, (2, 2, 1), (2, 2, -1)], True),
    "sharing a vertex, flat beside": ([0, (-1, 0, 0), (0, -1, 0)], False),
    "sharing a vertex, flat over": ([0, (1, 1, 0), (2, 1, 0)], True),
    "sharing an edge": ([1, 0, (2, 2, 2)], False),
    "sharing an edge, flat beside": ([1, 0, (2, -2, 0)], False),
    "sharing an edge, folded onto it": ([1, 0, (1, 1, 0)], True),
    "the same turned": ([2, 1, 0], True),
}


@pytest.mark.parametrize("name", CASES)
def test_pairs(name):
    second, expected = CASES[name]
    points = BASE + [corner for corner in second if not isinstance(corner, int)]
    names = iter(range(3, 6))
    triangles = np.array([[0, 1, 2], [corner if isinstance(corner, int) else next(names) for corner in second]])
    for turn in range(3):
        for order in (1, -1):
            turned = np.array([np.roll(triangles[0], turn)[::order], triangles[1]])
            assert surfaces.crossing(np.array(points, float), turned, 0, 1) == expected
            assert surfaces.crossing(np.array(points, float), turned, 1, 0) == expected


def test_defects():
    cube = np.array([(x, y, z) for x in (0.0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    assert surfaces.defects(cube, triangles) == set()
    assert surfaces.defects(cube, triangles[1:]) == {"open"}
    assert surfaces.defects(cube, np.vstack([triangles[:1, ::-1], triangles[1:]])) == {"orientation"}
    double = np.vstack([cube, cube[1:] * -1])
    other = np.where(triangles == 0, 0, triangles + 7)[:, ::-1]
    assert surfaces.defects(double, np.vstack([triangles, other])) == {"non-manifold"}
    assert "degenerate" in surfaces.defects(cube, np.vstack([triangles, [[0, 0, 1]]]))
    assert surfaces.defects(cube, np.vstack([triangles, [[0, 1, 8]]])) == {"index"}
