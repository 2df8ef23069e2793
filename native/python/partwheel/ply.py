# SPDX-License-Identifier: GPL-3.0-or-later
"""What is in the elements of a PLY file: triangles, colors, texture coordinates. plyfile has read them."""

import re
from pathlib import Path
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from .appearance import Appearance, Image, from_bytes
from .contents import read_header
from .polygons import fan_or_ears, is_fan

Elements = Mapping[str, np.ndarray]  # name -> (n,) with a field for each property
COORDINATES = ("texture_u", "texture_v"), ("u", "v"), ("s", "t")  # names of a vertex's texture coordinates


def to_surface(path: Path, elements: Elements) -> Tuple[np.ndarray, np.ndarray, Appearance]:
    """(vertices (V, 3), triangles (T, 3), appearance). Raises KeyError, IndexError, ValueError."""
    points = np.column_stack([elements["vertex"][axis] for axis in "xyz"]).astype(np.float64)
    triangles = np.array([*_face_triangles(points, elements.get("face")), *_strip_triangles(elements.get("tristrips"))],
                         np.int64).reshape(-1, 3)
    return points, triangles, _find_appearance(path, elements, triangles)


def _names(element: Optional[np.ndarray]) -> Sequence[str]:
    return () if element is None else element.dtype.names or ()


def _face_triangles(points: np.ndarray, faces: Optional[np.ndarray]) -> List[List[int]]:
    """The triangles of polygons: fans if these fit all of them."""
    name = next((name for name in ("vertex_index", "vertex_indices") if name in _names(faces)), None)
    if faces is None or name is None:
        return []
    polygons = [row.tolist() for row in faces[name] if len(row) > 2]
    if all(is_fan(points[polygon]) for polygon in polygons if len(polygon) > 3):
        return [[polygon[0], *ends] for polygon in polygons for ends in zip(polygon[1:], polygon[2:])]
    return [triangle for polygon in polygons for triangle in fan_or_ears(points[polygon], polygon)]


def _strip_triangles(strips: Optional[np.ndarray]) -> List[List[int]]:
    """The triangles of strips. Each corner forms a triangle with the two before it, with alternating orientation; -1 starts a
    new strip."""
    triangles = []
    for row in () if strips is None else strips["vertex_indices"]:
        for strip in np.split(row, np.flatnonzero(row < 0)):
            corners = strip[strip >= 0].tolist()
            triangles += [[b, a, c] if k % 2 else [a, b, c] for k, (a, b, c) in enumerate(zip(corners, corners[1:], corners[2:]))]
    return [triangle for triangle in triangles if len(set(triangle)) == 3]  # strips use the others to jump


def _colors(element: Optional[np.ndarray]) -> Optional[np.ndarray]:
    """(n, 4) linear colors of an element's rows; None if it has none."""
    if element is None or not {"red", "green", "blue"} <= set(_names(element)):
        return None
    columns = [element[name] for name in ("red", "green", "blue", "alpha") if name in _names(element)]
    scales = [255 / np.iinfo(column.dtype).max if column.dtype.kind in "iu" else 255.0 for column in columns]
    return from_bytes(np.column_stack([column * scale for column, scale in zip(columns, scales)]))


def _find_appearance(path: Path, elements: Elements, triangles: np.ndarray) -> Appearance:
    """Colors and texture coordinates of vertices or faces, of these only if all are triangles; a material for each texture that
    the file names, if it is there."""
    attributes: Dict[str, np.ndarray] = {}
    vertex, face, count = elements["vertex"], elements.get("face"), len(triangles)
    face = face if face is not None and len(face) == count else None
    if (colors := _colors(vertex)) is not None:
        attributes["COLOR_0"] = colors[triangles]
    elif (colors := _colors(face)) is not None:
        attributes["COLOR_0"] = np.repeat(colors[:, None], 3, axis=1)
    uv_names = next((pair for pair in COORDINATES if set(pair) <= set(_names(vertex))), None)
    if face is not None and "texcoord" in _names(face) and all(len(row) == 6 for row in face["texcoord"]):
        attributes["TEXCOORD_0"] = np.array([*face["texcoord"]], np.float64).reshape(-1, 3, 2)
    elif uv_names:
        attributes["TEXCOORD_0"] = np.column_stack([vertex[name] for name in uv_names]).astype(np.float64)[triangles]
    if "TEXCOORD_0" not in attributes:
        return Appearance(attributes, np.full(count, -1))
    attributes["TEXCOORD_0"] = attributes["TEXCOORD_0"] * [1, -1] + [0, 1]
    names = re.findall(rb"(?m)^comment TextureFile[ \t]+(.+?)\s*$", read_header(path))
    paths = [path.parent / Path(name.decode("utf-8", "replace").replace("\\", "/")).name for name in names]
    if not all(file.is_file() for file in paths):
        paths = []
    materials = [{"name": file.stem, "pbrMetallicRoughness": {"baseColorTexture": {"index": number}, "metallicFactor": 0.0}}
                 for number, file in enumerate(paths)]
    numbers = face["texnumber"].astype(int) if face is not None and "texnumber" in _names(face) else np.zeros(count, int)
    is_known = (numbers >= 0) & (numbers < len(paths))
    return Appearance(attributes, np.where(is_known, numbers, -1), materials,
                      [{"source": number} for number in range(len(paths))], [],
                      [Image(file.name, file.read_bytes()) for file in paths])
