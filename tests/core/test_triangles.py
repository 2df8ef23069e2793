# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures of triangles."""

import numpy as np
import pytest
from partwheel.triangles import nearest_targets, winding_number

CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
SIDES = np.array([(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
                  (1, 5, 7), (1, 7, 3)])


@pytest.mark.parametrize("point, expected", [((0.5, 0.5, 0.5), 1), ((0.1, 0.9, 0.3), 1), ((1.1, 0.5, 0.5), 0), ((9, 9, 9), 0)])
def test_winding_numbers_of_a_cube(point, expected):
    corners = (CUBE - point)[SIDES].transpose(1, 0, 2)
    assert winding_number(corners) == pytest.approx(expected)
    assert winding_number(corners[::-1]) == pytest.approx(-expected)  # inside out


@pytest.mark.parametrize("degrees", [10, 50, 80])
def test_the_open_ends_of_a_tube_take_up_their_solid_angle(degrees):
    """Seen from the middle, an end is a cap of the sphere: 2 pi (1 - cos(angle)) of 4 pi."""
    around, height = np.linspace(0, 2 * np.pi, 2000), 1 / np.tan(np.radians(degrees))
    low, high = (np.stack([np.cos(around), np.sin(around), np.full(2000, z)], axis=1) for z in (-height, height))
    corners = np.concatenate([[low[:-1], low[1:], high[1:]], [low[:-1], high[1:], high[:-1]]], axis=1)
    assert winding_number(corners) == pytest.approx(np.cos(np.radians(degrees)), abs=1e-5)


@pytest.mark.parametrize("scale", [1e-30, 1e-3, 1, 1e30])
def test_the_nearest_target_does_not_depend_on_the_units(scale):
    points, targets = (np.random.default_rng(seed).normal(size=(500, 3)) for seed in (1, 2))
    nearest = np.linalg.norm(points[:, None] - targets, axis=2).argmin(axis=1)
    np.testing.assert_array_equal(nearest_targets(scale * points, scale * targets), nearest)
