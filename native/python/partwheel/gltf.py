# SPDX-License-Identifier: GPL-3.0-or-later
"""What trimesh can't do with glTF: several materials per node, materials and images exactly as they are in the file."""

import base64
import json
import re
import struct
import urllib.parse
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from .appearance import Appearance, Image, default_attribute, to_png
from .gltf_types import check_types

TRIANGLE_FAN = 6  # a mode of glTF's primitives
ATTRIBUTE = re.compile(r"NORMAL|(?:TEXCOORD|COLOR)_\d+")  # the attributes that are read
WIDTHS = {"NORMAL": (3,), "TEXCOORD": (2,), "COLOR": (3, 4)}
COMPRESSIONS = {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"}
PREFIX = "_PARTWHEEL_"  # of the attributes that Document adds for trimesh
COMPONENTS = {"float32": 5126, "uint32": 5125}
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


class Node(NamedTuple):
    """A node with a mesh, to write."""

    name: str
    parent: int  # number of its parent; -1: none
    vertices: np.ndarray  # (n, 3)
    triangles: np.ndarray  # (m, 3)
    appearance: Appearance  # of its triangles; all nodes of a file have the same materials, textures and images
    matrix: Optional[np.ndarray] = None  # (4, 4) from the node's coordinates to its parent's; None: the identity
    extras: Optional[Dict[str, Any]] = None  # custom properties


class Document:
    """A glTF or GLB file, prepared for trimesh, which reads attributes whose names start with "_" as they are."""

    def __init__(self, path: Path, json_chunk: bytes) -> None:
        """json_chunk : the file's JSON. Raises ValueError if it can't be read."""
        self._path, self.tree = path, json.loads(json_chunk, object_pairs_hook=lambda pairs: {
            name: value for name, value in pairs if value is not None})  # what is null counts as absent
        self._rest = path.read_bytes()[20 + len(json_chunk):] if path.suffix.lower() == ".glb" else b""
        if isinstance(self.tree, dict) and isinstance(self.tree.get("meshes"), dict):
            raise ValueError("it is glTF 1.0. Convert it to glTF 2.0, with gltf-pipeline for example")
        check_types(self.tree)
        required = self.tree.get("extensionsRequired", [])
        if compressions := [name for name in sorted(COMPRESSIONS) if name in required]:
            raise ValueError(f"it is compressed ({compressions[0]}). Export it without compression, from Blender for example")
        if any(primitive.get("mode") == TRIANGLE_FAN for mesh in self.tree.get("meshes", []) for primitive in mesh["primitives"]):
            raise ValueError("it has triangle fans. Export it with plain triangles")  # trimesh skips them silently

    def for_trimesh(self) -> bytes:
        """The file as trimesh should read it: each attribute of ATTRIBUTE also under a name with PREFIX, an attribute whose
        name has the number of the material, and nodes with their numbers as names. Primitives without positions, which
        trimesh can't read, are left out: they are empty."""
        tree = json.loads(json.dumps(self.tree))
        for mesh in tree.get("meshes", []):
            mesh["primitives"] = [primitive for primitive in mesh["primitives"] if "POSITION" in primitive.get("attributes", {})]
            for primitive in mesh["primitives"]:
                attributes = primitive["attributes"]
                copies = {f"{PREFIX}{name}": number for name, number in attributes.items() if ATTRIBUTE.fullmatch(name)}
                attributes.update(copies, **{f"{PREFIX}MATERIAL_{primitive.get('material', -1)}": attributes["POSITION"]})
        for number, node in enumerate(tree.get("nodes", [])):
            node["name"] = str(number)
        text = json.dumps(tree).encode()
        return text if self._path.suffix.lower() != ".glb" else _glb(text, self._rest)

    def node_name(self, name: str) -> str:
        """The name of a node in the file; name : of the node in for_trimesh(), to which trimesh may add "_" and more."""
        node = self.tree["nodes"][int(name.split("_")[0])]
        return node.get("name") or self.tree["meshes"][node["mesh"]].get("name") or ""

    def appearance(self, attributes: Dict[str, np.ndarray], face_materials: np.ndarray) -> Appearance:
        """The appearance of a surface with these attributes and materials."""
        materials, textures, samplers = (self.tree.get(kind, []) for kind in ("materials", "textures", "samplers"))
        try:
            images = [self._read_image(number, image) for number, image in enumerate(self.tree.get("images", []))]
        except OSError:  # a texture next to the file is missing
            return Appearance(attributes, face_materials, _without_textures(materials))
        return Appearance(attributes, face_materials, materials, textures, samplers, images)

    def _read_image(self, number: int, image: Dict[str, Any]) -> Image:
        name = image.get("name") or f"texture{number}"
        if "bufferView" in image:
            view = self.tree["bufferViews"][image["bufferView"]]
            start = view.get("byteOffset", 0)
            uri = self.tree["buffers"][view["buffer"]].get("uri")
            data = (self._read_uri(uri) if uri else self._rest[8:])[start:start + view["byteLength"]]
        else:
            uri = image.get("uri", "")
            data, name = self._read_uri(uri), name if uri.startswith("data:") else Path(uri).name
        result = Image(name, data)
        ending = f".{result.mime_type[6:].replace('jpeg', 'jpg')}"
        name = re.sub(r"[^\w.-]", "_", name if Path(name).suffix else name + ending)
        others = [other.get("name") for other in self.tree["images"][:number]]
        return result._replace(name=f"{number}_{name}" if image.get("name") in others else name)

    def _read_uri(self, uri: str) -> bytes:
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (self._path.parent / urllib.parse.unquote(uri)).read_bytes()


def _without_textures(values: Any) -> Any:
    """JSON without entries whose names end with "Texture"."""
    if isinstance(values, dict):
        return {name: _without_textures(value) for name, value in values.items() if not name.endswith("Texture")}
    return list(map(_without_textures, values)) if isinstance(values, list) else values


def split_attributes(attributes: Dict[str, np.ndarray], triangles: np.ndarray) -> Tuple[Dict[str, np.ndarray], int]:
    """({name: (m, 3, k)} of the corners of triangles (m, 3), material) from attributes of vertices that trimesh has read
    from Document.for_trimesh()."""
    result, material = {}, -1
    for name, values in attributes.items():
        if name.startswith(f"{PREFIX}MATERIAL_"):
            material = int(name[len(PREFIX) + 9:])
        elif name.startswith(PREFIX):
            if values.ndim != 2 or values.shape[1] not in WIDTHS[name[len(PREFIX):].split("_")[0]]:
                raise ValueError(f"the attribute {name[len(PREFIX):]} has a wrong type")
            scale = 1 if values.dtype.kind == "f" else np.iinfo(values.dtype).max  # integers are normalized
            values = np.nan_to_num(values.astype(np.float64)[triangles] / scale, posinf=0, neginf=0)
            if name.startswith(f"{PREFIX}COLOR") and values.shape[2] == 3:
                values = np.concatenate([values, np.ones((len(values), 3, 1))], axis=2)
            result[name[len(PREFIX):]] = values
    return result, material


def join_attributes(pieces: Sequence[Dict[str, np.ndarray]], corners: Sequence[np.ndarray]) -> Dict[str, np.ndarray]:
    """The attributes of several surfaces with these corners (m, 3, 3) as one."""
    names = sorted({name for piece in pieces for name in piece})
    return {name: np.concatenate([piece[name] if name in piece else default_attribute(name, of_piece)
                                  for piece, of_piece in zip(pieces, corners)]) for name in names}


# ---- Writing


def write_glb(nodes: Sequence[Node]) -> bytes:
    """A GLB file. Each node's mesh has a primitive for each material; materials and images are those of the source.
    Raises RequirementError if an image must be converted for glTF, and the package for images is missing."""
    look = nodes[0].appearance
    buffer = _Buffer()
    tree: Dict[str, Any] = {"asset": {"version": "2.0", "generator": "Partwheel"}, "scene": 0, "scenes": [
        {"nodes": [number for number, node in enumerate(nodes) if node.parent < 0]}], "nodes": [], "meshes": []}
    for number, node in enumerate(nodes):
        children = [child for child, other in enumerate(nodes) if other.parent == number]
        matrix = [] if node.matrix is None else node.matrix.T.ravel().tolist()
        optional = {"children": children, "extras": node.extras, "matrix": matrix}
        tree["nodes"].append({"name": node.name, "mesh": number, **{key: value for key, value in optional.items() if value}})
        primitives = [buffer.add_primitive(node, material) for material in np.unique(node.appearance.face_materials).tolist()]
        tree["meshes"].append({"name": node.name, "primitives": primitives})
    images = []
    for image in look.images:
        image = image if image.mime_type else to_png(image)
        images.append({"name": image.name.rsplit(".", 1)[0], "mimeType": image.mime_type,
                       "bufferView": buffer.add_view(image.data)})
    tree.update({kind: list(values) for kind, values in (("materials", look.materials), ("textures", look.textures),
                                                         ("samplers", look.samplers), ("images", images)) if values})
    used = sorted(set(re.findall(r'"((?:KHR|EXT|MSFT)_\w+)": ', json.dumps([*look.materials, *look.textures]))))
    tree.update({"extensionsUsed": used} if used else {}, accessors=buffer.accessors, bufferViews=buffer.views,
                buffers=[{"byteLength": len(buffer.data)}])
    text = json.dumps(tree, separators=(",", ":")).encode()
    return _glb(text, struct.pack("<I4s", len(buffer.data), b"BIN\0") + buffer.data)


def _glb(text: bytes, rest: bytes) -> bytes:
    """A GLB file of JSON and the chunks after it."""
    text += b" " * (-len(text) % 4)
    return struct.pack("<4s3I4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest


class _Buffer:
    """The binary chunk, with its views and accessors."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: List[Dict[str, int]] = []
        self.accessors: List[Dict[str, Any]] = []

    def add_view(self, data: bytes, **options: int) -> int:
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **options})
        self.data += data + bytes(-len(data) % 4)
        return len(self.views) - 1

    def add_accessor(self, values: np.ndarray, target: int, **options: Any) -> int:
        kind = "SCALAR" if values.ndim == 1 else f"VEC{values.shape[1]}"
        self.accessors.append({"bufferView": self.add_view(values.tobytes(), target=target), "count": len(values), "type": kind,
                               "componentType": COMPONENTS[values.dtype.name], **options})
        return len(self.accessors) - 1

    def add_primitive(self, node: Node, material: int) -> Dict[str, Any]:
        """The triangles of one material, with a vertex for each combination of vertex and attributes."""
        is_used = node.appearance.face_materials == material
        attributes = {name: values[is_used].reshape(3 * is_used.sum(), -1) for name, values in node.appearance.attributes.items()}
        corners = node.triangles[is_used].ravel()
        first, indices = split_corners(corners, list(attributes.values()))
        positions = node.vertices[corners[first]].astype(np.float32)
        accessors = {"POSITION": self.add_accessor(positions, ARRAY_BUFFER, min=positions.min(axis=0).tolist(),
                                                   max=positions.max(axis=0).tolist())}
        for name, values in attributes.items():
            accessors[name] = self.add_accessor(values[first].astype(np.float32), ARRAY_BUFFER)
        return {"attributes": accessors, "indices": self.add_accessor(indices.astype(np.uint32), ELEMENT_ARRAY_BUFFER),
                **({"material": material} if material >= 0 else {})}


def split_corners(corners: np.ndarray, attributes: Sequence[np.ndarray]) -> Tuple[np.ndarray, np.ndarray]:
    """Vertices for corners that differ in vertex (n,) or attributes (n, k) each, compared in single precision, in the order
    of the vertices: ((v,) the first corner of each new vertex, (n,) the new vertex of each corner)"""
    parts = [corners.astype(np.int32)[:, None].view(np.uint8)]
    parts += [np.ascontiguousarray(values.astype(np.float32) + np.float32(0)).view(np.uint8) for values in attributes]
    keys = np.ascontiguousarray(np.concatenate(parts, axis=1))
    _, first, group = np.unique(keys.view(f"V{keys.shape[1]}").ravel(), return_index=True, return_inverse=True)
    order = np.argsort(corners[first], kind="stable")
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    return first[order], rank[group.ravel()]
