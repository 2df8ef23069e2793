# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the parts of a model to files: closed objects, colors, labels."""

from __future__ import annotations

import json
import re
from itertools import chain
from pathlib import Path
from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np

from .. import gltf, threemf, wavefront
from ..appearance import Appearance, from_bytes, to_bytes
from ..hierarchy import Solid
from ..meshes import Mesh
from ..output import whole_file
from ..rays import RayTarget
from ..requirements import Need, load_module
from ..separation import separate
from .borders import ParentLink, parents_first, part_tree
from .colors import colors
from .cut import Cut
from .names import find_names, make_unique, name_parts
from .printing import Printable
from .sources import find_source_faces

FORMATS = "glb", "obj", "3mf", "stl", "ply"


class Piece(NamedTuple):
    """A closed surface to write."""

    vertices: np.ndarray  # (n, 3)
    triangles: np.ndarray  # (m, 3)
    faces: np.ndarray  # (m,) the source face of each triangle; -1 for caps

    @classmethod
    def from_solid(cls, solid: Solid, faces: np.ndarray) -> Piece:
        """A solid as a 2-manifold by position, see separate(). faces : (m,) the source face of each of its triangles."""
        vertices, triangles, sources = separate(solid.vertices, solid.triangles)
        return cls(vertices, triangles, faces[sources])

    @property
    def corners(self) -> np.ndarray:
        """(m, 3, 3) the coordinates of each triangle's corners."""
        return self.vertices[self.triangles]


def write(folder: Path, name: str, mesh: Mesh, cut: Cut, formats: Sequence[str] = ("glb", "ply"), word: str = "Part",
          printable: Optional[Printable] = None) -> List[Path]:
    """Write the parts of a cut to files.

    ========  =========  =============================================================================================
    format    files      content
    ========  =========  =============================================================================================
    glb, obj  NAME.*     all parts as named, closed objects, with the model's materials, textures and colors, or one
                         color per part if it has none. In GLB each part is a child of its parent in the tree of parts
    3mf       NAME.3mf   the same, with colors in place of textures; for a printer with a bed, NAME-1.3mf and so on if the
                         pieces need several beds, with the pieces in their places
    stl       PART.stl   one file per part
    ply       NAME.ply   the model, with the part of each triangle, its color, and the model's textures and colors
    always    NAME.json  name, color, face count, volume and parent of each part; the part of each face; for a printer,
                         the name and the part of each piece
    ========  =========  =============================================================================================

    Parameters
    ----------
    folder : created if it does not exist
    name : of the files
    formats : some of FORMATS; if empty, only NAME.json is written
    word : what names of parts begin with
    printable : pieces to write instead of the cut's solids

    Returns
    -------
    the paths of the files

    Raises
    ------
    RequirementError : a package that a format needs is not installed
    OSError : a file can't be written
    """
    trimesh: Any = load_module("trimesh", "Writing parts") if {"stl", "ply"} & set(formats) else None
    names = name_parts(cut, mesh.vertices, mesh.triangles, mesh.faces, word, find_names(cut, mesh))
    labels = cut.labels[mesh.faces]
    links = part_tree(cut, mesh.vertices, mesh.triangles, labels)
    rgba = np.column_stack([colors(cut.keys), np.ones(len(cut))])
    nodes = _nodes(mesh, cut, names, links, rgba, printable) if formats else {}
    folder.mkdir(parents=True, exist_ok=True)
    paths: List[Path] = []
    beds = printable.beds if printable else []
    files = chain(*(_encode(file_format, name, nodes, beds, mesh, labels, rgba, trimesh) for file_format in formats),
                  [(f"{name}.json", json.dumps(_describe(cut, names, links, rgba, printable)))])
    for file_name, data in files:
        path = folder / file_name
        with whole_file(path):
            path.write_bytes(data if isinstance(data, bytes) else data.encode())
        paths.append(path)
    return list(dict.fromkeys(paths))  # two formats may share an image


def _describe(cut: Cut, names: Sequence[str], links: Sequence[ParentLink], rgba: np.ndarray,
              printable: Optional[Printable]) -> Dict[str, Any]:
    """The content of NAME.json."""
    parts = [{"name": names[part], "parent": None if links[part].parent < 0 else names[links[part].parent],
              "faces": int((cut.labels == part).sum()), "volume": cut.volume(part),
              "color": rgba[part, :3].round(4).tolist()} for part in range(len(cut))]
    pieces = [{"name": printable.names[piece], "part": printable.parts[piece]} for piece in printable.solids] if printable else []
    return {"parts": parts, "labels": cut.labels.tolist(), **({"pieces": pieces} if printable else {})}


def _nodes(mesh: Mesh, cut: Cut, names: Sequence[str], links: Sequence[ParentLink], rgba: np.ndarray,
           printable: Optional[Printable]) -> Dict[int, gltf.Node]:
    """The pieces as named objects with their appearance, parents first."""
    pieces: Dict[int, Piece]
    if printable:
        names, parts, scale = printable.names, printable.parts, printable.scale
        pieces = {piece: Piece(*solid, printable.source_faces[piece]) for piece, solid in printable.solids.items()}
    else:
        parts, scale = list(range(len(cut))), 1.0
        target = RayTarget(mesh.vertices, mesh.triangles)
        pieces = {part: Piece.from_solid(solid, find_source_faces(solid, target, mesh.faces))
                  for part, solid in enumerate(cut.solids()) if solid is not None}
    order = parents_first(links)
    numbers = sorted(pieces, key=lambda piece: order.index(parts[piece]))
    nodes = {}
    for number in numbers:
        piece, part = pieces[number], parts[number]
        parent = links[part].parent
        appearance = (_part_color(rgba[part], len(piece.triangles)) if mesh.appearance is None else
                      mesh.appearance.transfer(mesh.vertices[mesh.triangles], piece.corners / scale, piece.faces))
        nodes[number] = gltf.Node(names[number], numbers.index(parent) if parent in pieces else -1, piece.vertices,
                                  piece.triangles, appearance)
    return nodes


def _encode(file_format: str, name: str, pieces: Dict[int, gltf.Node], beds: Sequence[Dict[int, Any]], mesh: Mesh,
            labels: np.ndarray, rgba: np.ndarray, trimesh: Any) -> Iterator[Tuple[str, Union[bytes, str]]]:
    """Yield (file name, data) of each file of a format. beds : the place of each piece, see Printable"""
    nodes = list(pieces.values())
    if file_format == "stl":
        for node, file_name in zip(nodes, make_unique([re.sub(r"[^\w .()-]", "_", node.name) for node in nodes])):
            surface = trimesh.Trimesh(node.vertices, node.triangles, process=False)
            yield f"{file_name}.stl", surface.export(file_type="stl")
    elif file_format == "ply":
        yield f"{name}.ply", _ply(trimesh, mesh, labels, rgba)
        for image in mesh.appearance.images if mesh.appearance else ():
            yield image.name, image.data
    elif file_format == "glb":
        yield f"{name}.glb", gltf.write_glb(nodes)
    elif file_format == "obj":
        yield from wavefront.write_obj(name, nodes).items()
    elif beds:
        for number, places in enumerate(beds, 1):
            yield (f"{name}-{number}.3mf" if len(beds) > 1 else f"{name}.3mf",
                   threemf.write_3mf([pieces[piece] for piece in places], list(places.values())))
    else:
        yield f"{name}.3mf", threemf.write_3mf(nodes)


def image_needs(appearance: Appearance, formats: Sequence[str]) -> List[Need]:
    """The packages that write() needs for a model's images, for requirements.check()."""
    kinds = {image.mime_type for image in appearance.images}
    in_glb = "" in kinds, "Converting textures for glb files"
    needed = {"3mf": (bool(kinds), "Turning textures into colors of 3mf files"), "glb": in_glb, "unreal": in_glb, "godot": in_glb,
              "mjcf": (bool(kinds - {"image/png"}), "Converting textures for MuJoCo")}
    return [(needed[name][1], "PIL") for name in formats if name in needed and needed[name][0]]


def _part_color(color: np.ndarray, count: int) -> Appearance:
    """The appearance of count triangles of a part, if the model has none."""
    return Appearance({"COLOR_0": np.tile(from_bytes((color * 255).astype(np.uint8)), (count, 3, 1))}, np.full(count, -1))


def _ply(trimesh: Any, mesh: Mesh, labels: np.ndarray, rgba: np.ndarray) -> bytes:
    """The model as PLY: each triangle has its part and the part's color. Of the model's appearance it keeps vertex colors,
    texture coordinates and the names of the textures, in MeshLab's form."""
    model = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    model.visual.face_colors = (rgba[labels] * 255).astype(np.uint8)
    model.face_attributes["part"] = labels
    if mesh.appearance is None:
        return model.export(file_type="ply", include_attributes=True)
    attributes, materials = mesh.appearance.attributes, mesh.appearance.materials
    if "COLOR_0" in attributes:
        sums, corners = np.zeros((len(mesh.vertices), 4)), mesh.triangles.ravel()
        np.add.at(sums, corners, attributes["COLOR_0"].reshape(-1, 4))
        mean = sums / np.maximum(np.bincount(corners, minlength=len(sums)), 1)[:, None]
        model.vertex_attributes.update(zip(("red", "green", "blue", "alpha"), to_bytes(mean).T.copy()))
    comments = b""
    coordinates = mesh.appearance.plain_coordinates()
    if coordinates is not None:
        model.face_attributes["texcoord"] = (coordinates * [1, -1] + [0, 1]).reshape(-1, 6).astype(np.float32)
        textures = [mesh.appearance.base_image(number) for number in range(len(materials))]
        numbers = sorted({number for number in textures if number is not None})
        if numbers:
            texture_of_material = np.array([numbers.index(number) if number is not None else -1 for number in textures] + [-1])
            model.face_attributes["texnumber"] = texture_of_material[mesh.appearance.face_materials].astype(np.int32)
            comments = b"".join(f"comment TextureFile {mesh.appearance.images[number].name}\n".encode() for number in numbers)
    head, separator, rest = model.export(file_type="ply", include_attributes=True).partition(b"element vertex")
    return head + comments + separator + rest
