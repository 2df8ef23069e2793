# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits boxes, spheres, capsules and cylinders around convex hulls: engines collide them several times faster than
hulls.

A primitive contains its hull. Its excess is the one-sided Hausdorff distance from the primitive to the hull: exact,
except for a cylinder, where it is an upper bound, at most 0.2 % of the radius too large. The axes of capsules and
cylinders are found by a local search from a few directions, so they are good but not optimal."""

from functools import cached_property
from itertools import combinations
from typing import Any, Callable, Collection, Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from ..deform import affine, orthonormal_pair
from ..triangles import side_ends

KINDS = "sphere", "capsule", "box", "cylinder"  # fastest in engines first
EXCESS_TOLERANCE = 0.1  # fraction of max_excess by which a faster kind may exceed more than the best one
SEARCH_LIMIT = 4  # multiple of max_excess up to which an initial axis is improved
SEARCH_STEPS = 8  # iterations of the axis search; each halves the step
MAX_BOX_FACETS = 200  # largest facets that are tried as a side of the box
MESH_SIDES, MESH_RINGS = 16, 8  # resolution of the meshes of round primitives
CYLINDER_SAMPLES = 64  # corners of the polygon that encloses a cylinder's rim


class Primitive(NamedTuple):
    """A collision shape.

    kind : one of KINDS
    center : (3,)
    axes : (3, 3) rotation, the local x, y and z as columns; capsules and cylinders lie along z
    half_extents : (3,) along the axes; a capsule's include its round ends
    """

    kind: str
    center: np.ndarray
    axes: np.ndarray
    half_extents: np.ndarray

    def matrix(self) -> np.ndarray:
        """(4, 4) transform from local space to the hull's."""
        return affine(self.axes, self.center)

    def mesh(self) -> Tuple[np.ndarray, np.ndarray]:
        """A closed mesh in local space with the primitive's bounding box: vertices (n, 3), triangles (m, 3),
        outward."""
        if self.kind == "box":
            vertices = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * self.half_extents
            sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
            return vertices, np.array([triangle for a, b, c, d in sides for triangle in ((a, b, c), (a, c, d))])
        radius, half = self.half_extents[0], self.half_extents[2]
        if self.kind == "cylinder":
            rings = [(radius, -half), (radius, half)]
        else:
            angles = np.linspace(-np.pi / 2, np.pi / 2, MESH_RINGS + 1)[1:-1]
            straight = half - radius
            rings = [(radius * np.cos(angle), radius * np.sin(angle) + (straight if angle > 0 else -straight))
                     for angle in angles]
            if straight > 0:
                rings.insert(MESH_RINGS // 2, (radius, straight))
        circle = _circle(MESH_SIDES)
        layers = [np.column_stack([ring * circle, np.full(MESH_SIDES, z)]) for ring, z in rings]
        vertices = np.vstack([(0, 0, -half), *layers, (0, 0, half)])
        i, j = np.arange(MESH_SIDES), np.roll(np.arange(MESH_SIDES), -1)
        last = len(vertices) - 1
        triangles = [np.column_stack([0 * i, 1 + j, 1 + i]),
                     np.column_stack([last + 0 * i, last - MESH_SIDES + i, last - MESH_SIDES + j])]
        for ring in range(len(rings) - 1):
            low, high = 1 + ring * MESH_SIDES, 1 + (ring + 1) * MESH_SIDES
            triangles += [np.column_stack([low + i, low + j, high + j]), np.column_stack([low + i, high + j, high + i])]
        return vertices, np.vstack(triangles)

    def volume(self) -> float:
        """The volume."""
        radius, half = self.half_extents[0], self.half_extents[2]
        return {"box": 8 * self.half_extents.prod(), "sphere": 4 / 3 * np.pi * radius ** 3,
                "capsule": np.pi * radius ** 2 * (2 * half - 2 / 3 * radius),
                "cylinder": 2 * np.pi * radius ** 2 * half}[self.kind]


PrimitiveFit = Tuple[float, Primitive]  # (excess, the primitive)


def fit_primitive(vertices: np.ndarray, triangles: np.ndarray, max_excess: float,
                  kinds: Collection[str] = KINDS) -> Optional[Primitive]:
    """Fits a primitive that can replace a convex hull.

    Parameters
    ----------
    vertices : (n, 3) of the hull
    triangles : (m, 3) of the hull
    max_excess : the largest distance from the hull that a point of the primitive may have
    kinds : the kinds of primitive to choose from

    Returns
    -------
    the primitive that contains the hull with the least excess, or one of a faster kind with at most
    EXCESS_TOLERANCE * max_excess more; None if every fit exceeds max_excess
    """
    hull = _Hull(np.asarray(vertices, float), np.asarray(triangles))
    fits: List[PrimitiveFit] = []
    for kind in KINDS:
        if kind in kinds:
            fits.append(_FITS[kind](hull, max_excess))
            if fits[-1][0] <= EXCESS_TOLERANCE * max_excess:
                break
    limit = min(min((excess for excess, _ in fits), default=0) + EXCESS_TOLERANCE * max_excess, max_excess)
    return next((primitive for excess, primitive in fits if excess <= limit), None)


def kind_of(shape: Any) -> str:
    """The kind of a Primitive; "hull" for anything else."""
    return getattr(shape, "kind", "hull")


class _Hull:
    """A convex hull with its facet planes.

    vertices (n, 3); triangles (m, 3), without those of negligible area; areas (m,); normals (m, 3) unit, outward;
    corners (m, 3, 3); offsets (m,): facet f lies in the plane normals[f] . x = offsets[f]; size: the longest extent.
    """

    def __init__(self, vertices: np.ndarray, triangles: np.ndarray) -> None:
        self.vertices, self.size = vertices, np.ptp(vertices, axis=0).max()
        a, b, c = vertices[triangles].transpose(1, 0, 2)
        normals = np.cross(b - a, c - a)
        doubled_areas = np.linalg.norm(normals, axis=1)
        valid = doubled_areas > 1e-12 * doubled_areas.max()  # a smaller facet's normal is rounding noise
        self.triangles, self.areas = triangles[valid], doubled_areas[valid] / 2
        self.normals = normals[valid] / doubled_areas[valid, None]
        self.corners = vertices[self.triangles]
        self.offsets = (self.normals * self.corners[:, 0]).sum(axis=1)

    def signed_distances(self, points: np.ndarray) -> np.ndarray:
        """(n,) distances of points (n, 3) from the hull's surface, negative inside."""
        heights = points @ self.normals.T - self.offsets
        distances = heights.max(axis=1)
        # The hull's nearest point to an outside point lies on a facet visible from it. The tolerance keeps facets of
        # one plane that rounding would make invisible.
        outside, visible = np.nonzero((distances > 0)[:, None] & (heights > -1e-9 * self.size))
        if len(outside):
            to_facets = _triangle_distances(points[outside], self.corners[visible], self.normals[visible])
            first = np.flatnonzero(np.diff(outside, prepend=-1))
            distances[outside[first]] = np.minimum.reduceat(to_facets, first)
        return distances

    def axes(self) -> np.ndarray:
        """(n, 3) initial axes for capsules and cylinders: the principal axes of the surface, and the box's."""
        centroid = np.average(self.corners.mean(axis=1), axis=0, weights=self.areas)
        moments = np.einsum("t,tci,tcj->ij", self.areas, self.corners - centroid, self.corners - centroid)
        return np.vstack([np.linalg.eigh(moments)[1].T, self.box.T])

    @cached_property
    def box(self) -> np.ndarray:
        """(3, 3) axes, as columns, of the smallest bounding box among those with a side in a facet's plane."""
        return min(map(self._box_on, self._box_normals()), key=lambda box: box[0])[1]

    def _box_normals(self) -> List[np.ndarray]:
        """[(3,), ...] normals of the largest facets, up to sign, without duplicates."""
        normals: List[np.ndarray] = []
        for normal in self.normals[np.argsort(-self.areas, kind="stable")[:MAX_BOX_FACETS]]:
            if not normals or np.abs(np.array(normals) @ normal).max() < 1 - 1e-9:
                normals.append(normal)
        return normals

    def _box_on(self, normal: np.ndarray) -> Tuple[float, np.ndarray]:
        """(volume, axes (3, 3)) of the smallest bounding box with a side across the normal. A second side contains an
        edge of the silhouette: the minimum-area rectangle around a convex polygon has a side along an edge of it."""
        plane = np.column_stack(orthonormal_pair(normal))
        visible = self.triangles[self.normals @ normal > 0]
        edges, counts = np.unique(side_ends(visible), axis=0, return_counts=True)
        sides = np.diff(self.vertices[edges[counts == 1]], axis=1)[:, 0] @ plane
        lengths = np.linalg.norm(sides, axis=1)
        sides = sides[lengths > 1e-9 * lengths.max()] / lengths[lengths > 1e-9 * lengths.max(), None]
        projected = self.vertices @ plane
        areas = np.ptp(projected @ sides.T, axis=0) * np.ptp(projected @ (sides @ [[0, 1], [-1, 0]]).T, axis=0)
        best = int(areas.argmin())
        side = plane @ sides[best]
        return areas[best] * np.ptp(self.vertices @ normal), np.column_stack([side, np.cross(normal, side), normal])


# ---- Fits of each kind: (hull, max_excess) -> (excess, Primitive)


def _fit_sphere(hull: _Hull, _max_excess: float) -> PrimitiveFit:
    center, radius = _smallest_ball(hull.vertices)
    return radius + hull.signed_distances(center[None])[0], Primitive("sphere", center, np.eye(3), np.full(3, radius))


def _fit_box(hull: _Hull, _max_excess: float) -> PrimitiveFit:
    axes = hull.box
    local = hull.vertices @ axes
    low, high = local.min(axis=0), local.max(axis=0)
    box = Primitive("box", axes @ (low + high) / 2, axes, (high - low) / 2)
    corners = box.mesh()[0] @ axes.T + box.center
    return max(hull.signed_distances(corners).max(), 0.0), box


_FITS: Dict[str, Callable[[_Hull, float], PrimitiveFit]] = {
    "sphere": _fit_sphere, "capsule": lambda hull, max_excess: _search_axis(hull, max_excess, _capsule_along),
    "box": _fit_box, "cylinder": lambda hull, max_excess: _search_axis(hull, max_excess, _cylinder_along)}


def _search_axis(hull: _Hull, max_excess: float, fit_along: Callable[[_Hull, np.ndarray], PrimitiveFit]) -> PrimitiveFit:
    """The best fit over the initial axes; if its excess is at most SEARCH_LIMIT * max_excess, improved by a pattern
    search that tilts the axis in four directions and halves the step."""
    best = min((fit_along(hull, axis) for axis in hull.axes()), key=lambda fit: fit[0])
    step = 0.2
    for _ in range(SEARCH_STEPS if best[0] <= SEARCH_LIMIT * max_excess else 0):
        axis = best[1].axes[:, 2]
        x, y = orthonormal_pair(axis)
        for direction in (x, y, -x, -y):
            tilted = axis + step * direction
            best = min(best, fit_along(hull, tilted / np.linalg.norm(tilted)), key=lambda fit: fit[0])
        step /= 2
    return best


def _capsule_along(hull: _Hull, axis: np.ndarray) -> PrimitiveFit:
    axes, center_2d, radius, heights, distances = _enclosing_tube(hull, axis)
    cap = np.sqrt(np.maximum(radius ** 2 - distances ** 2, 0))  # height of the round end above its center at each vertex
    low, high = (heights + cap).min(), (heights - cap).max()
    if low > high:
        low = high = (low + high) / 2
    center = axes @ np.array([*center_2d, (low + high) / 2])
    ends = center + np.outer([-1, 1], (high - low) / 2 * axis)
    half = np.array([radius, radius, radius + (high - low) / 2])
    return radius + hull.signed_distances(ends).max(), Primitive("capsule", center, axes, half)


def _cylinder_along(hull: _Hull, axis: np.ndarray) -> PrimitiveFit:
    axes, center_2d, radius, heights, _ = _enclosing_tube(hull, axis)
    low, high = heights.min(), heights.max()
    rim = center_2d + radius / np.cos(np.pi / CYLINDER_SAMPLES) * _circle(CYLINDER_SAMPLES)
    points = np.vstack([np.column_stack([rim, np.full(CYLINDER_SAMPLES, z)]) for z in (low, high)]) @ axes.T
    cylinder = Primitive("cylinder", axes @ np.array([*center_2d, (low + high) / 2]), axes,
                         np.array([radius, radius, (high - low) / 2]))
    return max(hull.signed_distances(points).max(), 0.0), cylinder


def _enclosing_tube(hull: _Hull, axis: np.ndarray) -> Tuple[np.ndarray, np.ndarray, float, np.ndarray, np.ndarray]:
    """The smallest infinite cylinder along an axis that contains the hull: (a frame as columns (3, 3), the axis last; the
    cylinder's center (2,) in that frame's x and y; its radius; the vertices' heights along the axis (n,); their distances
    from it (n,))"""
    axes = np.column_stack([*orthonormal_pair(axis), axis])
    local = hull.vertices @ axes
    center_2d, radius = _smallest_ball(local[:, :2])
    return axes, center_2d, radius, local[:, 2], np.linalg.norm(local[:, :2] - center_2d, axis=1)


# ---- Geometry


def _circle(count: int) -> np.ndarray:
    """(count, 2) equally spaced points of the unit circle."""
    angles = 2 * np.pi * np.arange(count) / count
    return np.column_stack([np.cos(angles), np.sin(angles)])


def _smallest_ball(points: np.ndarray) -> Tuple[np.ndarray, float]:
    """(center, radius) of the smallest enclosing ball of points (n, d), d 2 or 3.

    Active-set method: while a point is outside, the farthest one joins the support set, and the smallest ball of that
    set is found among the circumscribed balls of its subsets. The radius grows each time, so the method terminates."""
    support = points[:1]
    center, radius = support[0], 0.0
    while True:
        distances = np.linalg.norm(points - center, axis=1)
        farthest = int(distances.argmax())
        if distances[farthest] <= radius * (1 + 1e-12):
            return center, radius
        support = np.vstack([support, points[farthest]])
        best = None
        for count in range(2, points.shape[1] + 2):
            for indices in combinations(range(len(support) - 1), count - 1):
                subset = support[[*indices, -1]]
                candidate = _circumcenter(subset)
                enclosing_radius = np.linalg.norm(support - candidate, axis=1).max()
                if best is None or enclosing_radius < best[1]:
                    best = candidate, enclosing_radius, subset
        assert best is not None
        if best[1] <= radius:  # the radius grows only by rounding error
            return center, distances[farthest]
        center, radius, support = best


def _circumcenter(points: np.ndarray) -> np.ndarray:
    """The point of the affine hull of points (n, d) that has the same distance to all of them."""
    sides = points[1:] - points[0]
    products = sides @ sides.T
    return points[0] + np.linalg.lstsq(2 * products, np.diag(products), rcond=None)[0] @ sides


def _triangle_distances(points: np.ndarray, corners: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(n,) distances of points (n, 3) from triangles (n, 3, 3) with unit normals (n, 3), pairwise."""
    distances = np.full(len(points), np.inf)
    inside = np.ones(len(points), bool)
    for k in range(3):
        start, side = corners[:, k], corners[:, (k + 1) % 3] - corners[:, k]
        offset = points - start
        fraction = np.clip((offset * side).sum(axis=1) / (side * side).sum(axis=1), 0, 1)
        distances = np.minimum(distances, np.linalg.norm(offset - fraction[:, None] * side, axis=1))
        inside &= (np.cross(side, offset) * normals).sum(axis=1) >= 0
    return np.where(inside, ((points - corners[:, 0]) * normals).sum(axis=1), distances)
