# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a mesh that deforms: what of it is free, what holds it, what is mirrored.

Coordinates are those of the shape being edited: the active shape key's, where there is one. No reference to Blender's
data is kept, so undo or a mode change can't make it dangle.
"""

import numpy as np
from mathutils.kdtree import KDTree

from partwheel.deform import FIXED, surface_distances
from partwheel.joint import find_joint
from partwheel.weld import weld_surface
from ..mesh import arrays
from ..mesh.errors import Refused

HANDLE_SIZE = 0.25  # of a handle by default: its radius, by the square root of the part's area
SAME_PLACE = 1e-4  # mirrored vertices are so near to each other, by the mesh's size
ACROSS = np.float32([-1, 1, 1])


class Region:
    """The part of a mesh that these faces make, and what is around it, ready to be deformed.

    Coincident vertices of the shape being edited are welded (partwheel.weld): old_to_new (V,) the vertex that each of the
    mesh's counts as.

    vertices (n,) of the welded mesh: the part's and those of the faces around it; rest (n,3) where they are, triangles
    (t,3) indices into these two. free (n,) bool: inside the part; its border and all beyond stay, and so does what is hidden.
    rings: so many rings of faces around the part deform with it. mirror: the same happens across the x axis. center
    (3,) and size: of the part.

    With reach the part is one that turns at its joint (partwheel.joint): what lies within so many radii of its border,
    on either side, is free as well; limb are the region's vertices of the rest of it; center is the joint's.

    moving (m,): the vertices of the mesh that may move, mirrored and coincident ones included, before (m,3) where they
    are. Of the polygons that have such a vertex: flat_faces, those shaded flat; polygons, whether one is no triangle.
    Not welded, for shading: shaded (k,) vertices of the mesh, of shaded_triangles (t,3); smooth (k,) bool: those of
    polygons that change and are shaded smooth; of_shaded (k,) the region's vertex that each is.
    """

    def __init__(self, obj, faces, rings=0, mirror=False, reach=None):
        """Raises Refused."""
        surface = arrays.read_surface(arrays.update_mesh(obj))
        mesh, points = obj.data, arrays.read_edited_positions(obj)
        count = len(points)
        self.old_to_new, welded = weld_surface(points, surface.triangles)
        inside = arrays.make_mask(surface.face_count, faces)
        for _ in range(rings):
            reached = arrays.make_mask(count, welded[inside[surface.faces]])
            inside[surface.faces[reached[welded].any(axis=1)]] = True
        within = inside[surface.faces]
        member, border = (arrays.make_mask(count, welded[side]) for side in (within, ~within))
        free, limb = member & ~border, np.zeros(count, bool)
        hinge = None if reach is None else find_joint(points.astype(np.float64), welded, within)
        if hinge and free.any():
            roles = hinge.roles(reach)
            free, limb = roles != FIXED, roles == 0
            member = free
        free &= arrays.make_mask(count, self.old_to_new[~arrays.read(mesh.vertices, "hide", bool)])
        near = member[welded].any(axis=1)
        self.vertices, triangles = np.unique(welded[near], return_inverse=True)
        self.triangles = triangles.reshape(-1, 3).astype(np.int32)
        self.rest = points[self.vertices].astype(np.float64)
        self.free = free[self.vertices]
        self.limb = np.flatnonzero((limb & free)[self.vertices])
        self.center = hinge.center if hinge else self.rest[self.free].mean(axis=0) if self.free.any() else np.zeros(3)
        corners = points[surface.triangles[within]].astype(np.float64)
        self.size = np.sqrt(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                                           axis=1).sum() / 2)
        if not self.free.any():
            raise Refused("The part has no vertex inside its border that is not hidden: pick a larger one.")
        if self.free.all():
            raise Refused("The part is the whole mesh, or a loose piece of it, without a border that would hold it: "
                          "pick a smaller one, or move it as it is.")
        if not self.size > 0:
            raise Refused("The faces of the part have no area: there is nothing to deform.")
        self._away = None, None
        self.partner, self._sources, images = None, np.empty(0, int), np.empty(0, int)
        if mirror:
            self.partner, self._sources, images = self._partners(points)
        own, self._moved = self._with_coincident(np.flatnonzero(self.free), self.vertices[self.free])
        images, self._sources = self._with_coincident(self._sources, images)
        self.moving = np.concatenate([own, images])
        self.before = points[self.moving]
        moves = arrays.make_mask(count, self.moving)
        changes = arrays.make_mask(len(inside), surface.faces[moves[surface.triangles].any(axis=1)])
        shaded_smooth = arrays.read(mesh.polygons, "use_smooth", bool)
        self.flat_faces = np.flatnonzero(changes & ~shaded_smooth)
        smooth = surface.triangles[(changes & shaded_smooth)[surface.faces]]
        self.shaded, triangles = np.unique(surface.triangles[near], return_inverse=True)
        self.shaded_triangles = triangles.reshape(-1, 3).astype(np.int32)
        self.smooth = arrays.make_mask(count, smooth)[self.shaded]
        self.of_shaded = np.searchsorted(self.vertices, self.old_to_new[self.shaded])
        self.polygons = bool((arrays.read_polygon_sizes(mesh)[1][changes] > 3).any())

    def _partners(self, points):
        """(partner (n,): of each vertex the one of the region across the x axis, -1 where there is none; the region's
        vertices whose partner is outside of it; those partners in the mesh)."""
        tree = KDTree(len(points))
        for index, point in enumerate(points.tolist()):
            tree.insert(point, index)
        tree.balance()
        limit = SAME_PLACE * float(np.ptp(points, axis=0).max())
        here = {vertex: index for index, vertex in enumerate(self.vertices.tolist())}
        partner, ours, theirs = np.full(len(self.vertices), -1), [], []
        for index in np.flatnonzero(self.free).tolist():
            x, y, z = self.rest[index]
            _, vertex, distance = tree.find((-x, y, z))
            if distance > limit:
                continue
            vertex = int(self.old_to_new[vertex])
            other = here.get(vertex, -1)
            if other >= 0 and self.free[other]:
                partner[index] = other
            else:
                ours.append(index)
                theirs.append(vertex)
        return partner, np.array(ours, int), np.array(theirs, int)

    def _with_coincident(self, indices, vertices):
        """(the mesh's vertices that are welded to vertices (n,), the one of indices (n,) for each)"""
        order = np.argsort(self.old_to_new, kind="stable")
        first, last = (np.searchsorted(self.old_to_new[order], vertices, side) for side in ("left", "right"))
        many = last - first
        begin = np.cumsum(many) - many
        return order[np.arange(many.sum()) + np.repeat(first - begin, many)], np.repeat(indices, many)

    def indices(self, vertices):
        """(k,) the region's indices of vertices (k,) of the mesh; -1 of those that it doesn't have."""
        vertices = np.asarray(vertices, np.int64)
        known = (vertices >= 0) & (vertices < len(self.old_to_new))
        vertices = self.old_to_new[np.where(known, vertices, 0)]
        at = np.minimum(np.searchsorted(self.vertices, vertices), len(self.vertices) - 1)
        return np.where(known & (self.vertices[at] == vertices), at, -1)

    def nearest_free(self, vertex):
        """The region's index of a vertex of the mesh; of the free one nearest to it if it is not free itself."""
        at = int(self.indices([vertex])[0])
        if at < 0:
            raise Refused("That is not a point of the part.")
        if self.free[at]:
            return at
        distance = np.linalg.norm(self.rest - self.rest[at], axis=1)
        return int(np.where(self.free, distance, np.inf).argmin())

    def patch(self, index, radius):
        """The region's indices of the free vertices within a radius along the surface, at least the one itself."""
        return np.flatnonzero(self.free & (self._away_from(index) <= radius))

    def usual_radius(self, index):
        """Of a handle at this vertex: a share of the part's size, but its neighbours belong to it at least, for a point
        alone draws out a thorn; and a quarter of the free vertices at most."""
        around = np.unique(self.triangles[(self.triangles == index).any(axis=1)])
        distance = self._away_from(index)
        nearer = np.sort(distance[self.free])
        return float(min(max(HANDLE_SIZE * self.size, 1.01 * distance[around].max()), nearer[len(nearer) // 4]))

    def _away_from(self, index):
        """(n,) along the surface. The last is kept: 0.1 s for 100,000 vertices."""
        if self._away[0] != index:
            self._away = index, surface_distances(self.rest, self.triangles, [index])
        return self._away[1]

    def targets(self, points):
        """(m,3) float32: where the vertices that move go if the region deformed to points (n,3)."""
        points = points.astype(np.float32)
        if self.partner is not None:
            both = np.flatnonzero(self.partner >= 0)
            points[both] = (points[both] + points[self.partner[both]] * ACROSS) / 2
        return np.concatenate([points[self._moved], points[self._sources] * ACROSS])
