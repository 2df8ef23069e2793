# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass, center of mass and inertia of the solid itself. Hulls overlap and are larger, so a simulator must not add up theirs."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ..hierarchy import Hierarchy

DEFAULT_DENSITY = 1000.0  # kg / m^3, as MuJoCo has it


class MassProperties(NamedTuple):
    """Of a rigid body.

    mass : kg
    center : (3,) m, the center of mass
    inertia : (3, 3) kg m^2, about the center, along the model's axes
    """

    mass: float
    center: np.ndarray
    inertia: np.ndarray


def mass_properties(hierarchy: Hierarchy, density: float = DEFAULT_DENSITY) -> MassProperties:
    """The mass properties of a hierarchy's tetrahedra, for a uniform density and coordinates in meters.

    Exact but for rounding: over a tetrahedron of volume V with corners p_i, the integral of x x^T is
    V / 20 (sum p_i p_i^T + s s^T), with s = sum p_i.

    Parameters
    ----------
    density : kg / m^3
    """
    origin = hierarchy.vertices.mean(axis=0)  # rounding is relative to the distance from here
    corners = (hierarchy.vertices - origin)[hierarchy.tetrahedra]
    mass = density * abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    sums = corners.sum(axis=1)
    center = mass @ sums / (4 * mass.sum())
    moments = (np.einsum("t,tki,tkj->ij", mass, corners, corners) + np.einsum("t,ti,tj->ij", mass, sums, sums)) / 20
    moments -= mass.sum() * np.outer(center, center)
    return MassProperties(float(mass.sum()), origin + center, np.trace(moments) * np.eye(3) - moments)
