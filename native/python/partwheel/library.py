# SPDX-License-Identifier: GPL-3.0-or-later
"""The ctypes binding of the native library: its functions as the headers declare them, structs and statuses; and builds in a
thread.

The worker imports this file, too, without numpy and outside the package."""

from __future__ import annotations

import ctypes
import enum
import functools
import os
import re
import threading
import weakref
from ctypes import c_char_p, c_double, c_int, c_int32, c_int64, c_size_t, c_uint32, c_void_p
from pathlib import Path

TYPE_CHECKING = False  # typing.TYPE_CHECKING, without the time that importing typing takes
if TYPE_CHECKING:
    from typing import Any, Callable, Iterable, Sequence

if __package__:
    from .loading import FILE_NAMES, SYSTEM, open_library
else:  # in the worker
    from loading import FILE_NAMES, SYSTEM, open_library  # type: ignore[no-redef]

VERSION = "0.1.0"  # of partwheel.h, which this file declares
EDIT_API_VERSION = 1  # of partwheel_edit.h
LIBRARY = Path(__file__).resolve().with_name(FILE_NAMES[SYSTEM])
SOURCES = LIBRARY.parent / "../../src"
INCLUDE = SOURCES.with_name("include") if SOURCES.is_dir() else LIBRARY.with_name("include")  # the headers


# pw_status; and pw_stage, the stages of a build in order.
Status = enum.IntEnum("Status", [
    "OK", "ARGUMENT", "EMPTY", "NOT_FINITE", "INDEX", "DEGENERATE", "OPEN", "NON_MANIFOLD", "ORIENTATION",
    "SELF_INTERSECTION", "NO_VOLUME", "TETRAHEDRA", "CANCELED", "MEMORY", "DATA", "INTERNAL", "NOT_SOLID",
    "CAPACITY"], start=0)
Stage = enum.IntEnum("Stage", ["SURFACE", "REPAIR", "TETRAHEDRA", "CLUSTER", "DENDROGRAM", "HIERARCHY"], start=0)


class FillMethod(enum.IntFlag):
    """pw_fill_method: how a surface is filled with tetrahedra; the best one first."""

    EXACT = 1
    REPAIRED = 2
    POINTS = 4
    SHEET = 8


FILL_METHODS = tuple(FillMethod)


class Mode(enum.IntEnum):
    """pw_mode."""

    LEARNED = 0
    PAPER = 1


class _Sized(ctypes.Structure):
    """A struct whose first field is its size: see the conventions in partwheel.h. load() gives it the fields of the headers;
    pointers are addresses."""

    def __new__(cls, **_: Any) -> _Sized:
        load()
        return super().__new__(cls)

    def __init__(self, **fields: Any) -> None:
        super().__init__(struct_size=ctypes.sizeof(self), **fields)


def _struct(name: str) -> Any:
    return type(name, (_Sized,), {})


# pw_error_info and so on
ErrorInfo, Marks, Arrays, Summary, ConvexOptions = map(_struct, ("ErrorInfo", "Marks", "Arrays", "Summary", "ConvexOptions"))


class MeshView(_Sized):
    """pw_mesh_view, of packed float64 and int32."""

    @classmethod
    def of(cls, vertices: Any, triangles: Any, faces: Any, face_count: int, address: Callable[[Any], int]) -> MeshView:
        """Creates a view of packed arrays, (V, 3) float64, (T, 3) int32, (T,) int32 or None, and keeps them alive.
        address(array): where its data is"""
        mesh = cls(vertices=address(vertices), vertex_count=len(vertices), triangles=address(triangles),
                   triangle_count=len(triangles), faces=None if faces is None else address(faces), face_count=face_count)
        mesh.arrays = vertices, triangles, faces
        return mesh


class BuildOptions(_Sized):
    """pw_build_options."""

    def set_marks(self, marks: list[tuple[str, Any, Any, bool]], address: Callable[[Any], int]) -> None:
        """Sets the marks and keeps them alive: of each kind the name, (n, 2) int32 edges, (n,) float32 strengths, and whether
        it was chosen. address(array): where its data is."""
        self.arrays = marks
        self.structs = (Marks * len(marks))(*(
            Marks(name=name.encode(), edges=address(edges), strengths=address(strengths), edge_count=len(edges),
                  chosen=chosen) for name, edges, strengths, chosen in marks))
        self.marks, self.mark_count = ctypes.addressof(self.structs), len(marks)


class Address(c_void_p):
    """The type of pointer arguments: accepts an address, a Handle, a ctypes buffer or struct, or a numpy array, which it
    keeps alive during the call."""

    @classmethod
    def from_param(cls, value: Any) -> Any:
        if hasattr(value, "ctypes"):
            return value.ctypes
        return ctypes.byref(value) if isinstance(value, ctypes.Structure) else super().from_param(value)


FUNCTION = re.compile(r"^PW_API ([^;(]+?)(pw_\w+)\(([^)]*)\);", re.M)
STRUCT = re.compile(r"^typedef struct pw_(\w+) {(.*?)}", re.M | re.S)
FIELD = re.compile(r"(\w[\w ]*?[ *]+)(\w+)(?:\[(\d+)\])?;")
# C types of results, arguments and fields. Pointers that are arguments are an Address.
TYPES: dict[str, Any] = {"void": None, "const char *": c_char_p, "size_t": c_size_t, "double": c_double, "int32_t": c_int32,
                         "uint32_t": c_uint32, "int64_t": c_int64, "pw_status": c_int, "pw_stage": c_int, "pw_fill_method": c_int}


def declared_functions(text: str) -> dict[str, tuple[Any, list[Any]]]:
    """{name: (result type, argument types)} of the functions in a header."""
    return {name: (TYPES[result.strip()], [
        Address if "*" in argument else TYPES[argument.split()[0]]
        for argument in arguments.split(",") if argument != "void"]) for result, name, arguments in FUNCTION.findall(text)}


def declared_fields(text: str) -> dict[str, list[tuple[str, Any]]]:
    """{name in Python: (name, type) of its fields} of the structs in a header."""
    def field_type(kind: str, count: str) -> Any:
        number = c_void_p if "*" in kind and kind not in TYPES else TYPES[kind]
        return number * int(count) if count else number

    bare = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    return {name.title().replace("_", ""): [(field, field_type(kind.strip(), count)) for kind, field, count in FIELD.findall(body)]
            for name, body in STRUCT.findall(bare)}


class Error(Exception):
    """Base class of the package's errors; str() tells the user what to do.

    name : the kind of error, stable
    seconds : stage name -> seconds of a failed build, else empty
    """

    name = "error"
    seconds: dict[str, float] = {}

    def __reduce__(self) -> tuple[Any, ...]:
        """Copies without calling the constructor, whose arguments are not self.args."""
        return _restore_error, (type(self), self.args), vars(self)


def _restore_error(kind: type[Error], arguments: Sequence[Any]) -> Error:
    """Creates an Error without its attributes."""
    return kind.__new__(kind, *arguments)


class LibraryError(Error, OSError):
    """The native library is missing, can't be loaded, or has another version than this code."""

    name = "library"


class PartwheelError(Error):
    """An error of the native library.

    status : a Status
    name : its name, such as "self-intersection"
    faces, vertices : tuples of the invalid source faces and vertices, as far as known: the first invalid face or two
        that intersect; a vertex or the two ends of an edge
    triangle : the triangle with an index out of range, or None
    """

    def __init__(self, status: int, message: str, seconds: dict[str, float] | None = None, faces: Iterable[int] = (),
                 vertices: Iterable[int] = (), triangle: int | None = None) -> None:
        super().__init__(message)
        self.status = Status(status)
        self.name = load().pw_status_name(status).decode()
        self.seconds = seconds or {}
        self.faces, self.vertices, self.triangle = tuple(faces), tuple(vertices), triangle


_load_lock = threading.Lock()


@functools.cache
def load() -> ctypes.CDLL:
    """The native library with the types of all functions declared. Raises LibraryError."""
    with _load_lock:  # on Windows open_library() writes files
        return _load()


def _load() -> ctypes.CDLL:
    # In a source tree, tests may load another library; an installed package loads its own only.
    override = SOURCES.is_dir() and os.environ.get("PARTWHEEL_LIBRARY")
    path = override or str(LIBRARY)
    try:
        library = open_library(path)
        headers = "".join((INCLUDE / name).read_text("utf-8") for name in ("partwheel.h", "partwheel_edit.h"))
    except FileNotFoundError as error:
        raise _version_error(path, f"there is no {error.filename}") from error
    except OSError as error:
        raise LibraryError(str(error)) from error.__cause__  # the loader's error
    for name, (result, arguments) in declared_functions(headers).items():
        try:
            function = getattr(library, name)
        except AttributeError as error:
            raise _version_error(path, f"it has no function {name}") from error
        function.restype, function.argtypes = result, arguments
    fields = declared_fields(headers)
    for struct in _Sized.__subclasses__():
        if not hasattr(struct, "_fields_"):
            struct._fields_ = fields[struct.__name__]
    version = library.pw_version().decode()
    if version != VERSION:
        raise _version_error(path, f"it is {version}, not {VERSION}")
    edit_version = library.pw_edit_api_version()
    if edit_version != EDIT_API_VERSION:
        raise _version_error(path, f"its editing functions are version {edit_version}, not {EDIT_API_VERSION}")
    return library


def _version_error(path: str, reason: str) -> LibraryError:
    # A program that had loaded the library before the add-on was updated still has the old one.
    return LibraryError(
        f"{path} is another version of Partwheel's library than this add-on needs: {reason}. Restart the program. If "
        "that does not help, install the add-on again, or build the library again (scripts/build)."
    )


def version() -> str:
    """The native library's version, "major.minor.patch"."""
    return load().pw_version().decode()


def saved_format() -> int:
    """The number of the format that Hierarchy.save() writes. Later ones can't be read."""
    return load().pw_saved_format()


def check(status: int, seconds: Callable[[], dict[str, float]] = dict) -> None:
    """Raises PartwheelError unless the status is OK. Call it in the thread of the failed call: messages are per
    thread."""
    if status != Status.OK:
        message, info = load().pw_error_message().decode(), ErrorInfo()
        if load().pw_error_details(info) != Status.OK:
            info = ErrorInfo(triangle=-1)
        faces, vertices = ([index for index in indices if index >= 0] for indices in (info.faces, info.vertices))
        raise PartwheelError(status, message, seconds(), faces, vertices, info.triangle if info.triangle >= 0 else None)


def call_with_outputs(types: Iterable[Any], function: Any, *arguments: Any) -> list[Any]:
    """Calls a function whose last arguments are pointers to these types; returns the values it writes. Raises
    PartwheelError."""
    outputs = [output_type() for output_type in types]
    check(function(*arguments, *map(ctypes.byref, outputs)))
    return [output.value for output in outputs]


class NonCopyable:
    """Base class of objects with native memory or a process, which have no saved form."""

    def __reduce__(self) -> Any:
        raise TypeError(f"{type(self).__name__} can't be copied or pickled: it refers to memory of this process. Make "
                        "another one from the same data. A Hierarchy can be pickled.")


class Handle(NonCopyable):
    """Owns a native object and frees it when the last reference is gone. It can be passed to the library's
    functions."""

    def __init__(self, free: Callable[[int | None], Any], address: int | None) -> None:
        self._as_parameter_ = address
        # Not at exit: views may still be in use, and the system frees the memory anyway.
        weakref.finalize(self, free, address).atexit = False


def create_handle(free: Callable[[int | None], Any], create: Any, *arguments: Any) -> Handle:
    """A Handle of the object that a function of the library creates. Raises PartwheelError."""
    return Handle(free, call_with_outputs([c_void_p], create, *arguments)[0])


# ---- Builds, in this process or in a worker


class Context(Handle):
    """Progress, cancellation and timing of a long call: a pw_context, also for functions that make several calls."""

    def __init__(self) -> None:
        super().__init__(load().pw_context_free, call_with_outputs([c_void_p], load().pw_context_create)[0])
        self._is_canceled, self._fraction = False, -1.0  # the fraction is below 0 before the first start_step()

    def cancel(self) -> None:
        """Cancels the call, from any thread."""
        self._is_canceled = True
        check(load().pw_context_cancel(self))

    def start_step(self, fraction: float) -> None:
        """Called by functions in Python between their steps, with the fraction 0..1 that is done. Raises PartwheelError
        (CANCELED) after cancel()."""
        if self._is_canceled:
            raise PartwheelError(Status.CANCELED, "This was canceled. Nothing was changed.")
        self._fraction = fraction

    def progress(self) -> tuple[float, str]:
        """(fraction 0..1, stage name)"""
        fraction, stage = call_with_outputs([c_double, c_int], load().pw_context_progress, self)
        return fraction if self._fraction < 0 else self._fraction, load().pw_stage_name(stage).decode()

    def seconds(self) -> dict[str, float]:
        """{stage name: seconds of the last build}"""
        seconds = (c_double * len(Stage))()
        check(load().pw_context_seconds(self, seconds))
        return {load().pw_stage_name(stage).decode(): seconds[stage] for stage in Stage}


class Build(threading.Thread):
    """Runs pw_build in a separate thread. ctypes releases the interpreter lock, so other threads can run.

    address : of the native hierarchy, after done is set; null if there is an error
    error : a PartwheelError or None
    done : set at the end
    """

    def __init__(self, context: Context, surface: MeshView, options: BuildOptions) -> None:
        super().__init__(name="partwheel-build", daemon=True)
        self._arguments = context, surface, ctypes.byref(options)
        self.context, self.address = context, c_void_p()
        self.error: PartwheelError | None = None
        self.done = threading.Event()  # not is_alive(), which may return False too early after Ctrl-C (bpo-45274)

    def run_to_end(self, report: Callable[[], object], seconds: float) -> None:
        """Starts the build and waits for its end; calls report() before, about every so many seconds, and after. If it raises,
        the build is canceled."""
        report()
        self.start()
        try:
            while not self.done.wait(seconds):
                report()
            report()
        finally:
            # Also after an exception in report() or Ctrl-C: the thread reads the arrays, so it must end first.
            if not self.done.is_set():
                self.context.cancel()
            self.join()

    def run(self) -> None:
        try:
            check(load().pw_build(*self._arguments, ctypes.byref(self.address)), self.context.seconds)
        except PartwheelError as error:
            self.error = error
        finally:
            self.done.set()
