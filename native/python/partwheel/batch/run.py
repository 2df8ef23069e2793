# SPDX-License-Identifier: GPL-3.0-or-later
"""A run: builds files into a folder of results, in parallel as far as cores and memory allow."""

import collections
import os
import threading
import time
from pathlib import Path
from typing import Any, Callable, Deque, Dict, FrozenSet, List, NamedTuple, Optional, Set, Tuple, Union

from . import lock
from .inputs import Input, tool_versions
from .slot import Slot
from .store import Store
from ..worker import available_memory

POLL_SECONDS = 0.1  # between two checks of the slots
MEMORY_FRACTION = 0.8  # of what is available when the run starts
# Memory that a model gets on the first attempt, in bytes and bytes per byte of its file: several times the most that
# reading and building took, in text and binary formats.
BASE_MEMORY, MEMORY_PER_BYTE = 512 * 2**20, 120
FILE_OVERHEAD = 200_000  # the fixed cost of a file, as the number of bytes that take as long


class BatchOptions(NamedTuple):
    """Options of a run."""

    settings: Dict[str, Any]  # see command.settings(); part of each key
    jobs: int  # number of models that are built at once
    memory: int  # bytes for all models that are built at once; 0: no limit
    seconds: Optional[float] = None  # limit on processor time per process; None: the defaults of Job and Slot
    retry: FrozenSet[str] = frozenset()  # names of errors after which a model is built again, or {"all"}
    shard: Tuple[int, int] = (1, 1)  # (index, count), 1 <= index <= count
    threads: int = 1  # per model

    def should_retry(self, report: Dict[str, Any]) -> bool:
        """Whether an existing result is an error after which to build the model again."""
        return bool(report["error"]) and bool({"all", report["error"]["name"]} & self.retry)

    def task(self, source: Input, folder: Path, memory: int) -> Dict[str, Any]:
        """The task for Slot.build(). folder : an empty one for the results; memory : limit in bytes; 0: no limit"""
        return {"path": source.path, "folder": str(folder), "settings": self.settings, "memory": memory,
                "seconds": self.seconds, "size": source.size, "threads": self.threads}


class Counts(NamedTuple):
    """Progress and totals of a run; partwheel batch --json prints them."""

    total: int  # number of files
    existing: int  # files that already had a result
    built: int  # files built by this run, including failures
    failed: Dict[str, int]  # {error name: number of files}, including existing results
    duplicates: int  # files with the content of another file
    changed: int  # files that changed while they were read
    fraction: float  # of the work done, 0..1
    seconds: float  # since the start
    dropped: Dict[str, int]  # {kind, see contents.KINDS: number of files that have it}; no output has it

    @property
    def seconds_left(self) -> Optional[float]:
        """Estimated seconds until the end; None at the beginning."""
        return self.seconds / self.fraction - self.seconds if self.fraction > 0.005 else None


def available_cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def default_memory() -> int:
    """The default memory of a run in bytes: 80 % of what is available to the system and to this process's control
    group."""
    return int(MEMORY_FRACTION * min((size for size in (available_memory(), _cgroup_memory()) if size), default=0))


def _cgroup_memory() -> int:
    """Bytes that this process's control group (a container, a SLURM job) may still use; 0: no limit."""
    try:
        name = Path("/proc/self/cgroup").read_text().strip().rsplit(":", 1)[-1].lstrip("/")
        group = Path("/sys/fs/cgroup") / name
        return max(int((group / "memory.max").read_text()) - int((group / "memory.current").read_text()), 1)
    except (OSError, ValueError):  # no control group, version 1, or "max"
        return 0


class BatchRun:
    """One run over the files of a shard. create_slot : creates a Slot; for tests"""

    def __init__(self, folder: Union[str, Path], paths: List[str], options: BatchOptions,
                 create_slot: Callable[[], Slot] = Slot) -> None:
        self.store = Store(folder, "{}-of-{}".format(*options.shard))
        self._options = options
        self._versions = tool_versions(options.settings)
        self._sizes = {path: _file_size(path) for path in paths}
        self._memory_share = options.memory // options.jobs
        # Files that need more than their share come last, so that no small file waits for them.
        self._queue: Deque[str] = collections.deque(
            sorted(paths, key=lambda path: _memory_estimate(self._sizes[path]) > self._memory_share))
        self._total_cost = sum(map(_cost, self._sizes.values())) or 1
        self._finished_cost = 0
        self._retries: Deque[Input] = collections.deque()  # ran out of memory; built again with all of it
        self._free_memory, self._busy_slots = options.memory, 0
        self._keys: Set[str] = set()  # of the files that this run has started
        self._counts: collections.Counter[str] = collections.Counter()  # by the names of Counts
        self._failed: collections.Counter[str] = collections.Counter()
        self._dropped: collections.Counter[str] = collections.Counter()
        self._condition = threading.Condition()  # guards all of the above
        self._stopped = threading.Event()
        self._error: Optional[Exception] = None
        self._slots = [create_slot() for _ in range(options.jobs)]

    def run(self, progress: Callable[[Counts], None] = lambda counts: None) -> Counts:
        """Builds all files. Raises OSError, or FolderInUseError if another run uses the folder.

        progress : called about ten times a second; if it raises (KeyboardInterrupt), the run stops and leaves no partial
            result"""
        self._start_time = time.monotonic()
        name = "shard-{}-of-{}".format(*self._options.shard)
        with lock.Lock(self.store.folder / "locks", name) as folder_lock:
            self._check_shard_count()
            self.store.begin()
            threads = [threading.Thread(target=self._serve, args=[slot], daemon=True) for slot in self._slots]
            try:
                for thread in threads:
                    thread.start()
                while any(thread.is_alive() for thread in threads) and not self._stopped.is_set():
                    for slot in self._slots:
                        slot.enforce_deadline()
                    if folder_lock.is_lost:
                        raise lock.FolderInUseError(
                            f"Another run took over {self.store.folder} while this one was suspended.")
                    progress(self.counts())
                    with self._condition:
                        self._condition.wait(POLL_SECONDS)
            finally:
                self.stop()
                for thread in threads:
                    if thread.ident:
                        thread.join()
                if not folder_lock.is_lost:
                    self.store.end()
        if self._error:
            raise self._error
        return self.counts()

    def stop(self) -> None:
        """Kills the running processes; finished results remain. Call it from any thread or signal handler."""
        self._stopped.set()
        for slot in self._slots:
            slot.close()

    def counts(self) -> Counts:
        """Progress so far."""
        existing, built, duplicates, changed = (self._counts[name] for name in ("existing", "built", "duplicates", "changed"))
        return Counts(len(self._sizes), existing, built, dict(self._failed), duplicates, changed,
                      self._finished_cost / self._total_cost, time.monotonic() - self._start_time, dict(self._dropped))

    def _check_shard_count(self) -> None:
        """Raises FolderInUseError if a run with another number of shards uses the folder. Called with this run's lock
        held, so that of two runs that start at the same time at least one sees the other."""
        suffix = "-of-{}".format(self._options.shard[1])
        conflicting = {name for name in lock.held_locks(self.store.folder / "locks") if not name.endswith(suffix)}
        if conflicting:
            raise lock.FolderInUseError(f"Runs with another number of shards use {self.store.folder}: "
                                        f"{', '.join(sorted(conflicting))}. Wait until they end, or use the same number.")

    # ---- In a thread for each slot

    def _serve(self, slot: Slot) -> None:
        """Builds files from the queue until it is empty."""
        try:
            while not self._stopped.is_set():
                path, retry = None, None
                with self._condition:
                    if self._queue:
                        path = self._queue.popleft()
                    elif self._retries:
                        retry = self._retries.popleft()
                    elif self._busy_slots:
                        self._condition.wait(POLL_SECONDS)  # a running model may have to be built again
                        continue
                    else:
                        return
                    self._busy_slots += 1
                try:
                    if retry:
                        self._process(slot, retry, True)
                    elif path is not None:
                        source = Input(path, self._options.settings, self._versions, self._stopped.is_set)
                        self._process(slot, source, False)
                finally:
                    with self._condition:
                        self._busy_slots -= 1
                        self._condition.notify_all()
        except Exception as error:  # a full disk, for example; run() raises it
            with self._condition:
                if not self._stopped.is_set():
                    self._error = error
                self._stopped.set()
                self._condition.notify_all()

    def _process(self, slot: Slot, source: Input, is_retry: bool) -> None:
        """Builds an input unless its result exists, and publishes the result."""
        if self._stopped.is_set():
            return
        if not is_retry:
            with self._condition:
                is_duplicate = source.key in self._keys
                self._keys.add(source.key)
                self.store.add_input(source.path, source.key)
            if is_duplicate:
                self._count(source, "duplicates")
                return
            existing = self.store.report(source.key)
            if existing and not self._options.should_retry(existing):
                self._count(source, "existing", existing)
                return
        folder = self.store.create_folder(source.key)
        if source.error:
            answer: Dict[str, Any] = {"error": {"name": "file", "message": source.error}}
            had_all_memory = True
        else:
            answer, had_all_memory = self._build(slot, source, folder, is_retry)
        if self._stopped.is_set():  # the process may have been killed
            self.store.discard(folder)
            return
        if error := answer.get("error"):
            if error["name"] == "memory" and not had_all_memory:
                self.store.discard(folder)
                with self._condition:
                    self._retries.append(source)
                return
            if not answer.pop("has_preview", False):  # what else was written before the error
                self.store.discard(folder)
                folder = self.store.create_folder(source.key)
        if source.has_changed():
            self.store.discard(folder)
            self._count(source, "changed")
            return
        report = {**source.report(), **answer}
        with self._condition:
            if (existing := self.store.report(source.key)) and existing["error"]:
                self.store.remove(source.key)  # the error of an earlier attempt
            self.store.publish(folder, source.key, report)
        self._count(source, "built", report)

    def _build(self, slot: Slot, source: Input, folder: Path, is_retry: bool) -> Tuple[Dict[str, Any], bool]:
        """(the slot's answer, whether it had all of the run's memory). Waits until enough memory is free."""
        total = self._options.memory
        granted = total if is_retry else min(max(self._memory_share, _memory_estimate(source.size)), total)
        with self._condition:
            while total and granted > self._free_memory and not self._stopped.is_set():
                self._condition.wait(POLL_SECONDS)
            self._free_memory -= granted
        try:
            if self._stopped.is_set():
                return {}, True
            return slot.build(self._options.task(source, folder, granted)), granted == total
        finally:
            with self._condition:
                self._free_memory += granted
                self._condition.notify_all()

    def _count(self, source: Input, name: str, report: Optional[Dict[str, Any]] = None) -> None:
        """Counts a finished file. name : of the number in Counts"""
        with self._condition:
            self._counts[name] += 1
            if report:
                self._dropped.update(report.get("dropped", ()))
            if report and report["error"]:
                self._failed[report["error"]["name"]] += 1
            self._finished_cost += _cost(self._sizes[source.path])


def _file_size(path: str) -> int:
    try:
        return os.stat(path).st_size
    except OSError:
        return 0


def _cost(size: int) -> int:
    """The expected time of a file of this size, in bytes."""
    return size + FILE_OVERHEAD


def _memory_estimate(size: int) -> int:
    """Bytes of memory for a file of this size on the first attempt."""
    return BASE_MEMORY + MEMORY_PER_BYTE * size
