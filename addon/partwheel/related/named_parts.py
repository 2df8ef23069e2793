# SPDX-License-Identifier: GPL-3.0-or-later
"""Remembered parts. Each is a face attribute "part: NAME" of the mesh, 1 on its faces: so the .blend file stores it,
Blender preserves it through edits and undo, and Geometry Nodes can use it. The node of a part is the one with the
largest overlap of faces in the current hierarchy."""

import bmesh
import bpy
import numpy as np

from ..mesh import MeshSnapshot, Refused, arrays
from ..pick import borders
from partwheel import Hierarchy
from partwheel.cut.names import MAX_NAME_BYTES
from partwheel.likeness import best_node

ATTRIBUTE_PREFIX = "part: "
MIN_OVERLAP = 0.5  # least overlap of a node with the remembered faces


def is_part_attribute(attribute: bpy.types.Attribute) -> bool:
    return (attribute.name.startswith(ATTRIBUTE_PREFIX) and attribute.domain == "FACE" and attribute.data_type == "INT")


def part_names(mesh: bpy.types.Mesh) -> list[str]:
    """The parts' names, in the order in which they were remembered. Cheap enough for panels."""
    return [attribute.name[len(ATTRIBUTE_PREFIX):] for attribute in mesh.attributes if is_part_attribute(attribute)]


def remember_part(mesh: bpy.types.Mesh, name: str, faces: np.ndarray) -> None:
    """Stores the faces (n,) under a new name. Raises Refused."""
    name = _check_new_name(mesh, name)
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        layer = bm.faces.layers.int.new(ATTRIBUTE_PREFIX + name)
        bm.faces.ensure_lookup_table()
        for face in faces.tolist():
            bm.faces[face][layer] = 1
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    else:
        mesh.attributes.new(ATTRIBUTE_PREFIX + name, "INT", "FACE").data.foreach_set(
            "value", arrays.make_mask(len(mesh.polygons), faces).astype(np.int32))


def rename_part(mesh: bpy.types.Mesh, name: str, new: str) -> None:
    """Raises Refused, for example for a name in use."""
    _require_name(mesh, name)
    if new != name:
        mesh.attributes[ATTRIBUTE_PREFIX + name].name = ATTRIBUTE_PREFIX + _check_new_name(mesh, new)


def forget_part(mesh: bpy.types.Mesh, name: str) -> None:
    """Raises Refused."""
    _require_name(mesh, name)
    mesh.attributes.remove(mesh.attributes[ATTRIBUTE_PREFIX + name])


def find_node(snapshot: MeshSnapshot, hierarchy: Hierarchy, name: str) -> tuple[int, bool]:
    """(the node nearest to the remembered faces, whether their border is in creases). hierarchy: from
    registry.get_hierarchy(snapshot). Raises Refused if no node is near."""
    _require_name(snapshot.mesh, name)
    is_remembered = arrays.read_face_integers(snapshot.mesh, ATTRIBUTE_PREFIX + name) != 0
    best, overlap = best_node(hierarchy, is_remembered)
    if overlap < MIN_OVERLAP:
        raise Refused("{name} no longer has a part similar to {part}. Pick the part again, forget the name {part}, "
                      "and remember the part under this name.", name=snapshot.obj.name, part=name)
    if overlap == 1:
        return best, False
    snapped = borders.get_part_mask(snapshot, hierarchy, best)
    return best, bool((snapped & is_remembered).sum() / (snapped | is_remembered).sum() > overlap)


def _require_name(mesh: bpy.types.Mesh, name: str) -> None:
    """Raises Refused if no part has this name."""
    if name not in part_names(mesh):
        raise Refused("{name} has no remembered part {part}. Pick the part, and name it with Remember Part.",
                      name=mesh.name, part=name)


def _check_new_name(mesh: bpy.types.Mesh, name: str) -> str:
    """The name without spaces around it. Raises Refused if it is empty, too long, or in use."""
    name = name.strip()
    if not name:
        raise Refused("Enter a name for the part.")
    if len(name.encode()) > MAX_NAME_BYTES:
        raise Refused("The name {name} is too long: use at most {count} letters, fewer in some scripts.", name=name,
                      count=MAX_NAME_BYTES)
    if ATTRIBUTE_PREFIX + name in mesh.attributes:
        raise Refused("There already is a remembered part {name}. Enter another name, or forget that part first.",
                      name=name)
    return name
