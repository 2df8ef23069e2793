# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh files as arrays: OFF read here, every other format through trimesh (optional), nothing merged or repaired."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple, Optional, Tuple, Union

import numpy as np

from .contents import find_contents
from .library import Error
from .polygons import triangulate
from .requirements import load_module

# Formats whose corners share vertices by index. All others store each triangle's corners apart (STL) or split vertices
# along texture seams (OBJ, glTF), so theirs are welded where their coordinates are exactly equal.
INDEXED_FORMATS = {"off", "ply"}


class MeshFileError(Error):
    """A file that can't be read as a mesh; str() says why. name: "mesh file", beside the library's error names."""

    name = "mesh file"


class Mesh(NamedTuple):
    """vertices (V,3) float64, triangles (T,3) int32, faces (T,) int32 the polygon of each triangle, face_count.
    welded: how many vertices were exact copies of another and were joined with it; 0 for formats with indices. dropped:
    what else the file has, of contents.KINDS, and no output will have."""

    vertices: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    face_count: int
    welded: int
    dropped: Tuple[str, ...] = ()


def read(path: Union[str, Path]) -> Mesh:
    """Reads the surface in a mesh file.

    Parameters
    ----------
    path : an OFF file, or one of any other format that trimesh reads

    Returns
    -------
    the Mesh; its dropped lists what else the file has

    Raises
    ------
    MeshFileError : the file holds no mesh, or a damaged one
    RequirementError : trimesh, which reads all formats but OFF, is not installed
    OSError : the file can't be opened
    """
    path = Path(path)
    with open(path, "rb"):
        pass  # trimesh takes a missing file for a format it does not know
    mesh = _read_off(path) if path.suffix.lower() == ".off" else _read_with_trimesh(path)
    return mesh._replace(dropped=find_contents(path))


def _read_with_trimesh(path: Path) -> Mesh:
    trimesh = load_module("trimesh", f"Reading {path.suffix or 'such'} files")
    try:
        suffix = path.suffix.lower().lstrip(".")
        # Geometry alone: for pictures trimesh would need another package.
        options = {"fix_texture": False} if suffix == "ply" else {}  # or it splits vertices along texture seams
        scene = trimesh.load(path, process=False, force="scene", skip_materials=True, **options)
        pieces = [piece for node in scene.graph.nodes_geometry if (piece := _placed(scene, *scene.graph[node]))]
    except MemoryError:
        raise  # it says nothing about the file
    except Exception as error:  # trimesh's readers raise whatever their parsing meets
        raise MeshFileError(f"trimesh can't read {path.name} as a mesh: {error}") from error
    if not pieces:
        raise MeshFileError(f"{path.name} holds no triangles; only surfaces can be built.")
    offsets = np.cumsum([0] + [len(points) for points, _ in pieces])
    vertices = np.vstack([points for points, _ in pieces])
    triangles = np.vstack([triangles + offset for (_, triangles), offset in zip(pieces, offsets)])
    welded = 0
    if suffix not in INDEXED_FORMATS:
        unique, index = np.unique(vertices + 0.0, axis=0, return_inverse=True)  # + 0.0: -0.0 is 0.0
        welded = len(vertices) - len(unique)
        vertices, triangles = unique, index.reshape(-1)[triangles]
    return Mesh(np.ascontiguousarray(vertices), np.ascontiguousarray(triangles, np.int32),
                np.arange(len(triangles), dtype=np.int32), len(triangles), welded)


def _placed(scene: Any, matrix: np.ndarray, name: str) -> Optional[Tuple[np.ndarray, np.ndarray]]:
    """(points (n,3), triangles (m,3)) of a piece of the scene where the matrix has it, or None if it has no triangles.
    By hand: Scene.dump() would copy what the piece looks like as well, which fails without the package for pictures."""
    piece = scene.geometry[name]
    triangles = piece.faces if hasattr(piece, "faces") else _of_strips(piece)
    if not len(triangles):
        return None
    points = np.asarray(piece.vertices, np.float64)
    if (matrix == np.eye(4)).all():
        return points, triangles
    turned = np.linalg.det(matrix[:3, :3]) < 0
    return points @ matrix[:3, :3].T + matrix[:3, 3], triangles[:, ::-1] if turned else triangles


def _of_strips(cloud: Any) -> np.ndarray:
    """The triangles of a PLY file's element "tristrips", which trimesh reads but takes for no surface: each corner
    makes one with the two before it, every other one turned; -1 begins anew."""
    strips = cloud.metadata.get("_ply_raw", {}).get("tristrips", {}).get("data")
    if strips is None:
        return np.zeros((0, 3), int)
    lists = strips["vertex_indices"]
    triangles = []
    for row in lists["f1"] if lists.dtype.names else lists:
        for strip in np.split(row, np.flatnonzero(row < 0)):
            strip = strip[strip >= 0]
            found = np.column_stack([strip[:-2], strip[1:-1], strip[2:]])
            found[1::2, :2] = found[1::2, 1::-1]
            triangles.append(found)
    triangles = np.vstack(triangles)
    flat = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)  # these only steer the strip
    return triangles[~flat]


def _read_off(path: Path) -> Mesh:
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
