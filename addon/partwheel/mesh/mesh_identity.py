# SPDX-License-Identifier: GPL-3.0-or-later
"""Identities of meshes and objects that stay valid across undo and file loading, where pointers into Blender's data
dangle.

A MeshTable is emptied when another file is opened and when the add-on ends. Objects are stored by their full name,
because a linked and a local object may share the short one.
"""

from __future__ import annotations

from collections.abc import Callable

import bmesh
import bpy


class MeshTable(dict):
    """One value per mesh, by mesh_key(mesh)."""

    tables: list[MeshTable] = []  # every table, so that all can be cleared

    def __init__(self, on_removal: Callable[[MeshTable, int | str], object] = dict.pop) -> None:
        """on_removal(table, key): what remove_deleted() does with the value of a deleted mesh; by default removes
        it."""
        self._on_removal = on_removal
        MeshTable.tables.append(self)

    def remove_deleted(self) -> None:
        """Call on_removal for each mesh that no longer exists."""
        for deleted in self.keys() - {mesh_key(mesh) for mesh in bpy.data.meshes}:
            self._on_removal(self, deleted)


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
