# SPDX-License-Identifier: GPL-3.0-or-later
"""Seeds of the fuzzers: small real meshes, and saved hierarchies of them, in the format of each fuzzer."""

import math

import numpy as np
from conftest import ROOT
from partwheel import FillMethod, Hierarchy, Mode, PartwheelError, meshes

DEMO = ROOT / "build" / "deps" / "meshes"
MAX_VERTICES, MAX_TRIANGLES = 239, 160  # of the mesh fuzzer's format
# Kind of a seed of the mesh fuzzer -> its first two bytes: see mesh_fuzzer.cpp.
KINDS = {
    "exact": (1, 0), "repaired": (3, 1 << 1), "inside": (1 + 16, 2 << 1), "polygons": (1 + 32, 3 << 1),
    "paper": (1 + 32, 1), "fine": (1, 8), "rough": (1, 8 + (2 << 4)), "crossing": (3, 8 + (3 << 4)),
    "coarse": (7, 128),
}
# Kind -> number of meshes, from the cube on, that have seeds of the kind; all meshes for other kinds.
MAX_SEEDS = {"repaired": 20, "inside": 20, "polygons": 20, "paper": 20, "fine": 1, "rough": 1, "crossing": 1, "coarse": 12,
             "sheet": 8}
# Kind of a saved hierarchy -> options of its build, where they differ from CLOSED.
CLOSED = {"fill_methods": FillMethod.EXACT | FillMethod.REPAIRED}
SAVED = {"learned": {}, "inside": {"quality": 1.4}, "paper": {"mode": Mode.PAPER}, "sheet": {"fill_methods": FillMethod.SHEET}}
MAX_FILE_BYTES, MAX_SAVED_BYTES = 40_000, 8_000  # of a model and of a saved hierarchy: small ones run faster
CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float), np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
     (1, 5, 7), (1, 7, 3)])


def small_meshes():
    """(name, vertices, triangles) of a cube, pairs of cubes that touch, cross or are nested, and small models."""
    vertices, triangles = CUBE
    yield "cube", vertices, triangles
    for name, by in (("touching", 1), ("crossing", 0.5), ("nested", -1)):
        other = vertices + by if by > 0 else 3 * vertices + by
        yield name, np.vstack([vertices, other]), np.vstack([triangles, triangles + len(vertices)])
    for path in sorted(DEMO.iterdir()):
        if path.stat().st_size < MAX_FILE_BYTES:
            try:
                mesh = meshes.read(path)
            except meshes.MeshFileError:  # a cloud of points
                continue
            yield path.name, mesh.vertices, mesh.triangles


def quantize(vertices):
    """The coordinates as bytes, rounded to the grid of bytes.h."""
    low, size = vertices.min(axis=0), max(np.ptp(vertices, axis=0).max(), 1e-300)
    return np.round((vertices - low) / size * 239).astype(np.uint8).tobytes()


def mesh_input(vertices, triangles, kind):
    """An input of the mesh fuzzer: see mesh_fuzzer.cpp."""
    return bytes([*KINDS[kind], len(vertices)]) + quantize(vertices) + triangles.astype(np.uint8).tobytes()


def surface_input(vertices, triangles, flags):
    """An input of the surface fuzzer: the part and the handle are on one side, fixed vertices on the other; two small moves of
    the handle. See surface_fuzzer.cpp."""
    axis = np.ptp(vertices, axis=0).argmax()
    along = (vertices[:, axis] - vertices[:, axis].min()) / max(np.ptp(vertices[:, axis]), 1e-300)
    handle, free, fixed = 0, 2, 6
    roles = np.where(along < 0.25, fixed, np.where(along > 0.75, handle, free)).astype(np.uint8)
    faces = triangles[::2] if flags & 1 else triangles
    part = (along[faces].mean(axis=1) > 0.5).astype(np.uint8)
    moves = bytes([0, *[120] * 3, 130, *[120] * 8]) + bytes([0, 120, 140, *[120] * 10])
    return (bytes([flags, len(vertices), len(triangles)]) + quantize(vertices) + triangles.astype(np.uint8).tobytes()
            + roles.tobytes() + part.tobytes() + moves)


def write(directory):
    """Writes the seeds to directory/FUZZER/KIND. Returns the number of files per fuzzer."""
    def write_seed(fuzzer, kind, name, data):
        path = directory / fuzzer / kind / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)

    for number, (name, vertices, triangles) in enumerate(small_meshes()):
        if len(vertices) <= MAX_VERTICES and len(triangles) <= MAX_TRIANGLES:
            for kind in KINDS:
                if number < MAX_SEEDS.get(kind, math.inf):
                    write_seed("mesh", kind, name, mesh_input(vertices, triangles, kind))
            for flags, kind in enumerate(("triangles", "polygons")):
                write_seed("surface", kind, name, surface_input(vertices, triangles, flags))
        for kind, options in SAVED.items():
            if number >= MAX_SEEDS.get(kind, math.inf):
                continue
            try:
                saved = Hierarchy.build(vertices, triangles, **{**CLOSED, **options}).save()
            except PartwheelError:
                continue
            if len(saved) <= MAX_SAVED_BYTES:
                write_seed("saved", kind, name, saved)
    return [sum(path.is_file() for path in each.rglob("*")) for each in directory.iterdir()]
