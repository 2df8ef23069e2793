# SPDX-License-Identifier: GPL-3.0-or-later
"""The toolbar's tool in each mode: each click picks a part, the wheel resizes it."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..parts import registry
from ..preferences import draw_overlays
from ..translations.lookup import iface_
from .hover import OPERATORS
from ..mesh.poll import DYNAMIC_TOPOLOGY_REASON
from .paint import TARGET_LABELS, TARGETS_BY_MODE

ICON = str(Path(__file__).with_name("partwheel.select"))  # Blender adds ".dat"


# Mode of the context -> Blender's tool before it in the toolbar.
AFTER_TOOL = {"EDIT_MESH": "builtin.select", "OBJECT": "builtin.select", "SCULPT": "builtin.box_mask",
              "PAINT_WEIGHT": "builtin.gradient", "PAINT_VERTEX": None, "PAINT_TEXTURE": None}
TOOL = "Select Part"
# Descriptions by mode.
DESCRIPTIONS = {
    "EDIT_MESH": "Select a meaningful part of the mesh.\n"
                 "Click a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes",
    "OBJECT": "Pick a meaningful part of a mesh.\n"
              "Click a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes",
    "SCULPT": "Mask a meaningful part of the mesh, or make it a face set.\n"
              "Click a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes",
    "PAINT_WEIGHT": "Make a meaningful part of the mesh a vertex group.\n"
                    "Click a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes",
    "PAINT_VERTEX": "Paint only on a meaningful part of the mesh.\n"
                    "Click a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes",
}
DESCRIPTIONS["PAINT_TEXTURE"] = DESCRIPTIONS["PAINT_VERTEX"]
GESTURES = {
    "Box": ("Select Parts by Box",
            "Select all parts that a box touches, at the level of the last pick.\n"
            "Shift adds, Ctrl removes. A click picks a part as with Select Part"),
    "Lasso": ("Select Parts by Lasso",
              "Select all parts that a lasso touches, at the level of the last pick.\n"
              "Shift adds, Ctrl removes. A click picks a part as with Select Part"),
}


def _create_tool(mode: str) -> type[bpy.types.WorkSpaceTool]:
    """Return the tool's class for one mode. Click, wheel, Shift and Ctrl mean the same in all modes."""
    return type(f"SelectPart_{mode}", (bpy.types.WorkSpaceTool,), {
        "bl_space_type": "VIEW_3D",
        "bl_context_mode": mode,
        "bl_idname": "partwheel.select",
        "bl_label": TOOL,
        "bl_description": DESCRIPTIONS[mode],
        "bl_icon": ICON,
        "bl_widget": "VIEW3D_GGT_partwheel_hover",
        "bl_keymap": (*(
            (OPERATORS[mode], {"type": "LEFTMOUSE", "value": "PRESS", **modifiers}, {"properties": [("tool", True), *options]})
            for modifiers, options in (({}, ()), ({"shift": True}, [("extend", True)]), ({"ctrl": True}, [("deselect", True)]))),
            *([("mesh.partwheel_border", {"type": "LEFTMOUSE", "value": "PRESS", "shift": True, "ctrl": True}, None)]
              if mode == "EDIT_MESH" else [])),
        "draw_settings": _draw_settings,
    })


def _create_gesture_tool(name: str, operator: str, gesture: str) -> type[bpy.types.WorkSpaceTool]:
    """Return the class of a tool for Edit Mode whose drag selects whole parts; a click picks."""
    bindings = (({}, "SET", ()), ({"shift": True}, "ADD", [("extend", True)]), ({"ctrl": True}, "SUB", [("deselect", True)]))
    return type(f"SelectParts_{name}", (bpy.types.WorkSpaceTool,), {
        "bl_space_type": "VIEW_3D",
        "bl_context_mode": "EDIT_MESH",
        "bl_idname": f"partwheel.{name.lower()}",
        "bl_label": GESTURES[name][0],
        "bl_description": GESTURES[name][1],
        "bl_icon": f"ops.generic.select_{name.lower()}",
        "bl_widget": "VIEW3D_GGT_partwheel_hover",
        "bl_keymap": (
            *((operator, {"type": "LEFTMOUSE", "value": "CLICK_DRAG", **modifiers},
               {"properties": [(gesture, [("mode", mode)] + [("wait_for_input", False)] * (name == "Box")),
                               ("MESH_OT_partwheel_gather", [("mode", mode)])]}) for modifiers, mode, _ in bindings),
            *(("mesh.partwheel_select", {"type": "LEFTMOUSE", "value": "CLICK", **modifiers},
               {"properties": [("tool", True), *options]}) for modifiers, _, options in bindings)),
        "draw_settings": _draw_settings,
    })


def _draw_settings(context: bpy.types.Context, layout: bpy.types.UILayout, tool: bpy.types.WorkSpaceTool) -> None:
    obj, mode = context.active_object, context.mode
    if obj is None or obj.type != "MESH":
        return
    if mode == "SCULPT" and obj.use_dynamic_topology_sculpting:
        layout.label(text=iface_(DYNAMIC_TOPOLOGY_REASON), icon="ERROR")
        return
    if registry.get_state(obj.data)[0] in {registry.State.NONE, registry.State.CHANGED}:
        layout.label(text="Parts are found at the first click", icon="INFO")
    properties = tool.operator_properties(OPERATORS[mode])
    targets = TARGETS_BY_MODE.get(mode, ())
    if len(targets) > 1:
        row = layout.row(align=True)
        for target, value in zip(targets, ("AUTO", *targets[1:])):
            row.prop_enum(properties, "write", value, text=TARGET_LABELS[target])
    layout.prop(properties, "snap")
    layout.popover("VIEW3D_PT_partwheel_overlays", text="Overlay")


class VIEW3D_PT_partwheel_overlays(bpy.types.Panel):
    bl_label = "Overlay"
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_options = {"INSTANCED"}

    def draw(self, _context: bpy.types.Context) -> None:
        draw_overlays(self.layout)


CLASSES = (VIEW3D_PT_partwheel_overlays,)


_tools = []


def register() -> None:
    """Register the tools, except in background mode: when add-ons are enabled there, no keymaps exist and no tool can
    be added."""
    if bpy.context.window_manager.keyconfigs.default is None:
        return
    for mode, after in AFTER_TOOL.items():
        _tools.append(_create_tool(mode))
        bpy.utils.register_tool(_tools[-1], after={after} if after else None, separator=after is None, group=True)
    for gesture in (("Box", "mesh.partwheel_box", "VIEW3D_OT_select_box"),
                    ("Lasso", "mesh.partwheel_lasso", "VIEW3D_OT_select_lasso")):
        _tools.append(_create_gesture_tool(*gesture))
        bpy.utils.register_tool(_tools[-1], after={"partwheel.select", "partwheel.box"})


def unregister() -> None:
    for tool in reversed(_tools):
        bpy.utils.unregister_tool(tool)
    _tools.clear()
