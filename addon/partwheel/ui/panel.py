# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the 3D view's sidebar: the active mesh's hierarchy, and the commands for a picked part."""

import weakref

import bpy
import numpy as np

from .. import library_error
from ..parts import picks, registry
from ..pick.build import describe_fill, describe_marks
from ..preferences import draw_build_options
from ..translations.lookup import iface_, format_percent
from partwheel import Hierarchy

State = registry.State
STATE_MESSAGES = {
    State.NONE: "No parts yet",
    State.UNOPENED: "Parts are stored in the file",
    State.FITS: "",
    State.MOVED: "Vertices have moved or marks have changed since: you can recompute the parts",
    State.CHANGED: "The mesh has changed: the next use finds its parts again",
}
_boxes = weakref.WeakKeyDictionary()  # hierarchy -> {node: extent (3,)}: panels are drawn often


def _is_mesh_active(context: bpy.types.Context) -> bool:
    return context.active_object is not None and context.active_object.type == "MESH"


class SidebarPanel:
    """Mixin for panels, listed before bpy.types.Panel."""

    bl_category = "Partwheel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"


class Subpanel(SidebarPanel):
    """Mixin for panels below the main one."""

    bl_parent_id = "VIEW3D_PT_partwheel"


def draw_operators(layout: bpy.types.UILayout, *operators: str) -> None:
    for operator in operators:
        layout.operator(operator)


class VIEW3D_PT_partwheel_no_mesh(SidebarPanel, bpy.types.Panel):
    """Replaces the panel while no mesh is active, for instance after importers have left the armature active."""

    bl_label = "Partwheel"
    bl_order = 1

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return not _is_mesh_active(context)

    def draw(self, context: bpy.types.Context) -> None:
        _draw_text(context, self.layout.column(), "Select a mesh object to see its parts here")


class VIEW3D_PT_partwheel(SidebarPanel, bpy.types.Panel):
    bl_label = "Partwheel"
    bl_order = 1  # below the steps of the tour

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _is_mesh_active(context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        if library_error.draw_library_error(context, layout):
            return
        if context.mode == "EDIT_MESH":
            column = layout.column()
            column.operator_context = "INVOKE_REGION_WIN"
            draw_operators(column, "mesh.partwheel_select", "mesh.partwheel_similar", "mesh.partwheel_mirrored",
                           "mesh.partwheel_move")
            column.operator("mesh.duplicate_move", text="Duplicate Selection")
            column.operator("mesh.partwheel_path")
            layout.separator()
        row = layout.row(align=True)
        row.operator_context = "INVOKE_REGION_WIN"
        row.operator("mesh.partwheel_parts")
        row.menu("VIEW3D_MT_partwheel_parts_from", text="", icon="DOWNARROW_HLT")
        state, entry = registry.get_state(context.active_object.data)
        column = layout.column(align=True)
        if entry:
            _draw_summary(context, column, entry.hierarchy)
        _draw_text(context, column, STATE_MESSAGES[state])
        if entry and entry.hierarchy.summary.proxy_triangles:
            column.operator("mesh.partwheel_build", text="Find at Full Resolution").full_resolution = True
        row = layout.row(align=True)
        row.operator("mesh.partwheel_build", text="Recompute" if entry else "Find Parts")
        if state != State.NONE:
            row.operator("mesh.partwheel_clear", text="", icon="X")


def _draw_summary(context: bpy.types.Context, column: bpy.types.UILayout, hierarchy: Hierarchy) -> None:
    """Draws the picked part, or the whole: in lines whose number doesn't change while parts are found in the
    background, or buttons would move away under the mouse."""
    pick = picks.get_pick_for_poll(context.edit_object) if context.mode == "EDIT_MESH" else None
    if pick:
        share = format_percent(hierarchy.area[pick.node] / hierarchy.area[-1])
        label = iface_("Part: {share} of the area").format(share=share)
        size = " × ".join(format_box_sides(context, context.edit_object, hierarchy, pick.node))
        for text in (label, size):
            column.label(text=text, translate=False)
    else:
        label = iface_("Parts of {count:,} faces").format(count=len(hierarchy.order))
        column.label(text=label, translate=False)


def format_box_sides(context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy, node: int) -> list[str]:
    """The sides of the part's bounding box, along the object's own axes, as texts; the longest first."""
    boxes = _boxes.setdefault(hierarchy, {})
    if node not in boxes:
        corners = hierarchy.vertices[hierarchy.tetrahedra[slice(*hierarchy.tet_slice(node))].ravel()]
        boxes[node] = np.ptp(corners, axis=0) if len(corners) else np.zeros(3)
    units = context.scene.unit_settings
    lengths = boxes[node] * np.abs(obj.matrix_world.to_scale()) * units.scale_length
    return [bpy.utils.units.to_string(units.system, "LENGTH", float(length), precision=3).strip()
            for length in sorted(lengths, reverse=True)]


def _draw_text(context: bpy.types.Context, column: bpy.types.UILayout, text: str) -> None:
    if text:
        library_error.draw_wrapped_text(context, column, iface_(text))


class VIEW3D_PT_partwheel_options(Subpanel, bpy.types.Panel):
    bl_label = "Options"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        column = self.layout.column()
        column.use_property_split = True
        draw_build_options(column)
        _, entry = registry.get_state(context.active_object.data)
        column = self.layout.column(align=True)
        for text in (describe_fill(entry.hierarchy), *describe_marks(entry.hierarchy)) if entry else ():
            library_error.draw_wrapped_text(context, column, text)
