# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders between the parts of a surface, the tree of parts that they define, and skinning weights that blend across
them."""

from typing import Collection, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import ArrayLike

from ..deform import surface_distances
from ..joint import MAX_REACH_FRACTION, PartBorder, find_borders
from ..library import Context
from ..weld import weld_surface
from .cut import Cut
from .names import mirror_images

REACH = 2.0  # radii of a border within which weights blend, on either side; joints bend best so, see docs/bones.md

VertexWeights = Tuple[np.ndarray, np.ndarray]  # of a part: vertices (n,), weights (n,)


class ParentLink(NamedTuple):
    """The parent of a part in the tree of parts."""

    parent: int  # a part; -1 for the root
    border: Optional[PartBorder]  # the PartBorder between the two; None for the root and for loose pieces


def part_borders(vertices: ArrayLike, triangles: ArrayLike, labels: np.ndarray) -> List[PartBorder]:
    """The borders between the parts of a surface, labels (T,), sorted by parts, then longest first. Coincident vertices are
    welded."""
    return find_borders(np.asarray(vertices), weld_surface(vertices, triangles)[1], labels)


def part_tree(cut: Cut, vertices: np.ndarray, triangles: np.ndarray, labels: np.ndarray,
              centers: Optional[np.ndarray] = None) -> List[ParentLink]:
    """The tree of the parts, labels (T,), of a surface that a cut is of, see link_parts(). centers : (parts, 3) of the parts;
    by default the means of their triangles' corners"""
    if centers is None:
        centers = np.array([vertices[triangles[labels == part]].mean(axis=(0, 1)) for part in range(len(cut))])
    central = {part for part, image in mirror_images(vertices, triangles, labels)[0].items() if part == image}
    return link_parts(cut, part_borders(vertices, triangles, labels), centers, central)


def link_parts(cut: Cut, borders: Sequence[PartBorder], centers: np.ndarray,
               central: Collection[int] = ()) -> List[ParentLink]:
    """The ParentLink of each part of a cut: a minimum spanning tree over the borders (Kruskal), see part_borders(), rooted at
    the part with the largest volume.

    Borders come in the order in which the hierarchy merges their parts, longest first. Two exceptions make the tree of a
    symmetric model symmetric: borders between central parts, which lie in the symmetry plane, come first, so neck and head
    hang on the trunk, not on an arm; and the borders of a part with central parts count as one, at the level of the earliest
    merge, so the part hangs on the central part with the longest border. Loose pieces are linked last, each to the nearest,
    by centers (parts, 3), of the parts that the hierarchy merges it with."""
    representative = list(range(len(cut)))

    def find(part: int) -> int:
        while representative[part] != part:
            part = representative[part]
        return part

    neighbors: List[List[Tuple[int, Optional[PartBorder]]]] = [[] for _ in representative]

    def link(candidates: Sequence[tuple]) -> None:
        for *_, (one, other), border in candidates:
            if find(one) != find(other):
                representative[find(one)] = find(other)
                neighbors[one].append((other, border))
                neighbors[other].append((one, border))

    def center_distance(one: int, other: int) -> float:
        return float(np.linalg.norm(centers[one] - centers[other]))

    levels = [cut.common_ancestor(*border.parts) for border in borders]
    lateral_parts = [frozenset(border.parts).difference(central) for border in borders]
    lowest: Dict[frozenset, int] = {}
    for lateral, level in zip(lateral_parts, levels):
        lowest[lateral] = min(lowest.get(lateral, level), level)
    link(sorted(((bool(lateral), lowest[lateral] if len(lateral) == 1 else level, -border.length, number, border.parts,
                  border) for number, (border, lateral, level) in enumerate(zip(borders, lateral_parts, levels))),
                key=lambda candidate: candidate[:4]))
    if len({find(part) for part in representative}) > 1:
        pairs = [(one, other) for one in range(len(cut)) for other in range(one) if find(one) != find(other)]
        link(sorted((cut.common_ancestor(*pair), center_distance(*pair), pair, None) for pair in pairs))
    root = max(range(len(cut)), key=cut.volume)
    links, queue = {root: ParentLink(-1, None)}, [root]
    for part in queue:
        for other, border in neighbors[part]:
            if other not in links:
                links[other] = ParentLink(part, border)
                queue.append(other)
    return [links[part] for part in range(len(cut))]


def parents_first(links: Sequence[ParentLink]) -> List[int]:
    """The parts of a tree, each after its parent."""
    order = [part for part, link in enumerate(links) if link.parent < 0]
    for part in order:
        order += [other for other, link in enumerate(links) if link.parent == part]
    return order


def skin_weights(vertices: ArrayLike, triangles: ArrayLike, labels: np.ndarray, count: int,
                 reach: float = REACH, context: Optional[Context] = None) -> List[VertexWeights]:
    """Skinning weights of the parts, for an armature. A part's weight is 1 inside it and falls smoothly to 0 across each
    border, over the same distance on both sides. The weights of a vertex add up to 1; a vertex without triangles has
    none. Coincident vertices are welded, so they have equal weights.

    Parameters
    ----------
    vertices : (V, 3) float
    triangles : (T, 3) int, indices into vertices
    labels : (T,) the part of each triangle
    count : number of parts
    reach : distance from a border over which weights blend, in its radii; limited to MAX_REACH_FRACTION of the depth of
        either part
    context : to cancel from another thread and to read the progress

    Returns
    -------
    of each part (vertices (n,), weights (n,))
    """
    context = context or Context()
    positions, (old_to_new, triangles) = np.asarray(vertices, np.float64), weld_surface(vertices, triangles)
    vertex_part = np.full(len(positions), -1)
    vertex_part[triangles.ravel()] = np.repeat(labels, 3)
    # For each border: parts, vertices nearby, and the weight there of the part on the other side; one half at the border.
    blends = []
    borders = part_borders(positions, triangles, labels)
    for number, border in enumerate(borders):
        context.start_step(number / len(borders))
        distance = surface_distances(positions, triangles, border.vertices)
        depths = [distance[(vertex_part == part) & np.isfinite(distance)].max(initial=0) for part in border.parts]
        width = min(reach * border.radius, MAX_REACH_FRACTION * min(depths))
        near = np.flatnonzero(distance <= width)
        x = distance[near] / width if width > 0 else np.zeros(len(near))
        blends.append((border.parts, near, 0.5 - x * x * (1.5 - x)))
    part_weights, total = [], np.zeros(len(positions))
    for part in range(count):
        weight = (vertex_part == part).astype(np.float64)
        for parts, near, across in blends:
            if part in parts:
                is_inside = vertex_part[near] == part
                weight[near] = np.where(is_inside, np.minimum(weight[near], 1 - across), np.maximum(weight[near], across))
        part_weights.append(weight)
        total += weight
    result = []
    for weight in part_weights:
        weight = (weight / np.where(total > 0, total, 1))[old_to_new]
        nonzero = np.flatnonzero(weight)
        result.append((nonzero, weight[nonzero]))
    return result
