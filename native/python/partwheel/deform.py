# SPDX-License-Identifier: GPL-3.0-or-later
"""As-rigid-as-possible deformation by handles, and distances along a surface. Native, with numpy."""

import math
from ctypes import c_double
from threading import Event
from typing import Iterable, List, Optional, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike

from .components import to_mask
from .hierarchy import to_array, to_indices, to_mesh_view
from .library import NonCopyable, PartwheelError, Status, call_with_outputs, check, create_handle, load
from .weld import weld_surface

FREE, FIXED = -1, -2  # roles: PW_VERTEX_FREE, PW_VERTEX_FIXED
# Deformation.move_in_steps():
STEP_ANGLE = math.radians(10)  # largest rotation of a handle per step
STEP_ITERATIONS = 3  # per step
# Deformation.settle():
ENERGY_TOLERANCE = 1e-4  # relative decrease of the energy per iteration that counts as converged
MAX_ITERATIONS = 300


class Deformation(NonCopyable):
    """A surface at rest and its deformed vertices: see pw_deformation in partwheel_edit.h for the energy and its source.
    Not thread-safe.

    Parameters
    ----------
    vertices : (V, 3) float, positions at rest
    triangles : (T, 3) int, indices into vertices
    roles : (V,) int, FREE, FIXED or the handle (0, 1, ...) that the vertex follows. Coincident vertices are welded;
        of their roles a handle wins over FIXED, FIXED over FREE
    threads : the most threads; 0: chosen automatically. The result does not depend on it

    Raises
    ------
    PartwheelError : the surface or a role is invalid
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, roles: ArrayLike, *, threads: int = 0) -> None:
        vertices, triangles, _ = to_mesh_view(vertices, triangles).arrays
        roles = to_indices(roles, "roles", (len(vertices),))
        if roles.size and (roles.min() < FIXED or roles.max() >= len(vertices)):
            raise PartwheelError(Status.ARGUMENT, "Each role must be FREE, FIXED or the number of a handle.")
        self._old_to_new, triangles = weld_surface(vertices, triangles, sheets=True)
        roles = _weld_roles(roles, self._old_to_new)
        self._handle = create_handle(load().pw_deformation_free, load().pw_deformation_create, None,
                                     to_mesh_view(vertices, triangles), roles, threads)
        self._vertex_count = len(vertices)

    def move(self, handle: int, matrix: ArrayLike) -> None:
        """Move a handle's vertices to matrix times their position at rest.

        Parameters
        ----------
        handle : its number
        matrix : (4, 4), or its upper (3, 4)

        Raises
        ------
        ValueError : the matrix has another shape
        PartwheelError : there is no such handle, or an entry of the matrix is not finite
        """
        rows = to_array(matrix, "matrix", np.float64, (4, 4), (3, 4))[:3]
        handle = int(handle)
        if handle < 0:
            raise PartwheelError(Status.ARGUMENT, f"There is no handle {handle}.")
        check(load().pw_deformation_move(self._handle, handle, rows))

    def iterate(self, iterations: int = 1) -> None:
        """Move the free vertices; each iteration lowers the energy, or keeps it at its minimum."""
        check(load().pw_deformation_iterate(None, self._handle, max(int(iterations), 0)))

    def energy(self) -> float:
        """The energy, in squared units of the coordinates."""
        return call_with_outputs([c_double], load().pw_deformation_energy, self._handle)[0]

    def positions(self) -> np.ndarray:
        """The current positions of all vertices, (V, 3)."""
        positions = np.empty((self._vertex_count, 3))
        check(load().pw_deformation_positions(self._handle, positions, self._vertex_count))
        return positions[self._old_to_new]

    def reset(self) -> None:
        """Move all vertices back to their positions at rest."""
        check(load().pw_deformation_reset(self._handle))

    def settle(self, stop: Optional[Event] = None) -> None:
        """Iterate until the energy converges, at most MAX_ITERATIONS times.

        Parameters
        ----------
        stop : ends the iteration early once it is set
        """
        energy = self.energy()
        for _ in range(MAX_ITERATIONS):
            if stop and stop.is_set():
                return
            self.iterate()
            before, energy = energy, self.energy()
            if before - energy <= ENERGY_TOLERANCE * before:
                return

    def move_in_steps(self, matrices: Iterable[np.ndarray], stop: Optional[Event] = None) -> None:
        """Move all handles to their matrices, by rotations of at most STEP_ANGLE per step, so that the surface follows;
        then settle.

        Parameters
        ----------
        matrices : (4, 4) of each handle
        stop : ends the motion early once it is set
        """
        matrices = [np.asarray(matrix, np.float64) for matrix in matrices]
        count = max([1, *(math.ceil(rotation_angle(matrix[:3, :3]) / STEP_ANGLE - 1e-9) for matrix in matrices)])
        for step in range(1, count + 1):
            if stop and stop.is_set():
                return
            for handle, matrix in enumerate(matrices):
                self.move(handle, interpolate_transform(matrix, step / count))
            if step < count:
                self.iterate(STEP_ITERATIONS)
        self.settle(stop=stop)


def _weld_roles(roles: np.ndarray, old_to_new: np.ndarray) -> np.ndarray:
    """Roles (V,) after welding: a handle wins over FIXED, FIXED over FREE; vertices that no longer exist are FIXED."""
    rank = np.where(roles == FREE, FIXED - 1, roles)
    highest = np.full_like(roles, FIXED - 1)
    np.maximum.at(highest, old_to_new, rank)
    remains = old_to_new == np.arange(len(roles))
    return np.where(remains, np.where(highest < FIXED, FREE, highest), FIXED).astype(roles.dtype)


def rotation_angle(linear: np.ndarray) -> float:
    """The angle, in radians, of the rotation nearest to a (3, 3) matrix."""
    return float(np.linalg.norm(_rotation_vector(_nearest_rotation(linear))))


def rigid_motion(before: np.ndarray, after: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """The rotation R (3, 3) and translation t (3,) that minimize sum |R before_i + t - after_i|^2 of points (n, 3) (Kabsch
    1976)."""
    center, goal = before.mean(axis=0), after.mean(axis=0)
    rotation = _nearest_rotation((after - goal).T @ (before - center))
    return rotation, goal - rotation @ center


def interpolate_transform(matrix: np.ndarray, fraction: float) -> np.ndarray:
    """An affine matrix (4, 4) between the identity (fraction 0) and the given one (fraction 1): the angle of its rotation and
    its stretch are interpolated linearly."""
    if fraction == 1:
        return matrix
    rotation = _nearest_rotation(matrix[:3, :3])
    stretch = rotation.T @ matrix[:3, :3]
    linear = rotation_from_vector(fraction * _rotation_vector(rotation)) @ (np.eye(3) + fraction * (stretch - np.eye(3)))
    # The fixed point of a pure rotation stays fixed throughout, so points move on circles, not on chords.
    offset = matrix[:3, 3]
    center, *_ = np.linalg.lstsq(np.eye(3) - matrix[:3, :3], offset, rcond=1e-6)
    residual = offset - (center - matrix[:3, :3] @ center)
    return affine(linear, center - linear @ center + fraction * residual)


def _nearest_rotation(linear: np.ndarray) -> np.ndarray:
    u, _, vt = np.linalg.svd(linear)
    return u @ np.diag([1, 1, np.sign(np.linalg.det(u @ vt))]) @ vt


def _rotation_vector(rotation: np.ndarray) -> np.ndarray:
    """(3,) axis times angle of a rotation."""
    cosine = np.clip((np.trace(rotation) - 1) / 2, -1, 1)
    angle = math.acos(cosine)
    axis = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    if angle < 1e-9:
        return axis / 2
    if np.linalg.norm(axis) < 1e-6:  # half a turn: the axis is the eigenvector of eigenvalue 1
        axis = np.linalg.eigh(rotation + rotation.T)[1][:, 2]
    return angle * axis / np.linalg.norm(axis)


def rotation_from_vector(vector: np.ndarray) -> np.ndarray:
    """The rotation (3, 3) about a vector (3,), by its length in radians (Rodrigues)."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    k = cross_matrix(vector / angle)
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)


def cross_matrix(vector: np.ndarray) -> np.ndarray:
    """The (3, 3) matrix M with M @ x = cross(vector, x) for all x (3,)."""
    x, y, z = vector
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def affine(linear: np.ndarray, offset: np.ndarray) -> np.ndarray:
    """The (4, 4) matrix that takes x to linear x + offset."""
    return np.vstack([np.column_stack([linear, offset]), (0, 0, 0, 1)])


def orthonormal_pair(axis: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Unit vectors x, y that make (x, y, axis) a right-handed orthonormal frame; axis (3,) is a unit vector."""
    x = np.cross(np.eye(3)[np.abs(axis).argmin()], axis)
    x /= np.linalg.norm(x)
    return x, np.cross(axis, x)


def vertex_normals(vertices: ArrayLike, triangles: ArrayLike) -> np.ndarray:
    """(V, 3) unit normals of vertices, for shading; 0, 0, 0 where no triangle has an area. See pw_vertex_normals in
    partwheel_edit.h."""
    mesh = to_mesh_view(vertices, triangles)
    normals = np.empty_like(mesh.arrays[0])
    check(load().pw_vertex_normals(mesh, normals))
    return normals


def surface_distances(vertices: ArrayLike, triangles: ArrayLike,
                      start: Union[np.ndarray, List[int]]) -> np.ndarray:
    """Distances along a surface from the nearest start vertex; a few percent too long. Coincident vertices are welded.

    Parameters
    ----------
    vertices : (V, 3) float
    triangles : (T, 3) int, indices into vertices
    start : (V,) bool, or vertex indices

    Returns
    -------
    (V,) float64; infinite where there is no path"""
    vertices, triangles, _ = to_mesh_view(vertices, triangles).arrays
    old_to_new, triangles = weld_surface(vertices, triangles, sheets=True)
    selected, distance = to_mask(len(vertices), old_to_new[start]), np.empty(len(vertices))
    check(load().pw_surface_distances(None, to_mesh_view(vertices, triangles), selected, distance))
    return distance[old_to_new]
