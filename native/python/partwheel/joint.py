# SPDX-License-Identifier: GPL-3.0-or-later
"""The joint of a part: where it hangs on the rest of its surface. A limb that is turned there keeps its shape, but for
what is near the joint, on either side, which bends."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Optional

import numpy as np

from .deform import FIXED, FREE, surface_distances
from .weld import weld_surface

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

REACH = 2.0  # how far from its border a part bends by default, in radii of the border
MOST = 0.5  # but on neither side more than this share of the way to the farthest point


class Joint(NamedTuple):
    """center (3,) and radius of the longest loop of the part's border, and how many loops there are; distance (V,) of
    each vertex from the border along the surface, infinity where no way leads; inner (V,) bool: the part's vertices, its
    border's not among them."""

    center: np.ndarray
    radius: float
    loops: int
    distance: np.ndarray
    inner: np.ndarray

    def depth(self) -> float:
        """How far the part's farthest vertex is from its border."""
        return self._farthest(self.inner)

    def roles(self, reach: float = REACH) -> np.ndarray:
        """(V,) for a Deformation: what is near the border, within so many of its radii, is FREE; the rest of the part is
        handle 0, and the rest of the surface FIXED."""
        ours, theirs = (min(reach * self.radius, MOST * self._farthest(side)) for side in (self.inner, ~self.inner))
        return np.where(self.inner, np.where(self.distance < ours, FREE, 0),
                        np.where(self.distance <= theirs, FREE, FIXED))

    def _farthest(self, side: np.ndarray) -> float:
        return float(self.distance[side & np.isfinite(self.distance)].max(initial=0))


def joint(vertices: np.ndarray, triangles: np.ndarray, inside: ArrayLike) -> Optional[Joint]:
    """The Joint of the part that the triangles inside (T,) bool make. vertices (V,3), triangles (T,3). None if the part
    has no border: if it is the whole surface, or loose pieces of it. Coincident vertices are welded."""
    inside, (old_to_new, triangles) = np.asarray(inside, bool), weld_surface(vertices, triangles)
    member, beyond = (np.zeros(len(vertices), bool) for _ in range(2))
    member[triangles[inside]] = True
    beyond[triangles[~inside]] = True
    shared = member & beyond
    # Edges of both sides: among those between shared vertices.
    near = shared[triangles].sum(axis=1) >= 2
    side = np.sort(triangles[near][:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    ours, theirs = (np.unique(side[which].reshape(-1, 2), axis=0) for which in (inside[near], ~inside[near]))
    both, counts = np.unique(np.vstack([ours, theirs]), axis=0, return_counts=True)
    border = both[counts == 2]
    if not len(border):
        return None
    a, b = vertices[border[:, 0]], vertices[border[:, 1]]
    loop, length = groups(border), np.linalg.norm(b - a, axis=1)
    longest = loop == np.bincount(loop, length).argmax()
    weight = length[longest] if length[longest].sum() > 0 else None
    middle = ((a + b) / 2)[longest]
    center = np.average(middle, axis=0, weights=weight)
    radius = np.average(np.linalg.norm(middle - center, axis=1), weights=weight)
    return Joint(center, float(radius), int(loop.max()) + 1, surface_distances(vertices, triangles, shared)[old_to_new],
                 (member & ~beyond)[old_to_new])


def groups(edges: np.ndarray) -> np.ndarray:
    """(n,) for each edge (n,2) the number, from 0, of the connected group that it is in."""
    names, ends = np.unique(edges, return_inverse=True)
    ends, lowest = ends.reshape(-1, 2), np.arange(len(names))
    while True:
        before = lowest.copy()
        both = np.minimum(lowest[ends[:, 0]], lowest[ends[:, 1]])
        np.minimum.at(lowest, ends[:, 0], both)
        np.minimum.at(lowest, ends[:, 1], both)
        lowest = lowest[lowest]
        if (lowest == before).all():
            return np.unique(lowest[ends[:, 0]], return_inverse=True)[1]
