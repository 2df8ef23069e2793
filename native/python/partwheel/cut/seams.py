# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams for unwrapping: along the borders of a cut, in creases. A part whose conformal map would overlap itself or distort
areas too much gets more cuts: into it, or through it along its tree. See docs/seams.md."""

from __future__ import annotations

from typing import TYPE_CHECKING, Callable, Dict, List, Optional, Set, Tuple

import numpy as np

from ..border import Creases
from ..components import components
from ..library import Context
from ..weld import is_welding, weld_surface
from .cut import ClusterTree, Cut
from .patches import Patch, SeamMesh, cut_path, cut_to_disk
from .stretch import ConformalMap, measure_distortion

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..hierarchy import Hierarchy

MAX_DISTORTION = 1.09  # predicted area distortion of a patch: measured for all patches of a model, it is 1.1
MAX_OVERLAP_FRACTION = 0.0005  # of a patch's area: less is below the resolution of the grid
# While a patch distorts areas more than NEARLY times too much, up to MAX_PEAKS_PER_ROUND cuts are made at once, then one. Where
# a patch has many peaks, as fur does, a round makes CUTS_SHARE of the cuts made so far: rounds grow with the logarithm.
NEARLY, MAX_PEAKS_PER_ROUND, CUTS_SHARE = 2, 16, 1 / 8
MAX_MERGE_WORK = 8  # triangles of all merges that are tried, relative to the part's; ordinary parts need 6 at most
FAILED_DISTORTION = 1.5  # of an island after unwrapping: only a failed solver leaves so much
MAX_REFINEMENTS = 3  # rounds in which seams are added where a solver failed
SCRAP_FRACTION = 0.1  # of the area of a part's largest component: smaller components go to a neighbor
MIN_SIDE_FRACTION = 0.05  # of a patch's area: either side of a division is larger


def seams(vertices: ArrayLike, triangles: np.ndarray, faces: ArrayLike, face_count: int, cut: Cut,
          max_distortion: float = MAX_DISTORTION, context: Optional[Context] = None) -> np.ndarray:
    """Seams along the borders of a cut, snapped to creases. Cut open there, the surface becomes patches that are disks.
    More cuts, preferably in creases, and most of all in concave ones, divide patches until the conformal map of none
    overlaps itself or exceeds the area distortion, as far as cuts can help.

    Parameters
    ----------
    vertices : (V, 3), triangles : (T, 3), faces : (T,) the polygon of each triangle, face_count : F. The surface that the
        cut is of. Coincident vertices are welded, and seams contain all edges that coincide
    max_distortion : mean factor by which areas of a patch may differ
    context : to cancel from another thread and to read the progress

    Returns
    -------
    (n, 2) int, the vertices of the edges

    Raises
    ------
    PartwheelError : the surface is invalid
    """
    context = context or Context()
    old_to_new, welded = weld_surface(vertices, triangles)
    mesh = SeamMesh(vertices, welded, faces)
    creases = Creases(vertices, triangles, faces, face_count)
    divider = _PatchDivider(cut.hierarchy, creases)
    seam_edges = [mesh.non_manifold_edges]
    labels = snap_labels(mesh, creases, cut.labels)
    done = 0
    for selected in mesh.label_components(labels):
        context.start_step(done / len(labels))
        done += len(selected)
        seam_edges += _patch_seams(mesh.submesh(selected), divider, max_distortion)
    seam_edges.append(_border_edges(mesh, labels))
    return _unweld_edges(mesh.edges[np.unique(np.concatenate(seam_edges))], old_to_new, triangles)


def unwrap_cut(vertices: ArrayLike, triangles: np.ndarray, faces: ArrayLike, face_count: int, cut: Cut,
               unwrap: Callable[[np.ndarray], np.ndarray]) -> Tuple[np.ndarray, np.ndarray]:
    """Unwrap a surface by the seams of a cut, and refine the seams where the solver failed.

    Parameters
    ----------
    vertices, triangles, faces, face_count, cut : see seams()
    unwrap : seams (n, 2) -> UVs (T, 3, 2) of the triangles' corners; called MAX_REFINEMENTS + 1 times at most

    Returns
    -------
    (seams (n, 2), UVs (T, 3, 2))
    """
    surface = vertices, triangles, faces, face_count
    seam_edges = seams(*surface, cut)
    uv = unwrap(seam_edges)
    for _ in range(MAX_REFINEMENTS):
        refined = refine_seams(*surface, cut, seam_edges, uv)
        if np.array_equal(refined, seam_edges):
            break
        seam_edges = refined
        uv = unwrap(seam_edges)
    return seam_edges, uv


def refine_seams(vertices: ArrayLike, triangles: np.ndarray, faces: ArrayLike, face_count: int, cut: Cut,
                 seam_edges: np.ndarray, uv: np.ndarray, max_distortion: float = MAX_DISTORTION,
                 context: Optional[Context] = None) -> np.ndarray:
    """Divide the islands of an unwrapping whose area distortion is far above the prediction, once, along the tree.

    Parameters
    ----------
    vertices, triangles, faces, face_count, cut, max_distortion, context : see seams()
    seam_edges : (n, 2) result of seams() or of this function
    uv : (T, 3, 2) UVs of the triangles' corners, unwrapped by those seams

    Returns
    -------
    (n, 2) the refined seams; the same ones if no island failed, or none can be divided
    """
    old_to_new, welded = weld_surface(vertices, triangles)
    mesh = SeamMesh(vertices, welded, faces)
    is_seam = np.isin(mesh.edges @ [len(mesh.positions), 1],
                      np.sort(old_to_new[seam_edges], axis=1) @ [len(mesh.positions), 1])
    divider, is_uncut = None, ~is_seam[mesh.interior_edges]
    context = context or Context()
    for selected in mesh.label_components(components(len(mesh.triangles), mesh.edge_triangles[is_uncut])):
        context.start_step(0)
        island = mesh.submesh(selected)
        if measure_distortion(island, uv[selected]) <= FAILED_DISTORTION:
            continue
        divider = divider or _PatchDivider(cut.hierarchy, Creases(vertices, triangles, faces, face_count))
        sides = divider.divide(island)
        if sides is not None:
            is_seam[island.interior_edges] = False  # cuts into the island are computed again
            is_seam[_border_edges(island, sides)] = True
            for component in island.label_components(sides):
                for edges in _patch_seams(mesh.submesh(selected[component]), divider, max_distortion):
                    is_seam[edges] = True
    return _unweld_edges(mesh.edges[is_seam], old_to_new, triangles)


def _unweld_edges(edges: np.ndarray, old_to_new: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The edges (n, 2) of the surface before welding that became these edges (m, 2)."""
    if not is_welding(old_to_new):
        return edges
    old_edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2), axis=0)
    return old_edges[np.isin(np.sort(old_to_new[old_edges], axis=1) @ [len(old_to_new), 1],
                             edges @ [len(old_to_new), 1])]


def _border_edges(mesh: SeamMesh, labels: np.ndarray) -> np.ndarray:
    """Indices into mesh.edges of the edges between triangles with different labels (T,)."""
    return mesh.interior_edges[labels[mesh.edge_triangles[:, 0]] != labels[mesh.edge_triangles[:, 1]]]


def _patch_seams(part: SeamMesh, divider: _PatchDivider, max_distortion: float) -> List[np.ndarray]:
    """The seams within a connected part, as arrays of indices into part.edges: divide the part along the tree until each
    patch can be mapped, then merge patches, longest borders first, where one map serves both."""
    patches: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}  # number -> (triangles, cuts into the patch)
    queue = [np.arange(len(part.triangles))]
    for selected in queue:
        patch_mesh = part.submesh(selected)
        edges, _, is_injective = _cut_patch(patch_mesh, max_distortion)
        sides = divider.divide(patch_mesh) if not is_injective else None
        if sides is None:
            patches[len(patches)] = selected, edges
        else:
            queue += [selected[component] for component in patch_mesh.label_components(sides)]
    label = np.empty(len(part.triangles), int)
    rejected: Set[Tuple[int, ...]] = set()
    next_number, work = len(patches), MAX_MERGE_WORK * len(part.triangles)
    for number, (selected, _) in patches.items():
        label[selected] = number
    while pair := _longest_border(part, label, rejected):
        selected = np.sort(np.concatenate([patches[number][0] for number in pair]))
        work -= len(selected)
        if work < 0:
            break
        edges, distortion, is_injective = _cut_patch(part.submesh(selected), max_distortion)
        if is_injective and distortion <= max_distortion:
            patches = {number: patch for number, patch in patches.items() if number not in pair}
            patches[next_number], label[selected] = (selected, edges), next_number
            next_number += 1
        else:
            rejected.add(pair)
    return [_border_edges(part, label), *(edges for _, edges in patches.values())]


def _longest_border(mesh: SeamMesh, labels: np.ndarray, rejected: Set[Tuple[int, ...]]) -> Optional[Tuple[int, ...]]:
    """The pair of labels whose border costs most to cut, except the rejected pairs; None if there is none."""
    pairs, cost = _border_costs(mesh, labels)
    order = np.argsort(-cost, kind="stable")
    return next((pair for pair in map(tuple, pairs[order].tolist()) if pair[0] < pair[1] and pair not in rejected), None)


def _border_costs(mesh: SeamMesh, labels: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """(pairs (n, 2) of adjacent labels, in both orders; cost (n,) of the edges between them)"""
    edge_labels = labels[mesh.edge_triangles]
    is_border = edge_labels[:, 0] != edge_labels[:, 1]
    pairs, edge_pair = np.unique(np.concatenate([edge_labels[is_border], edge_labels[is_border, ::-1]]), axis=0,
                                 return_inverse=True)
    return pairs, np.bincount(edge_pair.ravel(), np.tile(mesh.cut_cost[is_border], 2), len(pairs))


def _cut_patch(mesh: SeamMesh, max_distortion: float) -> Tuple[np.ndarray, float, bool]:
    """Cut a connected mesh to a disk, then from the boundary to the peaks of its conformal map while that distorts areas
    too much.

    Returns
    -------
    (cuts, as indices into mesh.edges; area distortion of the map; whether the map does not overlap itself)
    """
    is_cut, conformal_map, cut_count = cut_to_disk(mesh), None, 0
    while True:
        patch = Patch(mesh, is_cut)
        conformal_map = ConformalMap(patch, conformal_map)
        distortion = conformal_map.area_distortion()
        if distortion <= max_distortion:
            break
        boundary_distance, via, previous = patch.shortest_paths(np.flatnonzero(patch.is_boundary))
        is_near = distortion - 1 < NEARLY * (max_distortion - 1)
        peaks = conformal_map.peaks(boundary_distance, max(1 if is_near else MAX_PEAKS_PER_ROUND, int(CUTS_SHARE * cut_count)))
        cut_count += len(peaks)
        if not peaks:
            break
        for peak in peaks:
            cut_path(patch, is_cut, via, previous, peak)
    return mesh.interior_edges[is_cut], distortion, conformal_map.overlap_fraction() <= MAX_OVERLAP_FRACTION


class _PatchDivider:
    """Divides patches along the merge tree of a hierarchy."""

    def __init__(self, hierarchy: Hierarchy, creases: Creases) -> None:
        self.tree, self.creases = ClusterTree(hierarchy), creases
        self.position = np.empty(len(hierarchy.order), int)  # of each face in the hierarchy's order
        self.position[hierarchy.order] = np.arange(len(hierarchy.order))

    def divide(self, mesh: SeamMesh) -> Optional[np.ndarray]:
        """Divide a patch by a node of the tree: of the nodes on the path from the root to the largest piece of the patch,
        and their siblings, the one with the least border cost / area of the smaller side.

        Returns
        -------
        (T,) int, 1 for triangles on one side, else 0; None if no node divides the patch
        """
        position, area_fraction = self.position[mesh.faces], mesh.areas / max(mesh.areas.sum(), 1e-300)
        best, best_side, cluster = np.inf, None, self.tree.root
        while children := self.tree.children(cluster):
            sides = [(first <= position) & (position < last) for first, last in map(self.tree.face_slice, children)]
            fractions = [area_fraction[side].sum() for side in sides]
            for side, fraction in zip(sides, fractions):
                if MIN_SIDE_FRACTION <= fraction <= 1 - MIN_SIDE_FRACTION:
                    is_border = side[mesh.edge_triangles[:, 0]] != side[mesh.edge_triangles[:, 1]]
                    border_cost = mesh.cut_cost[is_border].sum()
                    if border_cost < best * min(fraction, 1 - fraction):
                        best, best_side = border_cost / min(fraction, 1 - fraction), side
            larger = int(fractions[1] > fractions[0])
            if fractions[larger] < MIN_SIDE_FRACTION:
                break
            cluster = children[larger]
        if best_side is None:
            return None
        inside = np.zeros(len(self.position), bool)
        inside[mesh.faces[best_side]] = True
        snapped = self.creases.snap(inside)[mesh.faces]
        if MIN_SIDE_FRACTION <= area_fraction[snapped].sum() <= 1 - MIN_SIDE_FRACTION:
            best_side = snapped
        return remove_scraps(mesh, best_side.astype(int))


def snap_labels(mesh: SeamMesh, creases: Creases, labels: np.ndarray) -> np.ndarray:
    """Snap the border of each part to the creases nearby, the largest part's last, and remove scraps.

    Parameters
    ----------
    labels : (F,) int, the part of each face, from 0

    Returns
    -------
    (T,) int, the part of each triangle
    """
    labels, unassigned = labels.copy(), labels.max(initial=0) + 1
    one, other = mesh.faces[mesh.edge_triangles].T
    area = np.bincount(mesh.faces, mesh.areas, len(labels))
    for part in np.argsort(np.bincount(labels, area), kind="stable").tolist():
        inside = labels == part
        snapped = creases.snap(inside) if inside.any() else inside
        if not snapped.any():
            continue
        labels[snapped] = part
        labels[inside & ~snapped] = unassigned  # until a neighbor's label spreads there
        while (is_unassigned := labels == unassigned).any():
            spread = labels.copy()
            for a, b in ((one, other), (other, one)):
                is_front = is_unassigned[a] & ~is_unassigned[b] & (labels[b] != part)
                np.minimum.at(spread, a[is_front], labels[b[is_front]])
            if (spread == labels).all():
                spread[is_unassigned] = part
            labels = spread
    return remove_scraps(mesh, labels[mesh.faces])


def remove_scraps(mesh: SeamMesh, labels: np.ndarray) -> np.ndarray:
    """Labels (T,) after small components of each label have joined the neighbor with the costliest common border."""
    while True:
        is_same = labels[mesh.edge_triangles[:, 0]] == labels[mesh.edge_triangles[:, 1]]
        component = components(len(labels), mesh.edge_triangles[is_same])
        label = labels[np.unique(component, return_index=True)[1]]  # of each component
        area = np.bincount(component, mesh.areas)
        largest = np.zeros(labels.max(initial=0) + 1)
        np.maximum.at(largest, label, area)
        is_scrap = area < SCRAP_FRACTION * largest[label]
        pairs, cost = _border_costs(mesh, component)
        is_usable = is_scrap[pairs[:, 0]] & ~is_scrap[pairs[:, 1]]
        if not is_usable.any():
            return labels
        pairs, cost = pairs[is_usable], cost[is_usable]
        order = np.lexsort((cost, pairs[:, 0]))  # ascending, so the last assignment to each scrap is the costliest border
        label[pairs[order, 0]] = label[pairs[order, 1]]
        labels = label[component]
