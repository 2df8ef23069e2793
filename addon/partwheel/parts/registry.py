# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy of each mesh, and whether it still fits.

A hierarchy belongs to a topology: polygons and their vertices. Moving vertices keeps it usable, and the user may build
it anew. Any other edit makes it stale. A stale hierarchy is never used: every use compares fingerprints.
"""

from __future__ import annotations

import dataclasses
from enum import Enum, auto

import bpy
from bpy.app.handlers import persistent

from ..mesh import arrays
from ..mesh.arrays import Fingerprint
from ..mesh.mesh_identity import MeshTable, element_counts, mesh_key
from ..mesh.errors import Refused
from . import changes
from .stored import PendingLoad, take_property, pending, has_stored
from partwheel import Hierarchy


@dataclasses.dataclass
class HierarchyEntry:
    """The hierarchy of a mesh, and what it was built for."""

    built_for: Fingerprint  # of the mesh when it was built
    counts: tuple  # of vertices and polygons, when it was built
    hierarchy: Hierarchy
    packed: bytes = None  # for files; created when a file is first saved
    fingerprint: Fingerprint = None  # of the mesh when it was last checked
    revision: tuple = None  # changes.geometry_revision() at that time

    def record_fingerprint(self, mesh: bpy.types.Mesh, fingerprint: Fingerprint) -> None:
        """Store the mesh's current fingerprint and revision."""
        self.fingerprint, self.revision = fingerprint, changes.geometry_revision(mesh)


class State(Enum):
    """The relation of a mesh to its hierarchy."""

    NONE = auto()
    UNOPENED = auto()  # it came with the file; loaded, or refused, at its first use
    FITS = auto()
    MOVED = auto()  # usable, but vertices have moved since
    CHANGED = auto()  # not usable


USABLE = State.FITS, State.MOVED
# Attribute of meshes whose hierarchy the user has cleared. Undo removes it again, in Edit Mode too, where it restores
# nothing of a mesh but its elements and their attributes. Blender hides names that start with a period.
CLEARED_ATTRIBUTE = ".partwheel_cleared"
MAX_RETIRED = 3

_entries = MeshTable(on_removal=lambda entries, key: _retire(entries.pop(key)))
_unmatched = MeshTable()  # geometry_revision() at which no identical mesh was found
_retired = []  # entries of meshes that are gone or have changed, newest last, at most MAX_RETIRED


@arrays.use_snapshot()
def get_hierarchy(obj: bpy.types.Object) -> Hierarchy | None:
    """Return the hierarchy of the object's mesh, or None if there is none for its current topology."""
    mesh = arrays.update_mesh(obj)
    if is_cleared(mesh):
        return None
    entry = _entries.get(mesh_key(mesh))
    pending_load = None if entry else PendingLoad(mesh)
    fingerprint = arrays.current_fingerprint(obj)  # takes half as long as loading, which runs at the same time
    if not entry or entry.built_for.topology != fingerprint.topology:
        entry = _find_identical(fingerprint) or _load_stored(pending_load or PendingLoad(mesh), fingerprint) or entry
    if not entry:
        return None
    store(mesh, entry, fingerprint)
    return entry.hierarchy if entry.built_for.topology == fingerprint.topology else None


def require_hierarchy(obj: bpy.types.Object) -> Hierarchy:
    """Return the hierarchy of the object's mesh. Raises Refused if there is none."""
    hierarchy = get_hierarchy(obj)
    if not hierarchy:
        raise Refused("{name} has no parts for its current mesh. Find them first.", name=obj.name)
    return hierarchy


def _find_identical(fingerprint: Fingerprint) -> HierarchyEntry | None:
    """Return a new entry with the hierarchy of an identical mesh, or None: one that was duplicated, or one
    that undo has brought back.
    """
    entry = next((entry for entry in (*_entries.values(), *reversed(_retired)) if entry.built_for == fingerprint), None)
    return entry and dataclasses.replace(entry)


def _load_stored(pending_load: PendingLoad, fingerprint: Fingerprint) -> HierarchyEntry | None:
    """Return a new entry with the hierarchy from the file, or None."""
    stored = pending_load.result(fingerprint)
    return stored and HierarchyEntry(stored[0], element_counts(pending_load.mesh), stored[1], pending_load.packed)


def store(mesh: bpy.types.Mesh, entry: HierarchyEntry, fingerprint: Fingerprint) -> None:
    """Make entry the mesh's entry. fingerprint: the mesh's current one. An earlier entry of another topology retires.
    """
    before = _entries.get(mesh_key(mesh))
    if before and before.built_for.topology != entry.built_for.topology:
        _retire(before)
    _entries[mesh_key(mesh)] = entry
    entry.record_fingerprint(mesh, fingerprint)


def _retire(entry: HierarchyEntry) -> None:
    """Keep an entry whose mesh is gone or has changed; undo may bring the mesh back."""
    _retired[:] = [other for other in _retired if other.hierarchy is not entry.hierarchy] + [entry]
    del _retired[:-MAX_RETIRED]


def is_retired(hierarchy: Hierarchy) -> bool:
    """Return whether undo may bring this hierarchy back."""
    return any(entry.hierarchy is hierarchy for entry in _retired)


def forget(mesh: bpy.types.Mesh) -> None:
    """Drop the mesh's hierarchy, including one that came with the file."""
    _entries.pop(mesh_key(mesh), None)
    pending.pop(mesh_key(mesh), None)
    take_property(mesh)


def is_cleared(mesh: bpy.types.Mesh) -> bool:
    """Return whether the user has cleared the mesh's hierarchy."""
    return CLEARED_ATTRIBUTE in mesh.attributes


def clear(mesh: bpy.types.Mesh) -> None:
    """Drop the mesh's hierarchy until undo, or until another one is built. It isn't saved any more."""
    mesh.attributes.new(CLEARED_ATTRIBUTE, "BOOLEAN", "FACE")


def end_clearing(mesh: bpy.types.Mesh) -> None:
    """Make the mesh as if its hierarchy had not been cleared."""
    if is_cleared(mesh):
        mesh.attributes.remove(mesh.attributes[CLEARED_ATTRIBUTE])


def forget_all() -> None:
    """Drop the hierarchies of all meshes, and every other MeshTable."""
    for table in (*MeshTable.tables, _retired):
        table.clear()


@persistent
def _on_undo(*_: object) -> None:
    """Assume that a mesh that had changed fits again. Outside Edit Mode, get_state() checks it."""
    for entry in _entries.values():
        if entry.fingerprint.topology != entry.built_for.topology:
            entry.fingerprint, entry.revision = entry.built_for, None


HANDLERS = {"undo_post": _on_undo, "redo_post": _on_undo}


# ---- For panels and poll(), which Blender calls often: fast


def get_state(mesh: bpy.types.Mesh) -> tuple[State, HierarchyEntry | None]:
    """Return (State, entry or None) for panels and poll().

    In Edit Mode this goes by the element counts and the last use; otherwise it is exact.
    """
    if is_cleared(mesh):
        return State.NONE, None
    entry = _entries.get(mesh_key(mesh)) or _adopt_identical(mesh)
    if not entry:
        return (State.UNOPENED if has_stored(mesh) else State.NONE), None
    if mesh.is_editmode:
        if element_counts(mesh) != entry.counts:
            return State.CHANGED, entry
    elif entry.revision != changes.geometry_revision(mesh):
        entry.record_fingerprint(mesh, arrays.compute_fingerprint(mesh))
    if entry.fingerprint.topology != entry.built_for.topology:
        twin = _find_identical(entry.fingerprint)
        if not twin:
            return State.CHANGED, entry
        store(mesh, twin, entry.fingerprint)
        return State.FITS, twin
    return (State.FITS if entry.fingerprint == entry.built_for else State.MOVED), entry


def _adopt_identical(mesh: bpy.types.Mesh) -> HierarchyEntry | None:
    """Return the entry for a duplicate, or a mesh that undo has brought back, that was not used since; or None."""
    if mesh.is_editmode or has_stored(mesh) or _unmatched.get(mesh_key(mesh)) == changes.geometry_revision(mesh):
        return None
    size = element_counts(mesh)
    if not any(entry.counts == size for entry in (*_entries.values(), *_retired)):
        return None
    fingerprint = arrays.compute_fingerprint(mesh)
    twin = _find_identical(fingerprint)
    if twin:
        store(mesh, twin, fingerprint)
    else:
        _unmatched[mesh_key(mesh)] = changes.geometry_revision(mesh)
    return twin


def find_entry(mesh: bpy.types.Mesh) -> HierarchyEntry | None:
    """Return the entry of the mesh, whether or not it still fits, or None. O(1)."""
    return None if is_cleared(mesh) else _entries.get(mesh_key(mesh))


def find_hierarchy(mesh: bpy.types.Mesh) -> Hierarchy | None:
    """Return the hierarchy of find_entry(mesh), or None. O(1)."""
    entry = find_entry(mesh)
    return entry and entry.hierarchy
