# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a deformed region into its mesh, and restores it."""

import struct
from collections import deque
from itertools import repeat

import bmesh
import bpy
import numpy as np

from partwheel.deform import vertex_normals
from ..mesh import arrays
from .region import Region


class VertexWriter:
    """Writes the vertices of a region that move, as often as the mouse moves.

    In Edit Mode it keeps references to Blender's vertices, so it is valid during one run of a tool, while the mesh
    keeps its elements (else Blender raises a ReferenceError)."""

    def __init__(self, obj: bpy.types.Object, region: Region) -> None:
        self.region, self._bm = region, None
        if obj.mode != "EDIT":
            return
        self._bm = bm = bmesh.from_edit_mesh(obj.data)
        bm.verts.ensure_lookup_table()
        bm.faces.ensure_lookup_table()
        self._verts = list(map(bm.verts.__getitem__, region.moving.tolist()))
        self._flat_faces = list(map(bm.faces.__getitem__, region.flat_faces.tolist()))
        self._smooth_verts = list(map(bm.verts.__getitem__, region.shaded[region.smooth].tolist()))

    def write_draft(self, obj: bpy.types.Object, points: np.ndarray) -> None:
        """Writes the region's points (n, 3), with the normals that are drawn, while the mouse moves. Blender needs 1
        to 3 us per vertex for all normals; these loops need less than half of one."""
        if self._bm is None:
            self.write(obj, points)
            return
        _set_attribute(self._verts, "co", self.region.targets(points))
        deque(map(bmesh.types.BMFace.normal_update, self._flat_faces), 0)
        if self._smooth_verts:
            normals = vertex_normals(points[self.region.of_shaded], self.region.shaded_triangles)
            _set_attribute(self._smooth_verts, "normal", normals[self.region.smooth])
        bmesh.update_edit_mesh(obj.data, loop_triangles=self.region.polygons, destructive=False)

    def write(self, obj: bpy.types.Object, points: np.ndarray) -> None:
        self._write_moving(obj, self.region.targets(points))

    def restore(self, obj: bpy.types.Object) -> None:
        """Restores the vertices bit for bit, as they were when the region was created."""
        self._write_moving(obj, self.region.before)

    def _write_moving(self, obj: bpy.types.Object, points: np.ndarray) -> None:
        """Writes the positions (m, 3) of the vertices that may move."""
        if self._bm is not None:
            _set_attribute(self._verts, "co", points)
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


def _set_attribute(elements: list, attribute: str, values: np.ndarray) -> None:
    """Sets a vector attribute of bmesh elements to values (n, 3)."""
    rows = struct.iter_unpack("3f", np.ascontiguousarray(values, np.float32))
    deque(map(setattr, elements, repeat(attribute), rows), 0)


def restore_regions(obj: bpy.types.Object, regions: list[Region]) -> None:
    """Restores the mesh to before the first of these regions, created one after the other."""
    for region in reversed(regions):
        VertexWriter(obj, region).restore(obj)
