# SPDX-License-Identifier: GPL-3.0-or-later
"""The joint of a part: its border with the rest of the surface. Turning the part there is rigid, except for a band
around the joint, which bends."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Optional

import numpy as np

from .components import edge_components
from .deform import FIXED, FREE, surface_distances
from .weld import weld_surface

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

REACH = 2.0  # default half-width of the bending band, in radii of the border
MAX_REACH_FRACTION = 0.5  # limit of that half-width, as a fraction of the depth of either side


class Joint(NamedTuple):
    """The border of a part.

    center : (3,) of the border's longest loop
    radius : of that loop, its mean distance from the center
    loop_count : number of loops of the border
    distance : (V,) distance of each vertex from the border along the surface; infinite where there is no path
    inner : (V,) bool, the vertices of the part without those on its border
    """

    center: np.ndarray
    radius: float
    loop_count: int
    distance: np.ndarray
    inner: np.ndarray

    def depth(self) -> float:
        """The largest distance of the part's vertices from its border."""
        return self._max_distance(self.inner)

    def roles(self, reach: float = REACH) -> np.ndarray:
        """Roles of the vertices in a Deformation that turns the part.

        Parameters
        ----------
        reach : half-width of the bending band, in radii of the border; limited to MAX_REACH_FRACTION of each side's depth

        Returns
        -------
        (V,) int: FREE in the band, handle 0 in the rest of the part, FIXED in the rest of the surface
        """
        inner_reach, outer_reach = (min(reach * self.radius, MAX_REACH_FRACTION * self._max_distance(side))
                                    for side in (self.inner, ~self.inner))
        return np.where(self.inner, np.where(self.distance < inner_reach, FREE, 0),
                        np.where(self.distance <= outer_reach, FREE, FIXED))

    def _max_distance(self, mask: np.ndarray) -> float:
        return float(self.distance[mask & np.isfinite(self.distance)].max(initial=0))


def find_joint(vertices: np.ndarray, triangles: np.ndarray, inside: ArrayLike) -> Optional[Joint]:
    """Find the joint of a part of a surface. Coincident vertices are welded.

    Parameters
    ----------
    vertices : (V, 3) float
    triangles : (T, 3) int, indices into vertices
    inside : (T,) bool, the triangles of the part

    Returns
    -------
    the Joint; None if the part has no border, because it is the whole surface or consists of whole shells
    """
    inside, (old_to_new, triangles) = np.asarray(inside, bool), weld_surface(vertices, triangles, sheets=True)
    in_part, in_rest = (np.zeros(len(vertices), bool) for _ in range(2))
    in_part[triangles[inside]] = True
    in_rest[triangles[~inside]] = True
    shared = in_part & in_rest
    # Border edges are edges of triangles of both sides. Only triangles with two shared vertices can have one.
    near = shared[triangles].sum(axis=1) >= 2
    edges = np.sort(triangles[near][:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    inner_edges, outer_edges = (np.unique(edges[mask].reshape(-1, 2), axis=0) for mask in (inside[near], ~inside[near]))
    edges, counts = np.unique(np.vstack([inner_edges, outer_edges]), axis=0, return_counts=True)
    border = edges[counts == 2]
    if not len(border):
        return None
    a, b = vertices[border[:, 0]], vertices[border[:, 1]]
    loop, length = edge_components(border), np.linalg.norm(b - a, axis=1)
    longest = loop == np.bincount(loop, length).argmax()
    weight = length[longest] if length[longest].sum() > 0 else None
    midpoints = ((a + b) / 2)[longest]
    center = np.average(midpoints, axis=0, weights=weight)
    radius = np.average(np.linalg.norm(midpoints - center, axis=1), weights=weight)
    return Joint(center, float(radius), int(loop.max()) + 1, surface_distances(vertices, triangles, shared)[old_to_new],
                 (in_part & ~in_rest)[old_to_new])
