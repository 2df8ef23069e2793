# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders between parts of a surface, and the joint of a part: its border with the rest. Turning the part there is rigid,
except for a band around the joint, which bends."""

from typing import List, NamedTuple, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike

from .components import edge_components, to_mask
from .deform import FIXED, FREE, surface_distances
from .triangles import side_ends
from .weld import weld_surface

REACH = 2.0  # default half-width of the bending band, in radii of the border
MAX_REACH_FRACTION = 0.5  # limit of that half-width, as a fraction of the depth of either side


class PartBorder(NamedTuple):
    """A connected group of edges between two parts."""

    parts: Tuple[int, int]  # the two parts, parts[0] < parts[1]
    vertices: np.ndarray  # (n,) vertices of the edges
    center: np.ndarray  # (3,)
    radius: float  # mean distance of the edges from the center
    length: float  # total length of the edges


class Joint(NamedTuple):
    """The border of a part."""

    center: np.ndarray  # (3,) of the border's longest loop
    radius: float  # of that loop, its mean distance from the center
    distance: np.ndarray  # (V,) distance of each vertex from the border along the surface; infinite where there is no path
    inner: np.ndarray  # (V,) bool, the vertices of the part without those on its border

    def roles(self, reach: float = REACH) -> np.ndarray:
        """(V,) roles of the vertices in a Deformation that turns the part: FREE in the bending band, handle 0 in the rest of
        the part, FIXED in the rest of the surface. reach : half-width of the band, in radii of the border; limited to
        MAX_REACH_FRACTION of each side's depth"""
        inner_reach, outer_reach = (min(reach * self.radius, MAX_REACH_FRACTION * self._max_distance(side))
                                    for side in (self.inner, ~self.inner))
        return np.where(self.inner, np.where(self.distance < inner_reach, FREE, 0),
                        np.where(self.distance <= outer_reach, FREE, FIXED))

    def _max_distance(self, mask: np.ndarray) -> float:
        return float(self.distance[mask & np.isfinite(self.distance)].max(initial=0))


def find_borders(vertices: np.ndarray, triangles: np.ndarray, labels: np.ndarray) -> List[PartBorder]:
    """The borders between parts, labels (T,), of a welded surface: sorted by parts, then longest first."""
    edge_parts = np.unique(np.column_stack([side_ends(triangles), np.repeat(labels, 3)]), axis=0)  # rows (vertex, vertex, part)
    edge_parts = edge_parts[edge_parts[:, 0] != edge_parts[:, 1]]
    shared = np.flatnonzero((edge_parts[1:, :2] == edge_parts[:-1, :2]).all(axis=1))
    edges, pairs = edge_parts[shared, :2], np.column_stack([edge_parts[shared, 2], edge_parts[shared + 1, 2]])
    borders: List[PartBorder] = []
    for pair in np.unique(pairs, axis=0):
        pair_edges = edges[(pairs == pair).all(axis=1)]
        component = edge_components(pair_edges)
        borders += [_part_border(vertices, pair, pair_edges[component == number]) for number in range(component.max() + 1)]
    return sorted(borders, key=lambda border: (border.parts, -border.length))


def _part_border(vertices: np.ndarray, pair: np.ndarray, edges: np.ndarray) -> PartBorder:
    a, b = vertices[edges[:, 0]], vertices[edges[:, 1]]
    length = np.linalg.norm(b - a, axis=1)
    weight = length if length.sum() > 0 else None
    center = np.average((a + b) / 2, axis=0, weights=weight)
    radius = np.average(np.linalg.norm((a + b) / 2 - center, axis=1), weights=weight)
    return PartBorder(tuple(pair.tolist()), np.unique(edges), center, float(radius), float(length.sum()))


def find_joint(vertices: np.ndarray, triangles: np.ndarray, inside: ArrayLike) -> Optional[Joint]:
    """The Joint of a part of a surface, inside (T,) bool; None if it has no border, because it is the whole surface or
    consists of whole shells. Coincident vertices are welded."""
    inside, (old_to_new, triangles) = np.asarray(inside, bool), weld_surface(vertices, triangles, sheets=True)
    in_part, in_rest = (to_mask(len(vertices), triangles[side]) for side in (inside, ~inside))
    shared = in_part & in_rest
    near = shared[triangles].sum(axis=1) >= 2  # only triangles with two shared vertices can have an edge of the border
    loops = find_borders(vertices, triangles[near], inside[near])
    if not loops:
        return None
    distances = surface_distances(vertices, triangles, shared)[old_to_new]
    return Joint(loops[0].center, loops[0].radius, distances, (in_part & ~in_rest)[old_to_new])
