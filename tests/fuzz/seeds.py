# SPDX-License-Identifier: GPL-3.0-or-later
"""What the fuzzers begin with: small real meshes, and the hierarchies saved of them, in the form that each reads."""

import numpy as np
from conftest import ROOT
from partwheel.core import Hierarchy, PartwheelError, meshes

DEMO = ROOT / "build" / "deps" / "meshes"
MOST_VERTICES, MOST_TRIANGLES = 239, 160  # that the mesh fuzzer can say
MOST_FILE, MOST_SAVED = 40_000, 8_000  # bytes of a file of the demo, and of a saved hierarchy: small ones run faster
CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float), np.array(
    [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
     (1, 5, 7), (1, 7, 3)])


def small():
    """(name, vertices, triangles) of a cube, two that touch, two that cross, and the demo's small meshes."""
    vertices, triangles = CUBE
    yield "cube", vertices, triangles
    for name, by in (("touching", 1), ("crossing", 0.5), ("nested", -1)):
        other = vertices + by if by > 0 else 3 * vertices + by
        yield name, np.vstack([vertices, other]), np.vstack([triangles, triangles + len(vertices)])
    for path in sorted(DEMO.iterdir()):
        if path.stat().st_size < MOST_FILE:
            try:
                mesh = meshes.read(path)
            except meshes.MeshFileError:  # a cloud of points
                continue
            yield path.name, mesh.vertices, mesh.triangles


def as_bytes(vertices, triangles, flags):
    """The bytes that the mesh fuzzer takes for this mesh, rounded to its grid; see mesh_fuzzer.cpp."""
    low, size = vertices.min(axis=0), max(np.ptp(vertices, axis=0).max(), 1e-300)
    grid = np.round((vertices - low) / size * 239).astype(np.uint8)
    return bytes([flags, len(vertices)]) + grid.tobytes() + triangles.astype(np.uint8).tobytes()


def write(directory):
    """Fills directory/mesh and directory/saved; returns their numbers of files."""
    for name in ("mesh", "saved"):
        (directory / name).mkdir(parents=True)
    for name, vertices, triangles in small():
        if len(vertices) <= MOST_VERTICES and len(triangles) <= MOST_TRIANGLES:
            for flags in (1, 3, 1 + 16, 1 + 32):
                (directory / "mesh" / f"{name}-{flags}").write_bytes(as_bytes(vertices, triangles, flags))
        try:
            saved = Hierarchy.build(vertices, triangles, rungs=3).save()
        except PartwheelError:
            continue
        if len(saved) <= MOST_SAVED:
            (directory / "saved" / name).write_bytes(saved)
    return [len(list((directory / name).iterdir())) for name in ("mesh", "saved")]
