# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_select: a click picks a face, the wheel grows and shrinks the part around it; and
object.partwheel_select, which does the same in Object Mode and enters Edit Mode with the part at the end."""

import bpy

from ..mesh import kept
from ..mesh.refusing import can, read_only
from ..mesh.selection import Selections
from ..view import keys, picking
from ..view.seen import NO_FACE
from .pick import PartPicker
from .prepared import prepared
from .preview import Preview
from ..words.say import rpt_


class MESH_OT_partwheel_select(PartPicker, bpy.types.Operator):
    """Pick a part of the mesh with a click, then make it larger or smaller with the mouse wheel"""

    bl_idname = "mesh.partwheel_select"
    bl_label = "Select Part by Wheel"
    bl_options = {"REGISTER", "UNDO"}
    commands = keys.COMMANDS

    @classmethod
    def poll(cls, context):
        return can(cls, context.mode == "EDIT_MESH" and context.edit_object,
                   "Parts are selected in Edit Mode of a mesh.")

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


class OBJECT_OT_partwheel_select(PartPicker, bpy.types.Operator):
    """Pick a part of the mesh under the mouse, which stays as it is meanwhile, then enter Edit Mode with the part"""

    bl_idname = "object.partwheel_select"
    bl_label = "Select Part by Wheel"
    bl_options = set()  # what is registered and undone is the pick in Edit Mode, see _edited()
    commands = keys.COMMANDS

    @classmethod
    def poll(cls, context):
        return can(cls, context.mode == "OBJECT", "This is for Object Mode.")

    def _begin(self, context, event):
        obj = self._target(context, event)
        if not obj:
            return {"CANCELLED"}
        self.object_name = obj.name_full
        return PartPicker._begin(self, context, event)

    def _target(self, context, event):
        """The object under the mouse, or else the active one, if it can be edited; or None and a report."""
        view = picking.under_mouse(context, event)
        hit = view and picking.surface_under(context, *view)
        obj = hit.obj if hit else context.active_object
        space = view[0].spaces.active if view else context.space_data
        shown = obj is not None and obj.visible_get(viewport=space)
        if obj is None or obj.type != "MESH" or not (hit or shown):
            reason = rpt_("There is no mesh under the mouse.")
        elif not shown:
            reason = rpt_("{name} is an instance, and this 3D view does not show its original: edit it there.").format(
                name=obj.name)
        else:
            reason = read_only(obj)
        if reason:
            self.report({"WARNING"}, reason)
        return None if reason else obj

    def _objects(self, context):
        """The one that was under the mouse at the beginning; without a mouse the active one."""
        obj = kept.named(self.object_name) if self.object_name else context.active_object
        return [obj] if context.mode == "OBJECT" and obj is not None and obj.type == "MESH" else []

    def _under(self, context, event):
        """Also on an instance of the object."""
        view, (obj,) = picking.under_mouse(context, event), self._objects(context)
        hit = view and picking.surface_under(context, *view)
        found = prepared(obj).tree(obj).under(hit.matrix, *view[1:]) if hit and hit.obj == obj else None
        if found and found[0] == NO_FACE:
            self._made_by_modifiers(obj)
        return (obj, found[0]) if found and found[0] != NO_FACE else (None, None)

    def _aim(self, context, obj):
        return Preview(obj)

    def _key_while_holding(self, context, event, over):
        if event.type == "TAB" and not (event.shift or event.ctrl):  # confirming does what it asks for
            return self._confirmed(context)
        return PartPicker._key_while_holding(self, context, event, over)

    def _commit(self, context):
        return self._edited(context, self._object(context))

    def _apply(self, context, obj, _faces, _picked):
        return self._edited(context, obj)

    def _edited(self, context, obj):
        """Edit Mode with the part that is picked: two undo steps, and the panel of the last operation is the second's.
        """
        if not obj.select_get():
            for other in context.selected_objects:
                other.select_set(False)
            obj.select_set(True)
        context.view_layer.objects.active = obj
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.ed.undo_push(message="Toggle Edit Mode")
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", True, face_index=self.face_index, level=self.level,
                                      snap=self.snap, extend=self.extend, deselect=self.deselect)
        return {"FINISHED"}


CLASSES = (MESH_OT_partwheel_select, OBJECT_OT_partwheel_select)
