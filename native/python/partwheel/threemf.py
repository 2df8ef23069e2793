# SPDX-License-Identifier: GPL-3.0-or-later
"""Colors in 3MF files, which trimesh writes without them."""

from __future__ import annotations

import io
import zipfile
from typing import Any, Mapping, Tuple

import numpy as np

from .appearance import Appearance, to_bytes
from .requirements import load_module

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
MATERIALS = "{http://schemas.microsoft.com/3dmanufacturing/material/2015/02}"


def add_colors(data: bytes, looks: Mapping[str, Appearance]) -> bytes:
    """A 3MF file with the colors of its objects' triangles: named materials if that is all they have, or else a color for
    each corner, in which textures are included.

    Parameters
    ----------
    data : the file, as trimesh writes it
    looks : the appearance of the object with each name

    Raises
    ------
    RequirementError : there are textures, and the package for images is not installed
    """
    etree: Any = load_module("lxml.etree", "Writing 3mf files")
    result = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as archive, zipfile.ZipFile(result, "w", zipfile.ZIP_DEFLATED) as output:
        for name in archive.namelist():
            content = archive.read(name)
            if name.lower().endswith(".model"):
                tree = etree.fromstring(content)
                resources = tree.find(f"{CORE}resources")
                identifier = max(int(element.get("id")) for element in resources) + 1
                for element in list(resources):
                    if element.get("name") in looks and element.find(f"{CORE}mesh") is not None:
                        group = _add_object_colors(etree, element, str(identifier), looks[element.get("name")])
                        resources.insert(resources.index(element), group)
                        identifier += 1
                content = etree.tostring(tree, xml_declaration=True, encoding="UTF-8")
            output.writestr(name, content)
    return result.getvalue()


def _add_object_colors(etree: Any, element: Any, identifier: str, look: Appearance) -> Any:
    """The group of an object's colors, to which its triangles then refer."""
    if "COLOR_0" in look.attributes or any("baseColorTexture" in material.get("pbrMetallicRoughness", {})
                                           for material in look.materials):
        unique, numbers = np.unique(to_bytes(look.base_colors()).reshape(-1, 4), axis=0, return_inverse=True)
        group = etree.Element(f"{MATERIALS}colorgroup", id=identifier)
        for color in unique.tolist():
            etree.SubElement(group, f"{MATERIALS}color", color=_hexadecimal(color))
        rows = numbers.reshape(-1, 3)
    else:
        group = etree.Element(f"{CORE}basematerials", id=identifier)
        used, numbers = np.unique(look.face_materials, return_inverse=True)
        colors = dict(zip(look.face_materials.tolist(), to_bytes(look.base_colors())[:, 0].tolist()))
        for material in used.tolist():
            name = look.materials[material].get("name") if material >= 0 else None
            etree.SubElement(group, f"{CORE}base", name=name or "Material", displaycolor=_hexadecimal(colors[material]))
        rows = numbers.reshape(-1, 1)
    element.set("pid", identifier)
    element.set("pindex", "0")
    for triangle, row in zip(element.iter(f"{CORE}triangle"), rows.tolist()):
        triangle.set("pid", identifier)
        for number, index in enumerate(row, 1):
            triangle.set(f"p{number}", str(index))
    return group


def _hexadecimal(color: Tuple[int, ...]) -> str:
    return "#" + bytes(color).hex().upper()
