# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a part to the mesh outside Edit Mode: as a face set, sculpt mask, vertex group or paint mask."""

import bpy
import numpy as np

from ..mesh import FACE_SET, Refused, arrays, assembly, select_outside_edit_mode
from ..translations.lookup import rpt_

MASK = ".sculpt_mask"  # an attribute from Blender 4.1 on

# Whether write_level_mask() works: undo reverts it in Blender 3.4, but not in 4.5 and 5.2; without a window, 3.4 crashes.
HAS_LEVEL_MASKS = bpy.app.version < (4, 1) and not bpy.app.background


def _part_vertices(mesh: bpy.types.Mesh, faces: np.ndarray) -> np.ndarray:
    """Return a mask (V,) of the vertices of these faces, and of vertices that coincide with them."""
    of_part = arrays.mask_elements_of_faces(mesh, arrays.make_mask(len(mesh.polygons), faces))
    old_to_new = arrays.find_coincident_vertices(mesh)
    return arrays.make_mask(len(of_part), old_to_new[of_part])[old_to_new]


def _write_face_set(obj: bpy.types.Object, faces: np.ndarray, _node: int, _extend: bool, deselect: bool) -> None:
    """Give the part a face set of its own. With deselect, return its faces to face set 1."""
    mesh = obj.data
    attribute = arrays.ensure_attribute(mesh, FACE_SET, "INT", "FACE")
    values = arrays.read(attribute.data, "value", np.int32)
    values[values == 0] = 1  # faces without a face set belong to the first one
    values[faces] = 1 if deselect else values.max(initial=1) + 1
    attribute.data.foreach_set("value", values)


def _write_mask(obj: bpy.types.Object, faces: np.ndarray, _node: int, extend: bool, deselect: bool) -> None:
    mesh = obj.data
    if find_mask(mesh) is None:
        if bpy.app.version >= (4, 1):
            arrays.ensure_attribute(mesh, MASK, "FLOAT", "POINT")
        else:
            with assembly.edit_as_bmesh(mesh, mesh) as bm:
                bm.verts.layers.paint_mask.verify()
    values = find_mask(mesh)
    outside = arrays.read(values, "value", np.float32) if extend or deselect else np.float32(0)
    values.foreach_set("value", np.where(_part_vertices(mesh, faces), np.float32(0 if deselect else 1), outside))


def write_level_mask(obj: bpy.types.Object, faces: np.ndarray, _node: int, extend: bool, deselect: bool) -> None:
    """Write the mask of a Multiresolution modifier's levels. Python can't access it. So all faces but the part are
    hidden, and Blender's *Mask Fill* changes what is visible."""
    polygons = obj.data.polygons
    hidden = arrays.read(polygons, "hide", bool)
    try:
        if not (extend or deselect):
            _fill_mask(0)
        arrays.write(polygons, "hide", ~arrays.make_mask(len(polygons), faces))
        _fill_mask(0 if deselect else 1)
    finally:
        arrays.write(polygons, "hide", hidden)


def _fill_mask(value: float) -> None:
    bpy.ops.object.mode_set(mode="SCULPT")
    try:
        bpy.ops.paint.mask_flood_fill(mode="VALUE", value=value)
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def find_mask(mesh: bpy.types.Mesh) -> bpy.types.bpy_prop_collection | None:
    """Return the collection with the mask value of each vertex, or None. It ignores levels of a Multiresolution modifier."""
    if bpy.app.version >= (4, 1):
        layer = arrays.find_attribute(mesh, MASK, "FLOAT", "POINT")
    else:
        layer = next(iter(mesh.vertex_paint_masks), None)
    return layer and layer.data


def _write_vertex_group(obj: bpy.types.Object, faces: np.ndarray, node: int, extend: bool, deselect: bool) -> str:
    """Write the part to a new, active vertex group, or into the active one. Return a sentence about it."""
    part = np.flatnonzero(_part_vertices(obj.data, faces)).tolist()
    group = obj.vertex_groups.active if extend or deselect else None
    if group and group.lock_weight:
        raise Refused("The vertex group {name} is locked. Unlock it, or pick the part alone: it gets a group of its own.",
                      name=group.name)
    if deselect:
        if not group:
            raise Refused("{name} has no vertex group that the part could be removed from.", name=obj.name)
        group.remove(part)
        return rpt_("The part was removed from the vertex group {name}.").format(name=group.name)
    if group:
        group.add(part, 1.0, "REPLACE")
        return rpt_("The part was added to the vertex group {name}.").format(name=group.name)
    group = obj.vertex_groups.new(name=f"Part {node}")
    group.add(part, 1.0, "REPLACE")
    return rpt_("The part is the new vertex group {name}.").format(name=group.name)


def _write_paint_mask(obj: bpy.types.Object, faces: np.ndarray, _node: int, extend: bool, deselect: bool) -> None:
    select_outside_edit_mode(obj.data, faces, extend, deselect)
    obj.data.use_paint_mask = bool(arrays.read(obj.data.polygons, "select", bool).any())


# Functions of (obj, faces, node, extend, deselect) that write a node's faces, by kind of target.
WRITERS = {"FACE_SET": _write_face_set, "MASK": _write_mask, "VERTEX_GROUP": _write_vertex_group,
           "PAINT_MASK": _write_paint_mask}
# Functions that return whether a mesh has a mask, which a click beside the model clears, by kind of target.
HAS_CONTENT = {"MASK": lambda mesh: find_mask(mesh) is not None and arrays.read(find_mask(mesh), "value", np.float32).any(),
               "PAINT_MASK": lambda mesh: mesh.use_paint_mask}
