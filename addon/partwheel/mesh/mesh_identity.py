# SPDX-License-Identifier: GPL-3.0-or-later
"""Identities of meshes and objects that stay valid across undo and file loading, where pointers into Blender's data
dangle.

Objects are stored by their full name, because a linked and a local object may share the short one.
"""

import bmesh
import bpy


def mesh_key(mesh: bpy.types.Mesh) -> int | str:
    """Return the mesh's identity, which outlives undo: its session UID, or before Blender 4.1 its full name. There a
    renamed mesh must be built again."""
    return getattr(mesh, "session_uid", None) or mesh.name_full


def element_counts(mesh: bpy.types.Mesh) -> tuple[int, int]:
    """Return (vertex count, polygon count) in constant time, also in Edit Mode. Different counts mean a changed
    mesh."""
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        return len(bm.verts), len(bm.faces)
    return len(mesh.vertices), len(mesh.polygons)


def find_object(name_full: str) -> bpy.types.Object | None:
    """Return the object with this full name, or None."""
    obj = bpy.data.objects.get(name_full)  # a linked object may match, too
    if obj is None or obj.name_full != name_full:
        obj = next((other for other in bpy.data.objects if other.name_full == name_full), None)
    return obj


def resolve_object(name: str) -> bpy.types.Object | None:
    """Return the object that a user or a script names: by full name, or else by its name without the library."""
    return find_object(name) or bpy.data.objects.get(name)
