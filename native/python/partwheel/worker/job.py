# SPDX-License-Identifier: GPL-3.0-or-later
"""Job: a build in a separate process, so that a crash, a hang or memory exhaustion in the native library can't harm
this one.

All data goes through two pipes, so no files and no shared memory can be left behind, and the end of a pipe tells each
process that the other has died. process.py runs on the other side.
"""

import json
import struct
import subprocess
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import IO, Any, Dict, List, Optional, Sequence, Tuple, Union

from numpy.typing import ArrayLike

from . import interpreter
from .exit_status import describe_exit
from .translatable import TranslatableText
from ..hierarchy import Hierarchy, check_marks, check_options, check_surface
from ..library import FILL_METHODS, FillMethod, NonCopyable, PartwheelError, Status, load
from ..marks import Marks

ENTRY = Path(__file__).with_name("process.py")
MEMORY_FRACTION = 0.8  # of the memory that is available when the build starts
# Default limit on processor time, about fifty times what an ordinary build takes: only an endless build should reach
# it.
CPU_SECONDS, CPU_SECONDS_PER_TRIANGLE = 120, 0.002
POLL_SECONDS = 0.1  # between two checks of the time limit
# result() waits in steps: an endless wait would not notice a Ctrl-C that comes just before it.
WAIT_SECONDS = 0.1
SEARCH_SECONDS = 0.01  # between two polls of the search for a Python
# Header of a message to or from the worker: kind, number of bytes that follow.
MESSAGE = struct.Struct("<cQ")

# Messages, see TranslatableText.
BUILD_CANCELED = "The build was canceled."
MESH_UNCHANGED = "The mesh was not changed."
CPU_LIMIT_REACHED = "The build was not done after {seconds} seconds of work and was stopped."
IDLE_LIMIT_REACHED = "The build was not done after {seconds} seconds without any work and was stopped."
HINT_FASTER = "A mesh with fewer faces (Decimate, or a voxel remesh) is faster."
OUT_OF_MEMORY = "The worker process ran out of memory."
MEMORY_LIMIT = "It may use {size:.1f} GiB."
HINT_LESS_MEMORY = "A mesh with fewer faces (Decimate, or a voxel remesh) needs less."
WORKER_DIED = "The worker process {how} before it was done."
HINT_REPAIR = "Merging vertices by distance, or a voxel remesh, often helps."
DAMAGED_ANSWER = "The worker process gave a damaged answer."
DAMAGED_ANSWER_REASON = "The worker process gave a damaged answer: {reason}"
WRONG_MESH = "The worker process returned the parts of another mesh."
NO_PYTHON = "There is no Python to run the worker process: {reason}."
START_FAILED = "The worker process could not be started: {reason}."
START_TIMEOUT = "The worker process did not begin in {seconds} seconds."
DIED_AT_START = "The worker process {how} before it began."
HINT_PYTHON = "If this happens again, choose a Python 3 to run it: Python in the add-on's preferences, or the argument python."


class WorkerError(PartwheelError):
    """The worker process ended, or was killed, without an answer.

    status : Status.INTERNAL, or Status.MEMORY
    name : "crash", "time limit", "memory", or "worker" if it could not be started
    sentences, values : see TranslatableText
    """

    def __init__(self, name: str, *sentences: str, **values: object) -> None:
        text = TranslatableText(*sentences, **values)
        super().__init__(Status.MEMORY if name == "memory" else Status.INTERNAL, str(text))
        self.name, self.sentences, self.values = name, text.sentences, text.values


class Job(NonCopyable):
    """One build in a worker process. Every method may be called from any thread.

    A worker that crashes, exits or exceeds a limit is followed by another one that starts with the next fill method, if
    there is one. The worker ends when this process does, however that happens. It starts when any method is called
    after a Python was found; these calls also enforce the time limit.

    Parameters
    ----------
    vertices ... face_count, marks, options : see Hierarchy.build()
    memory_limit : bytes that the worker may use; None: 80 % of what is available now; 0: no limit. Linux only: macOS
        ignores such limits, and none is set on Windows
    cpu_limit : seconds of processor time of one worker, all threads together, so that a busy machine stops no build;
        also seconds of wall-clock time without any work. None: 120 s plus 2 ms per triangle
    python : path of the Python that runs the worker, if it works; "": see interpreter.candidates()

    Attributes
    ----------
    failures : a WorkerError for each worker that failed

    Raises
    ------
    LibraryError, PartwheelError, ValueError, TypeError : as Hierarchy.build() for its arguments
    """

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
                 face_count: Optional[int] = None, *, marks: Sequence[Marks] = (), memory_limit: Optional[int] = None,
                 cpu_limit: Optional[float] = None, python: str = "", **options: Any) -> None:
        load()  # raises LibraryError here rather than in the worker
        self._arrays, self._face_count = check_surface(vertices, triangles, faces, face_count)
        kinds = check_marks(marks)
        self._marks = [(name, chosen) for name, _, _, chosen in kinds]
        self._arrays += [array for _, *arrays, _ in kinds for array in arrays]
        self._options = check_options(**options)
        self._fill_methods: int = self._options["fill_methods"] or sum(FILL_METHODS)
        self._fill_method: int = FillMethod.EXACT  # the fill method that the worker last reported
        self._memory_limit = int(MEMORY_FRACTION * available_memory()) if memory_limit is None else memory_limit
        self._cpu_limit = cpu_limit or CPU_SECONDS + CPU_SECONDS_PER_TRIANGLE * len(self._arrays[1])
        self.failures: List[WorkerError] = []
        self._progress: Tuple[float, str] = (0.0, "surface")
        # Whether the current worker has sent a message, its processor time, and when that last grew.
        self._has_answered, self._cpu_time, self._last_work_time = False, 0.0, 0.0
        # (the current worker, a list to which the message about an exceeded time limit is appended)
        self._watched: Optional[Tuple[subprocess.Popen[bytes], List[str]]] = None
        self._lock = threading.RLock()  # for the four below
        self._search: Optional[interpreter.Search] = interpreter.Search(python)
        self._python: Optional[str] = None
        self._process: Optional[subprocess.Popen[bytes]] = None
        self._is_canceled = False
        self._hierarchy: Optional[Hierarchy] = None
        self._error: Optional[Exception] = None
        self._done = threading.Event()  # not is_alive(), which may return False too early after Ctrl-C (bpo-45274)
        self._thread: Optional[threading.Thread] = None

    def poll(self) -> Optional[Tuple[float, str]]:
        """(monotone fraction 0..1, name of the stage) while the job runs; None once result() won't block."""
        self._begin()
        self._enforce_time_limit()
        return None if self._done.is_set() else self._progress

    def wait(self, seconds: float) -> bool:
        """Waits at most this long; returns whether the job is done."""
        end = time.monotonic() + seconds
        while self.poll() and (left := end - time.monotonic()) > 0:
            self._done.wait(min(SEARCH_SECONDS if self._search else POLL_SECONDS, left))
        return self._done.is_set()

    def cancel(self) -> None:
        """Kills the worker. result() then raises PartwheelError with Status.CANCELED, unless the job was done."""
        with self._lock:
            self._is_canceled = True
            if self._process:
                self._process.kill()
            self._begin()

    def result(self) -> Hierarchy:
        """Waits for the end of the job and returns the Hierarchy.

        Raises
        ------
        PartwheelError : what is wrong with the surface, or that the build was canceled
        WorkerError : every worker failed
        """
        try:
            while not self.wait(WAIT_SECONDS):
                pass
            assert self._thread is not None
            self._thread.join()
        except BaseException:  # Ctrl-C
            self.cancel()
            raise
        if self._error:
            raise self._error
        assert self._hierarchy is not None
        return self._hierarchy

    def _begin(self) -> None:
        """Starts the worker and the job's thread as soon as a Python was found.

        The caller's thread does this, not the job's, and not the constructor, so that the job's thread runs as little
        Python as possible: up to Python 3.11, Blender mistakes any thread that holds the interpreter lock for its own,
        and crashes if a script calls operators under temp_override() at that time (observed in 3.4).
        """
        with self._lock:
            if not self._search:
                return
            try:
                self._python = self._search.poll()
                if not self._python and not self._is_canceled:
                    return
                launched: Union[subprocess.Popen[bytes], PartwheelError] = self._launch()
            except interpreter.NoInterpreter as reason:
                launched = _start_error(NO_PYTHON, reason=reason.text)
            self._search.close()
            self._search = None
            self._thread = threading.Thread(target=self._run, args=[launched], name="partwheel-job", daemon=True)
            self._thread.start()

    def _enforce_time_limit(self) -> None:
        """Kills a worker that exceeds the time limit. In the caller's thread, see _begin()."""
        watched, cpu_time, idle_time = self._watched, self._cpu_time, time.monotonic() - self._last_work_time
        if watched and max(cpu_time, idle_time) > self._cpu_limit:
            process, exceeded = watched
            exceeded.append(CPU_LIMIT_REACHED if cpu_time > idle_time else IDLE_LIMIT_REACHED)
            process.kill()

    def _launch(self) -> Union[subprocess.Popen[bytes], PartwheelError]:
        """Starts a worker process; returns it, or the error."""
        with self._lock:
            if self._is_canceled:
                return PartwheelError(Status.CANCELED, BUILD_CANCELED)
            assert self._python is not None
            try:
                self._process = process = interpreter.start(self._python, str(ENTRY), stdin=subprocess.PIPE,
                                                            stdout=subprocess.PIPE)
            except OSError as error:
                return _start_error(START_FAILED, reason=error)
        return process

    # ---- In the job's thread ---------------------------------------------------------------------------------------

    def _run(self, launched: Union[subprocess.Popen[bytes], PartwheelError, None]) -> None:
        try:
            fill_methods = self._fill_methods
            while fill_methods:
                self._fill_method = fill_methods & -fill_methods  # the lowest bit: the first fill method
                try:
                    self._hierarchy = self._attempt(launched or self._launch(), fill_methods)
                    return
                except WorkerError as error:
                    self.failures.append(error)
                    if error.name == "worker":  # another one would not start either
                        interpreter.clear_cache()
                        break
                launched = None
                fill_methods &= -2 * self._fill_method  # the fill methods after it
            self._error = self.failures[-1]
        except Exception as error:  # result() raises it
            self._error = error
        finally:
            self._done.set()

    def _attempt(self, launched: Union[subprocess.Popen[bytes], PartwheelError], fill_methods: int) -> Hierarchy:
        """Runs one worker process from start to end. Raises PartwheelError."""
        if isinstance(launched, PartwheelError):
            raise launched
        process = launched
        assert process.stdin and process.stdout
        self._has_answered, self._cpu_time, self._last_work_time = False, 0.0, time.monotonic()
        exceeded: List[str] = []
        self._watched = process, exceeded
        try:
            self._send(process.stdin, fill_methods)
            answer = self._listen(process.stdout)
            if not answer:
                process.wait()  # the worker closed its pipe, so it is ending
        finally:
            self._watched = None
            process.kill()
            process.wait()
            process.stdout.close()
            with suppress(OSError):  # the worker died before it had read everything; reported below
                process.stdin.close()
        if isinstance(answer, PartwheelError):
            raise answer
        if answer:
            return self._load_hierarchy(*answer)
        if self._is_canceled:
            raise PartwheelError(Status.CANCELED, BUILD_CANCELED)
        if not self._has_answered:
            raise (_start_error(START_TIMEOUT, seconds=f"{self._cpu_limit:g}") if exceeded else
                   _start_error(DIED_AT_START, how=describe_exit(process.returncode)))
        if exceeded:
            raise WorkerError("time limit", exceeded[0], MESH_UNCHANGED, HINT_FASTER, seconds=f"{self._cpu_limit:g}")
        raise WorkerError("crash", WORKER_DIED, MESH_UNCHANGED, HINT_REPAIR, how=describe_exit(process.returncode))

    def _send(self, pipe: IO[bytes], fill_methods: int) -> None:
        """Sends the surface and the options. _listen() notices if the worker dies in the meantime."""
        header = {"options": {**self._options, "fill_methods": fill_methods}, "face_count": self._face_count,
                  "marks": self._marks, "memory_limit": self._memory_limit,
                  "sizes": [array.nbytes for array in self._arrays]}
        text = json.dumps(header).encode()
        with suppress(OSError):
            pipe.write(MESSAGE.pack(b"B", len(text)) + text)
            for array in self._arrays:
                pipe.write(array.data)
            pipe.flush()

    def _listen(self, pipe: IO[bytes]) -> Union[Tuple[bytes, Dict[str, float]], PartwheelError, None]:
        """Receives messages up to the answer: (the saved hierarchy, stage name -> seconds), or an error, or None if the
        pipe ends without one."""
        seconds: Dict[str, float] = {}
        while True:
            header = _read(pipe, MESSAGE.size)
            if len(header) < MESSAGE.size:
                return None
            kind, length = MESSAGE.unpack(header)
            payload = _read(pipe, length)
            if len(payload) < length:
                return None
            self._has_answered = True
            try:
                if kind == b"H":
                    return payload, seconds
                values = json.loads(payload)
                if kind == b"E":
                    return self._build_error(values, seconds)
                if kind == b"S":
                    seconds = {str(stage): float(value) for stage, value in values.items()}
                else:
                    fraction, stage, fill_method, cpu_time = values
                    if fill_method not in FILL_METHODS:
                        raise ValueError(fill_method)
                    # max(), because a new context reports the first method until it tries one.
                    self._fill_method = max(self._fill_method, fill_method)
                    if float(cpu_time) > self._cpu_time:
                        self._cpu_time, self._last_work_time = float(cpu_time), time.monotonic()
                    self._progress = max(self._progress[0], float(fraction)), str(stage)
            except (ValueError, TypeError, AttributeError, LookupError):  # malformed: the worker's memory is corrupt
                return WorkerError("crash", DAMAGED_ANSWER, MESH_UNCHANGED)

    def _load_hierarchy(self, data: bytes, seconds: Dict[str, float]) -> Hierarchy:
        """The hierarchy of an answer. Raises WorkerError."""
        try:
            hierarchy = Hierarchy.load(data)
        except PartwheelError as error:
            raise WorkerError("crash", DAMAGED_ANSWER_REASON, MESH_UNCHANGED, reason=error) from error
        if len(hierarchy.order) != self._face_count:
            raise WorkerError("crash", WRONG_MESH, MESH_UNCHANGED)
        hierarchy.seconds = seconds
        return hierarchy

    def _build_error(self, values: Dict[str, Any], seconds: Dict[str, float]) -> PartwheelError:
        """The error that the worker reports."""
        error = PartwheelError(int(values["status"]), str(values["message"]), seconds, values.get("faces", ()),
                               values.get("vertices", ()), values.get("triangle"))
        if error.status == Status.MEMORY:
            error = WorkerError("memory", OUT_OF_MEMORY, *[MEMORY_LIMIT] * bool(self._memory_limit), MESH_UNCHANGED,
                                HINT_LESS_MEMORY, size=self._memory_limit / 2**30)
        return error


def available_memory() -> int:
    """Bytes that a new process could use without swapping; 0 if unknown, outside Linux."""
    return read_memory("MemAvailable", "/proc/meminfo")


def read_memory(name: str, path: str = "/proc/self/status") -> int:
    """A field of a file in /proc in bytes; 0 if unknown, outside Linux."""
    try:
        with open(path, encoding="ascii") as lines:
            return next(int(line.split()[1]) * 1024 for line in lines if line.startswith(name + ":"))
    except (OSError, StopIteration):
        return 0


def _start_error(sentence: str, **values: object) -> WorkerError:
    return WorkerError("worker", sentence, MESH_UNCHANGED, HINT_PYTHON, **values)


def _read(pipe: IO[bytes], length: int) -> bytes:
    """length bytes, or fewer at the pipe's end. In chunks: a corrupt worker may announce any length."""
    chunks = []
    while length > 0:
        chunk = pipe.read(min(length, 2**20))
        if not chunk:
            break
        chunks.append(chunk)
        length -= len(chunk)
    return b"".join(chunks)
