# SPDX-License-Identifier: GPL-3.0-or-later
"""Marks: what an artist has drawn on a surface. Borders of materials and colors, seams and sharp edges become marked edges,
of which Hierarchy.build() makes borders of parts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Collection, List, NamedTuple, Optional, Tuple

import numpy as np
from numpy.typing import ArrayLike

from .components import components
from .triangles import triangle_areas
from .weld import weld_coincident_vertices

if TYPE_CHECKING:
    from .meshes import Mesh

KINDS = ("materials", "groups", "colors")  # of marks that a file may have
HINT_STRENGTH = 0.9  # of a border that the shape may overrule
# Differences of two colors in OKLab: below the first they count as equal, from the second on their border is certain.
SAME_COLOR, OTHER_COLOR = 0.06, 0.18
NOISE_FACTOR = 1.0  # a single face may differ from its region by this many median differences of neighbors
MIN_REGION_AREA_FRACTION = 0.0005  # a smaller region of one color joins another
# A region is the blur between two colors if at most this share of its faces has only neighbors in the region, and if the path
# from one color through its own to the other is at most this many times as long as the direct one.
MAX_INNER_FRACTION, MAX_DETOUR = 0.2, 1.2
SMOOTHING_PASSES = 3  # of colors within their region, before differences at its border are measured
FLARE = 0.01  # light that a screen adds to black; without it, noise in dark colors would count most
# Linear sRGB to cone responses, and their cube roots to OKLab: Björn Ottosson, "A perceptual color space for image
# processing" (2020).
_CONES = np.array([[0.4122214708, 0.5363325363, 0.0514459929], [0.2119034982, 0.6806995451, 0.1073969566],
                   [0.0883024619, 0.2817188376, 0.6299787005]])
_OKLAB = np.array([[0.2104542553, 0.7936177850, -0.0040720468], [1.9779984951, -2.4285922050, 0.4505937099],
                   [0.0259040371, 0.7827717662, -0.8086757660]])


class Marks(NamedTuple):
    """Marked edges of one kind.

    Attributes
    ----------
    name : of the kind, in the plural, for Hierarchy.notes: "seams"
    edges : (n, 2) vertices. Pairs that are not edges of the mesh mark nothing
    strengths : (n,) from 0 to 1; None: all are 1. 1: drawn on purpose, no part crosses the edge; below: a hint that the
        shape may overrule; below 0.5: nothing
    chosen : whether somebody chose these borders for this model. If not, a kind that cuts the whole surface into small
        pieces is ignored, because a program made it
    """

    name: str
    edges: ArrayLike
    strengths: Optional[ArrayLike] = None
    chosen: bool = False


class FacePairs(NamedTuple):
    """Where two faces meet."""

    edges: np.ndarray  # (n, 2) vertices of the common edge
    sides: np.ndarray  # (n, 2) the two faces


def find_face_pairs(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None) -> FacePairs:
    """The pairs of faces that share an edge, after coincident vertices are welded (see partwheel.weld).

    Parameters
    ----------
    vertices : (V, 3), triangles : (T, 3)
    faces : (T,) the polygon of each triangle; None: each is its own
    """
    triangles = np.asarray(triangles, np.int64)
    faces = np.arange(len(triangles)) if faces is None else np.asarray(faces)
    old_to_new = weld_coincident_vertices(vertices, triangles)
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    ends = np.sort(old_to_new[edges], axis=1)
    keys = ends[:, 0] * len(old_to_new) + ends[:, 1]
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(keys[order[1:]] == keys[order[:-1]])
    sides = np.repeat(faces, 3)[order[np.stack([first, first + 1], axis=1)]]
    is_border = sides[:, 0] != sides[:, 1]
    return FacePairs(edges[order[first]][is_border], sides[is_border])


def marks_of_labels(pairs: FacePairs, labels: ArrayLike, name: str, chosen: bool = False) -> Marks:
    """Marks the edges between faces with different labels (F,), such as materials: as hints, or, if somebody chose the labels
    to make parts of, so that no part crosses them."""
    sides = np.asarray(labels)[pairs.sides]
    edges = pairs.edges[sides[:, 0] != sides[:, 1]]
    return Marks(name, edges, None if chosen else np.full(len(edges), HINT_STRENGTH, np.float32), chosen)


def marks_of_colors(pairs: FacePairs, colors: ArrayLike, areas: ArrayLike, name: str = "colors") -> Marks:
    """Marks the borders between regions of different colors, stronger the more the colors differ along the border. Noise, and
    colors that change slowly, make no border.

    Parameters
    ----------
    pairs : see find_face_pairs()
    colors : (F, 3 or more) linear RGB of each face, 0 to 1
    areas : (F,) of the faces, above 0
    """
    lab = to_oklab(colors)
    regions = _color_regions(pairs.sides, lab, np.asarray(areas, np.float64))
    a, b = regions[pairs.sides].T
    is_inner = a == b
    for _ in range(SMOOTHING_PASSES):
        lab = _mean_of_neighbors(pairs.sides[is_inner], lab, np.ones(is_inner.sum()))
    a, b, edges, sides = a[~is_inner], b[~is_inner], pairs.edges[~is_inner], pairs.sides[~is_inner]
    # One strength for the whole border of two regions, so that it has no gaps.
    _, border = np.unique(np.minimum(a, b) * (regions.max(initial=0) + 1) + np.maximum(a, b), return_inverse=True)
    means = np.bincount(border, _distances(lab, sides)) / np.maximum(np.bincount(border), 1)
    strengths = 0.5 + (HINT_STRENGTH - 0.5) * np.clip((means - SAME_COLOR) / (OTHER_COLOR - SAME_COLOR), None, 1)
    is_marked = strengths[border] > 0.5
    return Marks(name, edges[is_marked], strengths[border][is_marked].astype(np.float32))


def marks_of_model(mesh: Mesh, kinds: Collection[str]) -> List[Marks]:
    """The marks in a file, of these KINDS: borders of materials, of groups (objects of a scene, objects or groups of an OBJ
    file), and of colors (base color, texture and vertex colors). Raises RequirementError if the package for images is missing.
    """
    pairs, look = find_face_pairs(mesh.vertices, mesh.triangles, mesh.faces), mesh.appearance
    labels = {kind: mesh.face_labels(kind) for kind in ("materials", "groups") if kind in kinds}
    marks = [marks_of_labels(pairs, values, kind) for kind, values in labels.items() if values is not None]
    if "colors" in kinds and look:
        areas = triangle_areas(mesh.vertices[mesh.triangles])
        marks.append(marks_of_colors(pairs, *mean_over_faces(look.mean_colors(), areas, mesh.faces)))
    return [kind for kind in marks if np.size(kind.edges)]


def mean_over_faces(values: np.ndarray, areas: np.ndarray, faces: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """((F, k) means by area, (F,) areas) of faces, from values (T, k) and areas (T,) of their triangles.

    faces : (T,) the face of each triangle
    """
    areas = np.maximum(areas, 1e-12 * areas.max(initial=0)) + 1e-300  # a degenerate face has a color, too
    totals = np.bincount(faces, areas)
    return np.column_stack([np.bincount(faces, areas * column) for column in values.T]) / totals[:, None], totals


def to_oklab(colors: ArrayLike) -> np.ndarray:
    """(n, 3) linear sRGB colors (n, 3 or more), 0 to 1, in the perceptual color space OKLab."""
    light = (np.clip(np.asarray(colors, np.float64)[:, :3], 0, 1) + FLARE) / (1 + FLARE)
    return np.asarray(np.cbrt(light @ _CONES.T) @ _OKLAB.T)


def _distances(colors: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """(n,) how much the colors (F, 3) of each pair (n, 2) differ."""
    return np.sqrt(((colors[pairs[:, 0]] - colors[pairs[:, 1]]) ** 2) @ np.ones(3))


def _mean_of_neighbors(sides: np.ndarray, values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(F, k) the mean of each face's values (F, k) and those of its neighbors, which have a weight for each pair (n,)."""
    count = len(values)
    ends, others = np.concatenate([sides, sides[:, ::-1]]).T
    weights = np.concatenate([weights, weights])
    sums = [column + np.bincount(ends, weights * column[others], count) for column in values.T]
    return np.column_stack(sums) / (1 + np.bincount(ends, weights, count))[:, None]


def _denoise(sides: np.ndarray, colors: np.ndarray, noise: float) -> np.ndarray:
    """(F, 3) the colors, smoothed where neighbors differ by little more than noise."""
    for _ in range(SMOOTHING_PASSES):
        weights = 1 / (1 + (_distances(colors, sides) / max(SAME_COLOR, 1.5 * noise)) ** 4)
        colors = _mean_of_neighbors(sides, colors, weights)
    return colors


def _color_regions(sides: np.ndarray, colors: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """(F,) the connected region of one color that each face belongs to.

    In each round the two regions merge that are the most similar neighbors of each other, until all neighbors differ by
    more than SAME_COLOR, or, as long as they have few faces, by more than noise explains.
    """
    noise = float(np.median(_distances(colors, sides))) if len(sides) else 0.0
    colors = _denoise(sides, colors, noise)
    regions = components(len(colors), sides[_distances(colors, sides) <= SAME_COLOR / 4])
    sums = np.column_stack([areas * column for column in colors.T] + [areas, np.ones(len(areas))])
    merged, pairs = regions, sides
    while True:
        sums = np.column_stack([np.bincount(merged, column) for column in sums.T])
        pairs = _distinct_pairs(merged[pairs], len(sums))
        means, size, counts = sums[:, :3] / sums[:, 3:4], sums[:, 3], sums[:, 4]
        a, b = pairs.T
        distances = _distances(means, pairs)
        limits = SAME_COLOR + NOISE_FACTOR * noise / np.sqrt(np.minimum(counts[a], counts[b]))
        is_small = np.minimum(size[a], size[b]) < MIN_REGION_AREA_FRACTION * areas.sum()
        can_merge = is_small | (distances <= limits)
        if not can_merge.any():
            return _absorb_mixtures(sides, colors, regions, means, pairs)
        merged = components(len(sums), _mutual_choices(pairs[can_merge], (distances - limits)[can_merge], len(sums)))
        regions = merged[regions]


def _absorb_mixtures(sides: np.ndarray, colors: np.ndarray, regions: np.ndarray, means: np.ndarray,
                     pairs: np.ndarray) -> np.ndarray:
    """The regions, after faces in the blur between two regions have joined the more similar one.

    Such faces are a region a face or two wide, with a color between those of its neighbors. means (R, 3), pairs (n, 2): colors
    and neighbors of the regions.
    """
    is_inner = np.ones(len(regions), bool)
    is_inner[sides[regions[sides[:, 0]] != regions[sides[:, 1]]]] = False
    is_thin = np.bincount(regions, is_inner) <= MAX_INNER_FRACTION * np.bincount(regions)
    ends, others = np.concatenate([pairs, pairs[:, ::-1]]).T
    is_wide = ~is_thin[others]  # a blur next to another blur says nothing about the colors on its sides
    ends, others = ends[is_wide], others[is_wide]
    distances = np.linalg.norm(means[ends] - means[others], axis=1)
    order = np.lexsort((distances, ends))
    first, last = (np.full(len(means), -1) for _ in range(2))
    last[ends[order]], first[ends[order[::-1]]] = order, order[::-1]
    strips = np.flatnonzero(is_thin & (first >= 0))
    near, far = others[first[strips]], others[last[strips]]
    detour = distances[first[strips]] + distances[last[strips]]
    is_mixture = (near != far) & (detour <= MAX_DETOUR * np.linalg.norm(means[near] - means[far], axis=1))
    sides_of = np.repeat(np.arange(len(means))[:, None], 2, axis=1)
    sides_of[strips[is_mixture]] = np.column_stack([near, far])[is_mixture]
    near, far = sides_of[regions].T
    is_far = np.linalg.norm(colors - means[far], axis=1) < np.linalg.norm(colors - means[near], axis=1)
    return np.where(is_far, far, near)


def _distinct_pairs(pairs: np.ndarray, count: int) -> np.ndarray:
    """(m, 2) the pairs of different numbers below count, each once."""
    low, high = np.minimum(*pairs.T), np.maximum(*pairs.T)
    keys = np.sort((low * count + high)[low < high])
    return np.column_stack(np.divmod(keys[np.append(True, keys[1:] > keys[:-1])] if len(keys) else keys, count))


def _mutual_choices(pairs: np.ndarray, costs: np.ndarray, count: int) -> np.ndarray:
    """(m, 2) those of the pairs (n, 2) that cost the least for both of their members."""
    scattered = np.arange(len(pairs)) * 0x9E3779B1 % 2 ** 32  # breaks ties: by index, a row of regions would merge one by one
    order = np.lexsort((scattered, costs))[::-1]
    choice = np.full(count, -1)
    choice[pairs[order].ravel()] = np.repeat(order, 2)  # the pair that costs the least is written last, and stays
    return pairs[(choice[pairs] == np.arange(len(pairs))[:, None]).all(axis=1)]
