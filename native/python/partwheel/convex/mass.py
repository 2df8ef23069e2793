# SPDX-License-Identifier: GPL-3.0-or-later
"""Mass, center of mass and inertia of the solid itself. Hulls overlap and are larger, so a simulator must not add up theirs."""

from typing import NamedTuple

import numpy as np

from ..hierarchy import Hierarchy
from ..triangles import second_moments

DEFAULT_DENSITY = 1000.0  # kg / m^3, as MuJoCo has it


class MassProperties(NamedTuple):
    """Mass properties of a rigid body."""

    mass: float  # kg
    center: np.ndarray  # (3,) m, the center of mass
    inertia: np.ndarray  # (3, 3) kg m^2, about the center, along the model's axes


def mass_properties(hierarchy: Hierarchy, density: float = DEFAULT_DENSITY) -> MassProperties:
    """The mass properties of a hierarchy's tetrahedra, exact up to rounding, for a uniform density in kg / m^3 and
    coordinates in meters."""
    origin = hierarchy.vertices.mean(axis=0)  # rounding is relative to the distance from here
    corners = (hierarchy.vertices - origin)[hierarchy.tetrahedra]
    mass = density * abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    center = mass @ corners.mean(axis=1) / mass.sum()
    moments = second_moments(mass, corners) / 20
    moments -= mass.sum() * np.outer(center, center)
    return MassProperties(float(mass.sum()), origin + center, np.trace(moments) * np.eye(3) - moments)
