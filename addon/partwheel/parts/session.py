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

from ..mesh import arrays
from . import stored
from partwheel import Error, Hierarchy, Mode, PartwheelError, Status
from partwheel.library import load
from partwheel.worker import WAIT_SECONDS, Job, available_memory
from ..mesh.arrays import Fingerprint
from ..preferences import preferences


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


class Outdated(Error):
    """A build ended and its mesh is not there any more, or not as it was. str() is sentences for the user."""


RETIRED = 3

_entries = {}
_retired = []  # of meshes that are gone, or others by now: undo may bring them back; the newest last, so many at most
_unopened = {}  # what came with the file, packed
_builds = {}  # those that have not ended, in the order in which they were asked for
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
    mesh = arrays.up_to_date(obj)
    entry = _entries.get(key(mesh))
    opening = None if entry else _Opening(mesh)
    now = arrays.fingerprint(mesh)  # takes half as long as opening
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
                now, arrays.read(self.mesh.vertices, "co", np.float32, 3),
                arrays.polygon_sizes(self.mesh)[0], arrays.read(self.mesh.loops, "vertex_index", np.int32))
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


# ---- Building: one at a time, the others wait for their turn


def running():
    """Whether any build is under way or waits."""
    return bool(_builds)


def being_built(obj):
    """Whether parts of the object's mesh as it is now are being found, or are to be."""
    build = _builds.get(key(obj.data))
    return build is not None and build.serves(arrays.fingerprint(arrays.up_to_date(obj)))


def build(obj, **options):
    """The Build of the object's mesh: the one that is under way, or else a new one. options: those of Build; without
    any whatever is under way will do. If the mesh has changed, or with other options, that is cancelled for a new one.
    """
    former = _builds.get(key(obj.data))
    if former:
        if former.serves(arrays.fingerprint(arrays.up_to_date(obj)), options):
            return former
        former.cancel()
    return Build(obj, **options)


class Build:
    """A build of the object's mesh as it is now, in a process of its own, once those asked for earlier are over. The
    mesh is not changed, nor kept from changing. To be had from build(): there is one a mesh."""

    def __init__(self, obj, quality=0.0, open_surfaces=False, mode=None, time_limit=None, memory_limit=None):
        """mode: a partwheel.Mode; limits: as Job has them; None: the preferences'. open_surfaces holds for later builds
        of the mesh too."""
        load()  # a missing library is better told here
        mesh = arrays.up_to_date(obj)
        self.name = mesh.name
        self._key, self._counts, self._built = key(mesh), _counts(mesh), arrays.fingerprint(mesh)
        former = _entries.get(self._key)
        self._open_surfaces = open_surfaces or (former is not None and former.open_surfaces)
        self._mode = Mode[preferences().parts] if mode is None else mode
        self._options = {"quality": quality, "open_surfaces": open_surfaces, "mode": mode, "time_limit": time_limit,
                         "memory_limit": memory_limit}
        self._surface = arrays.surface(mesh)
        self._hierarchy = self._error = None
        self._cancelled = False
        self.job = None  # from its turn on
        _builds[self._key] = self
        _turn()

    def serves(self, now, options=None):
        """Whether whoever wants a build of the mesh as it is now, with these options or whatever, can have this one."""
        return now.topology == self._built.topology and (
            not options or now == self._built and self._options == {**self._options, **options})

    def start(self):
        """It is its turn: whether it has a worker now."""
        share, options = preferences().memory_share / 100, self._options
        try:
            self.job = Job(*self._surface, quality=options["quality"], open_surfaces=self._open_surfaces,
                           mode=self._mode, memory_limit=options["memory_limit"] or int(share * available_memory()),
                           time_limit=options["time_limit"] or 60 * preferences().time_limit or None,
                           python=bpy.path.abspath(preferences().python))
        except Exception as error:  # whatever it is, finish() raises it
            self._error = error
            self._leave()
        return self.job is not None

    def poll(self):
        """(fraction 0..1 that never falls, what is done or waited for); None once finish() won't block."""
        turn = _turn()
        if self.job:
            return self.job.poll()
        return None if self._cancelled or self._error else (0.0, f"after those of {turn.name}")

    def wait(self, seconds):
        """Waits so long at most, and says whether finish() won't block."""
        turn = None if self.poll() is None else self if self.job else _turn()
        if turn:
            turn.job.wait(seconds)
        return self.poll() is None

    def cancel(self):
        """Takes it out of the queue and kills the worker. finish() is still to be called, and tells of the cancel even
        if the answer is there: nobody has seen that yet, and what Esc does must not depend on who was faster."""
        self._cancelled = True
        self._leave()
        if self.job:
            self.job.cancel()

    def _leave(self):
        if _builds.get(self._key) is self:
            del _builds[self._key]

    def finish(self):
        """Waits for the end and keeps the result: the Hierarchy. Raises PartwheelError, or Outdated if the mesh was
        edited or deleted meanwhile. All who wait for it may call it."""
        try:
            while not self.wait(WAIT_SECONDS):
                pass
        except BaseException:  # Ctrl-C
            self.cancel()
            raise
        self._leave()
        if self._cancelled:
            raise PartwheelError(Status.CANCELLED, "The build was cancelled.")
        if self._error:
            raise self._error
        if not self._hierarchy:
            self._keep(self._answer())
        return self._hierarchy

    def _answer(self):
        try:
            return self.job.result()
        except PartwheelError as error:
            if error.status == Status.NOT_SOLID:
                _sheets[self._key] = self._counts
            raise

    def _keep(self, built):
        obj = _user(self._key)
        if obj is None:
            raise Outdated(f"The mesh {self.name} is gone, so its parts were left aside.")
        mesh = arrays.up_to_date(obj)
        now = arrays.fingerprint(mesh)
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
        self._hierarchy = built

    def outdated(self):
        """Whether its mesh is gone, or is another one by now, be it only by places of vertices."""
        obj = _user(self._key)
        return obj is None or arrays.fingerprint(arrays.up_to_date(obj)) != self._built


def _turn():
    """The Build that has a worker; if none has, the one that has waited longest gets one. None if none waits."""
    return (next((each for each in _builds.values() if each.job and each.job.poll()), None)
            or next((each for each in list(_builds.values()) if not each.job and each.start()), None))


def drop_outdated_builds():
    """Cancels those whose mesh is not there any more as it was."""
    for each in list(_builds.values()):
        if each.outdated():
            each.cancel()


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
        entry.look(arrays.fingerprint(mesh))
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
    if arrays.writing_back:
        return
    for update in depsgraph.updates:
        if update.is_updated_geometry and isinstance(update.id, bpy.types.Mesh):
            mesh = key(update.id.original)
            _revisions[mesh] = _revisions.get(mesh, 0) + 1
            if mesh in _entries:
                _entries[mesh].sure = False
        elif (update.is_updated_geometry and isinstance(update.id, bpy.types.Object) and update.id.type == "MESH"
              and (update.id.mode != "EDIT" or arrays.on_cage(update.id))):
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
    for each in list(_builds.values()):
        each.cancel()


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
