# SPDX-License-Identifier: GPL-3.0-or-later
"""What a part becomes outside Edit Mode: a face set, a mask, a vertex group, a paint mask, written into the mesh."""

from __future__ import annotations

import bpy
import numpy as np

from ..mesh import arrays, assembly
from ..mesh.errors import Refused
from ..mesh.selection import select_outside_edit_mode
from ..words.say import rpt_

FACE_SET = ".sculpt_face_set"
MASK = ".sculpt_mask"  # an attribute from Blender 4.1 on

# Whether undo takes back what mask_levels() does: in Blender 4.5 and 5.2 it was seen not to.
UNDOES_LEVEL_MASKS = bpy.app.version < (4, 1)


def _part_vertices(mesh: bpy.types.Mesh, faces: np.ndarray) -> np.ndarray:
    """(V,) bool: the vertices of these faces, and those welded with them."""
    return arrays.add_coincident_vertices(mesh, arrays.mask_elements_of_faces(mesh, arrays.make_mask(len(mesh.polygons), faces)))


def _write_face_set(obj: bpy.types.Object, faces: np.ndarray, _node: int, _extend: bool, deselect: bool) -> None:
    """A set of its own; with deselect the part goes back to the first one."""
    mesh = obj.data
    attribute = arrays.ensure_attribute(mesh, FACE_SET, "INT", "FACE")
    values = arrays.read(attribute.data, "value", np.int32)
    values[values == 0] = 1  # what Blender takes faces without a set for
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
    before = arrays.read(values, "value", np.float32)
    values.foreach_set("value", _merge_mask(before, _part_vertices(mesh, faces), extend, deselect))


def write_level_mask(obj: bpy.types.Object, faces: np.ndarray, _node: int, extend: bool, deselect: bool) -> None:
    """The mask of a multires modifier's own levels, which Python can't write: Blender fills what is not hidden."""
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
    """What holds the mask's value of each vertex, or None. Not of the levels that a multires modifier has of its
    own."""
    if bpy.app.version >= (4, 1):
        layer = arrays.find_attribute(mesh, MASK, "FLOAT", "POINT")
    else:
        layer = next(iter(mesh.vertex_paint_masks), None)
    return layer and layer.data


def _merge_mask(before: np.ndarray, part: np.ndarray, extend: bool, deselect: bool) -> np.ndarray:
    """(V,) float32: the mask with the part in it, or taken out of it."""
    if deselect:
        return np.where(part, 0, before).astype(np.float32)
    return np.where(part, 1, before if extend else 0).astype(np.float32)


def _write_vertex_group(obj: bpy.types.Object, faces: np.ndarray, node: int, extend: bool, deselect: bool) -> str:
    """A new group, which becomes the active one; extend and deselect change the active one, unless it is locked. What
    was done, as a sentence."""
    part = np.flatnonzero(_part_vertices(obj.data, faces)).tolist()
    group = obj.vertex_groups.active if extend or deselect else None
    if group and group.lock_weight:
        raise Refused("The vertex group {name} is locked. Unlock it, or pick the part alone: it gets a group of its own.",
                      name=group.name)
    if deselect:
        if not group:
            raise Refused("{name} has no vertex group that the part could be taken out of.", name=obj.name)
        group.remove(part)
        return rpt_("The part was taken out of the vertex group {name}.").format(name=group.name)
    if group:
        group.add(part, 1.0, "REPLACE")
        return rpt_("The part was added to the vertex group {name}.").format(name=group.name)
    group = obj.vertex_groups.new(name=f"Part {node}")
    group.add(part, 1.0, "REPLACE")
    return rpt_("The part is the new vertex group {name}.").format(name=group.name)


def _write_paint_mask(obj: bpy.types.Object, faces: np.ndarray, _node: int, extend: bool, deselect: bool) -> None:
    select_outside_edit_mode(obj.data, faces, extend, deselect)
    obj.data.use_paint_mask = bool(arrays.read(obj.data.polygons, "select", bool).any())


# What writes the faces of a node: functions of (obj, faces, node, extend, deselect).
WRITERS = {"FACE_SET": _write_face_set, "MASK": _write_mask, "VERTEX_GROUP": _write_vertex_group,
           "PAINT_MASK": _write_paint_mask}
# Whether a mesh has what a click beside it clears, for those that are cleared so.
HAS_CONTENT = {"MASK": lambda mesh: find_mask(mesh) is not None and arrays.read(find_mask(mesh), "value", np.float32).any(),
               "PAINT_MASK": lambda mesh: mesh.use_paint_mask}
