# SPDX-License-Identifier: GPL-3.0-or-later
"""What already divides a mesh: its materials, face sets, vertex groups, a face attribute, loose parts."""

from collections.abc import Iterator
from typing import NamedTuple

import bpy
import numpy as np

from . import arrays
from .elements import read_attribute, read_corner_vertices, read_weights
from .errors import Refused
from .marks import FACE_SET, read_materials, readable_mesh
from .snapshot import MeshSnapshot
from ..translations.lookup import iface_
from partwheel.weld import loose_parts

SOURCES = {"MATERIALS": ("Materials", "The faces of each material"),
           "FACE_SETS": ("Face Sets", "Each face set of Sculpt Mode"),
           "VERTEX_GROUPS": ("Vertex Groups", "The faces in which each vertex group has the largest weight"),
           "LOOSE": ("Loose Parts", "What no edge joins to the rest"),
           "ATTRIBUTE": ("Attribute", "The faces with each value of a face attribute")}
ATTRIBUTE_TYPES = {"INT", "INT8", "BOOLEAN"}
NO_GROUP = -1


class Labels(NamedTuple):
    """of_face: (F,) int32. names: of labels that have one."""

    of_face: np.ndarray
    names: dict[int, str]


def list_sources(obj: bpy.types.Object) -> Iterator[tuple[str, str]]:
    """Yield (source, "" or the name of the attribute) of what the object has. Also while Blender draws."""
    mesh = obj.data
    if len({slot.material for slot in obj.material_slots}) > 1:
        yield "MATERIALS", ""
    if FACE_SET in mesh.attributes:
        yield "FACE_SETS", ""
    if obj.vertex_groups:
        yield "VERTEX_GROUPS", ""
    if _read_loose_parts(mesh).any():
        yield "LOOSE", ""
    for attribute in mesh.attributes:
        is_ours = attribute.name.startswith("partwheel_") or attribute.name in {"material_index", "sharp_face"}
        if attribute.domain == "FACE" and attribute.data_type in ATTRIBUTE_TYPES and attribute.name[0] != "." and not is_ours:
            yield "ATTRIBUTE", attribute.name


def read_labels(obj: bpy.types.Object, source: str, attribute: str = "") -> Labels:
    """Return the labels of a source. attribute: its name, for ATTRIBUTE. Raises Refused if the object has no such source."""
    MeshSnapshot(obj).update_mesh()
    names: dict[int, str] = {}
    with readable_mesh(obj.data, obj) as mesh:
        if source == "MATERIALS":
            materials = [slot.material for slot in obj.material_slots]
            of_face = read_materials(mesh, materials)
            names = {slot: material.name for slot, material in enumerate(materials) if material}
        elif source == "VERTEX_GROUPS":
            of_face = _find_largest_groups(mesh, len(obj.vertex_groups))
            names = {group.index: group.name for group in obj.vertex_groups}
        elif source == "LOOSE":
            of_face = _read_loose_parts(mesh)
        else:
            name = FACE_SET if source == "FACE_SETS" else attribute
            kind = mesh.attributes[name].data_type if name in mesh.attributes else "INT"
            values = read_attribute(mesh, name, kind, "FACE") if kind in ATTRIBUTE_TYPES else None
            if values is None:
                raise Refused("{name} has no {source}. Choose something else that divides it.", name=obj.name,
                              source=attribute or iface_(SOURCES[source][0]))
            of_face = values.astype(np.int32)
            names = {value: f"{attribute} {value}" for value in np.unique(of_face).tolist()} if attribute else {}
    return Labels(of_face, names)


def _find_largest_groups(mesh: bpy.types.Mesh, count: int) -> np.ndarray:
    """Return for each face the vertex group with the largest sum of weights at its corners; NO_GROUP without any."""
    faces = np.repeat(np.arange(len(mesh.polygons)), arrays.read_polygon_sizes(mesh)[1])
    corners = read_corner_vertices(mesh)
    largest, group_of_face = np.zeros(len(mesh.polygons)), np.full(len(mesh.polygons), NO_GROUP, np.int32)
    for group, weights in enumerate(read_weights(mesh, range(count))):
        of_face = np.bincount(faces, weights[corners], len(largest))
        group_of_face[of_face > largest] = group
        largest = np.maximum(largest, of_face)
    return group_of_face


def _read_loose_parts(mesh: bpy.types.Mesh) -> np.ndarray:
    surface = arrays.read_surface(mesh)
    first_triangles = np.unique(surface.faces, return_index=True)[1]
    return loose_parts(surface.vertices, surface.triangles)[first_triangles].astype(np.int32)
