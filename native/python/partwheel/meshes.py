# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads mesh files as arrays, without repairs. OFF and OBJ are read here, PLY by plyfile, other formats by trimesh; these two are
optional."""

import io
import re
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from . import gltf, ply, wavefront
from .appearance import Appearance, from_bytes
from .contents import find_contents, read_header
from .library import Error
from .polygons import fan_or_ears, triangulate
from .requirements import load_module
from .triangles import unit_vectors
from .weld import loose_parts

# The units of 3MF files.
MILLIMETERS = {"micron": 0.001, "millimeter": 1.0, "centimeter": 10.0, "inch": 25.4, "foot": 304.8, "meter": 1000.0}
MAX_COORDINATE = 1e100  # the library's limit


class MeshFileError(Error):
    """A file can't be read as a mesh; str() says why. Its name, "mesh file", differs from those of the library's errors."""

    name = "mesh file"


LABEL_KINDS = "materials", "groups", "loose"


class Mesh(NamedTuple):
    """A triangulated surface.

    vertices : (V, 3) float64
    triangles : (T, 3) int32
    faces : (T,) int32, the polygon of each triangle
    face_count : number of polygons
    welded : number of vertices removed because another one has identical coordinates; 0 for formats with indices
    dropped : the kinds of content, of contents.KINDS, that the file has but this mesh doesn't keep
    nodes : (T,) int, the node of each triangle: a node of a scene, or an object or group of an OBJ file; empty if the format
        has none
    node_names : the names of the nodes; "" for a node without a name
    appearance : None if the file has none, or for formats other than glTF, OBJ and PLY
    """

    vertices: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    face_count: int
    welded: int
    dropped: Tuple[str, ...] = ()
    nodes: np.ndarray = np.zeros(0, np.int64)
    node_names: Sequence[str] = ()
    appearance: Optional[Appearance] = None

    @property
    def kinds(self) -> Tuple[str, ...]:
        """The kinds of content, of contents.KINDS, that the mesh has besides its surface."""
        return (*(self.appearance.kinds if self.appearance else ()), *(["names"] if any(self.node_names) else []))

    def face_labels(self, kind: str) -> Optional[np.ndarray]:
        """(face_count,) int: the material of each face, its group (node) or its loose part, for kind in LABEL_KINDS. None if
        the file has none."""
        if kind == "materials":
            labels = self.appearance.face_materials if self.appearance and self.appearance.materials else None
        elif kind == "groups":
            labels = self.nodes if len(self.nodes) else None
        else:
            labels = loose_parts(self.vertices, self.triangles)
        return None if labels is None else labels[np.unique(self.faces, return_index=True)[1]]


class _Piece(NamedTuple):
    """One geometry of a scene."""

    points: np.ndarray  # (n, 3)
    triangles: np.ndarray  # (m, 3)
    attributes: Dict[str, np.ndarray] = {}  # {name: (m, 3, k)}, as in Appearance
    material: int = -1  # as in Appearance; -1: none


def read(path: Union[str, Path]) -> Mesh:
    """Reads the surface in a mesh file.

    Parameters
    ----------
    path : an OFF, OBJ or PLY file, or one of any other format that trimesh reads

    Returns
    -------
    the Mesh

    Raises
    ------
    MeshFileError : the file holds no mesh, or a damaged one
    RequirementError : plyfile, which reads PLY, or trimesh, which reads all other formats but OFF and OBJ, is not installed
    OSError : the file can't be opened
    """
    path = Path(path)
    with open(path, "rb"):
        pass  # raises OSError; trimesh would report an unknown format
    reader = {".off": _read_off, ".obj": _read_obj, ".ply": _read_ply}.get(path.suffix.lower(), _read_with_trimesh)
    with np.errstate(over="ignore", invalid="ignore"):  # of coordinates that are refused below
        mesh = reader(path)
    return mesh._replace(dropped=tuple(kind for kind in find_contents(path) if kind not in mesh.kinds))


def _read_with_trimesh(path: Path) -> Mesh:
    trimesh = load_module("trimesh", f"Reading {path.suffix or 'such'} files")
    suffix = path.suffix.lower().lstrip(".")
    document: Optional[gltf.Document] = None
    try:
        # skip_materials: images would require another package.
        options: Dict[str, Any] = {"process": False, "force": "scene", "skip_materials": True}
        if suffix in ("glb", "gltf"):
            document = _open_gltf(path)
            resolver = trimesh.resolvers.FilePathResolver(str(path))
            scene = trimesh.load(io.BytesIO(document.for_trimesh()), file_type=suffix, resolver=resolver, **options)
        else:
            scene = trimesh.load(path, **options)
        named_pieces = [(document.node_name(node) if document else node, node.split("_")[0] if document else node, piece)
                        for node in scene.graph.nodes_geometry
                        if (piece := _transformed_piece(scene, *scene.graph[node]))]
        if not named_pieces:
            raise _no_triangles(path)
        names, keys, pieces = zip(*named_pieces)
        offsets = np.cumsum([0] + [len(piece.points) for piece in pieces])
        vertices = np.vstack([piece.points for piece in pieces])
        triangles = np.vstack([piece.triangles + offset for piece, offset in zip(pieces, offsets)])
        attributes = gltf.join_attributes([piece.attributes for piece in pieces],
                                          [piece.points[piece.triangles] for piece in pieces])
        counts = [len(piece.triangles) for piece in pieces]
        materials = np.repeat([piece.material for piece in pieces], counts)
        appearance = document.appearance(attributes, materials) if document else None
    except (MemoryError, MeshFileError):
        raise  # memory is not the file's fault; MeshFileError already explains the error
    except FileNotFoundError as error:
        raise MeshFileError(f"{path.name} needs the file {error.filename or error}, which is missing. Put it next to the "
                            "model.") from error
    except Exception as error:  # trimesh's readers raise many types
        raise MeshFileError(f"trimesh can't read {path.name} as a mesh. Export it again, or in another format. "
                            f"({error!r})") from error
    if suffix == "3mf":  # 3D printers and this package's output use millimeters
        vertices *= MILLIMETERS.get(scene.units, 1.0)
    distinct = list(dict.fromkeys(keys))
    return triangle_mesh(vertices, triangles, weld=True)._replace(
        nodes=np.repeat([distinct.index(key) for key in keys], counts),
        node_names=[names[keys.index(key)] for key in distinct] if suffix != "stl" else [],
        appearance=appearance if appearance and appearance.kinds else None)


def read_elements(path: Path) -> ply.Elements:
    """The elements of a PLY file. Raises MeshFileError, RequirementError."""
    plyfile: Any = load_module("plyfile", "Reading .ply files")
    try:
        return {element.name: element.data for element in plyfile.PlyData.read(str(path))}
    except MemoryError:
        raise  # it is not the file's fault
    except Exception as error:  # plyfile's errors, and those of numpy
        raise MeshFileError(f"plyfile can't read {path.name}. Export it again, or in another format. ({error!r})") from error


def _read_ply(path: Path) -> Mesh:
    """Reads a PLY file. trimesh can't read binary polygons of different sizes, and triangulates concave ones as fans."""
    elements = read_elements(path)
    try:
        points, triangles, appearance = ply.to_surface(path, elements)
    except (KeyError, IndexError, ValueError) as error:
        raise MeshFileError(f"{path.name} is not a valid PLY file. Export it again, or in another format. "
                            f"({error!r})") from error
    if not len(triangles):
        raise _no_triangles(path)
    return triangle_mesh(points, triangles)._replace(
        nodes=np.zeros(len(triangles), np.int64), appearance=appearance if appearance.kinds else None)


def _open_gltf(path: Path) -> gltf.Document:
    try:
        return gltf.Document(path, read_header(path))
    except ValueError as error:
        raise MeshFileError(f"{path.name} can't be read: {error}.") from error


def triangle_mesh(vertices: np.ndarray, triangles: np.ndarray, weld: bool = False) -> Mesh:
    """A Mesh in which each triangle is a face.

    weld : whether to weld vertices with identical coordinates: for formats that store the corners of each triangle separately
        (STL) or split vertices along texture seams (OBJ, glTF)
    """
    _check_coordinates(vertices)
    welded = 0
    if weld:
        unique, index = np.unique(vertices + 0.0, axis=0, return_inverse=True)  # + 0.0 turns -0.0 into 0.0
        welded = len(vertices) - len(unique)
        vertices, triangles = unique, index.reshape(-1)[triangles]
    return Mesh(np.ascontiguousarray(vertices), np.ascontiguousarray(triangles, np.int32),
                np.arange(len(triangles), dtype=np.int32), len(triangles), welded)


def _check_coordinates(vertices: np.ndarray) -> None:
    """Raises MeshFileError as the library does, but before anything is computed, and with the vertices' numbers in the file."""
    is_refused = ~(np.abs(vertices) <= MAX_COORDINATE).all(axis=1)
    if is_refused.any():
        error = MeshFileError(f"Vertex {is_refused.argmax()} has a coordinate that is not a number, or is too large. Delete or "
                              "move that vertex.")
        error.name = "not finite"  # as the library calls it
        raise error


def _no_triangles(path: Path) -> MeshFileError:
    return MeshFileError(f"{path.name} has no triangles.")


def _transformed_piece(scene: Any, matrix: np.ndarray, name: str) -> Optional[_Piece]:
    """A geometry of the scene, transformed by the matrix (4, 4); None if it has no triangles.

    trimesh's Scene.dump() would also copy materials, and fail without the package for images."""
    piece = scene.geometry[name]
    triangles: Any = getattr(piece, "faces", ())
    if not len(triangles):
        return None
    points = np.asarray(piece.vertices, np.float64)
    attributes, material = gltf.split_attributes(getattr(piece, "vertex_attributes", {}), np.asarray(triangles))
    if (matrix == np.eye(4)).all():
        return _Piece(points, triangles, attributes, material)
    linear = matrix[:3, :3]
    if "NORMAL" in attributes:
        attributes["NORMAL"] = unit_vectors(attributes["NORMAL"] @ np.linalg.pinv(linear))
    if np.linalg.det(linear) < 0:  # mirrored
        triangles, attributes = triangles[:, ::-1], {name: values[:, ::-1] for name, values in attributes.items()}
    return _Piece(points @ linear.T + matrix[:3, 3], triangles, attributes, material)


class _ObjCorners:
    """The polygons of an OBJ file while it is read.

    values : coordinates by keyword: "v" vertices, "vt" texture coordinates, "vn" normals
    polygons : the corners of each polygon, as indices into rows
    rows : (vertex, texture coordinates, normal) of each corner, as indices into values; -1 for none
    materials, groups : of each polygon
    """

    def __init__(self) -> None:
        self.values: Dict[str, List[List[float]]] = {"v": [], "vt": [], "vn": []}
        self.polygons: List[List[int]] = []
        self.rows: List[Tuple[int, ...]] = []
        self.materials: List[str] = []
        self.groups: List[str] = []

    def add_polygon(self, words: Sequence[str], material: str, group: str) -> None:
        counts = [len(values) for values in self.values.values()]
        self.polygons.append(list(range(len(self.rows), len(self.rows) + len(words))))
        for word in words:
            numbers = [int(number) if number else 0 for number in (*word.split("/"), "", "")[:3]]
            self.rows.append(tuple(number - 1 if number > 0 else count + number if number else -1
                                   for number, count in zip(numbers, counts)))
        self.materials.append(material)
        self.groups.append(group)


def _read_obj(path: Path) -> Mesh:
    """Reads an OBJ file. trimesh would count negative indices from the end of the file rather than from their face, and
    triangulate concave polygons as fans."""
    corners, libraries, material, group = _ObjCorners(), [], "", ""
    try:
        for line in path.read_text("utf-8-sig", "replace").replace("\\\n", " ").splitlines():
            words = line.split("#", 1)[0].split()
            word = words[0] if words else ""
            if word in corners.values:
                corners.values[word].append([float(value) for value in words[1:7 if word == "v" else 4]])
            elif word == "f" and len(words) > 3:
                corners.add_polygon(words[1:], material, group)
            elif word == "usemtl":
                material = " ".join(words[1:])
            elif word in ("o", "g"):
                group = " ".join(words[1:])
            elif word == "mtllib":
                libraries.append(" ".join(words[1:]))
        if not corners.polygons:
            raise _no_triangles(path)
        points = np.array([point[:3] for point in corners.values["v"]], np.float64).reshape(-1, 3)
        rows = np.array(corners.rows)
        is_missing = (rows[:, 0] < 0) | (rows[:, 0] >= len(points))
        if is_missing.any():
            first = int(is_missing.argmax())
            number = next(number for number, polygon in enumerate(corners.polygons, 1) if polygon[-1] >= first)
            raise ValueError(f"face {number} refers to a vertex that does not exist")
    except ValueError as error:
        raise MeshFileError(f"{path.name} is not a valid OBJ file: {error}. Export it again.") from error
    pieces = [fan_or_ears(points[rows[polygon, 0]], polygon) for polygon in corners.polygons]
    triangles = np.array([triangle for piece in pieces for triangle in piece])
    polygons = np.repeat(np.arange(len(pieces)), [len(piece) for piece in pieces])
    mesh = triangle_mesh(points, rows[:, 0][triangles], weld=True)
    groups = list(dict.fromkeys(corners.groups))
    return mesh._replace(nodes=np.array([groups.index(name) for name in corners.groups])[polygons], node_names=groups,
                         appearance=_obj_appearance(path.parent, libraries, corners, rows[triangles], polygons))


def _obj_appearance(folder: Path, libraries: Sequence[str], corners: _ObjCorners, rows: np.ndarray,
                    polygons: np.ndarray) -> Optional[Appearance]:
    """The appearance of an OBJ file, or None.

    rows : (T, 3, 3) the row of _ObjCorners of each triangle's corners
    polygons : (T,) the polygon of each triangle
    """
    names = [name for name in dict.fromkeys(corners.materials) if name]
    materials, textures, images, mtl = wavefront.read_materials(folder, libraries, names)
    attributes = {}
    colors = [point[3:6] for point in corners.values["v"]]
    if all(len(color) == 3 for color in colors):
        attributes["COLOR_0"] = from_bytes(np.array(colors) * 255)[rows[:, :, 0]]
    for column, word, name, width in ((1, "vt", "TEXCOORD_0", 2), (2, "vn", "NORMAL", 3)):
        is_valid = (rows[:, :, column] >= 0) & (rows[:, :, column] < len(corners.values[word]))
        if is_valid.any() and (width == 2 or is_valid.all()):
            values = np.array([(value + [0.0] * width)[:width] for value in corners.values[word]])
            values = values * [1, -1] + [0, 1] if width == 2 else values
            attributes[name] = np.where(is_valid[:, :, None], values[np.where(is_valid, rows[:, :, column], 0)], 0.0)
    numbers = np.array([names.index(name) if name else -1 for name in corners.materials])[polygons]
    appearance = Appearance(attributes, numbers, materials, textures, [], images, mtl)
    return appearance if appearance.kinds else None


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
        _check_coordinates(vertices)
        triangles, faces = [], []
        for face, polygon in enumerate(polygons):
            if not all(0 <= corner < vertex_count for corner in polygon):
                raise ValueError(f"face {face} refers to a vertex that does not exist")
            pieces = [polygon] if len(polygon) == 3 else triangulate(vertices[polygon], polygon)
            triangles += pieces
            faces += [face] * len(pieces)
    except (IndexError, ValueError) as error:
        raise MeshFileError(f"{path.name} is not a valid OFF file: {error}. Export it again.") from error
    return Mesh(vertices, np.array(triangles, np.int64).reshape(-1, 3), np.array(faces, np.int32), face_count, 0)
