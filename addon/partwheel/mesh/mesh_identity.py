# SPDX-License-Identifier: GPL-3.0-or-later
"""What is remembered of meshes and objects. No pointer into Blender's data is: undo and file loading would make it
dangle. So it is under a key; tables of it are emptied when another file is opened, and when the add-on ends. Objects
are held by name, the one in full, for a linked and a local one may have the same."""

import bmesh
import bpy


class MeshTable(dict):
    """Something of each mesh, by key(mesh)."""

    tables = []  # all that there are

    def __init__(self, gone=dict.pop):
        """gone(table, key): what drop_gone() does with what it finds, if it isn't to be forgotten."""
        self._gone = gone
        MeshTable.tables.append(self)

    def drop_gone(self):
        """Nothing of meshes that are no more is kept."""
        for gone in self.keys() - {mesh_key(mesh) for mesh in bpy.data.meshes}:
            self._gone(self, gone)


def mesh_key(mesh):
    """A mesh's identity that outlives undo. Before Blender 4.1 its full name: renaming it means building again."""
    return getattr(mesh, "session_uid", None) or mesh.name_full


def element_counts(mesh):
    """(vertices, polygons), at once, also in Edit Mode: when these are others, the mesh is another one."""
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        return len(bm.verts), len(bm.faces)
    return len(mesh.vertices), len(mesh.polygons)


def find_object(name_full):
    """The object that is named so, or None."""
    found = bpy.data.objects.get(name_full)  # any linked one too
    if found is None or found.name_full != name_full:
        found = next((obj for obj in bpy.data.objects if obj.name_full == name_full), None)
    return found


def resolve_object(name):
    """The one that a user or a script names, in full or, where that is none, without its library."""
    return find_object(name) or bpy.data.objects.get(name)
