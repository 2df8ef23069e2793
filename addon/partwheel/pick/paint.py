# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts outside Edit Mode: object.partwheel_select enters it with a part; mesh.partwheel_paint makes a part a face set,
a mask, a vertex group or a paint mask, in the modes that have them."""

import bmesh
import bpy
import numpy as np

from ..mesh import arrays, objects
from ..view import picking
from ..mesh.refusing import Refused, can, changeable, read_only
from .prepared import prepared
from ..view.seen import NO_FACE
from ..mesh.selection import select_outside_edit_mode
from .pick import PartPicker

FACE_SET = ".sculpt_face_set"
MASK = ".sculpt_mask"  # an attribute from Blender 4.1 on
# Mode of the context -> what a part can become there, the first by default.
WAYS = {
    "SCULPT": ("FACE_SET", "MASK"), "PAINT_WEIGHT": ("VERTEX_GROUP", "PAINT_MASK"), "PAINT_VERTEX": ("PAINT_MASK",),
    "PAINT_TEXTURE": ("PAINT_MASK",),
}


class OBJECT_OT_partwheel_select(bpy.types.Operator):
    """Enter Edit Mode of the mesh under the mouse and pick a part of it"""

    bl_idname = "object.partwheel_select"
    bl_label = "Select Part by Wheel"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context):
        return can(cls, context.mode == "OBJECT", "This is for Object Mode")

    def invoke(self, context, event):
        view = picking.under_mouse(context, event)
        if not view:
            self.report({"ERROR"}, "Parts are picked in a 3D view: start this with the mouse over one")
            return {"CANCELLED"}
        area, *pixel = view
        hit = picking.surface_under(context, *view)
        obj = self._target(context, area.spaces.active, hit)
        if not obj:
            return {"CANCELLED"}
        # Edit Mode may show the mesh elsewhere, without its modifiers; meant is the face that is seen now.
        found = hit and prepared(obj).tree.under(hit.matrix, *pixel)
        if not obj.select_get():
            for other in context.selected_objects:
                other.select_set(False)
            obj.select_set(True)
        context.view_layer.objects.active = obj
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.ed.undo_push(message="Toggle Edit Mode")  # or it would be one step with the pick
        bpy.ops.mesh.partwheel_select("INVOKE_DEFAULT", begin=found[0] if found else NO_FACE)
        return {"CANCELLED"}

    def _target(self, context, space, hit):
        """The object that was hit, or else the active one, if it can be edited; or None and a report."""
        obj = hit.obj if hit else context.active_object
        shown = obj is not None and obj.visible_get(viewport=space)
        if obj is None or obj.type != "MESH" or not (hit or shown):
            reason = "There is no mesh under the mouse"
        elif not shown:
            reason = f"{obj.name} is an instance, and this 3D view does not show its original: edit it there"
        else:
            reason = read_only(obj)
        if reason:
            self.report({"WARNING"}, reason)
        return None if reason else obj


class Preview:
    """A target that changes nothing before the part is confirmed: the overlay alone shows it."""

    def __init__(self, obj):
        self.name, self.mode, self.faces = obj.name_full, obj.mode, len(obj.data.polygons)

    def select(self, *_):
        """What is drawn says it all."""

    def restore(self):
        """Nothing was changed."""

    def fits(self):
        obj = objects.named(self.name)
        return obj is not None and obj.mode == self.mode and len(obj.data.polygons) == self.faces


class MESH_OT_partwheel_paint(PartPicker, bpy.types.Operator):
    """Pick a part with a click and the mouse wheel, and make it a face set, a mask or a vertex group"""

    bl_idname = "mesh.partwheel_paint"
    bl_label = "Part by Wheel"
    bl_options = {"REGISTER", "UNDO"}

    write: bpy.props.EnumProperty(
        name="Make It", default="AUTO", description="What the part becomes",
        items=(("AUTO", "Usual", "A face set in Sculpt Mode, a vertex group in Weight Paint, else a paint mask"),
               ("FACE_SET", "Face Set", "A new face set"),
               ("MASK", "Mask", "Masked against sculpting"),
               ("VERTEX_GROUP", "Vertex Group", "Weight 1 in a new vertex group, named after the part; with Extend in "
                "the active one, with Deselect none there"),
               ("PAINT_MASK", "Paint Mask", "The only faces that can be painted on")),
    )

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return (can(cls, context.mode in WAYS and obj is not None and obj.type == "MESH",
                    "This is for Sculpt Mode and the paint modes of a mesh")
                and changeable(cls, obj)
                and can(cls, not obj.use_dynamic_topology_sculpting,
                        "Dynamic topology changes the faces all the time: switch it off first"))

    def _apply(self, context, obj, faces, picked):
        return self._write(context, obj, faces, picked.node)

    def _objects(self, context):
        return [context.active_object] if context.mode in WAYS else []

    def _aim(self, context, obj):
        return Preview(obj)

    def _commit(self, context):
        return self._write(context, self._object(context), self.faces, self.state.node)

    def _write(self, context, obj, faces, node):
        ways = WAYS[context.mode]
        way = ways[0] if self.write == "AUTO" else self.write
        if way not in ways:
            self.report({"ERROR"}, f"There is no {way.replace('_', ' ').lower()} in this mode")
            return {"CANCELLED"}
        # Sculpt Mode keeps data of its own beside the mesh's: it reads the mesh anew when it is entered.
        sculpting = context.mode == "SCULPT"
        if sculpting:
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            said = WRITERS[way](obj, faces, node, self.extend, self.deselect)
        except Refused as reason:
            self.report({"ERROR"}, str(reason))
            return {"CANCELLED"}
        finally:
            if sculpting:
                bpy.ops.object.mode_set(mode="SCULPT")
        if said:
            self.report({"INFO"}, said)
        return {"FINISHED"}


def _part_vertices(mesh, faces):
    """(V,) bool: the vertices of these faces."""
    inside = np.zeros(len(mesh.polygons), bool)
    inside[faces] = True
    corners = np.repeat(inside, arrays.polygon_sizes(mesh)[1])
    chosen = np.zeros(len(mesh.vertices), bool)
    chosen[arrays.read(mesh.loops, "vertex_index", np.int32)[corners]] = True
    return chosen


def _write_face_set(obj, faces, _node, _extend, deselect):
    """A set of its own; with deselect the part goes back to the first one."""
    mesh = obj.data
    attribute = mesh.attributes.get(FACE_SET) or mesh.attributes.new(FACE_SET, "INT", "FACE")
    values = arrays.read(attribute.data, "value", np.int32)
    values[values == 0] = 1  # what Blender takes faces without a set for
    values[faces] = 1 if deselect else values.max(initial=1) + 1
    attribute.data.foreach_set("value", values)


def _write_mask(obj, faces, _node, extend, deselect):
    part = _part_vertices(obj.data, faces)
    if bpy.app.version >= (4, 1):
        attribute = obj.data.attributes.get(MASK) or obj.data.attributes.new(MASK, "FLOAT", "POINT")
        before = arrays.read(attribute.data, "value", np.float32)
        attribute.data.foreach_set("value", _joined(before, part, extend, deselect))
        return
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    layer = bm.verts.layers.paint_mask.verify()
    before = np.array([vertex[layer] for vertex in bm.verts], np.float32)
    for vertex, value in zip(bm.verts, _joined(before, part, extend, deselect).tolist()):
        vertex[layer] = value
    bm.to_mesh(obj.data)
    bm.free()


def _joined(before, part, extend, deselect):
    """(V,) float32: the mask with the part in it, or taken out of it."""
    if deselect:
        return np.where(part, 0, before).astype(np.float32)
    return np.where(part, 1, before if extend else 0).astype(np.float32)


def _write_vertex_group(obj, faces, node, extend, deselect):
    """A new group, which becomes the active one; extend and deselect change the active one, unless it is locked. What
    was done, as a sentence."""
    part = np.flatnonzero(_part_vertices(obj.data, faces)).tolist()
    group = obj.vertex_groups.active if extend or deselect else None
    if group and group.lock_weight:
        raise Refused(f"The vertex group {group.name} is locked. Unlock it, or pick the part alone: it gets a group "
                         "of its own")
    if deselect:
        if not group:
            raise Refused(f"{obj.name} has no vertex group that the part could be taken out of")
        group.remove(part)
        return f"The part was taken out of the vertex group {group.name}"
    if group:
        group.add(part, 1.0, "REPLACE")
        return f"The part was added to the vertex group {group.name}"
    group = obj.vertex_groups.new(name=f"Part {node}")
    group.add(part, 1.0, "REPLACE")
    return f"The part is the new vertex group {group.name}"


def _write_paint_mask(obj, faces, _node, extend, deselect):
    select_outside_edit_mode(obj.data, faces, extend, deselect)
    obj.data.use_paint_mask = True


# What writes the faces of a node: functions of (obj, faces, node, extend, deselect).
WRITERS = {"FACE_SET": _write_face_set, "MASK": _write_mask, "VERTEX_GROUP": _write_vertex_group,
           "PAINT_MASK": _write_paint_mask}


CLASSES = (OBJECT_OT_partwheel_select, MESH_OT_partwheel_paint)
