# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a model as files: closed objects, colors, labels. With trimesh."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, NamedTuple, Optional, Sequence, Union

import numpy as np

from .. import gltf, threemf, wavefront
from ..appearance import Appearance, from_bytes, to_bytes
from ..output import whole_file
from ..rays import RayTarget
from ..requirements import Need, load_module
from ..separation import separate
from .borders import parents_first, part_tree
from .colors import colors
from .names import find_names, make_unique, name_parts
from .sources import find_source_faces

if TYPE_CHECKING:
    from ..hierarchy import Solid
    from ..meshes import Mesh
    from .cut import Cut
    from .printing import Printable

FORMATS = "glb", "obj", "3mf", "stl", "ply"


class Piece(NamedTuple):
    """A closed surface to write. faces : (m,) the source face of each triangle; -1: a cap"""

    vertices: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray

    @classmethod
    def separated(cls, solid: Solid, faces: np.ndarray) -> Piece:
        """A solid, of whose triangles these are the source faces, with parts that touch moved apart."""
        vertices, triangles, sources = separate(solid.vertices, solid.triangles)
        return cls(vertices, triangles, faces[sources])

    @property
    def corners(self) -> np.ndarray:
        """(m, 3, 3)"""
        return self.vertices[self.triangles]


def write(folder: Path, name: str, mesh: Mesh, cut: Cut, formats: Sequence[str] = ("glb", "ply"), word: str = "Part",
          printed: Optional[Printable] = None) -> List[Path]:
    """Write the parts of a cut to files.

    glb, obj, 3mf: NAME.glb and so on, all parts as closed objects with names, and with the materials, textures and colors of
    the model, or else in a color for each part; in GLB each is a child of its parent in the tree of parts; 3MF has colors in
    place of textures. stl: PART.stl for each part. ply: NAME.ply, the model, with the part of each triangle, its color, and
    the textures and colors of the model. NAME.json, always: name, color, face count, volume and parent of each part; the part of each face; of pieces
    for a printer, the names and the numbers of their parts.

    Parameters
    ----------
    folder : created if it does not exist
    name : of the files
    formats : some of FORMATS; if empty, only NAME.json is written
    word : what names of parts begin with
    printed : pieces to write instead of the cut's solids

    Returns
    -------
    the paths of the files

    Raises
    ------
    RequirementError : a package that a format needs is not installed
    OSError : a file can't be written
    """
    trimesh: Any = load_module("trimesh", "Writing parts") if {"3mf", "stl", "ply"} & set(formats) else None
    names = name_parts(cut, mesh.vertices, mesh.triangles, mesh.faces, word, find_names(cut, mesh))
    labels = cut.labels[mesh.faces]
    links = part_tree(cut, mesh.vertices, mesh.triangles, labels)
    rgba = np.column_stack([colors(cut.keys), np.ones(len(cut))])
    folder.mkdir(parents=True, exist_ok=True)
    paths: List[Path] = []

    def write_file(file_name: str, data: Union[bytes, str]) -> None:
        path = folder / file_name
        with whole_file(path):
            path.write_bytes(data if isinstance(data, bytes) else data.encode())
        if path not in paths:
            paths.append(path)

    pieces: Dict[int, Piece] = {}
    piece_names, piece_parts, scale = names, list(range(len(cut))), 1.0
    if printed:
        piece_names, piece_parts, scale = printed.names, printed.parts, printed.scale
        pieces = {piece: Piece(*solid, printed.source_faces[piece]) for piece, solid in printed.solids.items()}
    elif formats:
        target = RayTarget(mesh.vertices, mesh.triangles)
        pieces = {part: Piece.separated(solid, find_source_faces(solid, target, mesh.faces))
                  for part, solid in enumerate(cut.solids()) if solid is not None}
    order = parents_first(links)
    numbers = sorted(pieces, key=lambda piece: order.index(piece_parts[piece]))
    nodes = []
    for piece in numbers:
        parent = links[piece_parts[piece]].parent
        look = (_part_color(rgba[piece_parts[piece]], len(pieces[piece].triangles)) if mesh.appearance is None else
                mesh.appearance.transfer(mesh.vertices[mesh.triangles], pieces[piece].corners / scale, pieces[piece].faces))
        nodes.append(gltf.Node(piece_names[piece], numbers.index(parent) if parent in pieces else -1,
                               pieces[piece].vertices, pieces[piece].triangles, look))
    for file_format in formats:
        if file_format == "stl":
            for node, file_name in zip(nodes, make_unique([re.sub(r"[^\w .()-]", "_", node.name) for node in nodes])):
                write_file(f"{file_name}.stl", trimesh.Trimesh(node.vertices, node.triangles, process=False).export(file_type="stl"))
        elif file_format == "ply":
            write_file(f"{name}.ply", _ply(trimesh, mesh, labels, rgba))
            for image in mesh.appearance.images if mesh.appearance else ():
                write_file(image.name, image.data)
        elif file_format == "glb":
            write_file(f"{name}.glb", gltf.write_glb(nodes))
        elif file_format == "obj":
            for file_name, data in wavefront.write_obj(name, nodes).items():
                write_file(file_name, data)
        else:
            scene = trimesh.Scene()
            for node in nodes:
                scene.add_geometry(trimesh.Trimesh(node.vertices, node.triangles, process=False), node.name, node.name)
            write_file(f"{name}.3mf", threemf.add_colors(scene.export(file_type="3mf"),
                                                         {node.name: node.appearance for node in nodes}))
    write_file(f"{name}.json", json.dumps({
        "parts": [{"name": names[part], "parent": None if links[part].parent < 0 else names[links[part].parent],
                   "faces": int((cut.labels == part).sum()), "volume": cut.volume(part),
                   "color": rgba[part, :3].round(4).tolist()} for part in range(len(cut))],
        "labels": cut.labels.tolist(),
        **({"pieces": [{"name": piece_names[piece], "part": piece_parts[piece]} for piece in pieces]} if printed else {})}))
    return paths


def image_needs(look: Appearance, formats: Sequence[str]) -> List[Need]:
    """What write() needs for a model's images, for requirements.check()."""
    uses = {"3mf": "Turning textures into colors of 3mf files", "glb": "Converting textures for glb files"}
    is_foreign = any(not image.mime_type for image in look.images)
    return [(uses[name], "PIL") for name in formats if (name == "3mf" and look.images) or (name == "glb" and is_foreign)]


def _part_color(color: np.ndarray, count: int) -> Appearance:
    """The appearance of a part, of which count triangles are to be written, of a model that has none."""
    return Appearance({"COLOR_0": np.tile(from_bytes((color * 255).astype(np.uint8)), (count, 3, 1))}, np.full(count, -1))


def _ply(trimesh: Any, mesh: Mesh, labels: np.ndarray, rgba: np.ndarray) -> bytes:
    """The model with the part and its color of each triangle; of its own appearance, the color of each vertex, the texture
    coordinates of each triangle, and the names of the textures, as MeshLab has them."""
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
    if "TEXCOORD_0" in attributes:
        model.face_attributes["texcoord"] = (attributes["TEXCOORD_0"] * [1, -1] + [0, 1]).reshape(-1, 6).astype(np.float32)
        textures = [_texture_image(mesh.appearance, material) for material in materials]
        numbers = sorted({number for number in textures if number is not None})
        if numbers:
            of_material = np.array([numbers.index(number) if number is not None else -1 for number in textures] + [-1])
            model.face_attributes["texnumber"] = of_material[mesh.appearance.face_materials].astype(np.int32)
            comments = b"".join(f"comment TextureFile {mesh.appearance.images[number].name}\n".encode() for number in numbers)
    head, separator, rest = model.export(file_type="ply", include_attributes=True).partition(b"element vertex")
    return head + comments + separator + rest


def _texture_image(look: Appearance, material: Dict[str, Any]) -> Optional[int]:
    """The number of the image of a material's base color."""
    info = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
    return look.textures[info["index"]].get("source") if info else None
