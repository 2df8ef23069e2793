# SPDX-License-Identifier: GPL-3.0-or-later
"""The hierarchy of each mesh, and whether it still fits.

A hierarchy belongs to a topology: polygons and their vertices. Moving vertices keeps it usable, and the user may build
it again. Any other edit makes it stale. A stale hierarchy is never used: every use compares fingerprints."""

import dataclasses
from enum import Enum, auto

import bpy
import numpy as np

from ..mesh import Fingerprint, MeshSnapshot, MeshState, Refused, arrays, element_counts, find_deleted, get_mesh_state
from ..mesh.marks import list_settings
from ..mesh.mesh_state import forget_states, list_states
from . import own_parts
from .stored import PendingLoad, take_property, has_stored
from partwheel import Hierarchy
from partwheel.likeness import with_own_parts


@dataclasses.dataclass
class HierarchyEntry:
    """The hierarchy of a mesh, and what it was built for."""

    built_for: Fingerprint  # of the mesh when it was built
    counts: tuple  # of vertices and polygons, when it was built
    built: Hierarchy  # without the parts made by hand since it was built or loaded
    packed: bytes | None = None  # for files; created when a file is first saved
    fingerprint: Fingerprint | None = None  # of the mesh when it was last checked
    revision: tuple | None = None  # its MeshState's geometry_revision at that time, and which marks counted
    own_parts: tuple = (b"", None)  # digest of the parts made by hand, and geometry_revision when they were read
    with_own_parts: dict = dataclasses.field(default_factory=dict)  # digest -> Hierarchy: undo goes back to the same one

    @property
    def hierarchy(self) -> Hierarchy:
        """The hierarchy, with the parts made by hand."""
        return self.with_own_parts.get(self.own_parts[0], self.built)

    def update_own_parts(self, mesh: bpy.types.Mesh, state: MeshState) -> None:
        """Read the parts made by hand from the mesh, which the entry fits, if the mesh has changed. Fast if there are none."""
        if self.own_parts[1] == state.geometry_revision:
            return
        digest = own_parts.digest(mesh)
        if digest != self.own_parts[0]:
            self.packed = None
        self.own_parts = digest, state.geometry_revision
        if digest and digest not in self.with_own_parts:
            self.with_own_parts[digest] = with_own_parts(self.built, own_parts.load(mesh))

    def record_fingerprint(self, state: MeshState, fingerprint: Fingerprint) -> None:
        self.fingerprint, self.revision = fingerprint, _get_revision(state)

    def assume_fit(self) -> None:
        """Assume that a mesh that had changed fits again, after undo. Outside Edit Mode, get_state() checks it."""
        if self.fingerprint.topology != self.built_for.topology:
            self.fingerprint, self.revision = self.built_for, None


class State(Enum):
    """The relation of a mesh to its hierarchy."""

    NONE = auto()
    UNOPENED = auto()  # it came with the file; loaded, or refused, at its first use
    FITS = auto()
    MOVED = auto()  # usable, but vertices have moved since, or marks have changed
    CHANGED = auto()  # not usable


USABLE = State.FITS, State.MOVED
# Attribute of meshes whose hierarchy the user has cleared. Undo removes it again, in Edit Mode too, where it restores
# nothing of a mesh but its elements and their attributes. Blender hides names that start with a period.
CLEARED_ATTRIBUTE = ".partwheel_cleared"
MAX_RETIRED = 3

_retired = []  # entries of meshes that are gone or have changed, newest last, at most MAX_RETIRED


def get_hierarchy(snapshot: MeshSnapshot) -> Hierarchy | None:
    """Return the hierarchy of the mesh, or None if there is none for its current topology."""
    mesh, state = snapshot.update_mesh(), snapshot.state
    if is_cleared(mesh):
        return None
    entry = state.entry
    pending_load = None if entry else PendingLoad(mesh, state)
    fingerprint = snapshot.fingerprint  # takes half as long as loading, which runs at the same time
    if not entry or entry.built_for.topology != fingerprint.topology:
        entry = (_find_identical(fingerprint)
                 or _load_stored(pending_load or PendingLoad(mesh, state), fingerprint) or entry)
    if not entry:
        return None
    store(state, entry, fingerprint)
    if entry.built_for.topology != fingerprint.topology:
        return None
    entry.update_own_parts(mesh, state)
    return entry.hierarchy


def require_hierarchy(snapshot: MeshSnapshot) -> Hierarchy:
    """Return the hierarchy of the mesh. Raises Refused if there is none."""
    hierarchy = get_hierarchy(snapshot)
    if not hierarchy:
        raise Refused("{name} has no parts for its current mesh. Find them first.", name=snapshot.obj.name)
    return hierarchy


def _find_identical(fingerprint: Fingerprint) -> HierarchyEntry | None:
    """Return an entry with the hierarchy of an identical mesh, duplicated or brought back by undo; or None."""
    entry = next((entry for entry in (*list_entries(), *reversed(_retired)) if entry.built_for == fingerprint), None)
    return entry and dataclasses.replace(entry)


def _get_revision(state: MeshState) -> tuple:
    return state.geometry_revision, *list_settings()


def list_entries() -> list[HierarchyEntry]:
    return [state.entry for state in list_states() if state.entry]


def _load_stored(pending_load: PendingLoad, fingerprint: Fingerprint) -> HierarchyEntry | None:
    """Return a new entry with the hierarchy from the file, or None."""
    stored = pending_load.result(fingerprint)
    return stored and HierarchyEntry(stored[0], element_counts(pending_load.mesh), stored[1], pending_load.packed)


def store(state: MeshState, entry: HierarchyEntry, fingerprint: Fingerprint) -> None:
    """Make entry the mesh's entry. fingerprint: the mesh's current one. An earlier entry of another topology retires."""
    if state.entry and state.entry.built_for.topology != entry.built_for.topology:
        _retire(state.entry)
    state.entry = entry
    entry.record_fingerprint(state, fingerprint)


def restore(snapshot: MeshSnapshot, entry: HierarchyEntry) -> None:
    """Make an earlier entry the mesh's again, if the mesh has not changed in the meantime."""
    if entry.built_for.topology == snapshot.fingerprint.topology:
        store(snapshot.state, entry, snapshot.fingerprint)


def save_own_parts(mesh: bpy.types.Mesh, masks: list[np.ndarray], hierarchy: Hierarchy) -> None:
    """Store parts made by hand in the mesh, which has a hierarchy. The wheel stops at them from now on. Outside Edit
    Mode. masks: (F,) of the parts, any two nested or disjoint. hierarchy: with_own_parts() of them."""
    own_parts.save(mesh, masks)
    entry = find_entry(mesh)
    entry.with_own_parts[own_parts.digest(mesh)] = hierarchy
    entry.own_parts = entry.own_parts[0], None
    entry.update_own_parts(mesh, get_mesh_state(mesh))


def _retire(entry: HierarchyEntry) -> None:
    """Keep an entry whose mesh is gone or has changed; undo may bring the mesh back."""
    _retired[:] = [other for other in _retired if other.built is not entry.built] + [entry]
    del _retired[:-MAX_RETIRED]


def forget(mesh: bpy.types.Mesh) -> None:
    """Drop the mesh's hierarchy, including one that came with the file, and its picks."""
    state = get_mesh_state(mesh)
    state.entry = state.stored = state.pick = None
    state.past_picks.clear()
    take_property(mesh)


def is_cleared(mesh: bpy.types.Mesh) -> bool:
    return CLEARED_ATTRIBUTE in mesh.attributes


def clear(mesh: bpy.types.Mesh) -> None:
    """Drop the mesh's hierarchy until undo, or until another one is built. It isn't saved any more."""
    mesh.attributes.new(CLEARED_ATTRIBUTE, "BOOLEAN", "FACE")


def end_clearing(mesh: bpy.types.Mesh) -> None:
    """Make the mesh as if its hierarchy had not been cleared."""
    if is_cleared(mesh):
        mesh.attributes.remove(mesh.attributes[CLEARED_ATTRIBUTE])


def forget_deleted() -> None:
    """Forget meshes that no longer exist, except for what undo may bring back: the newest hierarchies and their picks."""
    deleted = find_deleted()
    for state in deleted:
        if state.entry:
            _retire(state.entry)
    may_return = [hierarchy for entry in _retired for hierarchy in (entry.built, *entry.with_own_parts.values())]
    forget_states(state for state in deleted if not (state.pick and state.pick.hierarchy in may_return))
    for state in find_deleted():
        state.entry = state.view_cache = state.creases = None


def forget_all() -> None:
    forget_states(list_states())
    _retired.clear()


# ---- For panels and poll(), which Blender calls often: fast


def get_state(mesh: bpy.types.Mesh) -> tuple[State, HierarchyEntry | None]:
    """Return (State, entry or None). In Edit Mode by the element counts and the last use, otherwise exact."""
    if is_cleared(mesh):
        return State.NONE, None
    state = get_mesh_state(mesh)
    entry = state.entry or _adopt_identical(mesh, state)
    if not entry:
        return (State.UNOPENED if has_stored(mesh, state) else State.NONE), None
    if mesh.is_editmode:
        if element_counts(mesh) != entry.counts:
            return State.CHANGED, entry
    elif entry.revision != _get_revision(state):
        entry.record_fingerprint(state, arrays.compute_fingerprint(mesh))
    if entry.fingerprint.topology != entry.built_for.topology:
        twin = _find_identical(entry.fingerprint)
        if not twin:
            return State.CHANGED, entry
        store(state, twin, entry.fingerprint)
        entry = twin
    entry.update_own_parts(mesh, state)
    return (State.FITS if entry.fingerprint == entry.built_for else State.MOVED), entry


def _adopt_identical(mesh: bpy.types.Mesh, state: MeshState) -> HierarchyEntry | None:
    """Return the entry for a duplicate, or a mesh that undo has brought back, that was not used since; or None."""
    if mesh.is_editmode or has_stored(mesh, state) or state.unmatched_revision == state.geometry_revision:
        return None
    size = element_counts(mesh)
    if not any(entry.counts == size for entry in (*list_entries(), *_retired)):
        return None
    fingerprint = arrays.compute_fingerprint(mesh)
    twin = _find_identical(fingerprint)
    if twin:
        store(state, twin, fingerprint)
    else:
        state.unmatched_revision = state.geometry_revision
    return twin


def find_entry(mesh: bpy.types.Mesh) -> HierarchyEntry | None:
    """Return the entry of the mesh, whether or not it still fits, or None. O(1)."""
    return None if is_cleared(mesh) else get_mesh_state(mesh).entry


def find_hierarchy(mesh: bpy.types.Mesh) -> Hierarchy | None:
    """Return the hierarchy of find_entry(mesh), or None. O(1)."""
    entry = find_entry(mesh)
    return entry and entry.hierarchy
