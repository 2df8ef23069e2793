# SPDX-License-Identifier: GPL-3.0-or-later
"""The toolbar's tool in Edit Mode: each click picks a part, the wheel grows and shrinks it."""

from pathlib import Path

import bpy

from ..parts import registry
from ..preferences import draw_overlays

ICON = str(Path(__file__).with_name("partwheel.select"))  # Blender adds ".dat"


class SelectPart(bpy.types.WorkSpaceTool):
    bl_space_type = "VIEW_3D"
    bl_context_mode = "EDIT_MESH"
    bl_idname = "partwheel.select"
    bl_label = "Select Part"
    bl_description = ("Select a meaningful part of the mesh.\n"
                      "Click a part, then turn the wheel for the next larger or smaller one. "
                      "Shift adds, Ctrl takes away")
    bl_icon = ICON
    bl_widget = "VIEW3D_GGT_partwheel_hover"
    bl_keymap = tuple(
        ("mesh.partwheel_select", {"type": "LEFTMOUSE", "value": "PRESS", **held},
         {"properties": [("tool", True), *what]})
        for held, what in (({}, ()), ({"shift": True}, [("extend", True)]), ({"ctrl": True}, [("deselect", True)])))

    def draw_settings(context, layout, tool):
        obj = context.edit_object
        state = registry.state(obj.data)[0] if obj else registry.State.NONE
        if state in {registry.State.NONE, registry.State.CHANGED}:
            layout.label(text="Parts are found at the first click", icon="INFO")
        layout.prop(tool.operator_properties("mesh.partwheel_select"), "snap")
        layout.popover("VIEW3D_PT_partwheel_overlays", text="Overlay")


class VIEW3D_PT_partwheel_overlays(bpy.types.Panel):
    bl_label = "Overlay"
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_options = {"INSTANCED"}

    def draw(self, _context):
        draw_overlays(self.layout)


CLASSES = (VIEW3D_PT_partwheel_overlays,)


_registered = False


def register():
    """Where Blender starts without a window it has no keymaps yet when it enables add-ons, and can't take a tool."""
    global _registered
    _registered = bpy.context.window_manager.keyconfigs.default is not None
    if _registered:
        bpy.utils.register_tool(SelectPart, after={"builtin.select"}, group=True)


def unregister():
    if _registered:
        bpy.utils.unregister_tool(SelectPart)
