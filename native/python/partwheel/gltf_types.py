# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that what is read from a glTF file's JSON has the right types, so that its readers need not."""

import math
from typing import Any, Callable, Dict, NamedTuple


class _Kind(NamedTuple):
    description: str
    matches: Callable[[Any], bool]


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value)


def _numbers(count: int) -> _Kind:
    return _Kind(f"{count} numbers", lambda value: isinstance(value, list) and len(value) == count and all(map(_is_number, value)))


NUMBER = _Kind("a number", _is_number)
SIZE = _Kind("a whole number of at least 0", lambda value: type(value) is int and value >= 0)
TEXT = _Kind("a text", lambda value: isinstance(value, str))
TEXTURE = {"index": "textures", "texCoord": SIZE, "extensions": {
    "KHR_texture_transform": {"offset": _numbers(2), "rotation": NUMBER, "scale": _numbers(2), "texCoord": SIZE}}}
# What the entries of each list are: objects with these kinds of values. The name of a list stands for an index into it.
ENTRIES: Dict[str, Dict[str, Any]] = {
    "nodes": {"name": TEXT, "mesh": "meshes"},
    "meshes": {"name": TEXT, "primitives": [{"attributes": {}, "material": "materials"}]},
    "materials": {
        "name": TEXT, "emissiveFactor": _numbers(3), "emissiveTexture": TEXTURE, "normalTexture": TEXTURE, "occlusionTexture": TEXTURE,
        "pbrMetallicRoughness": {"baseColorFactor": _numbers(4), "metallicFactor": NUMBER, "roughnessFactor": NUMBER,
                                 "baseColorTexture": TEXTURE, "metallicRoughnessTexture": TEXTURE}},
    "textures": {"source": "images", "sampler": "samplers", "extensions": {"EXT_texture_webp": {"source": "images"}}},
    "samplers": {},
    "images": {"name": TEXT, "uri": TEXT, "bufferView": "bufferViews"},
    "bufferViews": {"buffer": "buffers", "byteOffset": SIZE, "byteLength": SIZE},
    "buffers": {"uri": TEXT},
}
REQUIRED = {"index", "primitives", "buffer", "byteLength"}


def check_types(tree: Any) -> None:
    """Raises ValueError, which says what is wrong where, if the tree of a glTF file has values of wrong types."""
    _check(tree, {name: [entry] for name, entry in ENTRIES.items()}, "the file", tree)


def _check(value: Any, expected: Any, place: str, tree: Any) -> None:
    """expected : a _Kind, the name of a list, [kind of the entries], or {name: kind} of an object"""
    if isinstance(expected, dict):
        _require(isinstance(value, dict), place, "an object")
        for name, kind in expected.items():
            inside = f"{place}.{name}" if value is not tree else name
            if name in value:
                _check(value[name], kind, inside, tree)
            else:
                _require(name not in REQUIRED, inside, "there")
    elif isinstance(expected, list):
        _require(isinstance(value, list), place, "a list")
        for number, entry in enumerate(value):
            _check(entry, expected[0], f"{place}[{number}]", tree)
    elif isinstance(expected, str):
        entries = tree.get(expected)
        _require(SIZE.matches(value) and isinstance(entries, list) and value < len(entries), place, f"one of the file's {expected}")
    else:
        _require(expected.matches(value), place, expected.description)


def _require(is_met: bool, place: str, expected: str) -> None:
    if not is_met:
        raise ValueError(f"{place} is not {expected}. Correct it, or export the model again")
