# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes 3MF files: objects with names, colors and places on the print bed."""

import io
import zipfile
from typing import List, Optional, Sequence, Tuple
from xml.sax.saxutils import quoteattr

import numpy as np

from .appearance import Appearance, to_bytes
from .gltf import Node

CONTENT_TYPES = """<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>"""
RELATIONSHIPS = """<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"""
HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
 xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">
<resources>"""


def write_3mf(nodes: Sequence[Node], transforms: Optional[Sequence[np.ndarray]] = None) -> bytes:
    """A 3MF file of objects, each with the (3, 4) matrix that places it. An object's colors are named materials if that is
    all it has, or else a color for each corner, in which textures are included. Raises RequirementError if the package for
    images is missing."""
    lines, items = [HEAD], []
    for number, node in enumerate(nodes):
        group, identifier = 2 * number + 1, 2 * number + 2
        colors, rows = _colors(group, node.appearance)
        references = [f'pid="{group}" ' + " ".join(f'p{k}="{index}"' for k, index in enumerate(row, 1)) for row in rows]
        lines += [*colors, f'<object id="{identifier}" type="model" name={quoteattr(node.name)} pid="{group}" pindex="0"><mesh>',
                  "<vertices>",
                  *("<vertex x=\"%.9g\" y=\"%.9g\" z=\"%.9g\"/>" % tuple(point) for point in node.vertices.tolist()),
                  "</vertices><triangles>",
                  *("<triangle v1=\"%d\" v2=\"%d\" v3=\"%d\" %s/>" % (*triangle, reference)
                    for triangle, reference in zip(node.triangles.tolist(), references)), "</triangles></mesh></object>"]
        numbers = "" if transforms is None else " ".join(f"{value:.9g}" for value in transforms[number].T.ravel())
        items.append(f'<item objectid="{identifier}"' + (f' transform="{numbers}"' if numbers else "") + "/>")
    result = io.BytesIO()
    with zipfile.ZipFile(result, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (("[Content_Types].xml", CONTENT_TYPES), ("_rels/.rels", RELATIONSHIPS), (
                "3D/3dmodel.model", "\n".join([*lines, "</resources><build>", *items, "</build></model>"]))):
            archive.writestr(name, text)
    return result.getvalue()


def _colors(group: int, look: Appearance) -> Tuple[List[str], List[List[int]]]:
    """(the lines of an object's group of colors, for each triangle its colors in the group)"""
    if "COLOR_0" in look.attributes or any("baseColorTexture" in material.get("pbrMetallicRoughness", {})
                                           for material in look.materials):
        unique, numbers = np.unique(to_bytes(look.base_colors()).reshape(-1, 4), axis=0, return_inverse=True)
        lines = [f'<m:colorgroup id="{group}">', *(f'<m:color color="{_hexadecimal(color)}"/>' for color in unique.tolist()),
                 "</m:colorgroup>"]
        return lines, numbers.reshape(-1, 3).tolist()
    used, numbers = np.unique(look.face_materials, return_inverse=True)
    colors = dict(zip(look.face_materials.tolist(), to_bytes(look.base_colors())[:, 0].tolist()))
    names = [(look.materials[material].get("name") if material >= 0 else None) or "Material" for material in used.tolist()]
    return [f'<basematerials id="{group}">', *(
        f'<base name={quoteattr(name)} displaycolor="{_hexadecimal(colors[material])}"/>'
        for name, material in zip(names, used.tolist())), "</basematerials>"], numbers.reshape(-1, 1).tolist()


def _hexadecimal(color: Sequence[int]) -> str:
    return "#" + bytes(color).hex().upper()
