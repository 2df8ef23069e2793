# SPDX-License-Identifier: GPL-3.0-or-later
"""Which mesh has which hierarchy, and when one no longer fits its mesh.

A hierarchy belongs to a topology: polygons and their vertices. Moving vertices keeps it, and the user may have it made
anew; any other edit makes it stale, and a stale one is never used: every use compares fingerprints.
"""

import dataclasses
from enum import Enum, auto

from ..mesh import arrays
from ..mesh.arrays import Fingerprint
from ..mesh.mesh_identity import MeshTable, element_counts, mesh_key
from ..mesh.errors import Refused
from . import changes
from .stored import Opening, carried, unopened, waits
from partwheel import Hierarchy


@dataclasses.dataclass
class Entry:
    """A mesh's hierarchy."""

    built: Fingerprint  # what it was built for
    counts: tuple  # of vertices and polygons then
    hierarchy: Hierarchy
    packed: bytes = None  # for files; made when a file is first saved
    open_surfaces: bool = False  # the user wants this mesh taken for a thin solid, should it be a sheet
    seen: Fingerprint = None  # the mesh as it was when last looked at,
    looked: tuple = None  # and what changes.edits() said then

    def look(self, mesh, fingerprint):
        self.seen, self.looked = fingerprint, changes.edits(mesh)


class State(Enum):
    """How a mesh stands to its hierarchy."""

    NONE = auto()
    UNOPENED = auto()  # it came with the file and will be opened, or refused, at its first use
    FITS = auto()
    MOVED = auto()  # usable, but vertices have moved since
    CHANGED = auto()  # not usable


USABLE = State.FITS, State.MOVED
RETIRED = 3

_entries = MeshTable(gone=lambda entries, gone: _retire(entries.pop(gone)))
_strangers = MeshTable()  # what changes.edits() said when a mesh was found to be no twin of those
_retired = []  # of meshes that are gone, or others by now: undo may bring them back; the newest last, so many at most


@arrays.one_reading()
def hierarchy(obj):
    """The hierarchy of the object's mesh, or None if there is none for its present topology."""
    mesh = arrays.up_to_date(obj)
    entry = _entries.get(mesh_key(mesh))
    opening = None if entry else Opening(mesh)
    now = arrays.present(obj)  # takes half as long as opening
    if not entry or entry.built.topology != now.topology:
        entry = _twin(now) or _opened(opening or Opening(mesh), now) or entry
    if not entry:
        return None
    keep(mesh, entry, now)
    return entry.hierarchy if entry.built.topology == now.topology else None


def needed(obj):
    """The same. Raises Refused if there is none."""
    found = hierarchy(obj)
    if not found:
        raise Refused("{name} has no parts for its mesh as it is now. Find them first.", name=obj.name)
    return found


def _twin(now):
    """A new entry with the hierarchy of a mesh that is the same in all: the one that was duplicated, for instance, or
    the one that undo has brought back."""
    entry = next((entry for entry in (*_entries.values(), *reversed(_retired)) if entry.built == now), None)
    return entry and dataclasses.replace(entry)


def _opened(opening, now):
    """A new entry with what came from a file, or None."""
    found = opening.result(now)
    return found and Entry(found[0], element_counts(opening.mesh), found[1], opening.packed)


def keep(mesh, entry, now):
    """From now on it is the mesh's, whose Fingerprint is now; one of another topology that was there retires."""
    before = _entries.get(mesh_key(mesh))
    if before and before.built.topology != entry.built.topology:
        _retire(before)
    _entries[mesh_key(mesh)] = entry
    entry.look(mesh, now)


def _retire(entry):
    _retired[:] = [other for other in _retired if other.hierarchy is not entry.hierarchy] + [entry]
    del _retired[:-RETIRED]


def retired(hierarchy):
    """Whether undo may bring it back."""
    return any(entry.hierarchy is hierarchy for entry in _retired)


def forget(mesh):
    """Lets the mesh's hierarchy go, also the one that came with the file."""
    _entries.pop(mesh_key(mesh), None)
    unopened.pop(mesh_key(mesh), None)
    carried(mesh)


def forget_all():
    """Of every mesh."""
    for table in (*MeshTable.tables, _retired):
        table.clear()


# ---- For panels and poll(), which Blender calls often


def state(mesh):
    """(State, Entry or None). In Edit Mode as far as the counts and the last use tell; else exactly."""
    entry = _entries.get(mesh_key(mesh)) or _brought(mesh)
    if not entry:
        return (State.UNOPENED if waits(mesh) else State.NONE), None
    if mesh.is_editmode:
        if element_counts(mesh) != entry.counts:
            return State.CHANGED, entry
    elif entry.looked != changes.edits(mesh):
        entry.look(mesh, arrays.fingerprint(mesh))
    if entry.seen.topology != entry.built.topology:
        twin = _twin(entry.seen)
        if not twin:
            return State.CHANGED, entry
        keep(mesh, twin, entry.seen)
        return State.FITS, twin
    return (State.FITS if entry.seen == entry.built else State.MOVED), entry


def _brought(mesh):
    """The Entry of a mesh that undo has brought back, or of a duplicate, which nobody has used since; or None."""
    if mesh.is_editmode or waits(mesh) or _strangers.get(mesh_key(mesh)) == changes.edits(mesh):
        return None
    size = element_counts(mesh)
    if not any(entry.counts == size for entry in (*_entries.values(), *_retired)):
        return None
    now = arrays.fingerprint(mesh)
    twin = _twin(now)
    if twin:
        keep(mesh, twin, now)
    else:
        _strangers[mesh_key(mesh)] = changes.edits(mesh)
    return twin


def entry_of(mesh):
    """The Entry that was made for the mesh, fitting or not, or None. At once."""
    return _entries.get(mesh_key(mesh))


def known(mesh):
    """The hierarchy of that, or None."""
    entry = entry_of(mesh)
    return entry and entry.hierarchy
