# SPDX-License-Identifier: GPL-3.0-or-later
"""Which mesh has which hierarchy, and when one no longer fits its mesh.

A hierarchy belongs to a topology: polygons and their vertices. Moving vertices keeps it, and the user may have it made
anew; any other edit makes it stale, and a stale one is never used: every use compares fingerprints.
"""

from __future__ import annotations

import dataclasses
from enum import Enum, auto

import bpy

from ..mesh import arrays
from ..mesh.arrays import Fingerprint
from ..mesh.mesh_identity import MeshTable, element_counts, mesh_key
from ..mesh.errors import Refused
from . import changes
from .stored import PendingLoad, take_property, pending, has_stored
from partwheel import Hierarchy


@dataclasses.dataclass
class HierarchyEntry:
    """A mesh's hierarchy."""

    built_for: Fingerprint  # what it was built for
    counts: tuple  # of vertices and polygons then
    hierarchy: Hierarchy
    packed: bytes = None  # for files; made when a file is first saved
    open_surfaces: bool = False  # the user wants this mesh taken for a thin solid, should it be a sheet
    fingerprint: Fingerprint = None  # the mesh as it was when last looked at,
    revision: tuple = None  # and what changes.geometry_revision() said then

    def record_fingerprint(self, mesh: bpy.types.Mesh, fingerprint: Fingerprint) -> None:
        self.fingerprint, self.revision = fingerprint, changes.geometry_revision(mesh)


class State(Enum):
    """How a mesh stands to its hierarchy."""

    NONE = auto()
    UNOPENED = auto()  # it came with the file and will be opened, or refused, at its first use
    FITS = auto()
    MOVED = auto()  # usable, but vertices have moved since
    CHANGED = auto()  # not usable


USABLE = State.FITS, State.MOVED
MAX_RETIRED = 3

_entries = MeshTable(on_removal=lambda entries, gone: _retire(entries.pop(gone)))
_unmatched = MeshTable()  # what changes.geometry_revision() said when a mesh was found to be no twin of those
_retired = []  # of meshes that are gone, or others by now: undo may bring them back; the newest last, so many at most


@arrays.use_snapshot()
def get_hierarchy(obj: bpy.types.Object) -> Hierarchy | None:
    """The hierarchy of the object's mesh, or None if there is none for its present topology."""
    mesh = arrays.update_mesh(obj)
    entry = _entries.get(mesh_key(mesh))
    opening = None if entry else PendingLoad(mesh)
    now = arrays.current_fingerprint(obj)  # takes half as long as opening
    if not entry or entry.built_for.topology != now.topology:
        entry = _find_identical(now) or _load_stored(opening or PendingLoad(mesh), now) or entry
    if not entry:
        return None
    store(mesh, entry, now)
    return entry.hierarchy if entry.built_for.topology == now.topology else None


def require_hierarchy(obj: bpy.types.Object) -> Hierarchy:
    """The same. Raises Refused if there is none."""
    found = get_hierarchy(obj)
    if not found:
        raise Refused("{name} has no parts for its mesh as it is now. Find them first.", name=obj.name)
    return found


def _find_identical(now: Fingerprint) -> HierarchyEntry | None:
    """A new entry with the hierarchy of a mesh that is the same in all: the one that was duplicated, for instance, or
    the one that undo has brought back."""
    entry = next((entry for entry in (*_entries.values(), *reversed(_retired)) if entry.built_for == now), None)
    return entry and dataclasses.replace(entry)


def _load_stored(opening: PendingLoad, now: Fingerprint) -> HierarchyEntry | None:
    """A new entry with what came from a file, or None."""
    found = opening.result(now)
    return found and HierarchyEntry(found[0], element_counts(opening.mesh), found[1], opening.packed)


def store(mesh: bpy.types.Mesh, entry: HierarchyEntry, now: Fingerprint) -> None:
    """From now on it is the mesh's, whose Fingerprint is now; one of another topology that was there retires."""
    before = _entries.get(mesh_key(mesh))
    if before and before.built_for.topology != entry.built_for.topology:
        _retire(before)
    _entries[mesh_key(mesh)] = entry
    entry.record_fingerprint(mesh, now)


def _retire(entry: HierarchyEntry) -> None:
    _retired[:] = [other for other in _retired if other.hierarchy is not entry.hierarchy] + [entry]
    del _retired[:-MAX_RETIRED]


def is_retired(hierarchy: Hierarchy) -> bool:
    """Whether undo may bring it back."""
    return any(entry.hierarchy is hierarchy for entry in _retired)


def forget(mesh: bpy.types.Mesh) -> None:
    """Lets the mesh's hierarchy go, also the one that came with the file."""
    _entries.pop(mesh_key(mesh), None)
    pending.pop(mesh_key(mesh), None)
    take_property(mesh)


def forget_all() -> None:
    """Of every mesh."""
    for table in (*MeshTable.tables, _retired):
        table.clear()


# ---- For panels and poll(), which Blender calls often


def get_state(mesh: bpy.types.Mesh) -> tuple[State, HierarchyEntry | None]:
    """(State, Entry or None). In Edit Mode as far as the counts and the last use tell; else exactly."""
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
    """The Entry of a mesh that undo has brought back, or of a duplicate, which nobody has used since; or None."""
    if mesh.is_editmode or has_stored(mesh) or _unmatched.get(mesh_key(mesh)) == changes.geometry_revision(mesh):
        return None
    size = element_counts(mesh)
    if not any(entry.counts == size for entry in (*_entries.values(), *_retired)):
        return None
    now = arrays.compute_fingerprint(mesh)
    twin = _find_identical(now)
    if twin:
        store(mesh, twin, now)
    else:
        _unmatched[mesh_key(mesh)] = changes.geometry_revision(mesh)
    return twin


def find_entry(mesh: bpy.types.Mesh) -> HierarchyEntry | None:
    """The Entry that was made for the mesh, fitting or not, or None. At once."""
    return _entries.get(mesh_key(mesh))


def find_hierarchy(mesh: bpy.types.Mesh) -> Hierarchy | None:
    """The hierarchy of that, or None."""
    entry = find_entry(mesh)
    return entry and entry.hierarchy
