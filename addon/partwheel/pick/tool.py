# SPDX-License-Identifier: GPL-3.0-or-later
"""The toolbar's tool in each mode: each click picks a part, the wheel resizes it."""

from pathlib import Path

import bpy

from ..parts import registry
from ..preferences import draw_overlays
from ..translations.lookup import iface_
from .hover import OPERATORS
from ..mesh.errors import DYNAMIC_TOPOLOGY_REASON
from .paint import TARGET_LABELS, TARGETS_BY_MODE

ICON = str(Path(__file__).with_name("partwheel.select"))  # Blender adds ".dat"
# Mode of the context -> Blender's tool before it in the toolbar.
AFTER_TOOL = {"EDIT_MESH": "builtin.select", "OBJECT": "builtin.select", "SCULPT": "builtin.box_mask",
              "PAINT_WEIGHT": "builtin.gradient", "PAINT_VERTEX": None, "PAINT_TEXTURE": None}
TOOL = "Select Part"
# Descriptions by mode.
DESCRIPTIONS = {
    "EDIT_MESH": "Select a meaningful part of the mesh.",
    "OBJECT": "Pick a meaningful part of a mesh.",
    "SCULPT": "Mask a meaningful part of the mesh, or make it a face set.",
    "PAINT_WEIGHT": "Make a meaningful part of the mesh a vertex group.",
    "PAINT_VERTEX": "Paint only on a meaningful part of the mesh.",
    "PAINT_TEXTURE": "Paint only on a meaningful part of the mesh."}
CLICK_DESCRIPTION = "Click a part, then turn the wheel for the next larger or smaller one. Shift adds, Ctrl removes"
# Tools for Edit Mode whose drags select whole parts: label, description.
GESTURES = {
    "box": ("Select Parts by Box",
            "Select all parts that a box touches, at the level of the last pick.\n"
            "Shift adds, Ctrl removes. A click picks a part as with Select Part"),
    "lasso": ("Select Parts by Lasso",
              "Select all parts that a lasso touches, at the level of the last pick.\n"
              "Shift adds, Ctrl removes. A click picks a part as with Select Part"),
}
# Modifiers, mode of a gesture, properties of a click: the same in all modes.
BINDINGS = (({}, "SET", ()), ({"shift": True}, "ADD", [("extend", True)]), ({"ctrl": True}, "SUB", [("deselect", True)]))


def _register_tool(name: str, mode: str, label: str, description: str, icon: str, keymap: list, **place: object) -> None:
    tool = type(f"partwheel_{name}_{mode}", (bpy.types.WorkSpaceTool,), {
        "bl_space_type": "VIEW_3D", "bl_context_mode": mode, "bl_idname": f"partwheel.{name}", "bl_label": label,
        "bl_description": description, "bl_icon": icon, "bl_widget": "VIEW3D_GGT_partwheel_hover",
        "bl_keymap": tuple(keymap), "draw_settings": _draw_settings,
    })
    bpy.utils.register_tool(tool, **place)
    _tools.append(tool)


def _bind_clicks(operator: str, value: str) -> list[tuple]:
    return [(operator, {"type": "LEFTMOUSE", "value": value, **modifiers}, {"properties": [("tool", True), *options]})
            for modifiers, _, options in BINDINGS]


def _bind_drags(gesture: str) -> list[tuple]:
    options = [("wait_for_input", False)] * (gesture == "box")
    return [(f"mesh.partwheel_{gesture}", {"type": "LEFTMOUSE", "value": "CLICK_DRAG", **modifiers},
             {"properties": [(f"VIEW3D_OT_select_{gesture}", [("mode", mode), *options]),
                             ("MESH_OT_partwheel_gather", [("mode", mode)])]}) for modifiers, mode, _ in BINDINGS]


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


_tools = []


def register() -> None:
    """Register the tools. Background mode has no keymaps when add-ons are enabled, and no tool can be added."""
    if bpy.context.window_manager.keyconfigs.default is None:
        return
    for mode, after in AFTER_TOOL.items():
        keymap = _bind_clicks(OPERATORS[mode], "PRESS")
        if mode == "EDIT_MESH":
            press = {"type": "LEFTMOUSE", "value": "PRESS", "shift": True, "ctrl": True}
            keymap.append(("mesh.partwheel_border", press, None))
        _register_tool("select", mode, TOOL, f"{DESCRIPTIONS[mode]}\n{CLICK_DESCRIPTION}", ICON, keymap,
                       after={after} if after else None, separator=after is None, group=True)
    for name, texts in GESTURES.items():
        keymap = _bind_drags(name) + _bind_clicks("mesh.partwheel_select", "CLICK")
        _register_tool(name, "EDIT_MESH", *texts, f"ops.generic.select_{name}", keymap,
                       after={"partwheel.select", "partwheel.box"})


def unregister() -> None:
    for tool in reversed(_tools):
        bpy.utils.unregister_tool(tool)
    _tools.clear()
