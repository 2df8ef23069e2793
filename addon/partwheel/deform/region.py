# SPDX-License-Identifier: GPL-3.0-or-later
"""The region of a mesh that deforms: which vertices are free, which are fixed, which are mirrored.

Coordinates are those of the shape being edited, the active shape key's if there is one. The region keeps no
references to Blender's data, so undo or a mode change can't invalidate it."""

import bpy
import numpy as np

from partwheel.deform import FIXED, surface_distances
from partwheel.joint import find_joint
from partwheel.triangles import triangle_areas
from partwheel.weld import weld_surface
from ..mesh import Refused, arrays

HANDLE_RADIUS_FACTOR = 0.25  # default radius of a handle, by the square root of the part's area
MIRROR_TOLERANCE = 1e-4  # distance of a vertex from its partner's mirror image, by the size of the mesh
MIRROR_X = np.float32([-1, 1, 1])


class Region:
    """The part of a mesh that these faces form, and its surroundings, prepared for deformation.

    Coincident vertices of the edited shape are welded (partwheel.weld): old_to_new (V,) maps each mesh vertex to the
    one it counts as.

    vertices (n,): welded vertices of the part and of the faces around it
    rest (n, 3), triangles (t, 3): their positions; indices into vertices
    free (n,) bool: inside the part and visible; its border and the rest are fixed
    center (3,), size: of the part

    rings: rings of faces around the part that deform, too. mirror: the same happens across the x axis. With reach, the
    part turns at its joint (partwheel.joint): what is within this many radii of its border, on either side, is free,
    too; limb: the region's vertices of the rest of the part; center: the joint's.

    moving (m,), before (m, 3): mesh vertices that may move, with mirrored and coincident ones, and their positions
    flat_faces: polygons with such a vertex that are shaded flat; polygons: whether one of them is no triangle

    Not welded, for shading: shaded (k,) mesh vertices of shaded_triangles (t, 3); smooth (k,) bool: those of changing
    polygons that are shaded smooth; of_shaded (k,): the region's vertex of each."""

    def __init__(self, obj: bpy.types.Object, faces: np.ndarray, rings: int = 0, mirror: bool = False,
                 reach: float | None = None) -> None:
        """Raises Refused."""
        surface = arrays.read_surface(arrays.update_mesh(obj))
        mesh, points = obj.data, arrays.read_edited_positions(obj)
        count = len(points)
        self.old_to_new, welded = weld_surface(points, surface.triangles, sheets=True)
        is_inside = arrays.make_mask(surface.face_count, faces)
        for _ in range(rings):
            is_reached = arrays.make_mask(count, welded[is_inside[surface.faces]])
            reached = surface.faces[is_reached[welded].any(axis=1)]
            if is_inside[reached].all():
                break  # further rings would add nothing
            is_inside[reached] = True
        is_triangle_inside = is_inside[surface.faces]
        is_member, is_border = (arrays.make_mask(count, welded[mask])
                                for mask in (is_triangle_inside, ~is_triangle_inside))
        is_free, is_limb = is_member & ~is_border, np.zeros(count, bool)
        joint = None if reach is None else find_joint(points.astype(np.float64), welded, is_triangle_inside)
        if joint and is_free.any():
            roles = joint.roles(reach)
            is_free, is_limb = roles != FIXED, roles == 0
            is_member = is_free
        is_free &= arrays.make_mask(count, self.old_to_new[~arrays.read(mesh.vertices, "hide", bool)])
        is_near = is_member[welded].any(axis=1)
        self.vertices, triangles = np.unique(welded[is_near], return_inverse=True)
        self.triangles = triangles.reshape(-1, 3).astype(np.int32)
        self.rest = points[self.vertices].astype(np.float64)
        self.free = is_free[self.vertices]
        self.limb = np.flatnonzero((is_limb & is_free)[self.vertices])
        self.center = joint.center if joint else self.rest[self.free].mean(axis=0) if self.free.any() else np.zeros(3)
        corners = points[surface.triangles[is_triangle_inside]].astype(np.float64)
        self.size = np.sqrt(triangle_areas(corners).sum())
        if not self.free.any():
            raise Refused("The part has no visible vertex inside its border: pick a larger one.")
        if self.free.all():
            raise Refused("The part is the whole mesh or a loose piece, without a border that would stay fixed: "
                          "pick a smaller one, or move it with Blender's own tools.")
        if not self.size > 0:
            raise Refused("The faces of the part have no area: there is nothing to deform.")
        self._distance_cache = None, None
        self.partner, self._mirror_sources, images = None, np.empty(0, int), np.empty(0, int)
        if mirror:
            self.partner, self._mirror_sources, images = self._partners(points)
        moving, self._moving_sources = self._with_coincident(np.flatnonzero(self.free), self.vertices[self.free])
        images, self._mirror_sources = self._with_coincident(self._mirror_sources, images)
        self.moving = np.concatenate([moving, images])
        self.before = points[self.moving]
        is_moving = arrays.make_mask(count, self.moving)
        is_changing = arrays.make_mask(len(is_inside), surface.faces[is_moving[surface.triangles].any(axis=1)])
        shaded_smooth = arrays.read(mesh.polygons, "use_smooth", bool)
        self.flat_faces = np.flatnonzero(is_changing & ~shaded_smooth)
        smooth = surface.triangles[(is_changing & shaded_smooth)[surface.faces]]
        self.shaded, triangles = np.unique(surface.triangles[is_near], return_inverse=True)
        self.shaded_triangles = triangles.reshape(-1, 3).astype(np.int32)
        self.smooth = arrays.make_mask(count, smooth)[self.shaded]
        self.of_shaded = np.searchsorted(self.vertices, self.old_to_new[self.shaded])
        self.polygons = bool((arrays.read_polygon_sizes(mesh)[1][is_changing] > 3).any())

    def _partners(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(partner (n,): for each vertex, its mirror image in the region, or -1; the region's vertices whose mirror
        image is outside; these images in the mesh)"""
        tree = arrays.create_kd_tree(points)
        limit = MIRROR_TOLERANCE * float(np.ptp(points, axis=0).max())
        index_of = {vertex: index for index, vertex in enumerate(self.vertices.tolist())}
        partner, indices, vertices = np.full(len(self.vertices), -1), [], []
        for index in np.flatnonzero(self.free).tolist():
            x, y, z = self.rest[index]
            _, vertex, distance = tree.find((-x, y, z))
            if distance > limit:
                continue
            vertex = int(self.old_to_new[vertex])
            other = index_of.get(vertex, -1)
            if other >= 0 and self.free[other]:
                partner[index] = other
            else:
                indices.append(index)
                vertices.append(vertex)
        return partner, np.array(indices, int), np.array(vertices, int)

    def _with_coincident(self, indices: np.ndarray, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(mesh vertices that are welded to vertices (n,); for each of them the entry of indices (n,))"""
        order = np.argsort(self.old_to_new, kind="stable")
        first, last = (np.searchsorted(self.old_to_new[order], vertices, side) for side in ("left", "right"))
        counts = last - first
        begin = np.cumsum(counts) - counts
        return order[np.arange(counts.sum()) + np.repeat(first - begin, counts)], np.repeat(indices, counts)

    def indices(self, vertices: np.ndarray) -> np.ndarray:
        """(k,) the region's indices of mesh vertices (k,); -1 for those outside."""
        vertices = np.asarray(vertices, np.int64)
        is_valid = (vertices >= 0) & (vertices < len(self.old_to_new))
        vertices = self.old_to_new[np.where(is_valid, vertices, 0)]
        index = np.minimum(np.searchsorted(self.vertices, vertices), len(self.vertices) - 1)
        return np.where(is_valid & (self.vertices[index] == vertices), index, -1)

    def example(self) -> int:
        """A mesh vertex inside the part, for error messages: the nearest to its center."""
        distance = np.linalg.norm(self.rest - self.center, axis=1)
        return int(self.vertices[np.where(self.free, distance, np.inf).argmin()])

    def nearest_free(self, vertex: int) -> int:
        """The region's index of a mesh vertex, or of the nearest free one. Raises Refused outside the region."""
        index = int(self.indices([vertex])[0])
        if index < 0:
            raise Refused("This point is not on the part.")
        if self.free[index]:
            return index
        distance = np.linalg.norm(self.rest - self.rest[index], axis=1)
        return int(np.where(self.free, distance, np.inf).argmin())

    def patch(self, index: int, radius: float) -> np.ndarray:
        """The region's indices of the free vertices within a radius along the surface, at least the vertex itself."""
        return np.flatnonzero(self.free & (self._distances_from(index) <= radius))

    def default_radius(self, index: int) -> float:
        """The default radius of a handle at this vertex: a fraction of the part's size. It contains at least the neighbors,
        since a single vertex would draw a spike, and at most a quarter of the free vertices."""
        neighbors = np.unique(self.triangles[(self.triangles == index).any(axis=1)])
        distance = self._distances_from(index)
        sorted_distances = np.sort(distance[self.free])
        return float(min(max(HANDLE_RADIUS_FACTOR * self.size, 1.01 * distance[neighbors].max()),
                         sorted_distances[len(sorted_distances) // 4]))

    def _distances_from(self, index: int) -> np.ndarray:
        """(n,) distances along the surface. Caches the last result: 100,000 vertices take 0.1 s."""
        if self._distance_cache[0] != index:
            self._distance_cache = index, surface_distances(self.rest, self.triangles, [index])
        return self._distance_cache[1]

    def targets(self, points: np.ndarray) -> np.ndarray:
        """(m, 3) float32: positions of the moving vertices for the region's points (n, 3)."""
        points = points.astype(np.float32)
        if self.partner is not None:
            paired = np.flatnonzero(self.partner >= 0)
            points[paired] = (points[paired] + points[self.partner[paired]] * MIRROR_X) / 2
        return np.concatenate([points[self._moving_sources], points[self._mirror_sources] * MIRROR_X])
