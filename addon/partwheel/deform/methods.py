# SPDX-License-Identifier: GPL-3.0-or-later
"""How a region follows its handles: as rigidly as possible, at its joint, or proportionally."""

import threading
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from partwheel.deform import (FIXED, FREE, ENERGY_TOLERANCE, STEP_ANGLE, Deformation, interpolate_transform, rigid_motion,
                              rotation_angle, surface_distances)
from partwheel.components import triangle_components
from ..mesh import Refused
from .region import Region

VERTEX_ITERATIONS_PER_MOVE = 30_000  # vertices times iterations per mouse move
MAX_ITERATIONS_PER_MOVE = 5  # iterations per mouse move
MAX_SINGLE_TURN = np.radians(30)  # a handle that turns by more at once, as by a typed number, moves in steps
MIN_ANCHORS = 16  # least number of surface vertices that a loose component follows
N_STEPS = 32  # steps between the identity and the handle's matrix, of which a proportional deformation interpolates
MIRROR_X = np.diag([-1.0, 1, 1, 1])


class AsRigidAsPossible:
    """The region follows its handles, patches of its vertices, like a soft body: partwheel.deform.Deformation. Loose
    components in it (eyes, buttons) follow the surface next to them, each rigidly."""

    def __init__(self, region: Region, patches: list[np.ndarray]) -> None:
        """patches: the region's vertices of each handle. Raises Refused or PartwheelError."""
        roles = np.where(region.free, FREE, FIXED)
        for handle, patch in enumerate(patches):
            roles[patch] = handle
        if not (roles == FREE).any():
            raise Refused("The handle covers the whole part, so nothing is left to follow it: make the handle "
                          "smaller.")
        self._count, self._twins = len(patches), []
        if region.partner is not None:  # each handle has a twin across the x axis, unless it lies on it
            for handle, patch in enumerate(patches):
                twin = region.partner[patch]
                if (twin >= 0).all() and (roles[twin] == FREE).all():
                    roles[twin] = self._count + len(self._twins)
                    self._twins.append(handle)
        if len(np.unique(roles[roles >= 0])) < self._count + len(self._twins):
            raise Refused("One handle covers another: make it smaller or move it.")
        self._inputs = region.rest, region.triangles, roles
        self._iterations_per_move = min(max(VERTEX_ITERATIONS_PER_MOVE // len(roles), 1), MAX_ITERATIONS_PER_MOVE)
        self._energy, self._matrices = np.inf, [np.eye(4)] * self._count

    @cached_property
    def deformation(self) -> Deformation:
        """The factorized system: a second for 100,000 vertices at first use, in any thread. Raises PartwheelError."""
        return Deformation(*self._inputs)

    @cached_property
    def _loose_components(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """[(vertices of a loose component, surface vertices that it follows)]"""
        rest, triangles, roles = self._inputs
        is_loose = np.isinf(surface_distances(rest, triangles, roles != FREE))
        loose_triangles = triangles[is_loose[triangles[:, 0]]]
        if not len(loose_triangles):
            return []
        labels = triangle_components(loose_triangles)
        anchors = np.flatnonzero(~is_loose & (roles != FIXED))
        components = []
        for number in range(labels.max() + 1):
            component = np.unique(loose_triangles[labels == number])
            center = rest[component].mean(axis=0)
            distance = np.linalg.norm(rest[anchors] - center, axis=1)
            is_near = distance <= distance.min() + np.linalg.norm(rest[component] - center, axis=1).max()
            components.append((component,
                               anchors[np.argsort(distance, kind="stable")[:max(MIN_ANCHORS, is_near.sum())]]))
        return components

    def _with_twins(self, matrices: list[np.ndarray]) -> list[np.ndarray]:
        return [*matrices, *(MIRROR_X @ matrices[handle] @ MIRROR_X for handle in self._twins)]

    def follow(self, matrices: list[np.ndarray]) -> None:
        """Moves the handles to their matrices (4, 4), and the region as far as one mouse move has time for."""
        steps = [_relative_transform(before, matrix) for before, matrix in zip(self._matrices, matrices)]
        turn = max((rotation_angle(step[:3, :3]) for step in steps if step is not None), default=0)
        count = 1 if turn < MAX_SINGLE_TURN else int(np.ceil(turn / STEP_ANGLE))
        for number in range(1, count + 1):
            targets = matrices if number == count else [
                matrix if step is None else interpolate_transform(step, number / count) @ before
                for before, step, matrix in zip(self._matrices, steps, matrices)]
            for handle, matrix in enumerate(self._with_twins(targets)):
                self.deformation.move(handle, matrix)
            self.deformation.iterate(self._iterations_per_move)
        self._energy, self._matrices = np.inf, matrices

    def relax(self) -> bool:
        """A few more iterations towards the rest shape. Returns whether there is more to do."""
        self.deformation.iterate(self._iterations_per_move)
        before, self._energy = self._energy, self.deformation.energy()
        return before - self._energy > ENERGY_TOLERANCE * self._iterations_per_move * before

    def settle(self, stop: threading.Event | None = None) -> None:
        """Iterates to the rest shape, unless the threading.Event stop is set."""
        self.deformation.settle(stop=stop)

    def solve(self, matrices: list[np.ndarray], stop: threading.Event | None = None) -> None:
        """Moves the handles to their matrices and iterates to the rest shape, from the original one."""
        if all((matrix == np.eye(4)).all() for matrix in matrices):
            self.deformation.reset()  # without rounding
        else:
            self.deformation.move_in_steps(self._with_twins(matrices), stop)
        self._loose_components  # computed here, in the background
        self._energy, self._matrices = np.inf, matrices

    def points(self) -> np.ndarray:
        """(n, 3) the region's vertices now."""
        points, rest = self.deformation.positions(), self._inputs[0]
        for component, anchors in self._loose_components:
            rotation, translation = rigid_motion(rest[anchors], points[anchors])
            points[component] = rest[component] @ rotation.T + translation
        return points


def _relative_transform(start: np.ndarray, end: np.ndarray) -> np.ndarray | None:
    """end @ inverse(start); None if start is singular or the result is not finite."""
    if not np.linalg.cond(start) < 1e12:
        return None
    step = end @ np.linalg.inv(start)
    return step if np.isfinite(step).all() else None


class JointBending(AsRigidAsPossible):
    """A limb keeps its shape and moves as a whole; what is near its border bends, as rigidly as possible."""

    def __init__(self, region: Region, _patches: Sequence[np.ndarray] = ()) -> None:
        if not len(region.limb):
            raise Refused("No visible part of this limb is beyond its joint: make the joint smaller.")
        super().__init__(region, [region.limb])


class ProportionalDeformation:
    """The region follows one matrix, with a weight that falls to 0 at its border, by the distance along the surface."""

    def __init__(self, region: Region, _patches: Sequence[np.ndarray] = ()) -> None:
        distance = surface_distances(region.rest, region.triangles, ~region.free)
        farthest = distance[np.isfinite(distance)].max()
        fraction = np.minimum(distance / farthest, 1) if farthest > 0 else region.free.astype(float)
        self.weight = fraction * fraction * (3 - 2 * fraction)  # Blender's "smooth" falloff
        self._rest = self._points = region.rest

    def follow(self, matrices: list[np.ndarray]) -> None:
        """Moves the region to the first matrix (4, 4)."""
        steps = np.array([interpolate_transform(np.asarray(matrices[0], float), number / N_STEPS)
                          for number in range(N_STEPS + 1)])
        lower = np.minimum((self.weight * N_STEPS).astype(int), N_STEPS - 1)
        upper_weight = (self.weight * N_STEPS - lower)[:, None, None]
        matrix = (1 - upper_weight) * steps[lower] + upper_weight * steps[lower + 1]
        points = np.einsum("nij,nj->ni", matrix[:, :3, :3], self._rest) + matrix[:, :3, 3]
        self._points = np.where(self.weight[:, None] > 0, points, self._rest)

    def solve(self, matrices: list[np.ndarray], _stop: threading.Event | None = None) -> None:
        self.follow(matrices)

    def relax(self) -> bool:
        return False

    def settle(self, _stop: threading.Event | None = None) -> None:
        """Nothing to do."""

    def points(self) -> np.ndarray:
        return self._points


METHODS = {"RIGID": AsRigidAsPossible, "PROPORTIONAL": ProportionalDeformation, "JOINT": JointBending}
