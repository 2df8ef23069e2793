# SPDX-License-Identifier: GPL-3.0-or-later
"""Which mesh has which hierarchy, when one no longer fits its mesh, and its way into files and out of them.

A hierarchy belongs to a topology: polygons and their vertices. Moving vertices keeps it, and the user may have it made
anew; any other edit makes it stale, and a stale one is never used: every use compares fingerprints. No pointer into
Blender's data is kept: undo and file loading would make it dangle.
"""

import dataclasses
from enum import Enum, auto
from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from . import mesh_arrays, stored
from .core import Hierarchy, Mode, PartwheelError, Status
from .core.worker import Job, available_memory
from .mesh_arrays import Fingerprint
from .preferences import preferences


@dataclasses.dataclass
class Entry:
    """A mesh's hierarchy."""

    built: Fingerprint  # what it was built for
    counts: tuple  # of vertices and polygons then
    hierarchy: Hierarchy
    packed: bytes = None  # for files; made when a file is first saved
    open_surfaces: bool = False  # the user wants this mesh taken for a thin solid, should it be a sheet
    seen: Fingerprint = None  # the mesh as it was when last looked at,
    sure: bool = True  # and whether it still is, for all that Blender has told since

    def look(self, fingerprint):
        self.seen, self.sure = fingerprint, True


class Picked(NamedTuple):
    """A part of a mesh that the user chose: a node of its hierarchy, and the face that was clicked. snap: whether it was
    taken with its border in creases."""

    node: int
    face: int
    hierarchy: Hierarchy
    snap: bool


class State(Enum):
    """How a mesh stands to its hierarchy."""

    NONE = auto()
    UNOPENED = auto()  # it came with the file and will be opened, or refused, at its first use
    FITS = auto()
    MOVED = auto()  # usable, but vertices have moved since
    CHANGED = auto()  # not usable


class Outdated(Exception):
    """A build ended and its mesh is not there any more, or not as it was. str() is sentences for the user."""


RETIRED = 3

_entries = {}
_retired = []  # of meshes that are gone, or others by now: undo may bring them back; the newest last, so many at most
_unopened = {}  # what came with the file, packed
_running = None  # the Build that has not ended
_picks = {}  # the part that was confirmed last in each mesh
_sheets = {}  # how many vertices and polygons a mesh had when it was refused for being a sheet
_revisions = {}  # how often Blender has told that a mesh's geometry, or what is hidden of it, changed
_KEPT = _entries, _unopened, _picks, _sheets, _revisions
_undos = 0


def key(mesh):
    """A mesh's identity that outlives undo. Before Blender 4.1 its full name: renaming it means building again."""
    return getattr(mesh, "session_uid", None) or mesh.name_full


def hierarchy(obj):
    """The hierarchy of the object's mesh, or None if there is none for its present topology."""
    mesh = mesh_arrays.up_to_date(obj)
    entry = _entries.get(key(mesh))
    opening = None if entry else _Opening(mesh)
    now = mesh_arrays.fingerprint(mesh)  # takes half as long as opening
    if not entry or entry.built.topology != now.topology:
        entry = _twin(now) or (opening or _Opening(mesh)).entry(now) or entry
    if not entry:
        return None
    _keep(key(mesh), entry)
    entry.look(now)
    return entry.hierarchy if entry.built.topology == now.topology else None


def _twin(now):
    """A new entry with the hierarchy of a mesh that is the same in all: the one that was duplicated, for instance, or
    the one that undo has brought back."""
    entry = next((entry for entry in (*_entries.values(), *reversed(_retired)) if entry.built == now), None)
    return entry and dataclasses.replace(entry)


def _keep(mesh, entry):
    """From now on it is the one of the mesh with this key; one of another topology that was there retires."""
    before = _entries.get(mesh)
    if before and before.built.topology != entry.built.topology:
        _retire(before)
    _entries[mesh] = entry


def _retire(entry):
    _retired[:] = [other for other in _retired if other.hierarchy is not entry.hierarchy] + [entry]
    del _retired[:-RETIRED]


class _Opening:
    """The hierarchy, if any, that came with the mesh from a file, being opened while the caller does other things."""

    def __init__(self, mesh):
        self.mesh, self.packed = mesh, _unopened.pop(key(mesh), None) or _carried(mesh)
        self.unpacking = None if self.packed is None else stored.Unpacking(self.packed)

    def entry(self, now):
        """A new entry with it, or None."""
        if not self.unpacking:
            return None
        try:
            built, opened = self.unpacking.result(
                now, mesh_arrays.read(self.mesh.vertices, "co", np.float32, 3),
                mesh_arrays.polygon_sizes(self.mesh)[0], mesh_arrays.read(self.mesh.loops, "vertex_index", np.int32))
        except stored.Refused as reason:
            print(f"Partwheel: the parts saved with {self.mesh.name} are left aside, for {reason}.")
            return None
        return Entry(built, _counts(self.mesh), opened, self.packed)


def _carried(mesh):
    """What an appended or linked mesh has brought along; taken off it, if it can be changed."""
    packed = mesh.get(stored.PROPERTY)
    if packed is not None and not mesh.library:
        del mesh[stored.PROPERTY]
    return packed


def _counts(mesh):
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        return len(bm.verts), len(bm.faces)
    return len(mesh.vertices), len(mesh.polygons)


# ---- The part that was picked last


def remember_pick(obj, face, node, snap=False):
    """The user has chosen this part of the object's mesh, which has a hierarchy."""
    _picks[key(obj.data)] = Picked(int(node), int(face), _entries[key(obj.data)].hierarchy, bool(snap))


def picked(obj):
    """The Picked that was chosen last in the object's mesh; None if there is none, or its hierarchy is not the mesh's
    any more."""
    pick = _picks.get(key(obj.data))
    return pick if pick and hierarchy(obj) is pick.hierarchy else None


def picked_as_told(obj):
    """The same for panels and poll(), which Blender calls often: as far as state() tells."""
    pick = _picks.get(key(obj.data))
    if not pick:
        return None
    fits, entry = state(obj.data)
    return pick if fits in {State.FITS, State.MOVED} and entry.hierarchy is pick.hierarchy else None


def has_pick(obj):
    """For poll(): whether picked_as_told() finds one."""
    return picked_as_told(obj) is not None


# ---- Building


def running():
    """Whether a build is under way. There is one at a time."""
    return _running is not None


class Build:
    """A build of the object's mesh in a process of its own. The mesh is not changed, nor kept from changing."""

    def __init__(self, obj, quality=0.0, open_surfaces=False, mode=None):
        """mode: a core.Mode; None: the preferences'. open_surfaces holds for later builds of the mesh too."""
        global _running
        mesh = mesh_arrays.up_to_date(obj)
        self.name = mesh.name
        self._key, self._counts, self._built = key(mesh), _counts(mesh), mesh_arrays.fingerprint(mesh)
        former = _entries.get(self._key)
        self._open_surfaces = open_surfaces or (former is not None and former.open_surfaces)
        share, seconds = preferences().memory_share / 100, 60 * preferences().time_limit
        self.job = Job(*mesh_arrays.surface(mesh), quality=quality, open_surfaces=self._open_surfaces,
                       mode=Mode[preferences().parts] if mode is None else mode,
                       memory_limit=int(share * available_memory()), time_limit=seconds or None,
                       python=bpy.path.abspath(preferences().python))
        _running = self

    def cancel(self):
        """Kills the worker. finish() is still to be called."""
        self.job.cancel()

    def finish(self):
        """Waits for the end and keeps the result: the Hierarchy. Raises PartwheelError, or Outdated if the mesh was
        edited or deleted meanwhile."""
        global _running
        try:
            built = self.job.result()
        except PartwheelError as error:
            if error.status == Status.NOT_SOLID:
                _sheets[self._key] = self._counts
            raise
        finally:
            if _running is self:
                _running = None
        obj = _user(self._key)
        if obj is None:
            raise Outdated(f"The mesh {self.name} is gone, so its parts were left aside.")
        mesh = mesh_arrays.up_to_date(obj)
        now = mesh_arrays.fingerprint(mesh)
        if now.topology != self._built.topology:
            raise Outdated(f"{mesh.name} was edited while its parts were being built, so they were left aside. Build "
                           "them again when the mesh is as you want it.")
        alive = {key(other) for other in bpy.data.meshes}
        for gone in _entries.keys() - alive:
            _retire(_entries.pop(gone))
        retired = {id(entry.hierarchy) for entry in _retired}
        for kept in _KEPT:
            for gone in kept.keys() - alive:
                if kept is not _picks or id(kept[gone].hierarchy) not in retired:
                    del kept[gone]
        _unopened.pop(self._key, None)
        _sheets.pop(self._key, None)
        _keep(self._key, Entry(self._built, self._counts, built, open_surfaces=self._open_surfaces, seen=now))
        return built


def drop_outdated_build():
    """Cancels the build under way if its mesh is gone, or is another one by now, be it only by places of vertices."""
    if _running:
        obj = _user(_running._key)
        if not obj or mesh_arrays.fingerprint(mesh_arrays.up_to_date(obj)) != _running._built:
            _stop()


def _user(wanted):
    """An object with the mesh of this key, in Edit Mode if there is one such, or None."""
    users = [obj for obj in bpy.data.objects if obj.type == "MESH" and key(obj.data) == wanted]
    return next((obj for obj in users if obj.mode == "EDIT"), users[0] if users else None)


def forget(obj):
    """Lets the hierarchy of the object's mesh go, also the one that came with the file."""
    _entries.pop(key(obj.data), None)
    _unopened.pop(key(obj.data), None)
    _picks.pop(key(obj.data), None)
    _carried(obj.data)


# ---- For the panel, which draws often


def state(mesh):
    """(State, Entry or None). In Edit Mode as far as the counts and the last use tell; else exactly."""
    entry = _entries.get(key(mesh))
    if not entry:
        unopened = key(mesh) in _unopened or stored.PROPERTY in mesh
        return (State.UNOPENED if unopened else State.NONE), None
    if mesh.is_editmode:
        if _counts(mesh) != entry.counts:
            return State.CHANGED, entry
    elif not entry.sure:
        entry.look(mesh_arrays.fingerprint(mesh))
    if entry.seen.topology != entry.built.topology:
        twin = _twin(entry.seen)
        if not twin:
            return State.CHANGED, entry
        twin.look(entry.seen)
        _keep(key(mesh), twin)
        return State.FITS, twin
    return (State.FITS if entry.seen == entry.built else State.MOVED), entry


def refused_as_sheet(mesh):
    """Whether the last build refused the mesh for being a sheet, as far as the counts tell that it is the same."""
    return _sheets.get(key(mesh)) == _counts(mesh)


def known(mesh):
    """The hierarchy that was built for the mesh, fitting or not, or None. At once."""
    entry = _entries.get(key(mesh))
    return entry and entry.hierarchy


def seen(mesh):
    """The Fingerprint of a mesh that has a hierarchy, as it was when that was asked for last."""
    return _entries[key(mesh)].seen


def revision(mesh):
    """A number that is another one after each change of the mesh's geometry, of what modifiers show of it, be it on the
    cage, or of what is hidden, that Blender told of. Selecting is none."""
    return _revisions.get(key(mesh), 0), _undos


@bpy.app.handlers.persistent
def _edited(_scene, depsgraph):
    if mesh_arrays.writing_back:
        return
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Mesh):
            mesh = key(update.id.original)
            _revisions[mesh] = _revisions.get(mesh, 0) + 1
            if mesh in _entries:
                _entries[mesh].sure = False
        elif (update.is_updated_geometry and isinstance(update.id, bpy.types.Object) and update.id.type == "MESH"
              and (update.id.mode != "EDIT" or mesh_arrays.on_cage(update.id))):
            mesh = key(update.id.original.data)
            _revisions[mesh] = _revisions.get(mesh, 0) + 1


@bpy.app.handlers.persistent
def _undone(*_):
    global _undos
    _undos += 1
    for entry in _entries.values():
        entry.sure = False


# ---- Files


@bpy.app.handlers.persistent
def _before_saving(*_):
    if not preferences().save_with_file:
        return
    for mesh in bpy.data.meshes:
        if mesh.library:
            continue
        fits, entry = state(mesh)
        if fits in {State.FITS, State.MOVED} and not entry.packed:
            entry.packed = stored.pack(entry.built, entry.hierarchy)
        packed = _unopened.get(key(mesh)) if fits == State.UNOPENED else entry and entry.packed
        if packed:
            _carried(mesh)  # Blender 4.2 to 5.0 cut bytes off at a 0 where they replace others
            mesh[stored.PROPERTY] = packed


@bpy.app.handlers.persistent
def _after_saving(*_):
    for mesh in bpy.data.meshes:
        if not mesh.library and stored.PROPERTY in mesh:
            del mesh[stored.PROPERTY]


@bpy.app.handlers.persistent
def _after_loading(*_):
    """Another file was opened: its meshes are others."""
    _stop()
    for kept in (*_KEPT, _retired):
        kept.clear()
    for mesh in bpy.data.meshes:
        if stored.PROPERTY in mesh and not mesh.library:
            _unopened[key(mesh)] = _carried(mesh)


def _stop():
    global _running
    if _running:
        _running.cancel()
        _running = None


HANDLERS = {"load_post": _after_loading, "save_pre": _before_saving, "save_post": _after_saving,
            "save_post_fail": _after_saving,  # from Blender 4.0
            "depsgraph_update_post": _edited, "undo_post": _undone, "redo_post": _undone}


def register():
    for name, function in HANDLERS.items():
        if hasattr(bpy.app.handlers, name):
            getattr(bpy.app.handlers, name).append(function)


def unregister():
    for name, function in HANDLERS.items():
        if hasattr(bpy.app.handlers, name):
            getattr(bpy.app.handlers, name).remove(function)
    _stop()
    for kept in (*_KEPT, _retired):
        kept.clear()
