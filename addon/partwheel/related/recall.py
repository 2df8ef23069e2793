# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators for remembered parts: the part in hand gets a name; that name selects it again, is changed, is forgotten."""

import bpy

from ..mesh.errors import Refused
from ..mesh.poll import check_poll, poll_is_editable
from ..mesh.selection import Selections
from ..parts import picks, registry
from ..pick import borders
from ..view import overlay
from ..words.say import iface_
from . import remembered


class _InEditMode:
    """What they share: Edit Mode, errors."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return check_poll(cls, context.mode == "EDIT_MESH" and context.edit_object,
                          "Parts are remembered in Edit Mode of a mesh.") and poll_is_editable(cls, context.edit_object)

    def execute(self, context):
        try:
            self.work(context, context.edit_object)
        except Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        overlay.redraw_views()  # and with the view the list beside it
        return {"FINISHED"}


class _Named(_InEditMode):
    part: bpy.props.StringProperty(name="Part", description="The name under which it is remembered",
                                   options={"SKIP_SAVE"})


def _typed(layout, operator, name):
    """A text that can be typed at once, without a click into its field."""
    layout.activate_init = True
    layout.prop(operator, name)


class MESH_OT_partwheel_remember(_InEditMode, bpy.types.Operator):
    """Give the part (segment, region) that was picked last a name, by which the panel's list selects it again"""

    bl_idname = "mesh.partwheel_remember"
    bl_label = "Remember Part"

    part: bpy.props.StringProperty(name="Name", description="The part's name", default="Part", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context):
        return super().poll(context) and check_poll(cls, picks.get_pick_for_poll(context.edit_object), picks.NO_PICK)

    def invoke(self, context, _event):
        taken, number = remembered.names(context.edit_object.data), 1
        while (name := iface_("Part {number}").format(number=number)) in taken:
            number += 1
        self.part = name
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, _context):
        _typed(self.layout, self, "part")

    def work(self, _context, obj):
        hierarchy, node = picks.resolve_node(obj, -1)
        remembered.remember(obj.data, self.part, borders.get_part_faces(obj, hierarchy, node, picks.get_pick(obj).snap))


class MESH_OT_partwheel_recall(_Named, bpy.types.Operator):
    """Select the part that is remembered under this name. Shift adds it to the selection, Ctrl takes it away"""

    bl_idname = "mesh.partwheel_recall"
    bl_label = "Select Remembered Part"

    extend: bpy.props.BoolProperty(
        name="Extend", description="Add the part to what is selected, instead of replacing it", default=False,
        options={"SKIP_SAVE"})
    deselect: bpy.props.BoolProperty(
        name="Deselect", description="Take the part away from what is selected", default=False, options={"SKIP_SAVE"})

    def invoke(self, context, event):
        self.extend, self.deselect = bool(event.shift), bool(event.ctrl)
        return self.execute(context)

    def work(self, context, obj):
        hierarchy = registry.require_hierarchy(obj)
        node, snap = remembered.node(obj, hierarchy, self.part)
        faces = borders.get_part_faces(obj, hierarchy, node, snap)
        Selections(context.objects_in_mode_unique_data, obj).select(obj, faces, int(faces[0]), self.extend, self.deselect)
        picks.remember(obj, int(hierarchy.faces(node)[0]), node, snap)


class MESH_OT_partwheel_rename(_Named, bpy.types.Operator):
    """Give a remembered part another name"""

    bl_idname = "mesh.partwheel_rename"
    bl_label = "Rename Part"

    new: bpy.props.StringProperty(name="New Name", description="The part's name from now on", options={"SKIP_SAVE"})

    def invoke(self, context, _event):
        self.new = self.part
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, _context):
        _typed(self.layout, self, "new")

    def work(self, _context, obj):
        remembered.rename(obj.data, self.part, self.new)


class MESH_OT_partwheel_forget(_Named, bpy.types.Operator):
    """Forget the name of a part; the mesh stays as it is"""

    bl_idname = "mesh.partwheel_forget"
    bl_label = "Forget Part"

    def work(self, _context, obj):
        remembered.forget(obj.data, self.part)


CLASSES = (MESH_OT_partwheel_remember, MESH_OT_partwheel_recall, MESH_OT_partwheel_rename, MESH_OT_partwheel_forget)
