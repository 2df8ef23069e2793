# SPDX-License-Identifier: GPL-3.0-or-later
"""How a region follows its handles: as rigidly as possible, about its joint, or proportionally."""

from functools import cached_property

import numpy as np

from partwheel.deform import (
    FIXED, FREE, ENERGY_TOLERANCE, STEP_ANGLE, Deformation, interpolate_transform, rigid_motion, rotation_angle, surface_distances,
)
from partwheel.joint import edge_components
from ..mesh.errors import Refused

AT_ONCE, MOST_AT_ONCE = 30_000, 5  # iterations at a mouse move: so many vertices' in all; but no more than so many
TURN = np.radians(30)  # a handle that turns by more at once, as by a typed number, goes there in steps
BESIDE = 16  # at least so many vertices of the surface say where a loose piece near them goes
WAYS = 32  # matrices between rest and the handle's that a proportional deformation mixes
MIRROR = np.diag([-1.0, 1, 1, 1])


class AsRigidAsPossible:
    """The region follows its handles, patches of its vertices, like a soft body: partwheel.deform.Deformation. Loose
    pieces in it (eyes, buttons) go with the surface next to them, each as a whole."""

    def __init__(self, region, patches):
        """patches: the region's vertices of each handle. Raises Refused or PartwheelError."""
        roles = np.where(region.free, FREE, FIXED)
        for handle, patch in enumerate(patches):
            roles[patch] = handle
        if not (roles == FREE).any():
            raise Refused("The handle is the whole part, so nothing is left to follow it: make the handle smaller.")
        self._count, self._twins = len(patches), []
        if region.partner is not None:  # each handle has one across the x axis, unless it lies in the middle
            for handle, patch in enumerate(patches):
                other = region.partner[patch]
                if (other >= 0).all() and (roles[other] == FREE).all():
                    roles[other] = self._count + len(self._twins)
                    self._twins.append(handle)
        if len(np.unique(roles[roles >= 0])) < self._count + len(self._twins):
            raise Refused("One handle covers another: make it smaller, or put it elsewhere.")
        self._given = region.rest, region.triangles, roles
        self._at_once = min(max(AT_ONCE // len(roles), 1), MOST_AT_ONCE)
        self._energy, self._at = np.inf, [np.eye(4)] * self._count

    @cached_property
    def deformation(self):
        """Factorizing takes a second for 100,000 vertices: at the first use, in any thread. Raises PartwheelError."""
        return Deformation(*self._given)

    @cached_property
    def _pieces(self):
        """[(vertices of a loose piece, those of the surface that it goes with)]"""
        rest, triangles, roles = self._given
        loose = np.isinf(surface_distances(rest, triangles, roles != FREE))
        within = triangles[loose[triangles[:, 0]]]
        if not len(within):
            return []
        group = edge_components(within[:, [[0, 1], [1, 2]]].reshape(-1, 2))[::2]
        ends = np.flatnonzero(~loose & (roles != FIXED))
        pieces = []
        for number in range(group.max() + 1):
            piece = np.unique(within[group == number])
            middle = rest[piece].mean(axis=0)
            away = np.linalg.norm(rest[ends] - middle, axis=1)
            near = away <= away.min() + np.linalg.norm(rest[piece] - middle, axis=1).max()
            pieces.append((piece, ends[np.argsort(away, kind="stable")[:max(BESIDE, near.sum())]]))
        return pieces

    def _all(self, matrices):
        return [*matrices, *(MIRROR @ matrices[handle] @ MIRROR for handle in self._twins)]

    def follow(self, matrices):
        """The handles go to their matrices, (4,4) each, and the region most of the way: as much as a mouse move has
        time for."""
        steps = [_step(before, matrix) for before, matrix in zip(self._at, matrices)]
        turn = max((rotation_angle(step[:3, :3]) for step in steps if step is not None), default=0)
        count = 1 if turn < TURN else int(np.ceil(turn / STEP_ANGLE))
        for at in range(1, count + 1):
            between = matrices if at == count else [
                matrix if step is None else interpolate_transform(step, at / count) @ before
                for before, step, matrix in zip(self._at, steps, matrices)]
            for handle, matrix in enumerate(self._all(between)):
                self.deformation.move(handle, matrix)
            self.deformation.iterate(self._at_once)
        self._energy, self._at = np.inf, matrices

    def go_on(self):
        """A little further towards the shape of rest. Whether there is more to do."""
        self.deformation.iterate(self._at_once)
        before, self._energy = self._energy, self.deformation.energy()
        return before - self._energy > ENERGY_TOLERANCE * self._at_once * before

    def settle(self, stop=None):
        """All the way to the shape of rest, unless the threading.Event stop is set meanwhile."""
        self.deformation.settle(stop=stop)

    def jump(self, matrices, stop=None):
        """All the way at once, from rest."""
        if all((matrix == np.eye(4)).all() for matrix in matrices):
            self.deformation.reset()  # no rounding either
        else:
            self.deformation.move_in_steps(self._all(matrices), stop)
        self._pieces  # found while nobody waits
        self._energy, self._at = np.inf, matrices

    def points(self):
        points, rest = self.deformation.positions(), self._given[0]
        for piece, beside in self._pieces:
            turn, shift = rigid_motion(rest[beside], points[beside])
            points[piece] = rest[piece] @ turn.T + shift
        return points


def _step(before, after):
    """What leads from one matrix to another; None if there is no way back from the first, or nowhere to go."""
    if not np.linalg.cond(before) < 1e12:
        return None
    step = after @ np.linalg.inv(before)
    return step if np.isfinite(step).all() else None


class AtJoint(AsRigidAsPossible):
    """A limb keeps its shape and turns, moves or grows as a whole; what is near its border bends, as rigidly as
    possible."""

    def __init__(self, region, _patches=()):
        if not len(region.limb):
            raise Refused("No part of this limb is beyond its joint and not hidden: make the joint smaller.")
        super().__init__(region, [region.limb])


class Proportional:
    """The region follows one matrix, less and less towards its border: by the distance from it along the surface."""

    def __init__(self, region, _patches=()):
        distance = surface_distances(region.rest, region.triangles, ~region.free)
        farthest = distance[np.isfinite(distance)].max()
        share = np.minimum(distance / farthest, 1) if farthest > 0 else region.free.astype(float)
        self.weight = share * share * (3 - 2 * share)  # Blender's "smooth" falloff
        self._rest = self._now = region.rest

    def follow(self, matrices):
        ways = np.array([interpolate_transform(np.asarray(matrices[0], float), way / WAYS) for way in range(WAYS + 1)])
        below = np.minimum((self.weight * WAYS).astype(int), WAYS - 1)
        rest = (self.weight * WAYS - below)[:, None, None]
        matrix = (1 - rest) * ways[below] + rest * ways[below + 1]
        now = np.einsum("nij,nj->ni", matrix[:, :3, :3], self._rest) + matrix[:, :3, 3]
        self._now = np.where(self.weight[:, None] > 0, now, self._rest)

    def jump(self, matrices, _stop=None):
        self.follow(matrices)

    def go_on(self):
        return False

    def settle(self, _stop=None):
        pass

    def points(self):
        return self._now


METHODS = {"RIGID": AsRigidAsPossible, "PROPORTIONAL": Proportional, "JOINT": AtJoint}
