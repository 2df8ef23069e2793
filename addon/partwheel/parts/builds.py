# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies being built: one at a time, in a process of its own; the others wait for their turn."""

from __future__ import annotations

from collections.abc import Callable

import bpy

from ..mesh import arrays
from ..mesh.mesh_identity import MeshTable, element_counts, mesh_key
from ..preferences import preferences
from . import registry
from .stored import pending
from ..mesh.errors import UserError
from ..words.say import rpt_
from partwheel import Hierarchy, Mode, PartwheelError, Status
from partwheel.library import load
from partwheel.worker import WAIT_SECONDS, Job, available_memory
from ..mesh.arrays import Fingerprint

_builds = {}  # those that have not ended, in the order in which they were asked for, by the key of their mesh
_sheet_counts = MeshTable()  # how many vertices and polygons a mesh had when it was refused for being a sheet


class Outdated(UserError):
    """A build ended and its mesh is not there any more, or not as it was."""


def has_builds() -> bool:
    """Whether any build is under way or waits."""
    return bool(_builds)


def is_being_built(obj: bpy.types.Object) -> bool:
    """Whether parts of the object's mesh as it is now are being found, or are to be."""
    build = _builds.get(mesh_key(obj.data))
    return build is not None and build.matches(arrays.current_fingerprint(obj))


def request_build(obj: bpy.types.Object, **options: object) -> QueuedBuild:
    """The Build of the object's mesh: the one that is under way, or else a new one. options: those of Build; without
    any whatever is under way will do. If the mesh has changed, or with other options, that is cancelled for a new one.
    """
    former = _builds.get(mesh_key(obj.data))
    if former:
        if former.matches(arrays.current_fingerprint(obj), options):
            return former
        former.cancel()
    return QueuedBuild(obj, **options)


class QueuedBuild:
    """A build of the object's mesh as it is now, in a process of its own, once those asked for earlier are over. The
    mesh is not changed, nor kept from changing. To be had from build(): there is one a mesh. Ask it from the main
    thread: poll(), wait(), cancel(), result()."""

    def __init__(self, obj: bpy.types.Object, quality: float = 0.0, open_surfaces: bool = False,
                 mode: Mode | None = None, cpu_limit: float | None = None, memory_limit: int | None = None,
                 exactly: bool | None = None) -> None:
        """mode: a partwheel.Mode; limits and exactly: as Job has them; None: the preferences'. open_surfaces holds for
        later builds of the mesh too."""
        load()  # a missing library is better told here
        mesh, self._built = obj.data, arrays.current_fingerprint(obj)
        self.name, self._key, self._counts = mesh.name, mesh_key(mesh), element_counts(mesh)
        former = registry.find_entry(mesh)
        self._open_surfaces = open_surfaces or (former is not None and former.open_surfaces)
        self._mode = Mode[preferences().parts] if mode is None else mode
        self._exactly = preferences().exactly if exactly is None else exactly
        self._options = {"quality": quality, "open_surfaces": open_surfaces, "exactly": exactly, "mode": mode,
                         "cpu_limit": cpu_limit, "memory_limit": memory_limit}
        self._surface = arrays.read_surface(mesh)
        self._hierarchy = self._error = None
        self._cancelled = False
        self.job = None  # from its turn on
        _builds[self._key] = self
        _advance_queue()

    def matches(self, now: Fingerprint, options: dict | None = None) -> bool:
        """Whether whoever wants a build of the mesh as it is now, with these options or whatever, can have this one."""
        return now.topology == self._built.topology and (
            not options or now == self._built and self._options == {**self._options, **options})

    def start_worker(self) -> bool:
        """It is its turn: whether it has a worker now."""
        share, options = preferences().memory_share / 100, self._options
        try:
            self.job = Job(*self._surface, quality=options["quality"], open_surfaces=self._open_surfaces,
                           exactly=self._exactly, mode=self._mode,
                           memory_limit=options["memory_limit"] or int(share * available_memory()),
                           cpu_limit=options["cpu_limit"] or 60 * preferences().cpu_limit or None,
                           python=bpy.path.abspath(preferences().python))
        except Exception as error:  # whatever it is, result() raises it
            self._error = error
            self._remove_from_queue()
        return self.job is not None

    def poll(self) -> tuple[float, str] | None:
        """(fraction 0..1 that never falls, what is done, or whose build is waited for); None once result() won't block."""
        turn = _advance_queue()
        if self.job:
            return self.job.poll()
        return None if self._cancelled or self._error else (0.0, turn.name)

    def wait(self, seconds: float) -> bool:
        """Waits so long at most; whether result() won't block."""
        turn = None if self.poll() is None else self if self.job else _advance_queue()
        if turn:
            turn.job.wait(seconds)
        return self.poll() is None

    def cancel(self) -> None:
        """Takes it out of the queue and ends it at once: result() then raises PartwheelError, status CANCELLED, and no
        hierarchy is kept, even if the answer is there: nobody has seen that yet, and what Esc does must not depend on
        who was faster."""
        self._cancelled = True
        self._remove_from_queue()
        if self.job:
            self.job.cancel()

    def _remove_from_queue(self) -> None:
        if _builds.get(self._key) is self:
            del _builds[self._key]

    def result(self, progress: Callable[[float, str], object] | None = None) -> Hierarchy:
        """Waits for the end and keeps the Hierarchy, which is returned; without this call it is not kept. All who wait
        for it may call it. progress(fraction, what): called ten times a second; returning True cancels. Raises
        PartwheelError: why the mesh has no parts, or a limit was met; Outdated: it was edited or deleted meanwhile."""
        try:
            while told := self.poll():
                if progress and progress(*told):
                    self.cancel()
                self.wait(WAIT_SECONDS)
        except BaseException:  # what progress() raised, or Ctrl-C
            self.cancel()
            raise
        self._remove_from_queue()
        if self._cancelled:
            raise PartwheelError(Status.CANCELLED, rpt_("The build was canceled."))
        if self._error:
            raise self._error
        if not self._hierarchy:
            self._store(self._read_answer())
        return self._hierarchy

    def _read_answer(self) -> Hierarchy:
        try:
            return self.job.result()
        except PartwheelError as error:
            if error.status == Status.NOT_SOLID:
                _sheet_counts[self._key] = self._counts
            raise

    def _store(self, built: Hierarchy) -> None:
        obj = _find_user(self._key)
        if obj is None:
            raise Outdated("The mesh {name} is gone, so its parts were left aside.", name=self.name)
        mesh, now = obj.data, arrays.current_fingerprint(obj)
        if now.topology != self._built.topology:
            raise Outdated("{name} was edited while its parts were being found, so they were left aside. Find them again when "
                           "the mesh is as you want it.", name=mesh.name)
        for table in MeshTable.tables:
            table.remove_deleted()
        pending.pop(self._key, None)
        _sheet_counts.pop(self._key, None)
        registry.store(mesh, registry.HierarchyEntry(self._built, self._counts, built, open_surfaces=self._open_surfaces), now)
        self._hierarchy = built

    def is_outdated(self) -> bool:
        """Whether its mesh is gone, or is another one by now, be it only by places of vertices."""
        obj = _find_user(self._key)
        return obj is None or arrays.current_fingerprint(obj) != self._built


def _advance_queue() -> QueuedBuild | None:
    """The Build that has a worker; if none has, the one that has waited longest gets one. None if none waits."""
    return (next((each for each in _builds.values() if each.job and each.job.poll()), None)
            or next((each for each in list(_builds.values()) if not each.job and each.start_worker()), None))


def cancel_outdated() -> None:
    """Cancels those whose mesh is not there any more as it was."""
    for each in list(_builds.values()):
        if each.is_outdated():
            each.cancel()


def _find_user(wanted: int | str) -> bpy.types.Object | None:
    """An object with the mesh of this key, in Edit Mode if there is one such, or None."""
    users = [obj for obj in bpy.data.objects if obj.type == "MESH" and mesh_key(obj.data) == wanted]
    return next((obj for obj in users if obj.mode == "EDIT"), users[0] if users else None)


def is_refused_as_sheet(mesh: bpy.types.Mesh) -> bool:
    """Whether the last build refused the mesh for being a sheet, as far as the counts tell that it is the same."""
    return _sheet_counts.get(mesh_key(mesh)) == element_counts(mesh)


def cancel_all() -> None:
    """Cancels all."""
    for each in list(_builds.values()):
        each.cancel()
