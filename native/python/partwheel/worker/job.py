# SPDX-License-Identifier: GPL-3.0-or-later
"""Job: a build in a process of its own, so that nothing the native library does can harm this one.

Everything goes through two pipes, so no file and no shared memory can be left behind; and the end of a pipe tells each
side that the other has died. The other side is process.py.
"""

import json
import struct
import subprocess
import threading
import time
from pathlib import Path

from . import interpreter
from .ending import ending
from .said import Said
from ..hierarchy import Hierarchy, checked_surface
from ..library import RUNGS, Mode, NonCopyable, PartwheelError, Rung, Status, load

ENTRY = Path(__file__).with_name("process.py")
MEMORY_SHARE = 0.8  # of the memory that is available when the build starts
# Some fifty times what an ordinary build takes: only what would never end should meet this limit.
SECONDS, SECONDS_PER_TRIANGLE = 120, 0.002
WATCH_SECONDS = 0.1  # between two looks at what the worker has taken
# One wait of result(), which has several: a Ctrl-C that comes just before a wait without end would not be noticed in it.
WAIT_SECONDS = 0.1
SEARCH_SECONDS = 0.01  # between two looks whether a Python was found
# A message to or from the worker: kind, length, then so many bytes.
MESSAGE = struct.Struct("<cQ")

# What it says, see Said.
CANCELLED = "The build was cancelled."
HARMLESS = "Nothing else was harmed; the mesh is as it was."
LATE = "The build was not done after {seconds} seconds of work and was stopped."
IDLE = "The build was not done after {seconds} seconds without any work and was stopped."
FASTER = "A mesh with fewer faces (Decimate, or a voxel remesh) is faster."
FULL = "The worker process ran out of memory."
LIMIT = "It may use {size:.1f} GiB."
LESS = "A mesh with fewer faces (Decimate, or a voxel remesh) needs less."
BROKEN = "The worker process {how} before it was done."
MENDED = "Merging vertices by distance, or a voxel remesh, often helps."
DAMAGED = "The worker process gave a damaged answer."
DAMAGED_BY = "The worker process gave a damaged answer: {reason}"
OTHER = "The worker process gave the answer to another mesh."
NO_PYTHON = "There is no Python to run the worker process: {reason}."
NO_START = "The worker process could not be started: {reason}."
SILENT = "The worker process did not begin in {seconds} seconds."
GONE = "The worker process {how} before it began."
WHICH = "If it stays so, say which Python 3 is to run it: Python in the add-on's preferences, or the argument python."


class WorkerError(PartwheelError):
    """The worker process ended, or had to be ended, without an answer. status: Status.INTERNAL, or Status.MEMORY.
    name: "crash", "time limit", "memory", or "worker" when it could not even be started.
    sentences, values: as of a Said."""

    def __init__(self, name, *sentences, **values):
        said = Said(*sentences, **values)
        super().__init__(Status.MEMORY if name == "memory" else Status.INTERNAL, str(said))
        self.name, self.sentences, self.values = name, said.sentences, said.values


class Job(NonCopyable):
    """One build in a worker process; arguments as for Hierarchy.build().

    memory_limit: bytes that the worker may use (None: 80 % of what is available now; 0: no limit). Kept on Linux only:
    macOS does not honour such limits, and on Windows none is set; there the system's own limits hold.
    cpu_limit: seconds of processor time that one process may take, all its threads together, so that a machine busy
    with other things stops no build; and seconds by the clock in which it may do nothing at all (None: two minutes and
    2 ms a triangle).
    python: the path of the Python that runs the worker, if it does; "": see interpreter.candidates(). Which one does is
    found out once, beside what the caller does: the worker starts when one was found and any method is called, which also
    looks after the time limit.

    A worker that crashes, exits, or goes beyond a limit is followed by another that begins at the rung of the ladder
    after the one it tried, if there is one; failures holds a WorkerError for each. Every method may be called from any
    thread. The worker ends when this process does, however that happens.
    """

    def __init__(self, vertices, triangles, faces=None, face_count=None, *, quality=0.0, rungs=0, open_surfaces=False,
                 threads=0, mode=Mode.REGROUPED, exactly=False, exact_triangles=0, memory_limit=None, cpu_limit=None, python=""):
        load()  # a missing library is better told here
        self._arrays, self._face_count = checked_surface(vertices, triangles, faces, face_count)
        self._options = {"quality": float(quality), "open_surfaces": int(open_surfaces), "threads": threads,
                         "mode": int(mode), "exact_triangles": -1 if exactly else exact_triangles}
        self._rungs = rungs or sum(RUNGS)
        self._rung = Rung.EXACT  # that the worker tries, as far as it has told
        self._memory_limit = int(MEMORY_SHARE * available_memory()) if memory_limit is None else memory_limit
        self._cpu_limit = cpu_limit or SECONDS + SECONDS_PER_TRIANGLE * len(self._arrays[1])
        self.failures = []
        self._progress = 0.0, "surface"
        # Of this worker: whether it has begun to answer; processor time, and when that last grew.
        self._answered, self._work, self._seen_working = False, 0.0, 0.0
        self._watched = None  # (the process that is at work, a list to say in how it has gone beyond the time limit)
        self._lock = threading.RLock()  # for the four below
        self._search, self._python = interpreter.Search(python), None
        self._process = None
        self._cancelled = False
        self._hierarchy = self._error = None
        self._done = threading.Event()  # not is_alive(), which may say no too early after Ctrl-C (bpo-45274)
        self._thread = None

    def poll(self):
        """(fraction 0..1 that never falls, name of the stage) while it runs; None once result() won't block."""
        self._begin()
        self._look()
        return None if self._done.is_set() else self._progress

    def wait(self, seconds):
        """Waits so long at most, and says whether the job is done."""
        end = time.monotonic() + seconds
        while self.poll() and (left := end - time.monotonic()) > 0:
            self._done.wait(min(SEARCH_SECONDS if self._search else WATCH_SECONDS, left))
        return self._done.is_set()

    def cancel(self):
        """Kills the worker at once. result() then raises PartwheelError with Status.CANCELLED, unless it was done."""
        with self._lock:
            self._cancelled = True
            if self._process:
                self._process.kill()
            self._begin()

    def result(self):
        """Waits for the end: the Hierarchy. Raises PartwheelError: what is wrong with the surface, that the build was
        cancelled, or a WorkerError."""
        try:
            while not self.wait(WAIT_SECONDS):
                pass
            self._thread.join()
        except BaseException:  # Ctrl-C
            self.cancel()
            raise
        if self._error:
            raise self._error
        return self._hierarchy

    @property
    def process_id(self):
        """Of the worker that runs now, or ran last; None if there is none yet, or none could be started."""
        self._begin()
        return self._process and self._process.pid

    def _begin(self):
        """Starts the worker as soon as there is a Python for it, and the job's thread. Not in that thread, which so has
        little Python left to run: with Python up to 3.11 Blender takes any thread's hold of the interpreter for its
        own, and crashes (seen in 3.4, at once with a thread that only counts) where a script calls operators under
        temp_override() meanwhile. Nor when the job is made, for the same script may call the next one.
        """
        with self._lock:
            if not self._search:
                return
            try:
                self._python = self._search.poll()
                if not self._python and not self._cancelled:
                    return
                launched = self._launch()
            except interpreter.NoInterpreter as reason:
                launched = _no_worker(NO_PYTHON, reason=reason.said)
            self._search.close()
            self._search = None
            self._thread = threading.Thread(target=self._run, args=[launched], name="partwheel-job", daemon=True)
            self._thread.start()

    def _look(self):
        """Ends a worker that is late. Not in a thread of its own, see _begin()."""
        watched, work, idle = self._watched, self._work, time.monotonic() - self._seen_working
        if watched and max(work, idle) > self._cpu_limit:
            process, late = watched
            late.append(LATE if work > idle else IDLE)
            process.kill()

    def _launch(self):
        """A worker process that was started, or the error why there is none."""
        with self._lock:
            if self._cancelled:
                return PartwheelError(Status.CANCELLED, CANCELLED)
            try:
                self._process = process = interpreter.start(self._python, str(ENTRY), stdin=subprocess.PIPE,
                                                            stdout=subprocess.PIPE)
            except OSError as error:
                return _no_worker(NO_START, reason=error)
        return process

    # ---- In the job's thread ---------------------------------------------------------------------------------------

    def _run(self, launched):
        try:
            rungs = self._rungs
            while rungs:
                self._rung = rungs & -rungs  # the first
                try:
                    self._hierarchy = self._attempt(launched or self._launch(), rungs)
                    return
                except WorkerError as error:
                    self.failures.append(error)
                    if error.name == "worker":  # the next would not start either
                        interpreter.forget()
                        break
                launched = None
                rungs &= -2 * self._rung  # those after it
            self._error = self.failures[-1]
        except Exception as error:  # whatever it is, result() raises it
            self._error = error
        finally:
            self._done.set()

    def _attempt(self, launched, rungs):
        """One worker process from start to end: the Hierarchy, or raises PartwheelError."""
        process = _unless_error(launched)
        self._answered, self._work, self._seen_working = False, 0.0, time.monotonic()
        late = []
        self._watched = process, late
        try:
            self._send(process.stdin, rungs)
            answer = self._listen(process.stdout)
            if not answer:
                process.wait()  # it has closed its pipe, so it is ending
        finally:
            self._watched = None
            process.kill()
            process.wait()
            process.stdout.close()
            try:
                process.stdin.close()
            except OSError:
                pass  # the worker died before it had read everything: that is told below
        if answer:
            return self._loaded(_unless_error(answer))
        if self._cancelled:
            raise PartwheelError(Status.CANCELLED, CANCELLED)
        if not self._answered:
            raise (_no_worker(SILENT, seconds=f"{self._cpu_limit:g}") if late else
                   _no_worker(GONE, how=ending(process.returncode)))
        if late:
            raise WorkerError("time limit", late[0], HARMLESS, FASTER, seconds=f"{self._cpu_limit:g}")
        raise WorkerError("crash", BROKEN, HARMLESS, MENDED, how=ending(process.returncode))

    def _send(self, pipe, rungs):
        """Hands the surface over. A worker that dies meanwhile is left for _listen() to find."""
        header = {"options": {**self._options, "rungs": rungs}, "face_count": self._face_count,
                  "memory_limit": self._memory_limit, "sizes": [array.nbytes for array in self._arrays]}
        text = json.dumps(header).encode()
        try:
            pipe.write(MESSAGE.pack(b"B", len(text)) + text)
            for array in self._arrays:
                pipe.write(array.data)
            pipe.flush()
        except OSError:
            pass

    def _listen(self, pipe):
        """Takes in messages up to the answer: (the saved Hierarchy, seconds of the stages), or an error; None: none."""
        seconds = {}
        while True:
            head = _read(pipe, MESSAGE.size)
            if len(head) < MESSAGE.size:
                return None
            kind, length = MESSAGE.unpack(head)
            payload = _read(pipe, length)
            if len(payload) < length:
                return None
            self._answered = True
            try:
                if kind == b"H":
                    return payload, seconds
                values = json.loads(payload)
                if kind == b"E":
                    return self._refused(values, seconds)
                if kind == b"S":
                    seconds = {str(stage): float(value) for stage, value in values.items()}
                else:
                    fraction, stage, rung, work = values
                    self._rung = max(self._rung, Rung(rung))  # before it tries any, a context tells the first of all
                    if float(work) > self._work:
                        self._work, self._seen_working = float(work), time.monotonic()
                    self._progress = max(self._progress[0], float(fraction)), str(stage)
            except (ValueError, TypeError, AttributeError, LookupError):  # not what a sound worker writes
                return WorkerError("crash", DAMAGED, HARMLESS)

    def _loaded(self, answer):
        data, seconds = answer
        try:
            hierarchy = Hierarchy.load(data)
        except PartwheelError as error:
            raise WorkerError("crash", DAMAGED_BY, HARMLESS, reason=error) from error
        if len(hierarchy.order) != self._face_count:
            raise WorkerError("crash", OTHER, HARMLESS)
        hierarchy.seconds = seconds
        return hierarchy

    def _refused(self, values, seconds):
        error = PartwheelError(int(values["status"]), str(values["message"]), seconds)
        if error.status == Status.MEMORY:
            error = WorkerError("memory", FULL, *[LIMIT] * bool(self._memory_limit), HARMLESS, LESS,
                                size=self._memory_limit / 2**30)
        return error


def available_memory():
    """Bytes that a new process could use without the system having to swap, or 0 where it does not tell."""
    try:
        with open("/proc/meminfo", encoding="ascii") as lines:
            return next(int(line.split()[1]) * 1024 for line in lines if line.startswith("MemAvailable:"))
    except (OSError, StopIteration):
        return 0


def _no_worker(sentence, **values):
    return WorkerError("worker", sentence, HARMLESS, WHICH, **values)


def _unless_error(found):
    if isinstance(found, PartwheelError):
        raise found
    return found


def _read(pipe, length):
    """So many bytes, or fewer at the pipe's end. In pieces, for a mad worker may announce any length."""
    pieces = []
    while length > 0:
        piece = pipe.read(min(length, 2**20))
        if not piece:
            break
        pieces.append(piece)
        length -= len(piece)
    return b"".join(pieces)
