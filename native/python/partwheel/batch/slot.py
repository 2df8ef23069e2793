# SPDX-License-Identifier: GPL-3.0-or-later
"""A process that makes one model after the other, and the handle by which a run holds it.

What a file does to its reader (a crash, all memory taken, no end) this process alone suffers; the mesher is in one more
of its own, see worker. A line of JSON a model goes in by standard input, and one comes out by standard output.
"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

from ..worker.exit_status import describe_exit

MEGABYTE = 2**20
# For reading and writing, of processor time, where the user sets no limit: many times what any file takes.
SECONDS, SECONDS_PER_MEGABYTE = 120, 20
PATIENCE = 10  # times the limit, by the clock: for one that waits for ever, on a machine however busy
KEPT = 512 * MEGABYTE  # a process that holds more after a model makes place for a new one
ENTRY = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); from partwheel.batch.slot import main; main()"


class Slot:
    """The handle. One thread asks, any may kill."""

    def __init__(self):
        self._process, self._late, self._closed = None, False, False
        self._deadline = float("inf")
        self._lock = threading.Lock()  # for the process

    def make(self, task):
        """The answer to {"path", "folder", "settings", "memory", "seconds", "size", "threads"}, as for model.make() but
        size, the file's bytes: what it returns, or {"error": {"name", "message"}, "pictured": whether preview.png
        was made all the same}; and "processor_seconds", all processes' together."""
        process, self._late = self._started(), False
        limit = task["seconds"] or SECONDS + SECONDS_PER_MEGABYTE * task["size"] / MEGABYTE
        self._deadline = time.monotonic() + PATIENCE * limit
        try:
            process.stdin.write(json.dumps({**task, "limit": limit}).encode() + b"\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except OSError:
            line = b""  # it has ended: told below
        self._deadline = float("inf")
        if line.endswith(b"\n"):
            answer = json.loads(line)
            if answer.pop("resident") > KEPT:
                self.kill()
            return answer
        self.kill()
        process.wait()  # or another thread has killed it
        if self._late or process.returncode == -getattr(signal, "SIGXCPU", 24):
            return {"error": {"name": "time limit",
                              "message": f"Reading it, or writing what was made of it, took more than {limit:g} seconds."}}
        return {"error": {"name": "crash", "message": f"The process that read the file {describe_exit(process.returncode)}."}}

    def watch(self):
        """To be called now and then: kills a process that waits for ever."""
        if time.monotonic() > self._deadline:
            self._late = True
            self.kill()

    def _started(self):
        with self._lock:
            if self._closed:
                raise OSError(0, "The run was stopped")
            if self._process is None:
                # Its own session: a Ctrl-C in the terminal is the run's alone. One thread: cores are shared by models.
                self._process = subprocess.Popen(
                    [sys.executable, "-B", "-c", ENTRY, json.dumps([path or os.getcwd() for path in sys.path])],
                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True,
                    env={**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"})
            return self._process

    def close(self):
        """Ends the process; none is started any more."""
        with self._lock:
            self._closed = True
        self.kill()

    def kill(self):
        """Ends the process and what it has started."""
        with self._lock:
            process, self._process = self._process, None
        if process is None:
            return
        try:
            os.killpg(process.pid, signal.SIGKILL) if hasattr(os, "killpg") else process.kill()
        except ProcessLookupError:
            pass  # it has ended by itself
        process.wait()


# ---- In the process ------------------------------------------------------------------------------------------------


def main():
    parent = os.getppid()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a reader prints must not get between the answers
    _end_with_parent(parent)
    from .model import make  # with numpy, once for all models

    base = _data()
    for line in sys.stdin.buffer:
        task = json.loads(line)
        _limit(base, task)
        before = sum(os.times()[:4])  # with that of the worker processes that have ended
        try:
            memory = task["memory"] and max(task["memory"] - (_data() - base), 64 * MEGABYTE)
            answer = make(task["path"], Path(task["folder"]), task["settings"], memory=memory, seconds=task["seconds"],
                          threads=task["threads"])
        except Exception as error:  # whatever it is, it is this model's result
            answer = {"error": _told(error, task), "pictured": bool(getattr(error, "pictured", False))}
        answer["processor_seconds"] = round(sum(os.times()[:4]) - before, 2)
        answer["resident"] = _resident()
        answers.write(json.dumps(answer).encode() + b"\n")
        answers.flush()


def _told(error, task):
    from ..library import Error

    if isinstance(error, MemoryError):
        return {"name": "memory", "message": f"It needs more than {task['memory'] / MEGABYTE:.0f} MB of memory."}
    if isinstance(error, Error):
        return {"name": error.name, "message": str(error)}
    if isinstance(error, OSError):
        return {"name": "file", "message": f"{error.strerror or error}: {error.filename or task['path']}"}
    return {"name": "defect", "message": f"{type(error).__name__}: {error}"}


def _end_with_parent(parent):
    if sys.platform == "linux":
        import ctypes
        set_parent_death_signal = 1
        ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:
            os._exit(1)


def _limit(base, task):
    """Memory for data and processor time from here on, as far as the system keeps such limits."""
    try:
        import resource
    except ImportError:  # Windows
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    usage = resource.getrusage(resource.RUSAGE_SELF)
    _lower(resource, resource.RLIMIT_CPU, int(usage.ru_utime + usage.ru_stime + task["limit"]) + 1)
    if sys.platform == "linux":
        _lower(resource, resource.RLIMIT_DATA, base + task["memory"] if task["memory"] else resource.RLIM_INFINITY)


def _lower(resource, kind, value):
    _, most = resource.getrlimit(kind)
    if most != resource.RLIM_INFINITY:
        value = most if value == resource.RLIM_INFINITY else min(value, most)
    resource.setrlimit(kind, (value, most))


def _data():
    """Bytes of memory for data, as RLIMIT_DATA counts them; 0 where the system does not tell."""
    return memory("VmData")


def _resident():
    return memory("VmRSS")


def memory(name):
    """A number of bytes that Linux tells of this process; 0 where the system does not tell."""
    try:
        with open("/proc/self/status", encoding="ascii") as lines:
            return next(int(line.split()[1]) * 1024 for line in lines if line.startswith(name + ":"))
    except (OSError, StopIteration):
        return 0
