# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators for remembered parts: name the picked part, select it again by name, rename it, forget it."""

import bpy

from ..mesh import MeshSnapshot, Selections, check_poll, poll_is_editable, report_errors
from ..parts import picks, registry
from ..pick import borders
from ..view import overlay
from ..translations.lookup import iface_
from . import named_parts


class _NamingOperator:
    """Mixin for operators on remembered parts: needs Edit Mode, reports errors."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return check_poll(cls, context.mode == "EDIT_MESH" and context.edit_object,
                          "Remember parts in Edit Mode of a mesh.") and poll_is_editable(cls, context.edit_object)

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        self.run(context, context.edit_object)
        overlay.redraw_views()  # with the list in the sidebar
        return {"FINISHED"}


class _NamedPartOperator(_NamingOperator):
    """Mixin for operators on the part with a name."""

    part: bpy.props.StringProperty(name="Part", description="Name of the remembered part",
                                   options={"SKIP_SAVE"})


class MESH_OT_partwheel_remember(_NamingOperator, bpy.types.Operator):
    """Name the last picked part (segment, region), so that you can select it again from the panel's list"""

    bl_idname = "mesh.partwheel_remember"
    bl_label = "Remember Part"

    part: bpy.props.StringProperty(name="Name", description="The part's name", default="Part", options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and check_poll(cls, picks.get_pick_for_poll(context.edit_object), picks.NO_PICK)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        used_names, number = named_parts.part_names(context.edit_object.data), 1
        while (name := iface_("Part {number}").format(number=number)) in used_names:
            number += 1
        self.part = name
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.activate_init = True  # the user can type without a click
        self.layout.prop(self, "part")

    def run(self, _context: bpy.types.Context, obj: bpy.types.Object) -> None:
        snapshot = MeshSnapshot(obj)
        hierarchy, node = picks.resolve_node(snapshot, -1)
        named_parts.remember_part(obj.data, self.part,
                                  borders.get_part_faces(snapshot, hierarchy, node, picks.get_pick(snapshot).snap))


class MESH_OT_partwheel_recall(_NamedPartOperator, bpy.types.Operator):
    """Select the remembered part. Shift adds it to the selection, Ctrl removes it"""

    bl_idname = "mesh.partwheel_recall"
    bl_label = "Select Remembered Part"

    extend: bpy.props.BoolProperty(
        name="Extend", description="Add the part to the selection instead of replacing it", options={"SKIP_SAVE"})
    deselect: bpy.props.BoolProperty(
        name="Deselect", description="Remove the part from the selection", options={"SKIP_SAVE"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.extend, self.deselect = bool(event.shift), bool(event.ctrl)
        return self.execute(context)

    def run(self, context: bpy.types.Context, obj: bpy.types.Object) -> None:
        snapshot = MeshSnapshot(obj)
        hierarchy = registry.require_hierarchy(snapshot)
        node, snap = named_parts.find_node(snapshot, hierarchy, self.part)
        faces = borders.get_part_faces(snapshot, hierarchy, node, snap)
        Selections.of_edited(context, snapshot).select(obj, faces, int(faces[0]), self.extend, self.deselect)
        picks.remember(snapshot, int(hierarchy.faces(node)[0]), node, snap)


class MESH_OT_partwheel_rename(_NamedPartOperator, bpy.types.Operator):
    """Rename a remembered part"""

    bl_idname = "mesh.partwheel_rename"
    bl_label = "Rename Part"

    new: bpy.props.StringProperty(name="New Name", description="New name of the part", options={"SKIP_SAVE"})

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self.new = self.part
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.activate_init = True  # the user can type without a click
        self.layout.prop(self, "new")

    def run(self, _context: bpy.types.Context, obj: bpy.types.Object) -> None:
        named_parts.rename_part(obj.data, self.part, self.new)


class MESH_OT_partwheel_forget(_NamedPartOperator, bpy.types.Operator):
    """Forget a remembered part; the mesh does not change"""

    bl_idname = "mesh.partwheel_forget"
    bl_label = "Forget Part"

    def run(self, _context: bpy.types.Context, obj: bpy.types.Object) -> None:
        named_parts.forget_part(obj.data, self.part)
