# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy as an index: which part is where, for arrays of points, rays and places. Native, with numpy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional, Tuple

import numpy as np

from ..hierarchy import Hierarchy, indices
from ..library import Handle, NonCopyable, check, load, made

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Index(NonCopyable):
    """A hierarchy to be asked where things are: see pw_index in partwheel_edit.h. It never changes.

    bounds (K+1,) of a cut: its parts are the convex hulls of the cut's K parts. None: exact, its parts are the
    tetrahedra, which are the hierarchy's leaves; np.searchsorted(bounds, parts, "right") - 1 are the parts of a cut that they
    are in. threads: of one call at most so many, 0: as many as help. Raises PartwheelError.

    All that is asked is an array with a row for each; so are the answers. Parts are (n,) int32, -1 for none."""

    def __init__(self, hierarchy: Hierarchy, bounds: Optional[ArrayLike] = None, *, threads: int = 0) -> None:
        bounds = np.empty(0, np.int32) if bounds is None else indices(bounds, "bounds", (None,))
        self._handle = Handle(load().pw_index_free, made(load().pw_index_create, hierarchy._handle, bounds, len(bounds),
                                                         threads))

    def holding(self, points: ArrayLike) -> np.ndarray:
        """(n,) the part that holds each of points (n,3), of several the lowest; -1 outside."""
        points = _rows(points, "points", 3)
        parts = np.empty(len(points), np.int32)
        check(load().pw_index_holding(self._handle, points, len(points), parts))
        return parts

    def first_hits(self, origins: ArrayLike, directions: ArrayLike) -> Tuple[np.ndarray, np.ndarray]:
        """((n,) the part that each ray meets first, from whichever side, -1 if none; (n,) how far away, in lengths of its
        direction). origins, directions (n,3)."""
        origins, directions = _rows(origins, "origins", 3), _rows(directions, "directions", 3)
        if len(origins) != len(directions):
            raise ValueError(f"There are {len(origins)} origins and {len(directions)} directions.")
        parts, distances = np.empty(len(origins), np.int32), np.empty(len(origins))
        check(load().pw_index_first_hits(self._handle, origins, directions, len(origins), parts, distances))
        return parts, distances

    def nearest(self, points: ArrayLike) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """((n,) the part that is nearest to each of points (n,3), the one that holds it inside; (n,) its distance, 0
        inside; (n,3) its point that is nearest)."""
        points = _rows(points, "points", 3)
        parts, distances, nearest = np.empty(len(points), np.int32), np.empty(len(points)), np.empty_like(points)
        check(load().pw_index_nearest(self._handle, points, len(points), parts, distances, nearest))
        return parts, distances, nearest

    def touching(self, other: Index, matrices: ArrayLike) -> Tuple[np.ndarray, np.ndarray]:
        """Whether and where another index touches this one, at each of several places: ((n,2) a part of this one and one of the
        other that have a point in common, -1 and -1 where none have; (n,3) that point). matrices (n,4,4) or (n,3,4): take the
        other's coordinates to this one's; the last row of four is not looked at. Also where one is all inside the other."""
        matrices = np.asarray(matrices, np.float64)
        if matrices.ndim != 3 or matrices.shape[1:] not in ((3, 4), (4, 4)):
            raise ValueError(f"matrices must have the shape (n, 4, 4) or (n, 3, 4), not {matrices.shape}.")
        matrices = np.ascontiguousarray(matrices[:, :3])
        parts, points = np.empty((len(matrices), 2), np.int32), np.empty((len(matrices), 3))
        check(load().pw_index_touching(self._handle, other._handle, matrices, len(matrices), parts, points))
        return parts, points


def _rows(values: ArrayLike, name: str, width: int) -> np.ndarray:
    values = np.ascontiguousarray(values, np.float64)
    if values.ndim != 2 or values.shape[1] != width:
        raise ValueError(f"{name} must have the shape (n, {width}), not {values.shape}.")
    return values
