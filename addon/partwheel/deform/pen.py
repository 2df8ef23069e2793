# SPDX-License-Identifier: GPL-3.0-or-later
"""The way of a deformed region into its mesh, and back to what it was."""

import struct
from collections import deque
from itertools import repeat

import bmesh
import numpy as np

from partwheel.deform import vertex_normals
from ..mesh import arrays


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
        self._smooth = list(map(bm.verts.__getitem__, region.shaded[region.smooth].tolist()))

    def draft(self, obj, points):
        """The region deformed to points (n,3), with the normals that are seen, for as long as the mouse moves. Blender
        finds all of them in 1 to 3 us a vertex; in loops of Python's own this takes less than half of one."""
        if self._bm is None:
            self.write(obj, points)
            return
        _set_all(self._verts, "co", self.region.targets(points))
        deque(map(bmesh.types.BMFace.normal_update, self._flat), 0)
        if self._smooth:
            normals = vertex_normals(points[self.region.of_shaded], self.region.shaded_triangles)
            _set_all(self._smooth, "normal", normals[self.region.smooth])
        bmesh.update_edit_mesh(obj.data, loop_triangles=self.region.polygons, destructive=False)

    def write(self, obj, points):
        """The region deformed to points (n,3)."""
        self._put(obj, self.region.targets(points))

    def restore(self, obj):
        """Everything to where it was when the region was made, bit for bit."""
        self._put(obj, self.region.before)

    def _put(self, obj, points):
        if self._bm is not None:
            _set_all(self._verts, "co", points)
            self._bm.normal_update()
            bmesh.update_edit_mesh(obj.data, loop_triangles=True, destructive=False)
            return
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


def restore(obj, regions):
    """Puts the mesh back to before the first of these, made one after the other."""
    for region in reversed(regions):
        Pen(obj, region).restore(obj)
