# SPDX-License-Identifier: GPL-3.0-or-later
"""The queue of builds. One build runs at a time, in a worker process."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np

from ..mesh import Fingerprint, MeshSnapshot, arrays, element_counts
from ..mesh.errors import UserError
from ..mesh.marks import collect_marks
from ..mesh.mesh_state import mesh_key
from ..preferences import preferences
from . import registry
from ..translations.lookup import rpt_
from partwheel import Hierarchy, Mode, PartwheelError, Status
from partwheel.library import load
from partwheel.marks import find_face_pairs, marks_of_labels
from partwheel.worker import WAIT_SECONDS, Job, available_memory

_builds = {}  # builds that have not ended, by mesh_key, in the order of their requests


class Outdated(UserError):
    """A build ended, but its mesh is gone or has changed."""


def is_being_built(snapshot: MeshSnapshot) -> bool:
    """Return whether a build of the current mesh runs or waits."""
    build = _builds.get(snapshot.state.key)
    return build is not None and build.matches(snapshot.fingerprint)


def request_build(snapshot: MeshSnapshot, **options: object) -> QueuedBuild:
    """Return the QueuedBuild of the mesh: the current one, or a new one. options: of QueuedBuild. Without options, any
    build of the unchanged mesh is current. A build that is not current is canceled and replaced."""
    earlier_build = _builds.get(snapshot.state.key)
    if earlier_build:
        if earlier_build.matches(snapshot.fingerprint, options):
            return earlier_build
        earlier_build.cancel()
    return QueuedBuild(snapshot, **options)


class QueuedBuild:
    """A build of a mesh in a worker process. It starts after those that were requested earlier.

    It neither changes nor locks the mesh. request_build() creates one per mesh. Call its methods from the main thread
    only."""

    def __init__(self, snapshot: MeshSnapshot, quality: float = 0.0,
                 mode: Mode | None = None, cpu_limit: float | None = None, memory_limit: int | None = None,
                 full_resolution: bool | None = None, labels: bytes | None = None) -> None:
        """Queue the build. The options are those of partwheel.worker.Job. None: as in the preferences. labels: of the
        faces, (F,) int32; no part crosses their borders. Bytes, so that requests can be compared."""
        load()  # reports a missing library early
        mesh, self._fingerprint = snapshot.mesh, snapshot.fingerprint
        self.name, self._key, self._counts = mesh.name, snapshot.state.key, element_counts(mesh)
        self._mode = Mode[preferences().parts] if mode is None else mode
        self._full_resolution = preferences().full_resolution if full_resolution is None else full_resolution
        self._options = {"quality": quality, "full_resolution": full_resolution, "mode": mode, "cpu_limit": cpu_limit,
                         "memory_limit": memory_limit, "labels": labels}
        self._surface = arrays.read_surface(mesh)
        self._marks = collect_marks(snapshot.obj, self._surface)
        if labels:
            pairs = find_face_pairs(*self._surface[:3])
            self._marks.append(marks_of_labels(pairs, np.frombuffer(labels, np.int32), "labels", chosen=True))
        self._hierarchy = self._error = None
        self._canceled = False
        self.job = None  # set by start_worker()
        _builds[self._key] = self
        _advance_queue()

    def matches(self, fingerprint: Fingerprint, options: dict | None = None) -> bool:
        """Return whether this build answers a request for a mesh with this fingerprint, with these options if any."""
        return fingerprint.topology == self._fingerprint.topology and (
            not options or fingerprint == self._fingerprint and self._options == {**self._options, **options})

    def start_worker(self) -> bool:
        memory_fraction, options = preferences().memory_share / 100, self._options
        try:
            self.job = Job(*self._surface, quality=options["quality"],
                           full_resolution=self._full_resolution, mode=self._mode, marks=self._marks,
                           memory_limit=options["memory_limit"] or int(memory_fraction * available_memory()),
                           cpu_limit=options["cpu_limit"] or 60 * preferences().cpu_limit or None,
                           python=bpy.path.abspath(preferences().python))
        except Exception as error:  # any error: result() raises it
            self._error = error
            self._remove_from_queue()
        return self.job is not None

    def poll(self) -> tuple[float, str] | None:
        """Return (fraction, description), or None once result() won't block. fraction: 0 to 1, monotone. description:
        of the stage, or, while this build waits, the name of the mesh whose build runs."""
        running = _advance_queue()
        if self.job:
            return self.job.poll()
        return None if self._canceled or self._error else (0.0, running.name)

    def wait(self, seconds: float) -> bool:
        """Wait at most this many seconds and return whether result() won't block."""
        if self.poll() and (running := self if self.job else _advance_queue()):
            running.job.wait(seconds)
        return self.poll() is None

    def cancel(self) -> None:
        """Remove the build from the queue and kill its worker. result() then raises PartwheelError with status
        CANCELED, even if the worker has already sent the hierarchy: the effect of Esc must not depend on which was
        faster."""
        self._canceled = True
        self._remove_from_queue()
        if self.job:
            self.job.cancel()

    def _remove_from_queue(self) -> None:
        if _builds.get(self._key) is self:
            del _builds[self._key]

    def result(self, progress: Callable[[float, str], object] | None = None) -> Hierarchy:
        """Wait for the end, store the hierarchy for the mesh, which nothing else does, and return it. May be called
        repeatedly. progress: called as progress(fraction, description) ten times a second; it returns True to cancel.
        Raises PartwheelError, or Outdated if the mesh was edited or deleted in the meantime."""
        try:
            while status := self.poll():
                if progress and progress(*status):
                    self.cancel()
                self.wait(WAIT_SECONDS)
        except BaseException:  # raised by progress(), or Ctrl-C
            self.cancel()
            raise
        self._remove_from_queue()
        if self._canceled:
            raise PartwheelError(Status.CANCELED, rpt_("The build was canceled."))
        if self._error:
            raise self._error
        if not self._hierarchy:
            self._store(self.job.result())
        return self._hierarchy

    def _store(self, hierarchy: Hierarchy) -> None:
        obj = _find_user(self._key)
        if obj is None:
            raise Outdated("The mesh {name} was deleted, so its parts were discarded.", name=self.name)
        snapshot, mesh = MeshSnapshot(obj), obj.data
        if snapshot.fingerprint.topology != self._fingerprint.topology:
            raise Outdated("{name} was edited while its parts were being found, so they were discarded. Find them "
                           "again after editing.", name=mesh.name)
        registry.forget_deleted()
        snapshot.state.stored = None
        registry.end_clearing(mesh)
        entry = registry.HierarchyEntry(self._fingerprint, self._counts, hierarchy)
        registry.store(snapshot.state, entry, snapshot.fingerprint)
        entry.update_own_parts(mesh, snapshot.state)
        self._hierarchy = entry.hierarchy

    def is_outdated(self) -> bool:
        """Return whether the mesh is gone or has changed, including moved vertices."""
        obj = _find_user(self._key)
        return obj is None or MeshSnapshot(obj).fingerprint != self._fingerprint


def _advance_queue() -> QueuedBuild | None:
    """Return the build that runs, after starting the oldest one if none runs. None if the queue is empty."""
    return (next((build for build in _builds.values() if build.job and build.job.poll()), None)
            or next((build for build in list(_builds.values()) if not build.job and build.start_worker()), None))


def cancel_outdated() -> None:
    """Cancel the builds whose mesh is gone or has changed."""
    for build in list(_builds.values()):
        if build.is_outdated():
            build.cancel()


def _find_user(key: int | str) -> bpy.types.Object | None:
    """Return an object with the mesh of this key, one in Edit Mode if possible, or None."""
    users = [obj for obj in bpy.data.objects if obj.type == "MESH" and mesh_key(obj.data) == key]
    return next((obj for obj in users if obj.mode == "EDIT"), users[0] if users else None)


def cancel_all() -> None:
    for build in list(_builds.values()):
        build.cancel()
