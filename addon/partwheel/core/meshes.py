# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh files as arrays: OFF read here, every other format through trimesh (optional), nothing merged or repaired."""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from .polygons import triangulate

# Formats whose corners share vertices by index. All others store each triangle's corners apart (STL) or split vertices
# along texture seams (OBJ, glTF), so theirs are welded where their coordinates are exactly equal.
INDEXED_FORMATS = {"off", "ply"}


class MeshFileError(Exception):
    """A file that can't be read as a mesh; str() says why. name: "mesh file", beside the library's error names."""

    name = "mesh file"


class Mesh(NamedTuple):
    """vertices (V,3) float64, triangles (T,3) int32, faces (T,) int32 the polygon of each triangle, face_count.
    welded: how many vertices were exact copies of another and were joined with it; 0 for formats with indices."""

    vertices: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    face_count: int
    welded: int


def read(path):
    """The mesh in a file. Raises MeshFileError, or OSError when the file can't be opened."""
    path = Path(path)
    with open(path, "rb"):
        pass  # trimesh takes a missing file for a format it does not know
    if path.suffix.lower() == ".off":
        return _read_off(path)
    return _read_with_trimesh(path)


def _read_with_trimesh(path):
    try:
        import trimesh
    except ImportError as error:
        raise MeshFileError(
            f"Reading {path.suffix or 'this'} files needs the Python package trimesh, which is not installed: "
            "pip install trimesh. OFF files are read without it."
        ) from error
    try:
        scene = trimesh.load(path, process=False, force="scene")
        pieces = [piece for piece in scene.dump() if isinstance(piece, trimesh.Trimesh)]
    except Exception as error:  # trimesh's readers raise whatever their parsing meets
        raise MeshFileError(f"trimesh can't read {path.name} as a mesh: {error}") from error
    if not pieces:
        raise MeshFileError(f"{path.name} holds no triangles; only surfaces can be built.")
    offsets = np.cumsum([0] + [len(piece.vertices) for piece in pieces])
    vertices = np.vstack([np.asarray(piece.vertices, np.float64) for piece in pieces])
    triangles = np.vstack([piece.faces + offset for piece, offset in zip(pieces, offsets)])
    welded = 0
    if path.suffix.lower().lstrip(".") not in INDEXED_FORMATS:
        unique, index = np.unique(vertices + 0.0, axis=0, return_inverse=True)  # + 0.0: -0.0 is 0.0
        welded = len(vertices) - len(unique)
        vertices, triangles = unique, index.reshape(-1)[triangles]
    return Mesh(np.ascontiguousarray(vertices), np.ascontiguousarray(triangles, np.int32),
                np.arange(len(triangles), dtype=np.int32), len(triangles), welded)


def _read_off(path):
    """trimesh drops OFF polygons of more than four corners and forgets which triangles were one quad; we need both."""
    text = path.read_text("utf-8", "replace")
    lines = [words for words in (line.split("#", 1)[0].split() for line in text.splitlines()) if words]
    try:
        if lines[0][0].upper().lstrip("CN") != "OFF":
            raise ValueError("it does not start with OFF")
        lines[0] = lines[0][1:]
        lines = lines[0 if lines[0] else 1:]
        vertex_count, face_count = int(lines[0][0]), int(lines[0][1])
        vertices = np.array([[float(word) for word in line[:3]] for line in lines[1:1 + vertex_count]])
        polygons = [[int(word) for word in line[1:1 + int(line[0])]]
                    for line in lines[1 + vertex_count:1 + vertex_count + face_count]]
        if len(vertices) != vertex_count or len(polygons) != face_count:
            raise ValueError("it ends before all its vertices and faces were read")
        vertices = vertices.reshape(vertex_count, 3)
        triangles, faces = [], []
        for face, polygon in enumerate(polygons):
            if len(polygon) > 3 and not all(0 <= corner < vertex_count for corner in polygon):
                raise ValueError(f"face {face} names a vertex that does not exist")
            pieces = [polygon] if len(polygon) == 3 else triangulate(vertices[polygon], polygon)
            triangles += pieces
            faces += [face] * len(pieces)
    except (IndexError, ValueError) as error:
        raise MeshFileError(f"{path.name} is not a valid OFF file: {error}.") from error
    return Mesh(vertices, np.array(triangles, np.int64).reshape(-1, 3), np.array(faces, np.int32), face_count, 0)
