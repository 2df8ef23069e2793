# SPDX-License-Identifier: GPL-3.0-or-later
"""The ctypes binding of the native library: every function, struct and status of native/include/; and builds by it, for
this process and for a worker, which has neither numpy nor a package around this file."""

import ctypes
import enum
import functools
import os
import threading
import weakref
from ctypes import POINTER, c_char_p, c_double, c_int, c_int32, c_int64, c_size_t, c_uint32, c_void_p
from pathlib import Path

if __package__:
    from .loading import FILE_NAMES, SYSTEM, open_library
else:  # the worker's bare Python
    from loading import FILE_NAMES, SYSTEM, open_library  # type: ignore[no-redef]

VERSION = "0.1.0"  # of partwheel.h, as declared here
EDIT_API_VERSION = 1  # of partwheel_edit.h
LIBRARY = Path(__file__).resolve().with_name(FILE_NAMES[SYSTEM])
SOURCES = LIBRARY.parent / "../../src"


# pw_status; and pw_stage, the stages of a build in their order.
Status = enum.IntEnum("Status", [
    "OK", "ARGUMENT", "EMPTY", "NOT_FINITE", "INDEX", "DEGENERATE", "OPEN", "NON_MANIFOLD", "ORIENTATION",
    "SELF_INTERSECTION", "NO_VOLUME", "TETRAHEDRA", "CANCELLED", "MEMORY", "DATA", "INTERNAL", "NOT_SOLID",
    "CAPACITY"], start=0)
Stage = enum.IntEnum("Stage", ["SURFACE", "REPAIR", "TETRAHEDRA", "CLUSTER", "DENDROGRAM", "HIERARCHY"], start=0)


class FillMethod(enum.IntFlag):
    """pw_fill_method: how a surface is filled with tetrahedra, from the best way down."""

    EXACT = 1
    REPAIRED = 2
    POINTS = 4


FILL_METHODS = FillMethod.EXACT, FillMethod.REPAIRED, FillMethod.POINTS


class Mode(enum.IntEnum):
    """pw_mode."""

    REGROUPED = 0
    PAPER = 1


STAGE_COUNT = len(Stage)


class _Sized(ctypes.Structure):
    """A struct that begins with its size: see the habits in partwheel.h."""

    def __init__(self, **fields):
        super().__init__(struct_size=ctypes.sizeof(self), **fields)


class MeshView(_Sized):
    """pw_mesh_view, of packed float64 and int32."""

    _fields_ = [
        ("struct_size", c_size_t), ("vertices", c_void_p), ("vertex_count", c_size_t), ("vertex_stride", c_size_t),
        ("triangles", c_void_p), ("triangle_count", c_size_t), ("triangle_stride", c_size_t), ("faces", c_void_p),
        ("face_count", c_size_t), ("face_stride", c_size_t), ("vertex_type", c_int32), ("index_type", c_int32),
    ]

    @classmethod
    def of(cls, vertices, triangles, faces, face_count, address):
        """Of arrays, which live as long as this. faces may be None. address: a function that gives an array's."""
        mesh = cls(vertices=address(vertices), vertex_count=len(vertices), triangles=address(triangles),
                   triangle_count=len(triangles), faces=None if faces is None else address(faces), face_count=face_count)
        mesh.arrays = vertices, triangles, faces
        return mesh


class ErrorInfo(_Sized):
    """pw_error_info."""

    _fields_ = [("struct_size", c_size_t), ("faces", c_int64 * 2), ("vertices", c_int64 * 2), ("triangle", c_int64)]


class BuildOptions(_Sized):
    """pw_build_options."""

    _fields_ = [
        ("struct_size", c_size_t), ("quality", c_double), ("fill_methods", c_uint32), ("open_surfaces", c_int32),
        ("threads", c_int32), ("mode", c_int32), ("exact_triangles", c_int64),
    ]


class Arrays(_Sized):
    """pw_arrays. Its pointers are kept as addresses: hierarchy.py makes numpy views of them."""

    COUNTS = ("face_count", "node_count", "tetrahedron_count", "vertex_count")
    POINTERS = (
        "order", "leaf", "parent", "first", "last", "tet_first", "tet_last", "cost_class", "cost", "height", "volume",
        "area", "vertices", "source", "tetrahedra", "merges", "score",
    )
    _fields_ = [(name, c_size_t) for name in ("struct_size", *COUNTS)] + [(name, c_void_p) for name in POINTERS]


class SummaryStruct(_Sized):
    """pw_summary."""

    _fields_ = [
        ("struct_size", c_size_t), ("components", c_size_t), ("cavities", c_size_t), ("added_vertices", c_size_t),
        ("volume", c_double), ("hull_volume", c_double), ("fill_method", c_int), ("deviation", c_double),
        ("proxy_triangles", c_size_t),
    ]


class ConvexOptions(_Sized):
    """pw_convex_options."""

    _fields_ = [
        ("struct_size", c_size_t), ("hulls", c_size_t), ("error", c_double), ("max_vertices", c_size_t),
    ]


class Address(c_void_p):
    """An argument: a number, a Handle, a buffer of ctypes, or an array of numpy's, which lives on meanwhile."""

    @classmethod
    def from_param(cls, value):
        return value.ctypes if hasattr(value, "ctypes") else super().from_param(value)


# Name -> result, arguments. Every c_void_p that is not pointed to is taken as an Address.
FUNCTIONS = {
    "pw_version": (c_char_p, []),
    "pw_version_number": (c_int32, []),
    "pw_status_name": (c_char_p, [c_int]),
    "pw_stage_name": (c_char_p, [c_int]),
    "pw_error_message": (c_char_p, []),
    "pw_error_details": (c_int, [POINTER(ErrorInfo)]),
    "pw_edit_api_version": (c_int32, []),
    "pw_context_create": (c_int, [POINTER(c_void_p)]),
    "pw_context_free": (None, [c_void_p]),
    "pw_context_cancel": (c_int, [c_void_p]),
    "pw_context_progress": (c_int, [c_void_p, POINTER(c_double), POINTER(c_int)]),
    "pw_context_fill_method": (c_int, [c_void_p, POINTER(c_int)]),
    "pw_context_seconds": (c_int, [c_void_p, POINTER(c_double)]),
    "pw_build": (c_int, [c_void_p, POINTER(MeshView), POINTER(BuildOptions), POINTER(c_void_p)]),
    "pw_hierarchy_free": (None, [c_void_p]),
    "pw_hierarchy_arrays": (c_int, [c_void_p, POINTER(Arrays)]),
    "pw_hierarchy_summary": (c_int, [c_void_p, POINTER(SummaryStruct)]),
    "pw_hierarchy_account": (c_char_p, [c_void_p]),
    "pw_hierarchy_path": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_wheel": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t), POINTER(c_size_t)]),
    "pw_hierarchy_faces": (c_int, [c_void_p, c_size_t, POINTER(c_void_p), POINTER(c_size_t)]),
    "pw_hierarchy_cut_height": (c_int, [c_void_p, c_double, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_cut_parts": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_cut_least_concavity": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_cut_automatic": (c_int, [c_void_p, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_hull": (c_int, [c_void_p, c_void_p, c_size_t, c_size_t, POINTER(c_void_p)]),
    "pw_hierarchy_convex_parts": (c_int, [c_void_p, c_void_p, POINTER(ConvexOptions), POINTER(c_void_p)]),
    "pw_convex_parts_free": (None, [c_void_p]),
    "pw_convex_parts_count": (c_int, [c_void_p, POINTER(c_size_t)]),
    "pw_convex_parts_hull": (c_int, [c_void_p, c_size_t, POINTER(c_void_p), POINTER(c_size_t), POINTER(c_void_p),
                                     POINTER(c_size_t), POINTER(c_double), POINTER(c_double)]),
    "pw_hierarchy_solid": (c_int, [c_void_p, c_void_p, c_size_t, c_size_t, c_void_p, c_size_t, POINTER(c_void_p)]),
    "pw_hierarchy_solid_of_slices": (c_int, [c_void_p, c_void_p, c_void_p, c_size_t, c_void_p, c_size_t,
                                             POINTER(c_void_p)]),
    "pw_hierarchy_solid_of_faces": (c_int, [c_void_p, c_void_p, c_size_t, c_size_t, c_void_p, c_size_t,
                                            POINTER(c_void_p)]),
    "pw_polygon_faults": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, c_size_t, POINTER(c_size_t),
                                  POINTER(c_size_t), POINTER(c_size_t)]),
    "pw_duplicate_faces": (c_int, [c_void_p, POINTER(MeshView), c_void_p]),
    "pw_faired": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, c_void_p]),
    "pw_creases_create": (c_int, [c_void_p, POINTER(MeshView), POINTER(c_void_p)]),
    "pw_creases_free": (None, [c_void_p]),
    "pw_creases_snap": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p]),
    "pw_ray_target_create": (c_int, [c_void_p, POINTER(MeshView), POINTER(c_void_p)]),
    "pw_ray_target_free": (None, [c_void_p]),
    "pw_ray_target_first": (c_int, [c_void_p, c_void_p, c_void_p, c_double, POINTER(c_int32), POINTER(c_double)]),
    "pw_index_create": (c_int, [c_void_p, c_void_p, c_void_p, c_size_t, c_int32, POINTER(c_void_p)]),
    "pw_index_free": (None, [c_void_p]),
    "pw_index_holding": (c_int, [c_void_p, c_void_p, c_void_p, c_size_t, c_void_p]),
    "pw_index_first_hits": (c_int, [c_void_p, c_void_p, c_void_p, c_void_p, c_size_t, c_void_p, c_void_p]),
    "pw_index_nearest": (c_int, [c_void_p, c_void_p, c_void_p, c_size_t, c_void_p, c_void_p, c_void_p]),
    "pw_index_touching": (c_int, [c_void_p, c_void_p, c_void_p, c_void_p, c_size_t, c_void_p, c_void_p]),
    "pw_mirror_planes": (c_int, [c_void_p, POINTER(MeshView), c_void_p, POINTER(c_size_t)]),
    "pw_mesh_origins": (c_int, [c_void_p, POINTER(c_void_p), POINTER(c_void_p), POINTER(c_void_p)]),
    "pw_mesh_free": (None, [c_void_p]),
    "pw_mesh_arrays": (c_int, [c_void_p, POINTER(c_void_p), POINTER(c_size_t), POINTER(c_void_p), POINTER(c_size_t)]),
    "pw_hierarchy_save": (c_int, [c_void_p, c_void_p, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_load": (c_int, [c_void_p, c_void_p, c_size_t, POINTER(c_void_p)]),
    "pw_deformation_create": (c_int, [c_void_p, POINTER(MeshView), c_void_p, c_int32, POINTER(c_void_p)]),
    "pw_deformation_free": (None, [c_void_p]),
    "pw_deformation_move": (c_int, [c_void_p, c_size_t, c_void_p]),
    "pw_deformation_iterate": (c_int, [c_void_p, c_void_p, c_size_t]),
    "pw_deformation_energy": (c_int, [c_void_p, POINTER(c_double)]),
    "pw_deformation_positions": (c_int, [c_void_p, c_void_p, c_size_t]),
    "pw_deformation_reset": (c_int, [c_void_p]),
    "pw_vertex_normals": (c_int, [POINTER(MeshView), c_void_p]),
    "pw_surface_distances": (c_int, [c_void_p, POINTER(MeshView), c_void_p, c_void_p]),
}


class Error(Exception):
    """What this package refuses: the base of its own errors. str() is sentences a user can act on. name: what kind it
    is, in stable words. seconds: stage name -> seconds spent in a failed build, else empty."""

    name = "error"
    seconds: dict = {}

    def __reduce__(self):
        """As it is, for a copy or another process: constructors take other arguments than args."""
        return _restored, (type(self), self.args), vars(self)


def _restored(kind, arguments):
    """An Error without its attributes."""
    return kind.__new__(kind, *arguments)


class LibraryError(Error, OSError):
    """The native library is missing, or is not the one this Python code was written for."""

    name = "library"


class PartwheelError(Error):
    """What the native library refused, and why. status: a Status; name: it in words ("self-intersection").

    faces, vertices: tuples of the source faces and vertices of the given mesh that are wrong, as far as the library knows:
    the first wrong face or both that intersect; a vertex or both ends of an edge. triangle: the one that names a vertex
    or a face that does not exist, or None."""

    def __init__(self, status, message, seconds=None, faces=(), vertices=(), triangle=None):
        super().__init__(message)
        self.status = Status(status)
        self.name = load().pw_status_name(status).decode()
        self.seconds = seconds or {}
        self.faces, self.vertices, self.triangle = tuple(faces), tuple(vertices), triangle


_loading = threading.Lock()


@functools.cache
def load():
    """The native library with every function's types declared. Raises LibraryError."""
    with _loading:  # opening it writes files on Windows
        return _load()


def _load():
    # Another one, for tests and sanitizers, in the source tree alone: what is installed loads what it brings.
    other = SOURCES.is_dir() and os.environ.get("PARTWHEEL_LIBRARY")
    path = other or str(LIBRARY)
    try:
        library = open_library(path)
    except OSError as error:
        raise LibraryError(str(error)) from error.__cause__  # the loader's own words
    for name, (result, arguments) in FUNCTIONS.items():
        try:
            function = getattr(library, name)
        except AttributeError as error:
            raise _other_version(path, f"it has no function {name}") from error
        function.restype = result
        function.argtypes = [Address if each is c_void_p else each for each in arguments]
    found = library.pw_version().decode()
    if found != VERSION:
        raise _other_version(path, f"it is {found}, not {VERSION}")
    found = library.pw_edit_api_version()
    if found != EDIT_API_VERSION:
        raise _other_version(path, f"its editing functions are version {found}, not {EDIT_API_VERSION}")
    return library


def _other_version(path, why):
    # A program that had the library loaded when the add-on was updated goes on with the old one.
    return LibraryError(
        f"{path} is another version of Partwheel's library than this add-on is for: {why}. Restart the program. If "
        "that does not help, install the add-on anew, or build the library again (scripts/build)."
    )


def version():
    """The native library's version, "major.minor.patch"."""
    return load().pw_version().decode()


def check(status, seconds=dict):
    """Raises PartwheelError for any status but OK. Call it in the failed call's thread: each has its own message."""
    if status != Status.OK:
        message, info = load().pw_error_message().decode(), ErrorInfo()
        if load().pw_error_details(info) != Status.OK:
            info = ErrorInfo(triangle=-1)
        faces, vertices = ([index for index in each if index >= 0] for each in (info.faces, info.vertices))
        raise PartwheelError(status, message, seconds(), faces, vertices, info.triangle if info.triangle >= 0 else None)


def told(types, function, *arguments):
    """What a function of the library tells: the list of what its last arguments, pointers to these types, point to."""
    values = [each() for each in types]
    check(function(*arguments, *map(ctypes.byref, values)))
    return [each.value for each in values]


def made(create, *arguments):
    """The address of the native object that this function makes."""
    return told([c_void_p], create, *arguments)[0]


class NonCopyable:
    """What has native memory or a process of its own, and no saved form."""

    def __reduce__(self):
        raise TypeError(f"{type(self).__name__} can't be copied or pickled: it refers to memory of this process. Make "
                        "another one from the same data. A Hierarchy can be pickled.")


class Handle(NonCopyable):
    """A native object, freed with the last reference to this."""

    def __init__(self, free, address):
        self._as_parameter_ = address
        # Not at exit: views may still be in use then, and the process gives the memory back anyway.
        weakref.finalize(self, free, address).atexit = False


# ---- Builds, in this process or in a worker


class Context(Handle):
    """pw_context: progress, cancel and timing of a call."""

    def __init__(self):
        super().__init__(load().pw_context_free, made(load().pw_context_create))

    def cancel(self):
        check(load().pw_context_cancel(self))

    def progress(self):
        """(fraction, stage name)"""
        fraction, stage = told([c_double, c_int], load().pw_context_progress, self)
        return fraction, load().pw_stage_name(stage).decode()

    def seconds(self):
        """Stage name -> seconds of the last build."""
        seconds = (c_double * STAGE_COUNT)()
        check(load().pw_context_seconds(self, seconds))
        return {load().pw_stage_name(stage).decode(): seconds[stage] for stage in Stage}


class Build(threading.Thread):
    """pw_build in a thread of its own: ctypes lets go of Python's lock, so the caller's thread stays free."""

    def __init__(self, context, surface, options):
        """surface: a MeshView."""
        super().__init__(name="partwheel-build", daemon=True)
        self._arguments = context, surface, ctypes.byref(options)
        self.context, self.address, self.error = context, c_void_p(), None
        self.done = threading.Event()  # not is_alive(), which may say no too early after Ctrl-C (bpo-45274)

    def run(self):
        try:
            check(load().pw_build(*self._arguments, ctypes.byref(self.address)), self.context.seconds)
        except PartwheelError as error:
            self.error = error
        finally:
            self.done.set()
