# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_select: a click picks a face, the wheel grows and shrinks the part around it; and
object.partwheel_select, which enters Edit Mode with it."""

import bpy

from ..mesh.refusing import can, read_only
from ..mesh.selection import Selections
from ..view import keys, picking
from ..view.seen import NO_FACE
from .pick import PartPicker
from .prepared import prepared


class MESH_OT_partwheel_select(PartPicker, bpy.types.Operator):
    """Pick a part of the mesh with a click, then make it larger or smaller with the mouse wheel"""

    bl_idname = "mesh.partwheel_select"
    bl_label = "Select Part by Wheel"
    bl_options = {"REGISTER", "UNDO"}
    commands = keys.COMMANDS

    @classmethod
    def poll(cls, context):
        return can(cls, context.mode == "EDIT_MESH" and context.edit_object,
                   "Parts are selected in Edit Mode of a mesh")

    def _apply(self, context, obj, faces, picked):
        self._aim(context, obj).select(obj, faces, picked.face, self.extend, self.deselect)
        return {"FINISHED"}

    def _objects(self, context):
        """In Edit Mode; of objects that share a mesh, the one that is being edited."""
        if context.mode != "EDIT_MESH":
            return []
        return sorted(context.objects_in_mode_unique_data, key=lambda obj: obj != context.edit_object)

    def _aim(self, context, obj):
        return Selections(self._objects(context), obj)  # whose hierarchy was just asked for, or built

    def _missed(self, context):
        """As Blender's own select tools: a click beside everything selects nothing."""
        selections = Selections(self._objects(context))
        if self.extend or self.deselect or not selections.any():
            return {"CANCELLED"}
        selections.select(context.edit_object, [])
        return {"FINISHED"}

    def _commit(self, context):
        """The object of the part becomes the active one, as with Blender's own selecting."""
        context.view_layer.objects.active = self._object(context)
        return {"FINISHED"}


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
        found = hit and prepared(obj).tree(obj).under(hit.matrix, *pixel)
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


CLASSES = (MESH_OT_partwheel_select, OBJECT_OT_partwheel_select)
