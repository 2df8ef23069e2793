# SPDX-License-Identifier: GPL-3.0-or-later
"""Interchangeable parts: how similar two parts are, and the similarity transform that puts one in the place of the other.
With numpy.

Kreavoy, Julius, Sheffer (Model composition from interchangeable components, 2007) exchange parts between models that
correspond. Here the part to replace is given, and candidates are compared with it in the frame and size of its border:
cap loops and the shape seen from there. fit() aligns the borders (center, normal, radius), tries rotations about the
normal (some from the principal axes), and refines the best by trimmed point-to-plane ICP (Chen, Medioni 1992;
Chetverikov et al. 2002) with constraints that keep the borders together.
"""

from __future__ import annotations

import copy
from typing import Any, Callable, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .components import triangle_components
from .deform import affine, cross_matrix, orthonormal_pair, rotation_from_vector
from .hierarchy import Hierarchy
from .triangles import doubled_area_vectors, sample_triangles, triangle_areas, unit_vectors

# Sampling
SURFACE_SAMPLES = 800  # points on the surface of a part
CAP_SAMPLES = 300  # points on its caps
COARSE_STEP = 4  # ICP uses every 4th point of the moving part
# Alignment; here and below, lengths are in radii of the border
MAX_ICP_ITERATIONS = 12
TRIMMED_FRACTION = 0.7  # of the closest pairs that ICP uses: the parts may differ elsewhere
ROTATION_COUNT = 16  # rotations about the normal to try
MIN_NORMAL_COSINE = np.cos(np.radians(30))  # between the borders' normals after ICP
MAX_RMS_DISTANCE = 0.3  # between the surfaces after ICP: above it the alignment of the borders alone is used
# Caps and their loops
MAX_CAP_OFFSET = 0.15  # of two points on caps that are compared, perpendicular to the normal
MAX_SINK_DEPTH = 0.5  # by which a part may be moved in to close gaps
MIN_PROJECTED_FRACTION = 0.05  # area of a loop's caps along their normal / area: below it they enclose a cavity
MIN_RADIUS_FRACTION = 0.25  # loops smaller than this fraction of the largest radius don't count
# Candidates
MIN_AREA_FRACTION, MAX_AREA_FRACTION = 0.004, 0.7  # of the whole model's area
CUT_PART_COUNT = 200  # parts of the cut whose wheel stops are the candidates
MAX_FITS = 16  # candidates that are aligned, those with the most similar features
SCORE_DIGITS = 9
MIN_OVERLAP = 0.6  # two nodes of one hierarchy that overlap more count as one candidate


class CapLoop(NamedTuple):
    """A loop of a part's border, from a connected group of caps. All three values depend on the boundary of the caps only,
    not on their inside, except the center's component along the normal."""

    center: np.ndarray  # (3,) of the caps projected along the normal
    normal: np.ndarray  # (3,) unit, out of the solid
    radius: float  # of the disk with the same projected area


class Fit(NamedTuple):
    """How a part fits in the place of another."""

    matrix: np.ndarray  # (4, 4) similarity transform from the part to the place
    distance: float  # mean distance between the two surfaces after that, both ways, relative to the size of the replaced part


class Match(NamedTuple):
    """A candidate for the place of another part."""

    key: Any  # of the candidate, as in rank_parts()
    score: float  # 1 for the same shape, down to 0
    matrix: np.ndarray  # (4, 4), see Fit


def cap_loops(vertices: np.ndarray, triangles: np.ndarray, matrix: np.ndarray) -> List[CapLoop]:
    """The loops of a part's border, largest first, from its caps: triangles (T, 3), wound outward, of vertices (V, 3), with
    the matrix (4, 4) to the space of the loops. Triangles are grouped by positions, not by indices: where caps only touch, a
    part may have two vertices and the rest one, or vice versa."""
    if not len(triangles):
        return []
    local = vertices[triangles]
    corners = transform_points(local, matrix)
    normals = doubled_area_vectors(corners) / 2
    areas, centers = np.linalg.norm(normals, axis=1), corners.mean(axis=1)
    loops = []
    if np.linalg.det(matrix[:3, :3]) < 0:
        normals = -normals
    _, corners = np.unique(local.reshape(-1, 3), axis=0, return_inverse=True)  # connected by positions
    number = triangle_components(corners.reshape(-1, 3))
    for component in (np.flatnonzero(number == k) for k in range(number.max() + 1)):
        area, normal = areas[component].sum(), normals[component].sum(axis=0)
        length = np.linalg.norm(normal)
        if length > MIN_PROJECTED_FRACTION * area:
            projected = normals[component] @ normal / length  # their sum depends only on the boundary of the caps
            loops.append(CapLoop(projected @ centers[component] / length, normal / length, float(np.sqrt(length / np.pi))))
    return sorted(loops, key=lambda loop: -loop.radius)


def transform_points(points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """Points (..., 3) transformed by an affine matrix (4, 4)."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


class PartShape:
    """The closed surface of a part, sampled for comparison with other parts.

    vertices : (n, 3), triangles : (m, 3), wound outward, caps : (m,) bool, the triangles that close the part where it was cut
    matrix : (4, 4) from the vertices to the space where parts are compared
    size : of the whole model in that space, for example half the diagonal of its bounding box"""

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray, caps: np.ndarray, matrix: np.ndarray,
                 size: float) -> None:
        self.loops = cap_loops(vertices, triangles[caps], matrix)
        if not self.loops:
            return
        self.main = self.loops[0]
        self.loops = [loop for loop in self.loops if loop.radius >= MIN_RADIUS_FRACTION * self.main.radius]
        corners = transform_points(vertices, matrix)[triangles] - self.main.center
        self.volume = abs(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6
        cap_corners = corners[caps]
        self.cap_points = sample_triangles(cap_corners, triangle_areas(cap_corners), CAP_SAMPLES)[0] + self.main.center
        outer = corners[~caps]
        areas = triangle_areas(outer)
        self.area = areas.sum()
        if self.area > 0:
            self.points, sampled = sample_triangles(outer, areas, SURFACE_SAMPLES)
            self.points += self.main.center
            self.normals = unit_vectors(doubled_area_vectors(outer[sampled]))
            if np.linalg.det(matrix[:3, :3]) < 0:
                self.normals = -self.normals
        self.relative_radius = self.main.radius / size
        self._features: Optional[np.ndarray] = None

    @property
    def is_usable(self) -> bool:
        """Whether the part has a border and a surface, which comparisons need."""
        return bool(self.loops) and self.area > 0

    def reflection(self) -> np.ndarray:
        """The (4, 4) reflection across a plane through the border's center that contains its normal."""
        across, center = _border_frame(self)[0], self.main.center
        flip = np.eye(3) - 2 * np.outer(across, across)
        return affine(flip, center - flip @ center)

    def reflect(self, flip: np.ndarray) -> PartShape:
        """A copy, transformed by a reflection (4, 4)."""
        linear, image = flip[:3, :3], copy.copy(self)
        image.points, image.cap_points = transform_points(self.points, flip), transform_points(self.cap_points, flip)
        image.normals = self.normals @ linear.T
        image.loops = [loop._replace(center=transform_points(loop.center, flip), normal=linear @ loop.normal)
                       for loop in self.loops]
        image.main = image.loops[0]
        return image

    def features(self) -> np.ndarray:
        """(n,) weighted features, invariant to similarity transforms; their Euclidean distance measures how much two
        shapes differ. Logarithms of lengths are in radii of the border."""
        if self._features is None:
            radius = self.main.radius
            points = (self.points - self.main.center) / radius
            height, center = points @ self.main.normal, points.mean(axis=0)
            across = points - height[:, None] * self.main.normal
            extents = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(points.T)), 1e-9))
            lateral = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(across.T))[1:], 1e-9))
            axial_offset = center @ self.main.normal
            lateral_offset = np.linalg.norm(center - axial_offset * self.main.normal)
            # Radius near the border, halfway, and near the far end; all the same for a part that is nearly flat.
            depth = (height.max() - height) / max(np.ptp(height), 0.1)
            radii = [np.average(np.linalg.norm(across - np.average(across, axis=0, weights=weight), axis=1),
                                weights=weight)
                     for weight in 1e-3 + np.maximum([1 - 2 * depth, 1 - abs(2 * depth - 1), 2 * depth - 1], 0)]
            self._features = np.concatenate([
                [np.log(self.volume / radius ** 3) / 3, np.log(self.area / radius ** 2) / 2],
                np.log(extents), np.log(lateral), [np.log(max(height.std(), 1e-9))],
                [np.arcsinh(axial_offset), np.arcsinh(lateral_offset)], 0.5 * np.log(np.maximum(radii, 1e-9)),
                [0.3 * np.log(self.relative_radius), 0.7 * (len(self.loops) - 1)]])
        return self._features


# ---- Fitting one part


def fit(place: PartShape, part: PartShape, mirror: bool = False) -> Fit:
    """Fit a part, or its mirror image, whose matrix then contains a reflection, in the place of another."""
    if mirror:
        flip = part.reflection()
        mirrored_fit = fit(place, part.reflect(flip))
        return mirrored_fit._replace(matrix=mirrored_fit.matrix @ flip)
    scale = place.main.radius / part.main.radius
    place_frame, part_frame = _border_frame(place), _border_frame(part)
    moving = ((part.points - part.main.center) * scale) @ part_frame.T  # in the border's frame, z along the normal
    target = (place.points - place.main.center) @ place_frame.T
    candidates = []
    for angle in _candidate_angles(moving, target, place_frame, part_frame):
        rotation = rotation_from_vector(np.array([0, 0, angle]))
        candidates.append((_mean_distance(moving[::2 * COARSE_STEP] @ rotation.T, target[::3]), angle))
    candidates.sort()
    fits: List[Fit] = []
    for _, angle in candidates[:2]:
        rotation = place_frame.T @ rotation_from_vector(np.array([0, 0, angle])) @ part_frame
        fits.append(_refine(place, part, scale, rotation))
        if fits[-1].distance < 1e-6:
            break
    return min(fits, key=lambda candidate: candidate.distance)


def gap(place: PartShape, part: PartShape, matrix: np.ndarray) -> float:
    """How far a part that was fitted by a matrix (4, 4) must move along the border's normal until its caps leave no gap to
    the rest of the model: in radii of the border, at most MAX_SINK_DEPTH; 0 for caps that are flat or the same."""
    frame, main = _border_frame(place), place.main
    part_caps, place_caps = (((points - main.center) / main.radius) @ frame.T
                             for points in (transform_points(part.cap_points, matrix), place.cap_points))
    squared = _squared_distances(place_caps[:, :2], part_caps[:, :2])
    nearest = squared.argmin(axis=1)
    is_near = squared[np.arange(len(place_caps)), nearest] < MAX_CAP_OFFSET ** 2
    if not is_near.any():
        return 0.0
    return float(np.clip(np.quantile((place_caps[:, 2] - part_caps[nearest, 2])[is_near], 0.95), 0, MAX_SINK_DEPTH))


def _border_frame(shape: PartShape) -> np.ndarray:
    """Orthonormal rows (3, 3): two directions perpendicular to the border's normal, and the normal."""
    return np.array([*orthonormal_pair(shape.main.normal), shape.main.normal])


def _candidate_angles(moving: np.ndarray, target: np.ndarray, place_frame: np.ndarray,
                      part_frame: np.ndarray) -> List[float]:
    """Angles about the normal to try: two that align the major axes perpendicular to the normal, one that aligns the
    centroids, the one with the smallest rotation in space, and ROTATION_COUNT - 1 at equal steps from that."""
    def major_axis(points: np.ndarray) -> np.ndarray:
        return np.linalg.eigh(np.cov(points[:, :2].T))[1][:, 1]

    def angle(direction: np.ndarray) -> float:
        return np.arctan2(direction[1], direction[0])

    by_axes = angle(major_axis(target)) - angle(major_axis(moving))
    by_centroids = angle(target.mean(axis=0)) - angle(moving.mean(axis=0))
    change = place_frame @ part_frame.T  # the smallest rotation: the rotation about z that is nearest to this
    smallest = np.arctan2(change[1, 0] - change[0, 1], change[0, 0] + change[1, 1])
    return [by_axes, by_axes + np.pi, by_centroids, smallest,
            *(smallest + np.arange(1, ROTATION_COUNT) * (2 * np.pi / ROTATION_COUNT))]


def _squared_distances(moving: np.ndarray, target: np.ndarray) -> np.ndarray:
    """(n, m) squared distances, in single precision. A matrix product would be less accurate far from the origin, and slow on a
    busy machine, where the threads of BLAS wait for each other."""
    moving, target = moving.astype(np.float32), target.astype(np.float32)
    return sum((moving[:, None, axis] - target[:, axis]) ** 2 for axis in range(moving.shape[1]))


def _mean_distance(moving: np.ndarray, target: np.ndarray) -> float:
    """Mean distance from each point to the nearest one of the other set, averaged over both directions."""
    squared = _squared_distances(moving, target)
    return sum(np.sqrt(squared.min(axis=axis)).mean() for axis in (0, 1)) / 2


def _refine(place: PartShape, part: PartShape, scale: float, rotation: np.ndarray) -> Fit:
    """The Fit after ICP from a rotation (3, 3); before ICP if the shapes differ too much, or ICP tilts the part too far."""
    radius, size = place.main.radius, np.sqrt(place.area)
    target = (place.points - place.main.center) / radius
    start = ((part.points - part.main.center)[::COARSE_STEP] * (scale / radius)) @ rotation.T
    centers = np.array([(loop.center - part.main.center) * (scale / radius) for loop in part.loops]) @ rotation.T
    matrix, mean_squared_radius = np.eye(4), (start ** 2).sum(axis=1).mean()
    normal = rotation @ part.main.normal
    points = start
    last_error = np.inf
    for _ in range(MAX_ICP_ITERATIONS):
        squared = _squared_distances(points, target)
        nearest = squared.argmin(axis=1)
        squared = squared[np.arange(len(points)), nearest]
        last_used = int(TRIMMED_FRACTION * (len(squared) - 1))
        is_used = squared <= np.partition(squared, last_used)[last_used]
        error = squared[is_used].mean()
        if error > last_error * 0.999:
            break
        last_error = error
        step = _icp_step(points[is_used], target[nearest[is_used]], place.normals[nearest[is_used]],
                         _border_constraints(place, matrix, centers, normal, mean_squared_radius))
        matrix = step @ matrix
        points = transform_points(start, matrix)
    is_tilted = ((matrix[:3, :3] @ normal) @ place.main.normal < MIN_NORMAL_COSINE
                 or np.linalg.norm(matrix[:3, 3]) > 0.5)
    if is_tilted or np.sqrt(last_error) > MAX_RMS_DISTANCE * max(1.0, np.sqrt(mean_squared_radius) / 3):
        matrix = np.eye(4)
    rotation = matrix[:3, :3] @ rotation
    result = affine(scale * rotation, place.main.center + radius * matrix[:3, 3] - scale * rotation @ part.main.center)
    points = (transform_points(part.points, result) - place.main.center) / radius
    return Fit(result, float(_mean_distance(points, target) * radius / size))


Constraint = Tuple[np.ndarray, np.ndarray, float]  # points or directions (..., 3), their targets (..., 3), weight


def _border_constraints(place: PartShape, matrix: np.ndarray, centers: np.ndarray, normal: np.ndarray,
                        normal_weight: float) -> Tuple[Constraint, Constraint]:
    """Constraints that keep the borders together: centers of loops, and the normal of the main loop."""
    targets = np.array([(loop.center - place.main.center) / place.main.radius for loop in place.loops])
    centers = transform_points(centers, matrix)
    nearest = np.linalg.norm(centers[:, None] - targets, axis=2).argmin(axis=1)
    nearest[0] = 0
    is_near = np.linalg.norm(centers - targets[nearest], axis=1) < 1
    is_near[0] = True
    return (centers[is_near], targets[nearest[is_near]], 4.0), (matrix[:3, :3] @ normal, place.main.normal, normal_weight)


def _icp_step(points: np.ndarray, targets: np.ndarray, normals: np.ndarray,
              constraints: Tuple[Constraint, Constraint]) -> np.ndarray:
    """The rigid motion (4, 4) that minimizes point-to-plane distances and constraints: linear least squares for a small
    rotation vector and a translation."""
    (centers, center_targets, center_weight), (normal, normal_target, normal_weight) = constraints
    point_weight = 1 / np.sqrt(len(points))
    rows = [np.hstack([np.cross(points, normals), normals]) * point_weight]
    right_sides = [np.einsum("ij,ij->i", normals, targets - points) * point_weight]
    for center, target in zip(centers, center_targets):
        rows.append(np.sqrt(center_weight) * np.hstack([-cross_matrix(center), np.eye(3)]))
        right_sides.append(np.sqrt(center_weight) * (target - center))
    rows.append(np.sqrt(normal_weight) * np.hstack([-cross_matrix(normal), np.zeros((3, 3))]))
    right_sides.append(np.sqrt(normal_weight) * (normal_target - normal))
    solution = np.linalg.lstsq(np.vstack(rows), np.concatenate(right_sides), rcond=None)[0]
    return affine(rotation_from_vector(solution[:3]), solution[3:])


# ---- Choosing among many parts


def rank_parts(place: PartShape, parts: Sequence[Tuple[Any, PartShape]],
               is_same: Callable[[Any, Any], bool] = lambda one, other: False) -> List[Match]:
    """Rank candidates (key, PartShape) for the place of a part: at most MAX_FITS matches, those with the most similar
    features, best score first. is_same : whether two keys are nearly the same part, of which one match is enough"""
    by_distance = sorted((float(np.linalg.norm(place.features() - shape.features())), number)
                         for number, (_, shape) in enumerate(parts) if shape.is_usable)
    matches: List[Match] = []
    for distance, number in by_distance:
        key, shape = parts[number]
        if any(is_same(match.key, key) for match in matches):
            continue
        best_fit = fit(place, shape)
        # The last bits of matrix products depend on memory alignment; rounding keeps scores independent of it.
        score = round(float(np.exp(-(0.5 * distance + 4 * best_fit.distance))), SCORE_DIGITS)
        matches.append(Match(key, score, best_fit.matrix))
        if len(matches) == MAX_FITS:
            break
    return sorted(matches, key=lambda match: -match.score)


def candidate_nodes(hierarchy: Hierarchy) -> List[int]:
    """The wheel stops that are neither tiny nor nearly the whole model, ascending."""
    bounds = hierarchy.cut_parts(min(CUT_PART_COUNT, len(hierarchy.tetrahedra)))
    labels = hierarchy.face_labels(bounds)
    first_faces = np.unique(labels, return_index=True)[1].tolist()
    stops = {stop for face in first_faces for stop in hierarchy.wheel(face)[0].tolist()}
    fraction = hierarchy.area / hierarchy.area[-1]
    return sorted(stop for stop in stops if MIN_AREA_FRACTION <= fraction[stop] <= MAX_AREA_FRACTION)


def node_overlap(hierarchy: Hierarchy, one: int, other: int) -> float:
    """Overlap of two nodes: intersection over union of their areas, 0 to 1."""
    first, last = hierarchy.tet_first, hierarchy.tet_last
    inner, outer = sorted((one, other), key=lambda node: last[node] - first[node])
    is_nested = first[outer] <= first[inner] and last[inner] <= last[outer]
    return float(hierarchy.area[inner] / hierarchy.area[outer]) if is_nested else 0.0


def part_shape(hierarchy: Hierarchy, node: int, positions: np.ndarray, matrix: np.ndarray, size: float,
               faces: Optional[np.ndarray] = None) -> Optional[PartShape]:
    """The PartShape of a node, with these positions (V, 3) of the hierarchy's vertices; matrix, size : see PartShape. None if
    cut polygons leave nothing of the node. faces : (F,) bool, source faces to use instead of its own, see
    Hierarchy.solid_of_slice()"""
    solid = hierarchy.solids([hierarchy.tet_slice(node)], faces)[0]
    return solid and PartShape(positions[solid.source_vertices], solid.triangles, solid.neighbor_tets >= 0, matrix, size)
