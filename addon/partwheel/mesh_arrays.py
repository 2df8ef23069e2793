# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender mesh as numpy arrays: the cage as it is, without modifiers, in its object's own space. Only reads."""

import hashlib
from typing import NamedTuple

import numpy as np


class Surface(NamedTuple):
    """What Hierarchy.build() takes: vertices (V,3), triangles (T,3), faces (T,) the polygon of each triangle."""

    vertices: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    face_count: int


def up_to_date(obj):
    """The object's mesh; in Edit Mode after Blender wrote the edits back into it. Same order of elements in both."""
    if obj.mode == "EDIT":
        obj.update_from_editmode()
    return obj.data


def read(collection, attribute, dtype, width=1):
    """One attribute of all elements: (n,) or (n, width)."""
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(attribute, values)
    return values if width == 1 else values.reshape(-1, width)


def surface(mesh):
    """The mesh's surface as Blender itself triangulates it."""
    mesh.calc_loop_triangles()
    return Surface(
        read(mesh.vertices, "co", np.float32, 3).astype(np.float64),
        read(mesh.loop_triangles, "vertices", np.int32, 3),
        read(mesh.loop_triangles, "polygon_index", np.int32),
        len(mesh.polygons),
    )


def topology(mesh):
    """A digest of which polygons use which vertices; moving vertices does not change it."""
    digest = hashlib.blake2b(np.int64(len(mesh.vertices)).tobytes(), digest_size=16)
    digest.update(read(mesh.polygons, "loop_total", np.int32))
    digest.update(read(mesh.loops, "vertex_index", np.int32))
    return digest.digest()
