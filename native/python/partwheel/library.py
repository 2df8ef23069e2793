# SPDX-License-Identifier: GPL-3.0-or-later
"""The ctypes binding of the native library: every function, struct and status of native/include/."""

import ctypes
import enum
import functools
import os
from ctypes import POINTER, c_char_p, c_double, c_int, c_int32, c_int64, c_size_t, c_uint32, c_void_p
from pathlib import Path

if __package__:
    from .loading import FILE_NAMES, SYSTEM, open_library
else:  # the worker's bare Python
    from loading import FILE_NAMES, SYSTEM, open_library

VERSION = "0.1.0"  # of partwheel.h, as declared here
LIBRARY = Path(__file__).resolve().with_name(FILE_NAMES[SYSTEM])
SOURCES = LIBRARY.parent / "../../src"


class Status(enum.IntEnum):
    """pw_status."""

    OK = 0
    ARGUMENT = 1
    EMPTY = 2
    NOT_FINITE = 3
    INDEX = 4
    DEGENERATE = 5
    OPEN = 6
    NON_MANIFOLD = 7
    ORIENTATION = 8
    SELF_INTERSECTION = 9
    NO_VOLUME = 10
    TETRAHEDRA = 11
    CANCELLED = 12
    MEMORY = 13
    DATA = 14
    INTERNAL = 15
    NOT_SOLID = 16


class Stage(enum.IntEnum):
    """pw_stage: the stages of a build, in their order."""

    SURFACE = 0
    REPAIR = 1
    TETRAHEDRA = 2
    CLUSTER = 3
    DENDROGRAM = 4
    HIERARCHY = 5


class Rung(enum.IntEnum):
    """pw_rung: the ways to a surface that can be filled, from the best one down."""

    EXACT = 1
    REPAIRED = 2
    POINTS = 4
    COARSE = 8  # no way to be asked for: what comes of a large mesh, by one of those above


RUNGS = Rung.EXACT, Rung.REPAIRED, Rung.POINTS  # those that may be asked for


class Mode(enum.IntEnum):
    """pw_mode."""

    REGROUPED = 0
    PAPER = 1


STAGE_COUNT = len(Stage)


class _Sized(ctypes.Structure):
    """A struct that begins with its size: see the habits in partwheel.h."""

    def __init__(self, **fields):
        super().__init__(struct_size=ctypes.sizeof(self), **fields)


class BuildOptions(_Sized):
    """pw_build_options."""

    _fields_ = [
        ("struct_size", c_size_t), ("quality", c_double), ("rungs", c_uint32), ("open_surfaces", c_int32),
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
        ("volume", c_double), ("hull_volume", c_double), ("rung", c_int), ("deviation", c_double),
    ]


# Name -> result, arguments. Handles, and buffers that numpy owns, pass as addresses (c_void_p).
FUNCTIONS = {
    "pw_version": (c_char_p, []),
    "pw_version_number": (c_int32, []),
    "pw_status_name": (c_char_p, [c_int]),
    "pw_stage_name": (c_char_p, [c_int]),
    "pw_error_message": (c_char_p, []),
    "pw_context_create": (c_int, [POINTER(c_void_p)]),
    "pw_context_free": (None, [c_void_p]),
    "pw_context_cancel": (c_int, [c_void_p]),
    "pw_context_progress": (c_int, [c_void_p, POINTER(c_double), POINTER(c_int)]),
    "pw_context_rung": (c_int, [c_void_p, POINTER(c_int)]),
    "pw_context_seconds": (c_int, [c_void_p, POINTER(c_double)]),
    "pw_build": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, c_size_t, POINTER(BuildOptions),
                         POINTER(c_void_p)]),
    "pw_hierarchy_free": (None, [c_void_p]),
    "pw_hierarchy_arrays": (c_int, [c_void_p, POINTER(Arrays)]),
    "pw_hierarchy_summary": (c_int, [c_void_p, POINTER(SummaryStruct)]),
    "pw_hierarchy_account": (c_char_p, [c_void_p]),
    "pw_hierarchy_path": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_wheel": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t), POINTER(c_size_t)]),
    "pw_hierarchy_faces": (c_int, [c_void_p, c_size_t, POINTER(c_void_p), POINTER(c_size_t)]),
    "pw_hierarchy_cut_height": (c_int, [c_void_p, c_double, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_cut_parts": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_cut_least_concavity": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_cut_automatic": (c_int, [c_void_p, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_hull": (c_int, [c_void_p, c_size_t, c_size_t, POINTER(c_void_p)]),
    "pw_hierarchy_solid": (c_int, [c_void_p, c_size_t, c_size_t, c_void_p, c_size_t, POINTER(c_void_p)]),
    "pw_hierarchy_solid_of_faces": (c_int, [c_void_p, c_size_t, c_size_t, c_void_p, c_size_t, POINTER(c_void_p)]),
    "pw_polygon_faults": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, c_size_t, POINTER(c_size_t),
                                  POINTER(c_size_t), POINTER(c_size_t)]),
    "pw_faired": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, c_void_p]),
    "pw_creases_create": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_void_p)]),
    "pw_creases_free": (None, [c_void_p]),
    "pw_creases_snap": (c_int, [c_void_p, c_void_p, c_size_t, c_void_p]),
    "pw_ray_target_create": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, POINTER(c_void_p)]),
    "pw_ray_target_free": (None, [c_void_p]),
    "pw_ray_target_first": (c_int, [c_void_p, c_void_p, c_void_p, c_double, POINTER(c_int32), POINTER(c_double)]),
    "pw_mesh_origins": (c_int, [c_void_p, POINTER(c_void_p), POINTER(c_void_p), POINTER(c_void_p)]),
    "pw_mesh_free": (None, [c_void_p]),
    "pw_mesh_arrays": (c_int, [c_void_p, POINTER(c_void_p), POINTER(c_size_t), POINTER(c_void_p), POINTER(c_size_t)]),
    "pw_hierarchy_save": (c_int, [c_void_p, c_void_p, c_size_t, POINTER(c_size_t)]),
    "pw_hierarchy_load": (c_int, [c_void_p, c_size_t, POINTER(c_void_p)]),
    "pw_deformation_create": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, POINTER(c_void_p)]),
    "pw_deformation_free": (None, [c_void_p]),
    "pw_deformation_move": (c_int, [c_void_p, c_size_t, c_void_p]),
    "pw_deformation_iterate": (c_int, [c_void_p, c_size_t]),
    "pw_deformation_energy": (c_int, [c_void_p, POINTER(c_double)]),
    "pw_deformation_positions": (c_int, [c_void_p, c_void_p, c_size_t]),
    "pw_deformation_reset": (c_int, [c_void_p]),
    "pw_vertex_normals": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, c_void_p]),
    "pw_surface_distances": (c_int, [c_void_p, c_size_t, c_void_p, c_size_t, c_void_p, c_void_p]),
}


class Error(Exception):
    """What this package refuses: the base of its own errors. str() is sentences a user can act on."""


class LibraryError(Error, OSError):
    """The native library is missing, or is not the one this Python code was written for."""


class PartwheelError(Error):
    """What the native library refused, and why: str() is sentences a user can act on.

    status: a Status. name: it in words, stable ("self-intersection"). seconds: stage name -> seconds spent in a failed
    build, else empty.
    """

    def __init__(self, status, message, seconds=None):
        super().__init__(message)
        self.status = Status(status)
        self.name = load().pw_status_name(status).decode()
        self.seconds = seconds or {}


@functools.cache
def load():
    """The native library with every function's types declared. Raises LibraryError."""
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
        function.argtypes = arguments
    found = library.pw_version().decode()
    if found != VERSION:
        raise _other_version(path, f"it is {found}, not {VERSION}")
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


def check(status, seconds=None):
    """Raises PartwheelError for any status but OK. Call it in the failed call's thread: each has its own message."""
    if status != Status.OK:
        raise PartwheelError(status, load().pw_error_message().decode(), seconds)
