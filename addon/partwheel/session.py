# SPDX-License-Identifier: GPL-3.0-or-later
"""Which mesh has which hierarchy, for as long as Blender runs, and when one no longer fits its mesh.

A hierarchy belongs to a topology: polygons and their vertices. Moving vertices keeps it; any other edit makes it stale,
and a stale one is never used. No pointer into Blender's data is kept: undo and file loading would make it dangle.
"""

from typing import NamedTuple

import bpy

from . import mesh_arrays
from .core import Hierarchy

_entries = {}


class Entry(NamedTuple):
    topology: bytes
    counts: tuple  # of vertices and polygons: enough to draw the panel by
    hierarchy: Hierarchy


def _key(mesh):
    """A mesh's identity that outlives undo. Before Blender 4.1 its full name: renaming it means building again."""
    return getattr(mesh, "session_uid", None) or mesh.name_full


def hierarchy(obj):
    """The hierarchy of the object's mesh, or None if there is none for its present topology."""
    entry = _entries.get(_key(obj.data))
    if entry and entry.topology != mesh_arrays.topology(mesh_arrays.up_to_date(obj)):
        del _entries[_key(obj.data)]
        return None
    return entry and entry.hierarchy


def build(obj, quality=0.0, progress=None):
    """Builds and keeps the hierarchy of the object's mesh, see Hierarchy.build. The mesh is not changed."""
    mesh = mesh_arrays.up_to_date(obj)
    surface = mesh_arrays.surface(mesh)
    built = Hierarchy.build(*surface, quality=quality, progress=progress)
    alive = {_key(other) for other in bpy.data.meshes}
    for gone in _entries.keys() - alive:
        del _entries[gone]
    counts = len(mesh.vertices), len(mesh.polygons)
    _entries[_key(mesh)] = Entry(mesh_arrays.topology(mesh), counts, built)
    return built


def peek(obj):
    """For the panel, which draws often: (hierarchy or None, whether it still fits as far as the counts tell)."""
    entry = _entries.get(_key(obj.data))
    if not entry:
        return None, False
    mesh = obj.data
    return entry.hierarchy, obj.mode == "EDIT" or entry.counts == (len(mesh.vertices), len(mesh.polygons))


@bpy.app.handlers.persistent
def _forget(*_):
    """Another file was opened: its meshes are others."""
    _entries.clear()


def register():
    bpy.app.handlers.load_post.append(_forget)


def unregister():
    bpy.app.handlers.load_post.remove(_forget)
    _entries.clear()
