# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a mesh object that deforms: what is free and what holds it, its handles, and the way back into the mesh.

Coordinates are those of the shape being edited: the active shape key's, where there is one. No reference to Blender's
data is kept, so undo or a mode change can't make it dangle; the object is handed to every function.
"""

import bmesh
import numpy as np
from mathutils.kdtree import KDTree

from . import mesh_arrays
from .core.deform import FIXED, FREE, Deformation, part_of_the_way, surface_distances

HANDLE_SIZE = 0.25  # of a handle by default: its radius, by the square root of the part's area
SAME_PLACE = 1e-4  # mirrored vertices are so near to each other, by the mesh's size
WAYS = 32  # matrices between rest and the handle's that a proportional deformation mixes
MIRROR = np.diag([-1.0, 1, 1, 1])


class Refused(ValueError):
    """This part, or this handle, can't be deformed. str() is a sentence for the user."""


# ---- The object's coordinates


def coordinates(obj):
    """(V,3) float32, in the object's own space."""
    mesh = mesh_arrays.up_to_date(obj)
    key = obj.active_shape_key
    return mesh_arrays.read(key.data if key else mesh.vertices, "co", np.float32, 3)


def write(obj, vertices, points):
    """Puts these vertices (n,) of the shape being edited to these points (n,3)."""
    mesh = obj.data
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(mesh)
        bm.verts.ensure_lookup_table()
        verts = bm.verts
        for index, point in zip(vertices.tolist(), points.tolist()):
            verts[index].co = point
        bm.normal_update()
        bmesh.update_edit_mesh(mesh, loop_triangles=True, destructive=False)
        return
    key = obj.active_shape_key
    for collection in ([key.data] if key else []) + ([mesh.vertices] if key in {None, _basis(mesh)} else []):
        all_points = mesh_arrays.read(collection, "co", np.float32, 3)
        all_points[vertices] = points
        collection.foreach_set("co", all_points.ravel())
    mesh.update()


def _basis(mesh):
    return mesh.shape_keys and mesh.shape_keys.reference_key


# ---- The part


class Region:
    """The part of a mesh that these faces make, and what is around it, ready to be deformed.

    vertices (n,) of the mesh: the part's and those of the faces around it; rest (n,3) where they are, triangles (t,3)
    indices into these two. free (n,) bool: inside the part; its border and all beyond stay, and so does what is hidden.
    rings: so many rings of faces around the part deform with it. mirror: the same happens across the x axis.
    """

    def __init__(self, obj, faces, rings=0, mirror=False):
        """Raises Refused."""
        surface = mesh_arrays.surface(mesh_arrays.up_to_date(obj))
        mesh, points = obj.data, coordinates(obj)
        count = len(points)
        inside = np.zeros(surface.face_count, bool)
        inside[faces] = True
        for _ in range(rings):
            reached = np.zeros(count, bool)
            reached[surface.triangles[inside[surface.faces]]] = True
            inside[surface.faces[reached[surface.triangles].any(axis=1)]] = True
        within = inside[surface.faces]
        member, border = np.zeros(count, bool), np.zeros(count, bool)
        member[surface.triangles[within]] = True
        border[surface.triangles[~within]] = True
        free = member & ~border & ~mesh_arrays.read(mesh.vertices, "hide", bool)
        near = member[surface.triangles].any(axis=1)
        self.vertices, triangles = np.unique(surface.triangles[near], return_inverse=True)
        self.triangles = triangles.reshape(-1, 3).astype(np.int32)
        self.before = points[self.vertices]
        self.rest = self.before.astype(np.float64)
        self.free = free[self.vertices]
        self.center = self.rest[self.free].mean(axis=0) if self.free.any() else np.zeros(3)
        corners = points[surface.triangles[within]].astype(np.float64)
        self.size = np.sqrt(np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                                           axis=1).sum() / 2)
        if not self.free.any():
            raise Refused("The part has no vertex inside its border that is not hidden: pick a larger one.")
        if self.free.all():
            raise Refused("The part is the whole mesh, so nothing would hold it: pick a smaller one, or move the "
                          "object.")
        if not self.size > 0:
            raise Refused("The faces of the part have no area: there is nothing to deform.")
        self._find_partners(points) if mirror else self._no_partners()

    def _no_partners(self):
        self.mirrored = self.partner = None

    def _find_partners(self, points):
        """partner (n,): of each vertex the one of the region across the x axis, -1 where there is none; mirrored:
        (the region's vertices whose partner is outside of it, those partners in the mesh)."""
        tree = KDTree(len(points))
        for index, point in enumerate(points.tolist()):
            tree.insert(point, index)
        tree.balance()
        limit = SAME_PLACE * float(np.ptp(points, axis=0).max())
        here = {vertex: index for index, vertex in enumerate(self.vertices.tolist())}
        self.partner, ours, theirs = np.full(len(self.vertices), -1), [], []
        for index in np.flatnonzero(self.free).tolist():
            x, y, z = self.rest[index]
            _, vertex, distance = tree.find((-x, y, z))
            if distance > limit:
                continue
            other = here.get(vertex, -1)
            if other >= 0 and self.free[other]:
                self.partner[index] = other
            else:
                ours.append(index)
                theirs.append(vertex)
        self.mirrored = np.array(ours, int), np.array(theirs, int)
        self.mirrored_before = points[self.mirrored[1]]

    def nearest_free(self, vertex):
        """The region's index of a vertex of the mesh; of the free one nearest to it if it is not free itself."""
        at = np.flatnonzero(self.vertices == vertex)
        if not len(at):
            raise Refused("That is not a point of the part.")
        if self.free[at[0]]:
            return int(at[0])
        distance = np.linalg.norm(self.rest - self.rest[at[0]], axis=1)
        return int(np.where(self.free, distance, np.inf).argmin())

    def patch(self, index, radius):
        """The region's indices of the free vertices within a radius along the surface, at least the one itself."""
        distance = surface_distances(self.rest, self.triangles, [index])
        return np.flatnonzero(self.free & (distance <= radius))

    def usual_radius(self, index):
        """Of a handle at this vertex: a share of the part's size, but its neighbours belong to it at least, for a point
        alone draws out a thorn; and a quarter of the free vertices at most."""
        around = np.unique(self.triangles[(self.triangles == index).any(axis=1)])
        distance = surface_distances(self.rest, self.triangles, [index])
        nearer = np.sort(distance[self.free])
        return float(min(max(HANDLE_SIZE * self.size, 1.01 * distance[around].max()), nearer[len(nearer) // 4]))

    def changed(self, points):
        """(vertices of the mesh, where they go) for what deformed to points (n,3), mirrored ones included."""
        points = points.astype(np.float32)
        if self.partner is not None:
            both = np.flatnonzero(self.partner >= 0)
            flipped = points[self.partner[both]] * np.float32([-1, 1, 1])
            points[both] = (points[both] + flipped) / 2
        vertices, targets = self.vertices[self.free], points[self.free]
        if self.mirrored is not None:
            ours, theirs = self.mirrored
            vertices = np.concatenate([vertices, theirs])
            targets = np.concatenate([targets, points[ours] * np.float32([-1, 1, 1])])
        return vertices, targets

    def restore(self, obj):
        """Everything to where it was when this was made, bit for bit."""
        vertices, points = self.vertices[self.free], self.before[self.free]
        if self.mirrored is not None:
            vertices = np.concatenate([vertices, self.mirrored[1]])
            points = np.concatenate([points, self.mirrored_before])
        write(obj, vertices, points)


# ---- How it follows


class AsRigidAsPossible:
    """The region follows its handles, patches of its vertices, like a soft body: core.deform.Deformation."""

    def __init__(self, region, patches):
        """patches: the region's vertices of each handle. Raises Refused or PartwheelError."""
        roles = np.where(region.free, FREE, FIXED)
        for handle, patch in enumerate(patches):
            roles[patch] = handle
        if not (roles == FREE).any():
            raise Refused("The handle is the whole part, so nothing is left to follow it: make the handle smaller.")
        self._count, self._twins = len(patches), []
        if region.partner is not None:  # each handle has one across the x axis, unless it lies in the middle
            for handle, patch in enumerate(patches):
                other = region.partner[patch]
                if (other >= 0).all() and (roles[other] == FREE).all():
                    roles[other] = self._count + len(self._twins)
                    self._twins.append(handle)
        if len(np.unique(roles[roles >= 0])) < self._count + len(self._twins):
            raise Refused("One handle covers another: make it smaller, or put it elsewhere.")
        self.deformation = Deformation(region.rest, region.triangles, roles)
        self._energy = np.inf

    def _all(self, matrices):
        return [*matrices, *(MIRROR @ matrices[handle] @ MIRROR for handle in self._twins)]

    def follow(self, matrices, iterations):
        """The handles go to their matrices, (4,4) each, and the region some of the way."""
        for handle, matrix in enumerate(self._all(matrices)):
            self.deformation.move(handle, matrix)
        self.deformation.iterate(iterations)
        self._energy = np.inf

    def settle(self, iterations, share=1e-3):
        """Goes on where the handles are. Whether there is more to do."""
        self.deformation.iterate(iterations)
        before, self._energy = self._energy, self.deformation.energy()
        return self._energy < (1 - share) * before

    def jump(self, matrices):
        """All the way at once."""
        self.deformation.move_at_once(self._all(matrices))

    def points(self):
        return self.deformation.positions()


class Proportional:
    """The region follows one matrix, less and less towards its border: by the distance from it along the surface."""

    def __init__(self, region, _patches=()):
        distance = surface_distances(region.rest, region.triangles, ~region.free)
        farthest = distance[np.isfinite(distance)].max()
        share = np.minimum(distance / farthest, 1) if farthest > 0 else region.free.astype(float)
        self.weight = share * share * (3 - 2 * share)  # Blender's "smooth" falloff
        self._rest = self._now = region.rest

    def follow(self, matrices, _iterations=0):
        ways = np.array([part_of_the_way(np.asarray(matrices[0], float), way / WAYS) for way in range(WAYS + 1)])
        below = np.minimum((self.weight * WAYS).astype(int), WAYS - 1)
        rest = (self.weight * WAYS - below)[:, None, None]
        matrix = (1 - rest) * ways[below] + rest * ways[below + 1]
        now = np.einsum("nij,nj->ni", matrix[:, :3, :3], self._rest) + matrix[:, :3, 3]
        self._now = np.where(self.weight[:, None] > 0, now, self._rest)

    jump = follow

    def settle(self, _iterations):
        return False

    def points(self):
        return self._now


METHODS = {"RIGID": AsRigidAsPossible, "PROPORTIONAL": Proportional}
