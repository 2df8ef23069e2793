# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of the parts of a cut: mirror images get .L and .R, similar parts a number. Also the model's mirror planes."""

from __future__ import annotations

import ctypes
import hashlib
import re
from typing import TYPE_CHECKING, Dict, List, Optional, Sequence, Set, Tuple

import numpy as np
from numpy.typing import ArrayLike

from ..hierarchy import to_mesh_view
from ..library import check, load
from ..triangles import nearest_targets, sample_triangles, second_moments, triangle_areas
from .cut import Cut

if TYPE_CHECKING:
    from ..meshes import Mesh

GENERATED = re.compile(r"Part \d")  # names that name_parts() has given
MAX_NAME_BYTES = 50  # leaves space for endings: Blender truncates names at 63
MIN_SHARE = 0.5  # least share of a part's area that has the material, node or bone that it is named after
SAMPLE_COUNT = 2048  # points on the surface
MIN_MIRRORED_FRACTION = 0.5  # of a part's points whose mirror images are on its counterpart, and vice versa
MAX_LOG_DIFFERENCE = 0.2  # of the lengths of similar parts: they differ by about a fifth at most
# The surface that mirror_planes() was last called with, and its planes: one tuple, so that threads read both or neither.
_last: Tuple[Optional[List[bytes]], np.ndarray] = (None, np.empty((0, 4)))


def mirror_planes(vertices: ArrayLike, triangles: ArrayLike) -> List[Tuple[np.ndarray, float]]:
    """The planes in which a surface is its own mirror image: see pw_mirror_planes in partwheel_edit.h.

    Parameters
    ----------
    vertices : (V, 3) float
    triangles : (T, 3) int, indices into vertices

    Returns
    -------
    at most three (normal (3,), offset), the best first: points x with normal . x = offset

    Raises
    ------
    PartwheelError : the surface is invalid
    """
    global _last
    mesh = to_mesh_view(vertices, triangles)
    key = [hashlib.blake2b(array).digest() for array in mesh.arrays[:2]]
    last = _last
    if last[0] != key:  # names and bones need the planes of the same surface
        planes, count = np.empty((3, 4)), ctypes.c_size_t()
        check(load().pw_mirror_planes(None, mesh, planes, ctypes.byref(count)))
        last = _last = key, planes[:count.value]
    return [(plane[:3].copy(), float(plane[3])) for plane in last[1]]


def reflect(points: np.ndarray, normal: np.ndarray, offset: float) -> np.ndarray:
    """The mirror images (n, 3) of points (n, 3) in a plane of mirror_planes()."""
    return points - 2 * np.outer(points @ normal - offset, normal)


def find_names(cut: Cut, mesh: Mesh) -> List[Optional[str]]:
    """For each part the name of the file's node, object or group that most of its area is of, if there are several, else
    of its material, if there are several; None without any."""
    areas = triangle_areas(mesh.vertices[mesh.triangles])
    sources = [(mesh.node_names, mesh.nodes)]
    if look := mesh.appearance:
        sources.append(([material.get("name") or "" for material in look.materials], look.face_materials))
    choices = [find_majority(names, _areas_by_part(cut.labels[mesh.faces], numbers, areas, len(names), len(cut)))
               for names, numbers in sources if len(np.unique(numbers)) > 1 and len(names)]
    return [next(filter(None, names), None) for names in zip(*choices)] if choices else [None] * len(cut)


def _areas_by_part(labels: np.ndarray, numbers: np.ndarray, areas: np.ndarray, count: int, part_count: int) -> np.ndarray:
    """(count, parts) the share of the triangles with each number 0..count-1 in each part's area; labels, numbers, areas : (T,)"""
    result = np.zeros((count, part_count))
    is_known = numbers >= 0
    np.add.at(result, (numbers[is_known], labels[is_known]), areas[is_known])
    return result / np.maximum(np.bincount(labels, areas, part_count), 1e-300)


def find_majority(names: Sequence[str], shares: np.ndarray) -> List[Optional[str]]:
    """For each part the name with the largest share, shares (n, parts), if that is large enough; None for names that were
    generated, are empty, or too long."""
    if not names:
        return [None] * shares.shape[1]
    usable = [name if name and not GENERATED.match(name) and len(name.encode()) <= MAX_NAME_BYTES else None for name in names]
    best, largest = shares.argmax(axis=0).tolist(), shares.max(axis=0)
    return [usable[number] if share >= MIN_SHARE else None for number, share in zip(best, largest)]


def name_parts(cut: Cut, vertices: ArrayLike, triangles: ArrayLike, faces: np.ndarray, word: str = "Part",
               known: Sequence[Optional[str]] = ()) -> List[str]:
    """Unique names for the parts of a cut: "Part 2.L" and "Part 2.R" are mirror images of each other, "Part 3.001" and
    "Part 3.002" are similar, "Part 4.L.001" is both. Larger parts have lower numbers. L is the side toward +x, or toward
    the positive direction of the axis that the mirror plane's normal follows most.

    Parameters
    ----------
    vertices : (V, 3), triangles : (T, 3), faces : (T,) the source face of each triangle: the surface of the hierarchy
    word : what names begin with
    known : for each part what it is called in place of word and number, or None. Parts that are called alike get the same
        endings as similar ones

    Returns
    -------
    the name of each part
    """
    vertices, triangles = np.asarray(vertices, np.float64), np.asarray(triangles)
    labels = cut.labels[faces]
    corners = vertices[triangles]
    areas = triangle_areas(corners)
    part_areas = np.bincount(labels, areas, len(cut))
    sizes = np.array([_log_sizes(corners[labels == part]) for part in range(len(cut))])
    centers = np.array([np.average(corners[labels == part].mean(axis=1), axis=0, weights=areas[labels == part] + 1e-300)
                        for part in range(len(cut))])
    image, normal = mirror_images(vertices, triangles, labels)
    image = {part: other for part, other in image.items() if part != other}
    known = [*known] or [None] * len(cut)
    groups = {name: [part for part, other in enumerate(known) if other == name] for name in known if name}
    similar = [[part for part in group if not known[part]] for group in _similar_groups(sizes, part_areas, image)]
    groups.update((f"{word} {number}", group) for number, group in enumerate(filter(None, similar), 1))
    names = [""] * len(cut)
    for base, group in groups.items():
        image_in_group = {part: image[part] for part in group if image.get(part) in group}
        units = _order_along_line([(part,) if part not in image_in_group else
                                   tuple(sorted((part, image[part]), key=lambda side: -centers[side] @ normal))
                                   for part in group if part not in image_in_group or part < image[part]], centers)
        for position, unit in enumerate(units, 1):
            suffix = f".{position:03}" if len(units) > 1 else ""
            for part, side in zip(unit, (".L", ".R") if len(unit) == 2 else ("",)):
                names[part] = base + side + suffix
    return make_unique(names)


def make_unique(names: Sequence[str]) -> List[str]:
    """The names; one that is taken, also in other case, as files may have it, gets a number."""
    taken: Set[str] = set()
    result = []
    for name in names:
        number, unique = 1, name
        while unique.casefold() in taken:
            number += 1
            unique = f"{name}-{number}"
        taken.add(unique.casefold())
        result.append(unique)
    return result


def mirror_images(vertices: ArrayLike, triangles: np.ndarray, labels: np.ndarray) -> Tuple[Dict[int, int], np.ndarray]:
    """Which parts of a surface, labels (T,), are mirror images of each other, in the mirror plane that pairs the most area:
    ({part: its mirror image}, normal (3,) of the plane, toward the left). A part on both sides is its own image; a part
    without one is missing. ({}, zeros) if no plane pairs parts."""
    corners = np.asarray(vertices, np.float64)[triangles]
    areas = triangle_areas(corners)
    part_areas = np.bincount(labels, areas)
    points, sampled = sample_triangles(corners, areas, SAMPLE_COUNT)
    labels = labels[sampled]
    best: Tuple[Dict[int, int], np.ndarray] = ({}, np.zeros(3))
    best_area = 0.0
    for normal, offset in mirror_planes(vertices, triangles):
        votes = np.zeros((len(part_areas), len(part_areas)))  # (part, part of the mirrored point)
        np.add.at(votes, (labels, labels[nearest_targets(reflect(points, normal, offset), points)]), 1)
        majority = votes.argmax(axis=1).tolist()
        image = {part: other for part, other in enumerate(majority) if majority[other] == part
                 and all(votes[a, b] > MIN_MIRRORED_FRACTION * votes[a].sum() for a, b in ((part, other), (other, part)))}
        area = sum(part_areas[part] for part, other in image.items() if part != other)
        if area > best_area:
            best, best_area = (image, normal * np.sign(normal[abs(normal).argmax()])), area
    return best


def _similar_groups(sizes: np.ndarray, areas: np.ndarray, image: Dict[int, int]) -> List[List[int]]:
    """Groups of parts that are similar to their largest one, largest first. Mirror images are in one group."""
    groups: List[List[int]] = []
    grouped: Set[int] = set()
    for part in sorted(range(len(areas)), key=lambda part: (-areas[part], part)):
        if part in grouped:
            continue
        similar = np.flatnonzero(abs(sizes - sizes[part]).max(axis=1) < MAX_LOG_DIFFERENCE).tolist()
        group = {*similar, *(image[member] for member in similar if member in image)} - grouped
        grouped.update(group)
        groups.append(sorted(group))
    return groups


def _log_sizes(corners: np.ndarray) -> np.ndarray:
    """(4,) logarithms of the square root of a part's area and of its extents along the principal axes. Unlike the features
    in partwheel.compatible they don't depend on the border, which differs a little between similar parts of a cut.
    corners : (T, 3, 3)"""
    areas = triangle_areas(corners)
    total = max(areas.sum(), 1e-300)
    moments = second_moments(areas, corners - (areas @ corners.mean(axis=1)) / total)
    return np.log(np.sqrt(np.maximum([total, *np.linalg.eigvalsh(moments / (12 * total))], 1e-300)))


def _order_along_line(units: Sequence[Tuple[int, ...]], centers: np.ndarray) -> List[Tuple[int, ...]]:
    """Parts or pairs, in their order along the line that fits them best."""
    positions = np.array([centers[list(unit)].mean(axis=0) for unit in units])
    direction = np.linalg.svd(positions - positions.mean(axis=0))[2][0] if len(units) > 1 else np.ones(3)
    direction = direction * np.sign(direction[abs(direction).argmax()])
    return [units[number] for number in np.argsort(positions @ direction, kind="stable")]
