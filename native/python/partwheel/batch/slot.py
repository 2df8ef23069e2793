# SPDX-License-Identifier: GPL-3.0-or-later
"""A process that builds one model after another, and the run's handle to it.

If a file makes its reader crash, hang or run out of memory, only this process is affected; the native build runs in yet
another process, see worker. For each model, one line of JSON goes to standard input and one comes from standard output.
"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any, Dict, Optional

from ..limits import die_with_parent, limit_memory, limit_processor_time
from ..worker import read_memory
from ..worker.exit_status import describe_exit

MEGABYTE = 2**20
# The default limit on processor time for reading and writing: many times what any file takes.
CPU_SECONDS, CPU_SECONDS_PER_MEGABYTE = 120, 20
WALL_CLOCK_FACTOR = 10  # wall-clock limit / processor time limit: for a process that waits forever, on a busy machine
MAX_RESIDENT_BYTES = 512 * MEGABYTE  # a process that holds more after a model is replaced by a new one
ENTRY = "import json, sys; sys.path[:] = json.loads(sys.argv[1]); from partwheel.batch.slot import main; main()"


class Slot:
    """The handle. One thread calls build(); any thread may call the other methods."""

    def __init__(self) -> None:
        self._process: Optional[subprocess.Popen[bytes]] = None
        self._is_overdue, self._is_closed = False, False
        self._deadline = float("inf")
        self._lock = threading.Lock()  # for the process

    def build(self, task: Dict[str, Any]) -> Dict[str, Any]:
        """Builds a model in the process: the report of model.build_model(), or {"error": {"name", "message"}, "has_preview"};
        and "processor_seconds", of all processes together.

        task : {"path", "folder", "settings", "memory", "seconds", "threads"}, see model.build_model(), and "size", that of
            the file in bytes"""
        process, self._is_overdue = self._ensure_process(), False
        assert process.stdin and process.stdout
        limit = task["seconds"] or CPU_SECONDS + CPU_SECONDS_PER_MEGABYTE * task["size"] / MEGABYTE
        self._deadline = time.monotonic() + WALL_CLOCK_FACTOR * limit
        try:
            process.stdin.write(json.dumps({**task, "limit": limit}).encode() + b"\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except OSError:
            line = b""  # the process has ended; reported below
        self._deadline = float("inf")
        if line.endswith(b"\n"):
            answer = json.loads(line)
            if answer.pop("resident") > MAX_RESIDENT_BYTES:
                self.kill()
            return answer
        self.kill()
        process.wait()  # another thread may have killed it
        if self._is_overdue or process.returncode == -getattr(signal, "SIGXCPU", 24):
            return {"error": {"name": "time limit",
                              "message": f"Reading the file or writing the results took more than {limit:g} seconds."}}
        ending = describe_exit(process.returncode)
        return {"error": {"name": "crash", "message": f"The process that read the file {ending}."}}

    def enforce_deadline(self) -> None:
        """Kills a process that exceeds its wall-clock limit. Call it regularly."""
        if time.monotonic() > self._deadline:
            self._is_overdue = True
            self.kill()

    def _ensure_process(self) -> subprocess.Popen[bytes]:
        with self._lock:
            if self._is_closed:
                raise OSError(0, "The run was stopped")
            if self._process is None:
                # A new session: only the run receives Ctrl-C. One thread for numpy: the models share the cores.
                self._process = subprocess.Popen(
                    [sys.executable, "-B", "-c", ENTRY, json.dumps([path or os.getcwd() for path in sys.path])],
                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True,
                    env={**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"})
            return self._process

    def close(self) -> None:
        """Kills the process and prevents new ones."""
        with self._lock:
            self._is_closed = True
        self.kill()

    def kill(self) -> None:
        """Kills the process and its children."""
        with self._lock:
            process, self._process = self._process, None
        if process is None:
            return
        with suppress(ProcessLookupError):  # it has ended
            os.killpg(process.pid, signal.SIGKILL) if hasattr(os, "killpg") else process.kill()
        process.wait()


# ---- In the process ------------------------------------------------------------------------------------------------


def main() -> None:
    """Builds models until standard input ends."""
    parent = os.getppid()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a reader prints to standard output must not mix with the answers
    die_with_parent()
    if os.getppid() != parent:
        os._exit(1)
    from .model import build_model  # imports numpy once for all models

    base = read_memory("VmData")
    for line in sys.stdin.buffer:
        task = json.loads(line)
        limit_processor_time(task["limit"])
        limit_memory(task["memory"] and base + task["memory"])
        before = sum(os.times()[:4])  # includes worker processes that have ended
        try:
            memory = task["memory"] and max(task["memory"] - (read_memory("VmData") - base), 64 * MEGABYTE)
            answer = build_model(task["path"], Path(task["folder"]), task["settings"], memory=memory,
                                 seconds=task["seconds"], threads=task["threads"])
        except Exception as error:  # any error is this model's result
            answer = {"error": _error_report(error, task), "has_preview": bool(getattr(error, "has_preview", False))}
        answer["processor_seconds"] = round(sum(os.times()[:4]) - before, 2)
        answer["resident"] = read_memory("VmRSS")
        answers.write(json.dumps(answer).encode() + b"\n")
        answers.flush()


def _error_report(error: Exception, task: Dict[str, Any]) -> Dict[str, str]:
    """{"name", "message"} of an error."""
    from ..library import Error

    if isinstance(error, MemoryError):
        return {"name": "memory", "message": f"It needs more than {task['memory'] / MEGABYTE:.0f} MB of memory."}
    if isinstance(error, Error):
        return {"name": error.name, "message": str(error)}
    if isinstance(error, OSError):
        return {"name": "file", "message": f"{error.strerror or error}: {error.filename or task['path']}"}
    return {"name": "defect", "message": f"{type(error).__name__}: {error}"}
