# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of the panel with the remembered parts: Blender's own list, whose filter is the search."""

import fnmatch

import bpy

from ..related import remembered

ROW = "partwheel_remembered"  # a property of the window manager: Blender's lists want one for the active row


class VIEW3D_UL_partwheel_remembered(bpy.types.UIList):
    """Of all the mesh's attributes those that are remembered parts."""

    def draw_item(self, _context, layout, _mesh, attribute, _icon, _active, _property):
        name = attribute.name[len(remembered.PREFIX):]
        row = layout.row(align=True)
        left = row.row()
        left.alignment = "LEFT"
        left.operator("mesh.partwheel_recall", text=name, icon="RESTRICT_SELECT_OFF", emboss=False).part = name
        right = row.row(align=True)
        right.alignment = "RIGHT"
        right.operator("mesh.partwheel_rename", text="", icon="GREASEPENCIL", emboss=False).part = name
        right.operator("mesh.partwheel_forget", text="", icon="X", emboss=False).part = name

    def filter_items(self, _context, mesh, _property):
        wanted = f"*{self.filter_name.lower()}*"
        names = [each.name[len(remembered.PREFIX):].lower() if remembered.ours(each) else None
                 for each in mesh.attributes]
        flags = [self.bitflag_filter_item if name is not None and fnmatch.fnmatchcase(name, wanted) else 0
                 for name in names]
        order = bpy.types.UI_UL_list.sort_items_helper(list(enumerate(name or "" for name in names)),
                                                       lambda each: each[1]) if self.use_filter_sort_alpha else []
        return flags, order


class VIEW3D_PT_partwheel_remembered(bpy.types.Panel):
    bl_label = "Remembered Parts"
    bl_category = "Partwheel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_parent_id = "VIEW3D_PT_partwheel"

    @classmethod
    def poll(cls, context):
        return context.mode == "EDIT_MESH"

    def draw(self, context):
        mesh = context.edit_object.data
        if remembered.names(mesh):
            self.layout.template_list("VIEW3D_UL_partwheel_remembered", "", mesh, "attributes", context.window_manager,
                                      ROW, rows=3)
        self.layout.operator("mesh.partwheel_remember", icon="ADD")


CLASSES = (VIEW3D_UL_partwheel_remembered, VIEW3D_PT_partwheel_remembered)


def register():
    setattr(bpy.types.WindowManager, ROW, bpy.props.IntProperty(options={"SKIP_SAVE"}))


def unregister():
    delattr(bpy.types.WindowManager, ROW)
