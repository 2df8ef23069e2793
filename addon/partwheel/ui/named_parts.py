# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel's list of remembered parts, a list of Blender's with its text filter."""

import fnmatch
from typing import Any

import bpy

from ..related import named_parts
from .panel import Subpanel

ROW_PROPERTY = "partwheel_remembered"  # property of the window manager: Blender's lists need one for the active row


class VIEW3D_UL_partwheel_remembered(bpy.types.UIList):
    """A list of those attributes of the mesh that are remembered parts."""

    def draw_item(self, _context: bpy.types.Context, layout: bpy.types.UILayout, _mesh: bpy.types.Mesh,
                  attribute: bpy.types.Attribute, _icon: int, _active: Any, _property: str) -> None:
        name = attribute.name[len(named_parts.ATTRIBUTE_PREFIX):]
        row = layout.row(align=True)
        left = row.row()
        left.alignment = "LEFT"
        left.operator("mesh.partwheel_recall", text=name, icon="RESTRICT_SELECT_OFF", emboss=False).part = name
        right = row.row(align=True)
        right.alignment = "RIGHT"
        right.operator("mesh.partwheel_rename", text="", icon="GREASEPENCIL", emboss=False).part = name
        right.operator("mesh.partwheel_forget", text="", icon="X", emboss=False).part = name

    def filter_items(self, _context: bpy.types.Context, mesh: bpy.types.Mesh,
                     _property: str) -> tuple[list[int], list[int]]:
        pattern = f"*{self.filter_name.lower()}*"
        prefix = len(named_parts.ATTRIBUTE_PREFIX)
        names = [attribute.name[prefix:].lower() if named_parts.is_part_attribute(attribute) else None
                 for attribute in mesh.attributes]
        flags = [self.bitflag_filter_item if name is not None and fnmatch.fnmatchcase(name, pattern) else 0
                 for name in names]
        order = bpy.types.UI_UL_list.sort_items_helper(list(enumerate(name or "" for name in names)),
                                                       lambda item: item[1]) if self.use_filter_sort_alpha else []
        return flags, order


class VIEW3D_PT_partwheel_remembered(Subpanel, bpy.types.Panel):
    bl_label = "Remembered Parts"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "EDIT_MESH"

    def draw(self, context: bpy.types.Context) -> None:
        mesh = context.edit_object.data
        if named_parts.part_names(mesh):
            self.layout.template_list("VIEW3D_UL_partwheel_remembered", "", mesh, "attributes", context.window_manager,
                                      ROW_PROPERTY, rows=3)
        self.layout.operator("mesh.partwheel_remember", icon="ADD")


def register() -> None:
    setattr(bpy.types.WindowManager, ROW_PROPERTY, bpy.props.IntProperty(options={"SKIP_SAVE"}))


def unregister() -> None:
    delattr(bpy.types.WindowManager, ROW_PROPERTY)
