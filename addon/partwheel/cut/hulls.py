# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls as objects that engines take as a model's collision."""

import bpy
from mathutils import Matrix

from ..solid import composition


def made(obj, hulls):
    """[object, ...]: a child of the object for each partwheel.ConvexPart, UCX_<its name>_00 and so on, seen as wires and
    not rendered, in a new collection."""
    collection = bpy.data.collections.new(f"{obj.name} hulls")
    composition.home(obj).children.link(collection)
    found = []
    for number, hull in enumerate(hulls):
        mesh = bpy.data.meshes.new(f"UCX_{obj.name}_{number:02}")
        mesh.from_pydata(hull.vertices.tolist(), [], hull.triangles.tolist())
        new = bpy.data.objects.new(mesh.name, mesh)
        collection.objects.link(new)
        new.parent, new.matrix_parent_inverse = obj, Matrix()
        new.display_type, new.hide_render = "WIRE", True
        found.append(new)
    composition.update_matrices()
    return found
