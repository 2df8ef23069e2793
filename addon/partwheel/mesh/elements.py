# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes one property of all elements of a mesh at once."""

from collections.abc import Iterable, Iterator

import bpy
import numpy as np

# Properties that Blender stores as an attribute, most of them since 4.0: property -> (attribute, field, data type).
# Copying the attribute is a hundred times faster. "select" and "hide" have one attribute per kind of element.
_LAYERS = {"co": ("position", "vector", "FLOAT_VECTOR"), "vertex_index": (".corner_vert", "value", "INT"),
           "edge_index": (".corner_edge", "value", "INT"),
           "select": (".select_{kind}", "value", "BOOLEAN"), "hide": (".hide_{kind}", "value", "BOOLEAN")}
_KINDS = {"MeshVertices": "vert", "MeshEdges": "edge", "MeshPolygons": "poly"}
# Data type of an attribute -> that of its array.
_DTYPES = {"INT": np.int32, "INT8": np.int8, "BOOLEAN": bool, "FLOAT": np.float32}
# Blender copies these as one block, ten times faster, into unsigned arrays.
_UNSIGNED = {"vertex_index", "edge_index", "vertices", "loop_start", "loop_total", "polygon_index"}


def read(collection: bpy.types.bpy_prop_collection, attribute: str, dtype: type, width: int = 1) -> np.ndarray:
    """Return one property of all elements, as an array of shape (n,) or (n, width)."""
    values = np.empty(len(collection) * width, dtype)
    layer, field = _find_layer(collection, attribute)
    if layer:
        layer.data.foreach_get(field, values)
    else:
        collection.foreach_get(attribute, values.view(np.uint32) if attribute in _UNSIGNED else values)
    return values if width == 1 else values.reshape(-1, width)


def read_positions(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the position of each vertex, (V, 3) float32."""
    return read(mesh.vertices, "co", np.float32, 3)


def read_corner_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the vertex of each corner, (C,) int32."""
    return read(mesh.loops, "vertex_index", np.int32)


def read_edge_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the vertices of each edge, (E, 2) int32."""
    return read(mesh.edges, "vertices", np.int32, 2)


def find_attribute(mesh: bpy.types.Mesh, name: str, kind: str, domain: str) -> bpy.types.Attribute | None:
    """Return the attribute of this name, data type and domain, or None. Another one may have the same name."""
    attribute = mesh.attributes.get(name)
    return attribute if attribute and (attribute.data_type, attribute.domain) == (kind, domain) else None


def read_attribute(mesh: bpy.types.Mesh, name: str, kind: str, domain: str) -> np.ndarray | None:
    """Return the values of find_attribute(), (n,), or None. In Edit Mode only of a marks.readable_mesh()."""
    attribute = find_attribute(mesh, name, kind, domain)
    return read(attribute.data, "value", _DTYPES[kind]) if attribute else None


def read_weights(mesh: bpy.types.Mesh, groups: Iterable[int]) -> Iterator[np.ndarray]:
    """Yield the weights (V,) of each of these vertex groups, given by their indices; 0 outside."""
    entries = [(entry.group, vertex.index, entry.weight) for vertex in mesh.vertices for entry in vertex.groups]
    numbers, vertices, weights = np.array(entries, float).reshape(-1, 3).T
    for group in groups:
        of_vertex, is_in_group = np.zeros(len(mesh.vertices)), numbers == group
        of_vertex[vertices[is_in_group].astype(int)] = weights[is_in_group]
        yield of_vertex


def write(collection: bpy.types.bpy_prop_collection, attribute: str, values: np.ndarray) -> None:
    """Set one property of all elements: values (n,) or (n, width), int32 if they are indices."""
    values = np.ascontiguousarray(values).ravel()
    layer, field = _find_layer(collection, attribute)
    if layer:
        layer.data.foreach_set(field, values)
    else:
        collection.foreach_set(attribute, values.view(np.uint32) if attribute in _UNSIGNED else values)


def _find_layer(collection: bpy.types.bpy_prop_collection, attribute: str) -> tuple[bpy.types.Attribute | None, str]:
    """Return (attribute that stores this property, its field), or (None, "")."""
    if attribute not in _LAYERS or not isinstance(collection.data, bpy.types.Mesh):
        return None, ""
    name, field, data_type = _LAYERS[attribute]
    layer = collection.data.attributes.get(name.format(kind=_KINDS.get(collection.bl_rna.identifier)))
    # Blender 5.0.1 may give .select_edge a wrong type. In Edit Mode an attribute has no elements.
    fits = layer and layer.data_type == data_type and len(layer.data) == len(collection)
    return (layer, field) if fits else (None, "")
