# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a mesh object that deforms: what is free and what holds it, its handles, and the way back into the mesh.

Coordinates are those of the shape being edited: the active shape key's, where there is one. But for a Pen, no reference
to Blender's data is kept, so undo or a mode change can't make it dangle; the object is handed to every function.
"""

import struct
from collections import deque
from functools import cached_property
from itertools import repeat

import bmesh
import numpy as np
from mathutils.kdtree import KDTree

from ..mesh import arrays
from ..mesh.refusing import Refused
from partwheel.deform import (
    FIXED, FREE, SETTLED, STEP_ANGLE, Deformation, part_of_the_way, rigid_motion, rotation_angle, surface_distances,
    vertex_normals,
)
from partwheel.joint import groups, joint

HANDLE_SIZE = 0.25  # of a handle by default: its radius, by the square root of the part's area
SAME_PLACE = 1e-4  # mirrored vertices are so near to each other, by the mesh's size
AT_ONCE, MOST_AT_ONCE = 30_000, 5  # iterations at a mouse move: so many vertices' in all; but no more than so many
TURN = np.radians(30)  # a handle that turns by more at once, as by a typed number, goes there in steps
BESIDE = 16  # at least so many vertices of the surface say where a loose piece near them goes
WAYS = 32  # matrices between rest and the handle's that a proportional deformation mixes
MIRROR, ACROSS = np.diag([-1.0, 1, 1, 1]), np.float32([-1, 1, 1])


# ---- The way into the mesh


class Pen:
    """Puts the vertices of a region that move to new places, as often as the mouse moves.

    In Edit Mode it holds on to Blender's own vertices, so that it is for one tool's run alone: while the mesh keeps its
    elements. (Blender's error is a ReferenceError.)
    """

    def __init__(self, obj, region):
        self.region, self._bm = region, None
        if obj.mode != "EDIT":
            return
        self._bm = bm = bmesh.from_edit_mesh(obj.data)
        bm.verts.ensure_lookup_table()
        bm.faces.ensure_lookup_table()
        self._verts = list(map(bm.verts.__getitem__, region.moving.tolist()))
        self._flat = list(map(bm.faces.__getitem__, region.flat_faces.tolist()))
        self._smooth = list(map(bm.verts.__getitem__, region.vertices[region.smooth].tolist()))

    def draft(self, obj, points):
        """The region deformed to points (n,3), with the normals that are seen, for as long as the mouse moves. Blender
        finds all of them in 1 to 3 us a vertex; in loops of Python's own this takes less than half of one."""
        if self._bm is None:
            self.write(obj, points)
            return
        _set_all(self._verts, "co", self.region.targets(points))
        deque(map(bmesh.types.BMFace.normal_update, self._flat), 0)
        if self._smooth:
            _set_all(self._smooth, "normal", vertex_normals(points, self.region.triangles)[self.region.smooth])
        bmesh.update_edit_mesh(obj.data, loop_triangles=self.region.polygons, destructive=False)

    def write(self, obj, points):
        """The region deformed to points (n,3)."""
        self._put(obj, self.region.targets(points))

    def restore(self, obj):
        """Everything to where it was when the region was made, bit for bit."""
        self._put(obj, self.region.before)

    def _put(self, obj, points):
        if self._bm is None:
            self._put_mesh(obj, points)
            return
        _set_all(self._verts, "co", points)
        self._bm.normal_update()
        bmesh.update_edit_mesh(obj.data, loop_triangles=True, destructive=False)

    def _put_mesh(self, obj, points):
        mesh, key = obj.data, obj.active_shape_key
        basis = mesh.shape_keys and mesh.shape_keys.reference_key
        for collection in ([key.data] if key else []) + ([mesh.vertices] if key in {None, basis} else []):
            all_points = arrays.read(collection, "co", np.float32, 3)
            all_points[self.region.moving] = points
            collection.foreach_set("co", all_points.ravel())
        mesh.update()


def _set_all(elements, attribute, values):
    """The same attribute of elements of a bmesh: values (n,3)."""
    each = struct.iter_unpack("3f", np.ascontiguousarray(values, np.float32))
    deque(map(setattr, elements, repeat(attribute), each), 0)


# ---- The part


class Region:
    """The part of a mesh that these faces make, and what is around it, ready to be deformed.

    vertices (n,) of the mesh: the part's and those of the faces around it; rest (n,3) where they are, triangles (t,3)
    indices into these two. free (n,) bool: inside the part; its border and all beyond stay, and so does what is hidden.
    rings: so many rings of faces around the part deform with it. mirror: the same happens across the x axis. center
    (3,) and size: of the part.

    With reach the part is one that turns at its joint (partwheel.joint): what lies within so many radii of its border, on
    either side, is free as well; limb are the region's vertices of the rest of it; center is the joint's.

    moving (m,): the vertices of the mesh that may move, mirrored ones included, before (m,3) where they are. Of the
    polygons that have such a vertex: flat_faces, those shaded flat; smooth (n,) bool, vertices of the others; polygons,
    whether one is no triangle.
    """

    def __init__(self, obj, faces, rings=0, mirror=False, reach=None):
        """Raises Refused."""
        surface = arrays.surface(arrays.up_to_date(obj))
        mesh, points = obj.data, arrays.edited_positions(obj)
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
        free, limb = member & ~border, np.zeros(count, bool)
        hinge = None if reach is None else joint(points.astype(np.float64), surface.triangles, within)
        if hinge and free.any():
            roles = hinge.roles(reach)
            free, limb = roles != FIXED, roles == 0
            member = free
        free &= ~arrays.read(mesh.vertices, "hide", bool)
        near = member[surface.triangles].any(axis=1)
        self.vertices, triangles = np.unique(surface.triangles[near], return_inverse=True)
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
        self.moving = np.concatenate([self.vertices[self.free], images])
        self.before = points[self.moving]
        moves, changes, smooth = np.zeros(count, bool), np.zeros(len(inside), bool), np.zeros(count, bool)
        moves[self.moving] = True
        changes[surface.faces[moves[surface.triangles].any(axis=1)]] = True
        shaded_smooth = arrays.read(mesh.polygons, "use_smooth", bool)
        self.flat_faces = np.flatnonzero(changes & ~shaded_smooth)
        smooth[surface.triangles[(changes & shaded_smooth)[surface.faces]]] = True
        self.smooth = smooth[self.vertices]
        self.polygons = bool((arrays.polygon_sizes(mesh)[1][changes] > 3).any())

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
            other = here.get(vertex, -1)
            if other >= 0 and self.free[other]:
                partner[index] = other
            else:
                ours.append(index)
                theirs.append(vertex)
        return partner, np.array(ours, int), np.array(theirs, int)

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
        return np.concatenate([points[self.free], points[self._sources] * ACROSS])


# ---- How it follows


class AsRigidAsPossible:
    """The region follows its handles, patches of its vertices, like a soft body: partwheel.deform.Deformation. Loose pieces in
    it (eyes, buttons) go with the surface next to them, each as a whole."""

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
        self._given = region.rest, region.triangles, roles
        self._at_once = min(max(AT_ONCE // len(roles), 1), MOST_AT_ONCE)
        self._energy, self._at = np.inf, [np.eye(4)] * self._count

    @cached_property
    def deformation(self):
        """Factorizing takes a second for 100,000 vertices: at the first use, in any thread. Raises PartwheelError."""
        return Deformation(*self._given)

    @cached_property
    def _pieces(self):
        """[(vertices of a loose piece, those of the surface that it goes with)]"""
        rest, triangles, roles = self._given
        loose = np.isinf(surface_distances(rest, triangles, roles != FREE))
        within = triangles[loose[triangles[:, 0]]]
        if not len(within):
            return []
        group = groups(within[:, [[0, 1], [1, 2]]].reshape(-1, 2))[::2]
        ends = np.flatnonzero(~loose & (roles != FIXED))
        pieces = []
        for number in range(group.max() + 1):
            piece = np.unique(within[group == number])
            middle = rest[piece].mean(axis=0)
            away = np.linalg.norm(rest[ends] - middle, axis=1)
            near = away <= away.min() + np.linalg.norm(rest[piece] - middle, axis=1).max()
            pieces.append((piece, ends[np.argsort(away, kind="stable")[:max(BESIDE, near.sum())]]))
        return pieces

    def _all(self, matrices):
        return [*matrices, *(MIRROR @ matrices[handle] @ MIRROR for handle in self._twins)]

    def follow(self, matrices):
        """The handles go to their matrices, (4,4) each, and the region most of the way: as much as a mouse move has
        time for."""
        steps = [_step(before, matrix) for before, matrix in zip(self._at, matrices)]
        turn = max((rotation_angle(step[:3, :3]) for step in steps if step is not None), default=0)
        count = 1 if turn < TURN else int(np.ceil(turn / STEP_ANGLE))
        for at in range(1, count + 1):
            between = matrices if at == count else [
                matrix if step is None else part_of_the_way(step, at / count) @ before
                for before, step, matrix in zip(self._at, steps, matrices)]
            for handle, matrix in enumerate(self._all(between)):
                self.deformation.move(handle, matrix)
            self.deformation.iterate(self._at_once)
        self._energy, self._at = np.inf, matrices

    def go_on(self):
        """A little further towards the shape of rest. Whether there is more to do."""
        self.deformation.iterate(self._at_once)
        before, self._energy = self._energy, self.deformation.energy()
        return before - self._energy > SETTLED * self._at_once * before

    def settle(self, stop=None):
        """All the way to the shape of rest, unless the threading.Event stop is set meanwhile."""
        self.deformation.settle(stop=stop)

    def jump(self, matrices, stop=None):
        """All the way at once, from rest."""
        if all((matrix == np.eye(4)).all() for matrix in matrices):
            self.deformation.reset()  # no rounding either
        else:
            self.deformation.move_at_once(self._all(matrices), stop)
        self._pieces  # found while nobody waits
        self._energy, self._at = np.inf, matrices

    def points(self):
        points, rest = self.deformation.positions(), self._given[0]
        for piece, beside in self._pieces:
            turn, shift = rigid_motion(rest[beside], points[beside])
            points[piece] = rest[piece] @ turn.T + shift
        return points


def _step(before, after):
    """What leads from one matrix to another; None if there is no way back from the first, or nowhere to go."""
    if not np.linalg.cond(before) < 1e12:
        return None
    step = after @ np.linalg.inv(before)
    return step if np.isfinite(step).all() else None


class AtJoint(AsRigidAsPossible):
    """A limb keeps its shape and turns, moves or grows as a whole; what is near its border bends, as rigidly as
    possible."""

    def __init__(self, region, _patches=()):
        if not len(region.limb):
            raise Refused("No part of this limb is beyond its joint and not hidden: make the joint smaller.")
        super().__init__(region, [region.limb])


class Proportional:
    """The region follows one matrix, less and less towards its border: by the distance from it along the surface."""

    def __init__(self, region, _patches=()):
        distance = surface_distances(region.rest, region.triangles, ~region.free)
        farthest = distance[np.isfinite(distance)].max()
        share = np.minimum(distance / farthest, 1) if farthest > 0 else region.free.astype(float)
        self.weight = share * share * (3 - 2 * share)  # Blender's "smooth" falloff
        self._rest = self._now = region.rest

    def follow(self, matrices):
        ways = np.array([part_of_the_way(np.asarray(matrices[0], float), way / WAYS) for way in range(WAYS + 1)])
        below = np.minimum((self.weight * WAYS).astype(int), WAYS - 1)
        rest = (self.weight * WAYS - below)[:, None, None]
        matrix = (1 - rest) * ways[below] + rest * ways[below + 1]
        now = np.einsum("nij,nj->ni", matrix[:, :3, :3], self._rest) + matrix[:, :3, 3]
        self._now = np.where(self.weight[:, None] > 0, now, self._rest)

    def jump(self, matrices, _stop=None):
        self.follow(matrices)

    def go_on(self):
        return False

    def settle(self, _stop=None):
        pass

    def points(self):
        return self._now


METHODS = {"RIGID": AsRigidAsPossible, "PROPORTIONAL": Proportional, "JOINT": AtJoint}
