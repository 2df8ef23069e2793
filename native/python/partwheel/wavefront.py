# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes what OBJ files and their material files say about appearance. trimesh has one material per object, and
converts images."""

from pathlib import Path
from typing import Any, Dict, Iterable, List, Optional, Sequence, Tuple

import numpy as np

from .appearance import Image, describe_mtl, to_srgb
from .gltf import Node, split_corners

# Words of a material file -> where glTF has the same texture
TEXTURE_WORDS = {"map_kd": ("pbrMetallicRoughness", "baseColorTexture"), "map_ke": ("emissiveTexture",),
                 "norm": ("normalTexture",)}


def read_materials(folder: Path, libraries: Iterable[str], names: Sequence[str]
                   ) -> Tuple[Sequence[Dict[str, Any]], List[Dict[str, Any]], List[Image], List[str]]:
    """(materials, textures, images, lines of each material) of an OBJ file in a folder, which names these libraries and uses
    materials with these names; one that no file has is white. Materials and textures as glTF has them."""
    lines: Dict[str, List[List[str]]] = {}
    for library in libraries:
        path = folder / Path(library.replace("\\", "/")).name
        current: List[List[str]] = []
        for line in path.read_text("utf-8-sig", "replace").splitlines() if path.is_file() else ():
            words = line.split("#", 1)[0].split()
            if words[:1] == ["newmtl"]:
                current = lines.setdefault(" ".join(words[1:]), [])
            elif words:
                current.append(words)
    images: Dict[str, Image] = {}
    textures: List[Dict[str, Any]] = []
    materials = [_read_material(folder, name, lines.get(name, []), images, textures) for name in names]
    return materials, textures, list(images.values()), ["\n".join(map(" ".join, lines.get(name, []))) for name in names]


def _read_material(folder: Path, name: str, lines: Sequence[List[str]], images: Dict[str, Image],
                   textures: List[Dict[str, Any]]) -> Dict[str, Any]:
    """A material of glTF. The lines get the names of the files that are written; images and textures are added."""
    surface: Dict[str, Any] = {"baseColorFactor": [1.0] * 4, "metallicFactor": 0.0}
    material: Dict[str, Any] = {"name": name, "pbrMetallicRoughness": surface}
    for words in lines:
        word = words[0].lower()
        if word.startswith(("map_", "bump", "norm", "disp", "decal", "refl")):
            image = _read_image(folder, words)
            if image:
                number = list(images.setdefault(image.name, image) and images).index(image.name)
                if word in TEXTURE_WORDS:
                    *group, key = TEXTURE_WORDS[word]
                    (material[group[0]] if group else material)[key] = {"index": len(textures)}
                    textures.append({"source": number})
            continue
        try:
            values = [float(value) for value in words[1:]]
        except ValueError:
            continue
        if word == "kd" and len(values) == 3:
            surface["baseColorFactor"] = [*values, surface["baseColorFactor"][3]]
        elif word in ("d", "tr") and len(values) == 1:
            surface["baseColorFactor"][3] = values[0] if word == "d" else 1 - values[0]
        elif word == "ke" and len(values) == 3 and any(values):
            material["emissiveFactor"] = np.clip(values, 0, 1).tolist()
        elif word in ("pr", "pm") and len(values) == 1:
            surface["roughnessFactor" if word == "pr" else "metallicFactor"] = values[0]
    if "emissiveTexture" in material:
        material.setdefault("emissiveFactor", [1.0] * 3)
    if surface["baseColorFactor"][3] < 1:
        material["alphaMode"] = "BLEND"
    return material


def _read_image(folder: Path, words: List[str]) -> Optional[Image]:
    """The image that a line names after its options; None if there is no such file. The line's last word becomes the name
    of the file without its folder."""
    for start in range(1, len(words)):
        path = folder / " ".join(words[start:]).replace("\\", "/")
        path = path if path.is_file() else folder / path.name
        if path.is_file():
            words[start:] = [path.name]
            return Image(path.name, path.read_bytes())
    return None


def write_obj(name: str, nodes: Sequence[Node]) -> Dict[str, bytes]:
    """{file name: content} of NAME.obj, NAME.mtl and the images, with an object for each node."""
    look = nodes[0].appearance
    used = [f"{material.get('name') or 'Material'}" for material in look.materials]
    names = [f"{word}.{number}" if word in used[:number] else word
             for number, word in enumerate("_".join(w.split()) for w in used)]
    described = [*(look.mtl or describe_mtl(look.materials, look.textures, look.images)), *describe_mtl([{}], [], [])]
    names.append("Partwheel_None")  # of triangles without material: else the last material goes on
    lines = [f"mtllib {name}.mtl"] if look.materials else []
    counts = [1, 1, 1]  # of vertices, texture coordinates and normals so far, plus 1
    for node in nodes:
        lines.append(f"o {node.name}")
        _write_object(node, names if look.materials else [], lines, counts)
    files = {f"{name}.obj": "\n".join([*lines, ""]).encode()}
    if look.materials:
        files[f"{name}.mtl"] = "\n".join(f"newmtl {word}\n{text}\n" for word, text in zip(names, described)).encode()
    return {**files, **{image.name: image.data for image in look.images}}


def _write_object(node: Node, names: Sequence[str], lines: List[str], counts: List[int]) -> None:
    """Appends the lines of a node."""
    corners, attributes = node.triangles.ravel(), node.appearance.attributes
    by_word = {"vt": node.appearance.plain_coordinates(), "vn": attributes.get("NORMAL")}
    colors = attributes.get("COLOR_0")
    flat = [] if colors is None else [to_srgb(colors.reshape(-1, colors.shape[2])[:, :3])]
    first, indices = split_corners(corners, flat)
    points = np.concatenate([node.vertices[corners[first]], *(values[first] for values in flat)], axis=1)
    lines += ["v " + " ".join(map(repr, point)) for point in points.tolist()]
    columns = [indices + counts[0]]
    counts[0] += len(points)
    for kind, (word, of_corners) in enumerate(by_word.items(), 1):
        if of_corners is not None:
            values = of_corners.reshape(len(corners), -1)
            values = np.column_stack([values[:, 0], 1 - values[:, 1]]) if word == "vt" else values
            unique, index = np.unique(values.astype(np.float32), axis=0, return_inverse=True)
            lines += [f"{word} " + " ".join(map(repr, value)) for value in unique.tolist()]
            columns.append(index.ravel() + counts[kind])
            counts[kind] += len(unique)
    form = "/".join(["{}", *("" if values is None else "{}" for values in by_word.values())]).rstrip("/")
    face_form = "f " + " ".join([form] * 3)
    rows = np.column_stack(columns).reshape(len(node.triangles), -1).tolist()
    materials = node.appearance.face_materials
    for material in np.unique(materials).tolist():
        lines += [f"usemtl {names[material]}"] if names else []
        lines += [face_form.format(*rows[triangle]) for triangle in np.flatnonzero(materials == material).tolist()]
