# SPDX-License-Identifier: GPL-3.0-or-later
"""A run: files in, results in a folder, as many at a time as there are cores and as there is memory for."""

import collections
import os
import threading
import time
from pathlib import Path
from typing import NamedTuple, Optional

from . import lock
from .inputs import Input, of_shard, versions
from .slot import Slot
from .store import Store
from ..worker import available_memory

TICK = 0.1  # seconds between two looks at what runs
MEMORY_SHARE = 0.8  # of what is available when the run starts
# What a model is given at first: some times what reading and building took at most, in files of either kind.
NEED, NEED_PER_BYTE = 512 * 2**20, 120
UNIT = 200_000  # bytes of a file that cost as much time as beginning with it does


class Options(NamedTuple):
    """settings: as command.settings() gives them, they are part of each key. jobs: models at a time. memory: bytes for
    all of them, 0: no limit. seconds: of processor time a process, None: as Job and Slot have it. retry: names of
    failures that are to be tried again, or {"all"}. shard: (i, n). threads: a model."""

    settings: dict
    jobs: int
    memory: int
    seconds: Optional[float] = None
    retry: frozenset = frozenset()
    shard: tuple = (1, 1)
    threads: int = 1

    def to_retry(self, report):
        """Whether an old result is a failure that is to be tried again."""
        return report["error"] and bool({"all", report["error"]["name"]} & self.retry)

    def task(self, source, folder, memory):
        """What a Slot is asked to make of an Input in a folder, with so much memory."""
        return {"path": source.path, "folder": str(folder), "settings": self.settings, "memory": memory,
                "seconds": self.seconds, "size": source.size, "threads": self.threads}


class Counts(NamedTuple):
    """dropped: {what files have and no output: how many files}, see contents.KINDS. total: files. old: their results were there. made: in this run, failures among them. failed: {name: how many}, old
    ones too. same: files whose content another one has. skipped: those that changed while they were read. share: how
    much of the work is done, 0..1. seconds: since the start."""

    total: int
    old: int
    made: int
    failed: dict
    same: int
    skipped: int
    share: float
    seconds: float
    dropped: dict

    @property
    def left(self):
        """Seconds until the end, as far as can be told, or None."""
        return self.seconds / self.share - self.seconds if self.share > 0.005 else None


def cores():
    """That this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def memory():
    """Bytes that a run takes where it is not told: 80 % of what is available, to the system or to this job of a cluster."""
    return int(MEMORY_SHARE * min((each for each in (available_memory(), _group_memory()) if each), default=0))


def _group_memory():
    """What this process's control group (a container, a SLURM job) may still take, in bytes, 0 for all."""
    try:
        below = Path("/proc/self/cgroup").read_text().strip().rsplit(":", 1)[-1].lstrip("/")
        group = Path("/sys/fs/cgroup") / below
        return max(int((group / "memory.max").read_text()) - int((group / "memory.current").read_text()), 1)
    except (OSError, ValueError):  # none, another version of them, or "max"
        return 0


class Run:
    """One run over a shard's files. go() does it; stop() ends it from any thread or signal handler."""

    def __init__(self, folder, paths, options, slots=Slot):
        self.store = Store(folder, "{}-of-{}".format(*options.shard))
        self._options = options
        self._versions = versions(options.settings)
        paths = of_shard(paths, *options.shard)
        sizes = {path: _size(path) for path in paths}
        share = options.memory // options.jobs
        # Those that need more than their share come last: then nothing small waits for them.
        self._todo = collections.deque(sorted(paths, key=lambda path: _need(sizes[path]) > share))
        self._sizes, self._share_of_memory = sizes, share
        self._work = sum(map(_cost, sizes.values())) or 1
        self._done_work = 0
        self._again = collections.deque()  # inputs that had too little memory
        self._free, self._busy = options.memory, 0
        self._keys = set()  # that this run has begun
        self._old = self._made = self._same = self._skipped = 0
        self._failed, self._dropped = collections.Counter(), collections.Counter()
        self._change = threading.Condition()
        self._stopped, self._error = threading.Event(), None
        self._slots = [slots() for _ in range(options.jobs)]

    def go(self, progress=lambda counts: None):
        """Does it all; the Counts. progress: called with Counts some times a second. Raises lock.Busy, OSError, and what
        progress raises (KeyboardInterrupt): nothing is left half done then."""
        self._began = time.monotonic()
        name = "shard-{}-of-{}".format(*self._options.shard)
        with lock.Lock(self.store.folder / "locks", name) as held:
            self._no_other_division()
            self.store.begin()
            threads = [threading.Thread(target=self._serve, args=[slot], daemon=True) for slot in self._slots]
            try:
                for thread in threads:
                    thread.start()
                while any(thread.is_alive() for thread in threads) and not self._stopped.is_set():
                    for slot in self._slots:
                        slot.watch()
                    if held.lost:
                        raise lock.Busy(f"{self.store.folder} was taken over by another run while this one slept.")
                    progress(self.counts())
                    with self._change:
                        self._change.wait(TICK)
            finally:
                self.stop()
                for thread in threads:
                    if thread.ident:
                        thread.join()
                if not held.lost:
                    self.store.end()
        if self._error:
            raise self._error
        return self.counts()

    def stop(self):
        """What runs is killed; what is done stays."""
        self._stopped.set()
        for slot in self._slots:
            slot.close()

    def counts(self):
        return Counts(len(self._sizes), self._old, self._made, dict(self._failed), self._same, self._skipped,
                      self._done_work / self._work, time.monotonic() - self._began, dict(self._dropped))

    def _no_other_division(self):
        """Raises lock.Busy where the folder is being worked on in another number of shards. Asked with our own lock
        held: of two that begin at once, one sees the other."""
        ours = "-of-{}".format(self._options.shard[1])
        others = {name for name in lock.living(self.store.folder / "locks", "shard-") if not name.endswith(ours)}
        if others:
            raise lock.Busy(f"{self.store.folder} is being worked on in another number of shards: "
                            f"{', '.join(sorted(others))}.")

    # ---- In a thread for each slot

    def _serve(self, slot):
        try:
            while not self._stopped.is_set():
                with self._change:
                    if self._todo:
                        path, again = self._todo.popleft(), None
                    elif self._again:
                        path, again = None, self._again.popleft()
                    elif self._busy:
                        self._change.wait(TICK)  # what runs may have to be done again
                        continue
                    else:
                        return
                    self._busy += 1
                try:
                    self._one(slot, again or self._input(path), bool(again))
                finally:
                    with self._change:
                        self._busy -= 1
                        self._change.notify_all()
        except Exception as error:  # a full disk, for instance: go() raises it
            with self._change:
                if not self._stopped.is_set():
                    self._error = error
                self._stopped.set()
                self._change.notify_all()

    def _input(self, path):
        return Input(path, self._options.settings, self._versions, self._stopped.is_set)

    def _one(self, slot, source, again):
        if self._stopped.is_set():
            return
        if not again:
            with self._change:
                same = source.key in self._keys
                self._keys.add(source.key)
                self.store.note(source.path, source.key)
            if same:
                self._count(source, "_same")
                return
            old = self.store.report(source.key)
            if old and not self._options.to_retry(old):
                self._count(source, "_old", old)
                return
        beside = self.store.beside(source.key)
        if source.error:
            answer, all_memory = {"error": {"name": "file", "message": source.error}}, True
        else:
            answer, all_memory = self._made_in(slot, source, beside, again)
        if self._stopped.is_set():  # it was killed, perhaps
            self.store.discard(beside)
            return
        error = answer.get("error")
        if error:
            pictured = answer.pop("pictured", False)
            if not pictured:
                self.store.discard(beside)
            if error["name"] == "memory" and not all_memory:
                with self._change:
                    self._again.append(source)  # later, with all memory
                self.store.discard(beside)
                return
            if not pictured:
                beside = self.store.beside(source.key)
        if source.changed():
            self.store.discard(beside)
            self._count(source, "_skipped")
            return
        report = {**source.report(), **answer}
        with self._change:
            if (old := self.store.report(source.key)) and old["error"]:
                self.store.withdraw(source.key)  # it was tried again
            self.store.publish(beside, source.key, report)
        self._count(source, "_made", report)

    def _made_in(self, slot, source, beside, again):
        """(the slot's answer, whether it had all the memory that any may have)"""
        most = self._options.memory
        granted = most if again else min(max(self._share_of_memory, _need(source.size)), most)
        with self._change:
            while most and granted > self._free and not self._stopped.is_set():
                self._change.wait(TICK)
            self._free -= granted
        try:
            if self._stopped.is_set():
                return {}, True
            return slot.make(self._options.task(source, beside, granted)), granted == most
        finally:
            with self._change:
                self._free += granted
                self._change.notify_all()

    def _count(self, source, what, report=None):
        with self._change:
            setattr(self, what, getattr(self, what) + 1)
            if report:
                self._dropped.update(report.get("dropped", ()))
            if report and report["error"]:
                self._failed[report["error"]["name"]] += 1
            self._done_work += _cost(self._sizes[source.path])


def _size(path):
    try:
        return os.stat(path).st_size
    except OSError:
        return 0


def _cost(size):
    return size + UNIT


def _need(size):
    return NEED + NEED_PER_BYTE * size
