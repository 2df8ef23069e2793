# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformation: a surface follows handles as rigidly as possible; and distances along a surface. Native, with numpy."""

from __future__ import annotations

import math
from ctypes import c_double
from typing import TYPE_CHECKING, Iterable, Optional, Tuple

import numpy as np

from .hierarchy import indices, surface
from .library import Handle, NonCopyable, PartwheelError, Status, check, load, made, told
from .weld import weld_surface

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from threading import Event

FREE, FIXED = -1, -2  # PW_VERTEX_FREE, PW_VERTEX_FIXED
# Deforming at once, without a mouse: the handle turns by at most so much a step.
STEP_ANGLE = math.radians(10)
STEP_ITERATIONS = 3
# Settled: an iteration lowers the energy by less than this share; or so many iterations are over.
SETTLED = 1e-4
MOST_ITERATIONS = 300


class Deformation(NonCopyable):
    """A surface at rest, and where it is now: see pw_deformation in partwheel_edit.h for the energy and its source.

    vertices (V,3) at rest; triangles (T,3) indices into them; roles (V,) FREE, FIXED or the number of the handle that a
    vertex follows, counted from 0. Coincident vertices are welded: of their roles a handle's wins, then FIXED. Not for
    several threads at a time. Raises PartwheelError.
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, roles: ArrayLike) -> None:
        vertices, _, triangles, _ = given = list(surface(vertices, triangles)[:4])
        roles = indices(roles, "roles", (len(vertices),))
        if roles.size and (roles.min() < FIXED or roles.max() >= len(vertices)):
            raise PartwheelError(Status.ARGUMENT, "A role is neither FREE, nor FIXED, nor the number of a handle.")
        self._old_to_new, given[2] = weld_surface(vertices, triangles)
        roles = _welded_roles(roles, self._old_to_new)
        self._handle = Handle(load().pw_deformation_free, made(load().pw_deformation_create, *given, roles))
        self._count = len(vertices)

    def move(self, handle: int, matrix: ArrayLike) -> None:
        """Takes a handle's vertices to matrix times their place at rest. matrix: (4,4), or its upper (3,4)."""
        matrix = np.asarray(matrix, np.float64)
        if matrix.shape not in {(3, 4), (4, 4)}:
            raise ValueError(f"matrix must have the shape (4, 4) or (3, 4), not {matrix.shape}.")
        rows = np.ascontiguousarray(matrix[:3])
        handle = int(handle)
        if handle < 0:
            raise PartwheelError(Status.ARGUMENT, f"There is no handle {handle}.")
        check(load().pw_deformation_move(self._handle, handle, rows))

    def iterate(self, iterations: int = 1) -> None:
        """Improves the free vertices' places; the energy falls, or stays where it is least."""
        check(load().pw_deformation_iterate(self._handle, max(int(iterations), 0)))

    def energy(self) -> float:
        """In the unit of the coordinates squared."""
        return told([c_double], load().pw_deformation_energy, self._handle)[0]

    def positions(self) -> np.ndarray:
        """(V,3) where all vertices are now."""
        positions = np.empty((self._count, 3))
        check(load().pw_deformation_positions(self._handle, positions, self._count))
        return positions[self._old_to_new]

    def reset(self) -> None:
        """Everything back to rest."""
        check(load().pw_deformation_reset(self._handle))

    def settle(self, settled: float = SETTLED, most: int = MOST_ITERATIONS, stop: Optional[Event] = None) -> int:
        """Iterates until little changes, or the threading.Event stop is set. The number of iterations."""
        before = self.energy()
        for done in range(1, most + 1):
            if stop and stop.is_set():
                return done - 1
            self.iterate()
            now = self.energy()
            if before - now <= settled * before:
                return done
            before = now
        return most

    def move_at_once(self, matrices: Iterable[np.ndarray], stop: Optional[Event] = None) -> None:
        """Takes every handle all the way to its matrix, (4,4) each, in steps that the surface can follow; then
        settles. Ends early if the threading.Event stop is set."""
        matrices = [np.asarray(matrix, np.float64) for matrix in matrices]
        count = max([1, *(math.ceil(rotation_angle(matrix[:3, :3]) / STEP_ANGLE - 1e-9) for matrix in matrices)])
        for step in range(1, count + 1):
            if stop and stop.is_set():
                return
            for handle, matrix in enumerate(matrices):
                self.move(handle, part_of_the_way(matrix, step / count))
            if step < count:
                self.iterate(STEP_ITERATIONS)
        self.settle(stop=stop)


def _welded_roles(roles: np.ndarray, old_to_new: np.ndarray) -> np.ndarray:
    """roles (V,) of welded vertices: those that are there no more stay."""
    rank = np.where(roles == FREE, FIXED - 1, roles)
    highest = np.full_like(roles, FIXED - 1)
    np.maximum.at(highest, old_to_new, rank)
    kept = old_to_new == np.arange(len(roles))
    return np.where(kept, np.where(highest < FIXED, FREE, highest), FIXED).astype(roles.dtype)


def rotation_angle(linear: np.ndarray) -> float:
    """The angle, in radians, of the rotation nearest to a (3,3) matrix."""
    return float(np.linalg.norm(_turn(_rotation(linear))))


def rigid_motion(before: np.ndarray, after: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """(rotation (3,3), shift (3,)): rotation @ p + shift takes points before (n,3) nearest to those after, by the sum of
    squares (Kabsch 1976)."""
    middle, goal = before.mean(axis=0), after.mean(axis=0)
    rotation = _rotation((after - goal).T @ (before - middle))
    return rotation, goal - rotation @ middle


def part_of_the_way(matrix: np.ndarray, share: float) -> np.ndarray:
    """An affine matrix (4,4) between the identity (share 0) and this one (share 1): what it turns is turned by that
    share of the angle, all else is in proportion."""
    if share == 1:
        return matrix
    rotation = _rotation(matrix[:3, :3])
    stretch = rotation.T @ matrix[:3, :3]
    turn = share * _turn(rotation)
    result = np.eye(4)
    result[:3, :3] = rotation_by(turn) @ (np.eye(3) + share * (stretch - np.eye(3)))
    # The point that a pure rotation keeps in place is kept all the way: it moves on a circle, not on a chord.
    offset = matrix[:3, 3]
    center, *_ = np.linalg.lstsq(np.eye(3) - matrix[:3, :3], offset, rcond=1e-6)
    along = offset - (center - matrix[:3, :3] @ center)
    result[:3, 3] = center - result[:3, :3] @ center + share * along
    return result


def _rotation(linear: np.ndarray) -> np.ndarray:
    u, _, vt = np.linalg.svd(linear)
    return u @ np.diag([1, 1, np.sign(np.linalg.det(u @ vt))]) @ vt


def _turn(rotation: np.ndarray) -> np.ndarray:
    """(3,) axis times angle of a rotation."""
    cosine = np.clip((np.trace(rotation) - 1) / 2, -1, 1)
    angle = math.acos(cosine)
    axis = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    if angle < 1e-9:
        return axis / 2
    if np.linalg.norm(axis) < 1e-6:  # half a turn: the axis is what stays
        axis = np.linalg.eigh(rotation + rotation.T)[1][:, 2]
    return angle * axis / np.linalg.norm(axis)


def rotation_by(turn: np.ndarray) -> np.ndarray:
    """(3,3) about turn (3,) by its length (Rodrigues)."""
    angle = np.linalg.norm(turn)
    if angle == 0:
        return np.eye(3)
    k = crossing(turn / angle)
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)


def crossing(vector: np.ndarray) -> np.ndarray:
    """(3,3) that gives the cross product with the vector on its left."""
    x, y, z = vector
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def vertex_normals(vertices: ArrayLike, triangles: ArrayLike) -> np.ndarray:
    """(V,3) of length 1, for shading; 0, 0, 0 where there are no triangles with area. See pw_vertex_normals."""
    vertices, *_ = given = surface(vertices, triangles)[:4]
    normals = np.empty_like(vertices)
    check(load().pw_vertex_normals(*given, normals))
    return normals


def surface_distances(vertices: ArrayLike, triangles: ArrayLike, start: np.ndarray) -> np.ndarray:
    """(V,) how far each vertex is from the nearest start along the surface, a few percent too long; infinity where no
    way leads. start: (V,) bool, or an array of vertex indices. Coincident vertices are welded."""
    vertices, _, triangles, _ = given = list(surface(vertices, triangles)[:4])
    old_to_new, given[2] = weld_surface(vertices, triangles)
    chosen = np.zeros(len(vertices), bool)
    chosen[start] = True
    mask = np.zeros(len(vertices), np.uint8)
    mask[old_to_new[chosen]] = 1
    distance = np.empty(len(vertices))
    check(load().pw_surface_distances(*given, mask, distance))
    return distance[old_to_new]
