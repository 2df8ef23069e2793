# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts made by hand, as sets of faces, with their mirror images and similar parts. Any two of them are nested or
disjoint, so all of them can be nodes of one hierarchy. With numpy."""

from typing import Iterable, Iterator, List, Optional, Sequence

import numpy as np

from ..components import to_mask
from ..cut import mirror_planes, reflect
from ..hierarchy import Hierarchy
from ..index import Index
from ..library import Context, PartwheelError, Status
from .similar import THRESHOLD, best_node, measure_nodes, similar_parts

MAX_OWN_PARTS = 64  # of a model; more are not added


def with_own_parts(hierarchy: Hierarchy, parts: Sequence[np.ndarray], context: Optional[Context] = None) -> Hierarchy:
    """The hierarchy with these parts, masks (F,), as wheel stops, without those that can't be nodes, see
    Hierarchy.with_part(); the same one if they already are."""
    context = context or Context()
    for number, part in enumerate(sorted(parts, key=np.count_nonzero, reverse=True)):
        context.start_step(number / len(parts))
        node, overlap = best_node(hierarchy, part)
        if overlap < 1 or hierarchy.score[node] < 1:
            hierarchy = _insert(hierarchy, part) or hierarchy
    return hierarchy


def extend_own_parts(hierarchy: Hierarchy, vertices: np.ndarray, triangles: np.ndarray, faces: np.ndarray,
                     parts: Sequence[np.ndarray], new_parts: Iterable[np.ndarray],
                     context: Optional[Context] = None) -> List[np.ndarray]:
    """Adds parts, and then their mirror images and similar parts: masks (F,), at most MAX_OWN_PARTS, the new ones first.

    hierarchy : without parts made by hand; faces : (T,) the source face of each of its surface's triangles
    parts, new_parts : masks (F,), any two of either nested or disjoint. Parts that cross a new one are dropped"""
    result = [part for part in new_parts if _insert(hierarchy, part)]
    new_parts = result.copy()
    result += [known for known in parts if all(are_nested(known, part) and (known != part).any() for part in new_parts)]
    context = context or Context()
    for number, part in enumerate(new_parts):
        context.start_step(number / len(new_parts))
        for alike in _find_alike(hierarchy, vertices, triangles, faces, part):
            if all(are_nested(known, alike) and (known != alike).any() for known in result):
                result.append(alike)
    return result[:MAX_OWN_PARTS]


def are_nested(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether one of two sets contains the other, or they are disjoint. Masks (F,)."""
    common = np.count_nonzero(one & other)
    return common in (0, np.count_nonzero(one), np.count_nonzero(other))


def _insert(hierarchy: Hierarchy, part: np.ndarray) -> Optional[Hierarchy]:
    """The hierarchy with this part as a node, or None if it can't be one."""
    try:
        return hierarchy.with_part(np.flatnonzero(part))
    except PartwheelError as error:
        if error.status not in (Status.EMPTY, Status.ARGUMENT):
            raise
        return None


def _find_alike(hierarchy: Hierarchy, vertices: np.ndarray, triangles: np.ndarray, faces: np.ndarray,
                part: np.ndarray) -> Iterator[np.ndarray]:
    """Masks (F,) of the mirror images of a part that don't meet it, and of the nodes similar to it."""
    tree = hierarchy.with_part(np.flatnonzero(part))
    node = best_node(tree, part)[0]
    corners = np.asarray(vertices, np.float64)[np.asarray(triangles)]
    counts = np.maximum(np.bincount(faces, minlength=len(part)), 1)
    centers = np.column_stack([np.bincount(faces, column, len(part)) / counts for column in corners.mean(axis=1).T])
    index = None
    for normal, offset in mirror_planes(vertices, triangles):
        index = index or Index(tree)
        tets = index.nearest(reflect(centers, normal, offset))[0]
        image = (tets >= tree.tet_first[node]) & (tets < tree.tet_last[node])
        if image.any() and not (image & part).any() and (inserted := _insert(hierarchy, image)):
            yield _mask(inserted, best_node(inserted, image)[0])
    for other, likeness in similar_parts(tree, measure_nodes(tree, vertices, triangles, faces), node):
        if likeness >= THRESHOLD:
            yield _mask(tree, other)


def _mask(hierarchy: Hierarchy, node: int) -> np.ndarray:
    """(F,) bool, the faces of a node."""
    return to_mask(len(hierarchy.order), hierarchy.faces(node))
