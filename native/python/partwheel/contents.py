# SPDX-License-Identifier: GPL-3.0-or-later
"""Detects what a mesh file contains besides its surface, and what of that an output will not have."""

import os
import re
import zipfile
from pathlib import Path
from typing import Dict, List, Sequence, Tuple, Union

# What can be lost, in the order of messages. Not normals: they follow from the surface.
KINDS = ("texture coordinates", "textures", "materials", "colors", "names", "skeletons", "animations", "shape keys")

# Format of parts, or of convex parts with the model -> the kinds of content that it keeps, of those that meshes.read() reads.
# NAME.json has the names, too. In 3MF, textures become colors.
WRITTEN = {
    **dict.fromkeys(("unreal", "godot", "urdf"), ("texture coordinates", "textures", "materials", "colors", "names")),
    "mjcf": ("texture coordinates", "textures", "materials", "names"),
    "usd": ("names",),
    "glb": ("texture coordinates", "textures", "materials", "colors", "names"),
    "obj": ("texture coordinates", "textures", "materials", "colors", "names"),
    "ply": ("texture coordinates", "textures", "colors", "names"),
    "3mf": ("textures", "materials", "colors", "names"),
    "stl": ("names",),
}

# Format -> kind -> a pattern that the file then contains. Patterns, unlike parsers, accept damaged files.
GLTF = {
    "texture coordinates": rb'"TEXCOORD_\d', "textures": rb'"(?:textures|images)"\s*:\s*\[\s*\{',
    "materials": rb'"materials"\s*:\s*\[\s*\{', "colors": rb'"COLOR_\d', "names": rb'"name"\s*:\s*"[^"]',
    "skeletons": rb'"skins"\s*:\s*\[\s*\{', "animations": rb'"animations"\s*:\s*\[\s*\{',
    "shape keys": rb'"targets"\s*:\s*\[\s*\{',
}
OFF_HEADER = rb"\A(?:\s*#[^\n]*\n)*\s*"
PATTERNS: Dict[str, Dict[str, bytes]] = {
    ".glb": GLTF, ".gltf": GLTF,
    ".obj": {
        "texture coordinates": rb"(?m)^[ \t]*vt[ \t]", "materials": rb"(?m)^[ \t]*usemtl[ \t]",
        "textures": rb"(?m)^[ \t]*map_\w+[ \t]", "colors": rb"(?m)^[ \t]*v(?:[ \t]+[-+.\deE]+){6}",
        "names": rb"(?m)^[ \t]*[og][ \t]+\S",
    },
    ".ply": {
        "texture coordinates": rb"(?m)^property .*\b(?:s|t|u|v|s0|s1|texture_u|texture_v|texcoord)\s*$",
        "textures": rb"(?m)^comment TextureFile\b", "materials": rb"(?m)^element material\b",
        "colors": rb"(?m)^property \w+ (?:diffuse_)?red\b",
    },
    ".off": {
        "texture coordinates": OFF_HEADER + rb"(?i:ST)\w*OFF",
        "colors": OFF_HEADER + rb"(?is:(?:ST)?C\w*OFF|OFF\b.*?\n[ \t]*(?:3(?:[ \t]+\d+){3}|4(?:[ \t]+\d+){4})[ \t]+[\d.])",
    },
    ".stl": {"colors": rb"(?s)\A.{0,74}COLOR="},
    ".3mf": {
        "texture coordinates": rb"<(?:\w+:)?tex2coord\b", "textures": rb"<(?:\w+:)?texture2d\b",
        "materials": rb"<(?:\w+:)?basematerials\b", "colors": rb"<(?:\w+:)?colorgroup\b",
        "names": rb'<object\b[^>]*\bname="[^"]',
    },
    ".dae": {
        "texture coordinates": rb'semantic="TEXCOORD"', "textures": rb"<image\b", "materials": rb"<material\b",
        "colors": rb'semantic="COLOR"', "names": rb'<(?:node|geometry)\b[^>]*\bname="[^"]', "skeletons": rb"<skin\b",
        "animations": rb"<animation\b", "shape keys": rb"<morph\b",
    },
}


def find_contents(path: Union[str, Path]) -> Tuple[str, ...]:
    """The kinds of KINDS that a file contains besides its surface; none for a format without PATTERNS. Raises OSError."""
    path = Path(path)
    patterns = PATTERNS.get(path.suffix.lower(), {})
    text = read_header(path) if patterns else b""
    return tuple(kind for kind in KINDS if kind in patterns and re.search(patterns[kind], text))


def find_losses(dropped: Sequence[str], kinds: Sequence[str], formats: Sequence[str]) -> Dict[str, Tuple[str, ...]]:
    """What an output will not have of a model's Mesh.dropped and Mesh.kinds: {format: kinds}; {"": kinds} without formats."""
    return {name: tuple(kind for kind in KINDS if kind in dropped or (kind in kinds and kind not in WRITTEN.get(name, ())))
            for name in formats or [""]}


def find_dropped(losses: Dict[str, Tuple[str, ...]]) -> Tuple[str, ...]:
    """What no output will have."""
    return tuple(kind for kind in KINDS if all(kind in lost for lost in losses.values()))


def describe_losses(losses: Dict[str, Tuple[str, ...]]) -> List[str]:
    """Sentences about what will be missing; none if nothing will be."""
    dropped = find_dropped(losses)
    sentences = [("Not in the output, though the file has them", dropped)]
    sentences += [(f"Not in {name} files", tuple(kind for kind in kinds if kind not in dropped))
                  for name, kinds in losses.items()]
    return [f"{start}: {_listed(kinds)}." for start, kinds in sentences if kinds]


def _listed(kinds: Sequence[str]) -> str:
    *first, last = kinds
    return f"{', '.join(first)} and {last}" if first else last


def read_header(path: Path) -> bytes:
    """The part of a file in which to search."""
    suffix = path.suffix.lower()
    if suffix == ".3mf":
        with zipfile.ZipFile(path) as archive:
            return b"\n".join(archive.read(name) for name in archive.namelist() if name.lower().endswith(".model"))
    with open(path, "rb") as file:
        if suffix == ".glb":  # 12 bytes of header, then the JSON chunk: length, type, data
            head = file.read(20)
            return file.read(int.from_bytes(head[12:16], "little"))
        if suffix == ".stl":
            return file.read(80)
        text = file.read()
    if suffix == ".ply":
        return text[:text.find(b"end_header")]
    return text + _materials(path, text) if suffix == ".obj" else text


def _materials(path: Path, text: bytes) -> bytes:
    """The content of an OBJ's existing material files."""
    materials = b""
    for name in re.findall(rb"(?m)^[ \t]*mtllib[ \t]+(.+?)\s*$", text):
        library = path.parent / os.path.basename(name.decode("utf-8", "replace"))
        materials += b"\n" + library.read_bytes() if library.is_file() else b""
    return materials
