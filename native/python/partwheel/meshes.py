# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads mesh files as arrays, without repairs: OFF and OBJ itself, other formats through trimesh (optional)."""

from __future__ import annotations

import io
import json
import re
import struct
from pathlib import Path
from typing import Any, Dict, NamedTuple, Optional, Tuple, Union

import numpy as np

from .contents import find_contents, read_header
from .library import Error
from .ply import to_text_if_mixed
from .polygons import fan_or_ears, is_fan, triangulate
from .requirements import load_module

# Formats in which triangles share vertices by index. The others store the corners of each triangle separately (STL) or
# split vertices along texture seams (OBJ, glTF); for these, vertices with identical coordinates are welded.
INDEXED_FORMATS = {"off", "ply"}
# The units of 3MF files.
MILLIMETERS = {"micron": 0.001, "millimeter": 1.0, "centimeter": 10.0, "inch": 25.4, "foot": 304.8, "meter": 1000.0}

TRIANGLE_FAN = 6  # a mode of glTF's primitives


class MeshFileError(Error):
    """A file can't be read as a mesh; str() says why. name: "mesh file", which is no name of the library's errors."""

    name = "mesh file"


class Mesh(NamedTuple):
    """A triangulated surface.

    vertices : (V, 3) float64
    triangles : (T, 3) int32
    faces : (T,) int32, the polygon of each triangle
    face_count : number of polygons
    welded : number of vertices removed because another one has identical coordinates; 0 for formats with indices
    dropped : what else the file has, of contents.KINDS; no output has it
    nodes : (T,) int, the number of the scene's node that each triangle is from; empty if the format has no scene
    """

    vertices: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    face_count: int
    welded: int
    dropped: Tuple[str, ...] = ()
    nodes: np.ndarray = np.zeros(0, np.int64)


def read(path: Union[str, Path]) -> Mesh:
    """Reads the surface in a mesh file.

    Parameters
    ----------
    path : an OFF or OBJ file, or one of any other format that trimesh reads

    Returns
    -------
    the Mesh; its dropped lists what else the file has

    Raises
    ------
    MeshFileError : the file holds no mesh, or a damaged one
    RequirementError : trimesh, which reads all formats but OFF and OBJ, is not installed
    OSError : the file can't be opened
    """
    path = Path(path)
    with open(path, "rb"):
        pass  # raises OSError; trimesh would report an unknown format
    reader = {".off": _read_off, ".obj": _read_obj}.get(path.suffix.lower(), _read_with_trimesh)
    return reader(path)._replace(dropped=find_contents(path))


def _read_with_trimesh(path: Path) -> Mesh:
    trimesh = load_module("trimesh", f"Reading {path.suffix or 'such'} files")
    suffix = path.suffix.lower().lstrip(".")
    try:
        # skip_materials: images would require another package.
        options: Dict[str, Any] = {"process": False, "force": "scene", "skip_materials": True}
        if suffix == "ply":
            options["fix_texture"] = False  # True would split vertices along texture seams
        data = {"ply": to_text_if_mixed, "glb": _check_primitives, "gltf": _check_primitives}.get(suffix, lambda _: None)(path)
        if data is None:
            scene = trimesh.load(path, **options)
        else:
            resolver = trimesh.resolvers.FilePathResolver(str(path))
            scene = trimesh.load(io.BytesIO(data), file_type=suffix, resolver=resolver, **options)
        pieces = [piece for node in scene.graph.nodes_geometry if (piece := _transformed_piece(scene, *scene.graph[node]))]
    except (MemoryError, MeshFileError):
        raise  # not an error of the file; already says what is wrong
    except Exception as error:  # trimesh's readers raise many types
        raise MeshFileError(f"trimesh can't read {path.name} as a mesh: {error}") from error
    if not pieces:
        raise _no_triangles(path)
    offsets = np.cumsum([0] + [len(points) for points, _ in pieces])
    vertices = np.vstack([points for points, _ in pieces])
    triangles = np.vstack([triangles + offset for (_, triangles), offset in zip(pieces, offsets)])
    if suffix == "3mf":  # 3D printers and this package's output use millimeters
        vertices *= MILLIMETERS.get(scene.units, 1.0)
    nodes = np.repeat(np.arange(len(pieces)), [len(triangles) for _, triangles in pieces])
    return _triangle_mesh(vertices, triangles, weld=suffix not in INDEXED_FORMATS)._replace(nodes=nodes)


def _check_primitives(path: Path) -> Optional[bytes]:
    """Raises MeshFileError if a glTF file has triangle fans, which trimesh skips without a message. If it has primitives
    without positions, which are empty, and which trimesh can't read: the file without them; otherwise None."""
    header = read_header(path)
    document = json.loads(header)
    primitives = [primitive for mesh in document.get("meshes", []) for primitive in mesh.get("primitives", [])]
    if any(primitive.get("mode") == TRIANGLE_FAN for primitive in primitives):
        raise MeshFileError(f"{path.name} has triangle fans, which can't be read. Export it with plain triangles.")
    if all("POSITION" in primitive.get("attributes", {}) for primitive in primitives):
        return None
    for mesh in document["meshes"]:
        mesh["primitives"] = [primitive for primitive in mesh["primitives"] if "POSITION" in primitive.get("attributes", {})]
    text = json.dumps(document).encode()
    if path.suffix.lower() != ".glb":
        return text
    text += b" " * (-len(text) % 4)
    rest = path.read_bytes()[20 + len(header):]
    return struct.pack("<4s3I4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest


def _triangle_mesh(vertices: np.ndarray, triangles: np.ndarray, weld: bool) -> Mesh:
    """A Mesh whose faces are its triangles. weld: weld vertices with identical coordinates."""
    welded = 0
    if weld:
        unique, index = np.unique(vertices + 0.0, axis=0, return_inverse=True)  # + 0.0 turns -0.0 into 0.0
        welded = len(vertices) - len(unique)
        vertices, triangles = unique, index.reshape(-1)[triangles]
    return Mesh(np.ascontiguousarray(vertices), np.ascontiguousarray(triangles, np.int32),
                np.arange(len(triangles), dtype=np.int32), len(triangles), welded)


def _no_triangles(path: Path) -> MeshFileError:
    return MeshFileError(f"{path.name} has no triangles.")


def _transformed_piece(scene: Any, matrix: np.ndarray, name: str) -> Optional[Tuple[np.ndarray, np.ndarray]]:
    """(points (n, 3), triangles (m, 3)) of a geometry of the scene after the transform (4, 4); None without triangles.

    Not Scene.dump(), which copies materials, too, and fails without the package for images."""
    piece = scene.geometry[name]
    triangles = _piece_triangles(piece) if hasattr(piece, "faces") else _strip_triangles(piece)
    if not len(triangles):
        return None
    points = np.asarray(piece.vertices, np.float64)
    if (matrix == np.eye(4)).all():
        return points, triangles
    is_mirrored = np.linalg.det(matrix[:3, :3]) < 0
    return points @ matrix[:3, :3].T + matrix[:3, 3], triangles[:, ::-1] if is_mirrored else triangles


def _piece_triangles(piece: Any) -> np.ndarray:
    """(m, 3) triangles of a trimesh mesh. trimesh splits polygons into fans; if a polygon of a PLY file has no valid
    fan, all polygons of the file are triangulated again."""
    data = piece.metadata.get("_ply_raw", {}).get("face", {}).get("data")
    names = getattr(getattr(data, "dtype", None), "names", None) or (data if isinstance(data, dict) else ())
    name = next((name for name in ("vertex_index", "vertex_indices") if name in names), None)
    if name is None:
        return piece.faces
    lists = data[name]["f1"] if getattr(getattr(data[name], "dtype", None), "names", None) else data[name]
    points = np.asarray(piece.vertices, np.float64)
    polygons = [np.ravel(row).tolist() for row in lists if len(row) > 2]
    if all(is_fan(points[polygon]) for polygon in polygons if len(polygon) > 3):
        return piece.faces
    return np.array([triangle for polygon in polygons for triangle in fan_or_ears(points[polygon], polygon)])


def _strip_triangles(cloud: Any) -> np.ndarray:
    """(m, 3) triangles of the element "tristrips" of a PLY file, which trimesh reads as a point cloud. Each corner
    forms a triangle with the two before it, with alternating orientation; -1 starts a new strip."""
    strips = cloud.metadata.get("_ply_raw", {}).get("tristrips", {}).get("data")
    if strips is None:
        return np.zeros((0, 3), int)
    lists = strips["vertex_indices"]
    triangles = []
    for row in lists["f1"] if lists.dtype.names else lists:
        for strip in np.split(row, np.flatnonzero(row < 0)):
            strip = strip[strip >= 0]
            corners = np.column_stack([strip[:-2], strip[1:-1], strip[2:]])
            corners[1::2, :2] = corners[1::2, 1::-1]
            triangles.append(corners)
    triangles = np.vstack(triangles)
    is_degenerate = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)  # connects parts of the strip
    return triangles[~is_degenerate]


def _read_obj(path: Path) -> Mesh:
    """Reads an OBJ file. trimesh would count negative indices from the end of the file rather than from their face, and
    triangulate concave polygons as fans."""
    points, polygons = [], []
    try:
        for line in path.read_text("utf-8-sig", "replace").replace("\\\n", " ").splitlines():
            words = line.split("#", 1)[0].split()
            if words[:1] == ["v"]:
                points.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"] and len(words) > 3:
                corners = [int(word.split("/", 1)[0]) for word in words[1:]]
                polygons.append([corner - 1 if corner > 0 else len(points) + corner for corner in corners])
        if not polygons:
            raise _no_triangles(path)
        points = np.array(points, np.float64).reshape(len(points), 3)
        for number, polygon in enumerate(polygons, 1):
            if not all(0 <= corner < len(points) for corner in polygon):
                raise ValueError(f"face {number} names a vertex that does not exist")
    except ValueError as error:
        raise MeshFileError(f"{path.name} is not a valid OBJ file: {error}.") from error
    return _triangle_mesh(points, np.array([triangle for polygon in polygons
                                            for triangle in fan_or_ears(points[polygon], polygon)]), weld=True)


def _read_off(path: Path) -> Mesh:
    """Reads an OFF file. trimesh would drop polygons with more than four corners and forget which triangles form a
    quad."""
    text = re.sub(r"\A(\s*(?:#.*\s+)*\w*OFF)(?=\d)", r"\1 ", path.read_text("utf-8-sig", "replace"), flags=re.IGNORECASE)
    lines = [words for words in (line.split("#", 1)[0].split() for line in text.splitlines()) if words]
    try:
        if not lines or lines[0][0].upper().lstrip("CN") != "OFF":
            raise ValueError("it does not start with OFF")
        lines[0] = lines[0][1:]
        lines = lines[0 if lines[0] else 1:]
        if not lines or len(lines[0]) < 2:
            raise ValueError("it does not say how many vertices and faces it has")
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
