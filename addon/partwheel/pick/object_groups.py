# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups of whole objects around an object, from small to large: where the wheel stops beyond the whole object.

First the objects that touch it, then its family (objects with the same parent or armature, from the nearest ancestor
to the farthest), then its collections, from the innermost out. The scene's root collection is no stop, because it is
everything in the scene."""

from collections.abc import Collection, Iterator

import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ..view.visible_surface import read_displayed_triangles

CONTACT_DISTANCE = 0.01  # between surfaces that touch, as a fraction of the diagonal of the group so far
MAX_PAIRS = 256  # limit of pairs of objects whose surfaces are compared per pick; above it, the wheel skips this stop
MAX_TRIANGLES = 20_000  # limit per surface of triangles near the other one; above it, evenly spaced ones are compared

Group = frozenset  # a set of objects


def find_object_groups(obj: bpy.types.Object, candidates: Collection[bpy.types.Object]) -> tuple[Group, ...]:
    """Return the groups around an object, each a proper superset of the previous one, the first one of {obj}.
    candidates: the mesh objects that a group may contain."""
    candidates = {obj, *candidates}
    if len(candidates) == 1:
        return ()
    larger = [*_find_families(obj, candidates), *_find_collections(obj, candidates)]
    larger = [group for group in larger if len(group) > 1]
    mates = larger[0] if larger else candidates & {*bpy.context.scene.collection.objects}
    groups, last = [], Group({obj})
    for group in (*_find_contacts(obj, mates), *larger):
        if not group <= last:
            last |= group
            groups.append(last)
    return tuple(groups)


def _find_families(obj: bpy.types.Object, candidates: set[bpy.types.Object]) -> list[Group]:
    """Return the candidates that descend from the object, from its parents, from their parents, and so on. The armature
    that deforms an object counts as a parent."""
    lineages = {candidate: set().union(*_iter_generations(candidate)) for candidate in candidates}
    return [Group(candidate for candidate in candidates if not generation.isdisjoint(lineages[candidate]))
            for generation in _iter_generations(obj)]


def _iter_generations(obj: bpy.types.Object) -> Iterator[set[bpy.types.Object]]:
    """Yield the object, its parents, their parents, and so on."""
    generation, visited = {obj}, {None}
    while generation:
        yield generation
        visited |= generation
        armatures = {modifier.object for child in generation for modifier in child.modifiers
                     if modifier.type == "ARMATURE"}
        generation = (armatures | {child.parent for child in generation}) - visited


def _find_collections(obj: bpy.types.Object, candidates: set[bpy.types.Object]) -> list[Group]:
    """Return the candidates in each collection that contains the object, directly or nested, from small to large."""
    members = ({*collection.all_objects} for collection in bpy.context.scene.collection.children_recursive)
    return sorted((Group(candidates & objects) for objects in members if obj in objects), key=len)


def _find_contacts(obj: bpy.types.Object, mates: Collection[bpy.types.Object]) -> list[Group]:
    """Return two groups of the object and mates: those that touch the object, and all that a chain of contacts connects
    with it. Leaves out a group that would exceed MAX_PAIRS."""
    boxes = {member: _compute_box(member) for member in {obj, *mates}}
    surfaces, group, ring, rings, pairs_left = {}, {obj}, {obj}, [], MAX_PAIRS
    while ring:
        low = np.min([boxes[member][0] for member in group], axis=0)
        high = np.max([boxes[member][1] for member in group], axis=0)
        reach = CONTACT_DISTANCE * float(np.linalg.norm(high - low))
        pairs = [(member, other) for member in ring for other in boxes.keys() - group
                 if _intersect_boxes(boxes[member], boxes[other], reach)]
        pairs_left -= len(pairs)
        if pairs_left < 0:
            return rings[:1]
        for member in {member for pair in pairs for member in pair} - surfaces.keys():
            surfaces[member] = _read_corners(member)
        ring = set()
        for member, other in pairs:
            if other not in ring and _touches(surfaces[member], surfaces[other], reach):
                ring.add(other)
        group |= ring
        rings.append(Group(group))
    return [rings[0], rings[-1]]


def _compute_box(obj: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Return (low, high) of a bounding box in world space, as Blender displays the object."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    corners = np.array([evaluated.matrix_world @ Vector(corner) for corner in evaluated.bound_box])
    return corners.min(axis=0), corners.max(axis=0)


def _intersect_boxes(box: tuple, other: tuple, reach: float) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the intersection of two boxes (low, high), each enlarged by reach on all sides; None if it is empty."""
    low, high = np.maximum(box[0], other[0]) - reach, np.minimum(box[1], other[1]) + reach
    return None if (low > high).any() else (low, high)


def _read_corners(obj: bpy.types.Object) -> np.ndarray:
    """Return the corners (T, 3, 3) of the displayed triangles in world space."""
    positions, triangles = read_displayed_triangles(obj)
    matrix = np.array(obj.matrix_world)
    return (positions @ matrix[:3, :3].T + matrix[:3, 3])[triangles]


def _touches(surface: np.ndarray, other: np.ndarray, reach: float) -> bool:
    """Return whether two surfaces, as corners (T, 3, 3), intersect, or a corner of one is within reach of the other."""
    if not (len(surface) and len(other)):
        return False
    boxes = [(triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))) for triangles in (surface, other)]
    overlap = _intersect_boxes(*boxes, reach)
    near = overlap and [_clip(triangles, *overlap) for triangles in (surface, other)]
    if not near or not all(map(len, near)):
        return False
    trees = [BVHTree.FromPolygons(triangles.reshape(-1, 3).tolist(), np.arange(3 * len(triangles)).reshape(-1, 3).tolist(),
                                  all_triangles=True) for triangles in near]
    return bool(trees[0].overlap(trees[1])) or any(
        tree.find_nearest(corner, reach)[0] is not None
        for tree, corners in zip(trees, reversed(near)) for corner in np.unique(corners.reshape(-1, 3), axis=0).tolist())


def _clip(surface: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return the triangles whose bounding boxes intersect the box; of too many, evenly spaced ones."""
    near = surface[((surface.min(axis=1) <= high) & (surface.max(axis=1) >= low)).all(axis=1)]
    return near[::len(near) // MAX_TRIANGLES + 1]
