# SPDX-License-Identifier: GPL-3.0-or-later
"""Spatial index of a hierarchy: point location, ray casting, nearest points and intersection, for arrays of queries."""

from __future__ import annotations

from typing import Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike

from ..hierarchy import Hierarchy, to_array, to_indices
from ..library import NonCopyable, check, create_handle, load


class Index(NonCopyable):
    """Immutable spatial index of a hierarchy: see pw_index in partwheel_edit.h.

    Every query takes an array with one row per query and returns arrays with one row per answer. Part ids are (n,) int32,
    -1 for none. Each method raises PartwheelError for coordinates that are not finite, ValueError for a wrong shape.

    Parameters
    ----------
    hierarchy : the hierarchy to index
    bounds : (K+1,) bounds of a cut: the index holds the convex hulls of its K parts. None: exact, the index holds the
        tetrahedra, which are the hierarchy's leaves; np.searchsorted(bounds, parts, "right") - 1 turns its answers into
        parts of a cut
    threads : the most threads that one call may use; 0: chosen automatically

    Raises
    ------
    PartwheelError : the bounds are not those of a cut
    """

    def __init__(self, hierarchy: Hierarchy, bounds: Optional[ArrayLike] = None, *, threads: int = 0) -> None:
        bounds = np.empty(0, np.int32) if bounds is None else to_indices(bounds, "bounds", (None,))
        self._handle = create_handle(load().pw_index_free, load().pw_index_create, None, hierarchy._handle, bounds,
                                     len(bounds), threads)

    def locate(self, points: ArrayLike) -> np.ndarray:
        """Point location.

        Parameters
        ----------
        points : (n, 3)

        Returns
        -------
        (n,) int32, the part that contains each point; the lowest id if several do, -1 outside
        """
        points = to_array(points, "points", np.float64, (None, 3))
        parts = np.empty(len(points), np.int32)
        check(load().pw_index_locate(None, self._handle, points, len(points), parts))
        return parts

    def first_hits(self, origins: ArrayLike, directions: ArrayLike) -> Tuple[np.ndarray, np.ndarray]:
        """Ray casting; facets are hit from either side.

        Parameters
        ----------
        origins, directions : (n, 3) each

        Returns
        -------
        parts : (n,) int32, the part that each ray hits first, -1 for none
        distances : (n,) float64, in lengths of the ray's direction
        """
        origins = to_array(origins, "origins", np.float64, (None, 3))
        directions = to_array(directions, "directions", np.float64, origins.shape)
        parts, distances = np.empty(len(origins), np.int32), np.empty(len(origins))
        check(load().pw_index_first_hits(None, self._handle, origins, directions, len(origins), parts, distances))
        return parts, distances

    def nearest(self, points: ArrayLike) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Nearest points.

        Parameters
        ----------
        points : (n, 3)

        Returns
        -------
        parts : (n,) int32, the part nearest to each point, or the one that contains it
        distances : (n,) float64, 0 inside
        nearest : (n, 3) float64, the nearest point of that part
        """
        points = to_array(points, "points", np.float64, (None, 3))
        parts, distances, nearest = np.empty(len(points), np.int32), np.empty(len(points)), np.empty_like(points)
        check(load().pw_index_nearest(None, self._handle, points, len(points), parts, distances, nearest))
        return parts, distances, nearest

    def intersects(self, other: Index, matrices: ArrayLike) -> Tuple[np.ndarray, np.ndarray]:
        """Intersection with another index under several transforms; full containment counts.

        Parameters
        ----------
        other : the other index
        matrices : (n, 4, 4) or (n, 3, 4), from the other's coordinates to this one's; the fourth row is ignored

        Returns
        -------
        parts : (n, 2) int32, a part of this index and a part of the other that have a point in common; -1, -1 for none
        points : (n, 3) float64, that point
        """
        matrices = np.ascontiguousarray(to_array(matrices, "matrices", np.float64, (None, 4, 4), (None, 3, 4))[:, :3])
        parts, points = np.empty((len(matrices), 2), np.int32), np.empty((len(matrices), 3))
        check(load().pw_index_intersects(None, self._handle, other._handle, matrices, len(matrices), parts, points))
        return parts, points
