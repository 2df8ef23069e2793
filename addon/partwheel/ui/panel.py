# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the 3D view's sidebar: the active mesh's hierarchy, and what can be done with a selected part."""

import bpy

from .. import trouble
from ..parts import builds, registry

State = registry.State
STATES = {
    State.NONE: ["No parts yet"],
    State.UNOPENED: ["Parts came with the file"],
    State.FITS: [],
    State.MOVED: ["Vertices have moved since:", "the parts can be recomputed"],
    State.CHANGED: ["The mesh has changed: its parts", "are built anew at the next use"],
}
SHEET = ["A sheet, not a solid: thicken it,", "close it, or have it taken for", "a thin solid"]
BUILD = {State.FITS: "Recompute", State.MOVED: "Recompute", State.CHANGED: "Recompute"}
RUNGS = {
    "exact": "From the mesh as it is", "repaired": "From a repaired copy", "points": "From points on it",
    "coarse": "From a coarser copy",
}


class VIEW3D_PT_partwheel(bpy.types.Panel):
    bl_label = "Partwheel"
    bl_category = "Partwheel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return obj is not None and obj.type == "MESH"

    def draw(self, context):
        layout = self.layout
        if trouble.draw(context, layout):
            return
        if context.mode == "EDIT_MESH":
            column = layout.column()
            column.operator_context = "INVOKE_REGION_WIN"
            column.operator("mesh.partwheel_select")
            column.operator("mesh.partwheel_similar")
            column.operator("mesh.partwheel_mirrored")
            column.operator("mesh.partwheel_move")
            column.operator("mesh.duplicate_move", text="Duplicate Part")
            column.operator("mesh.partwheel_path")
            layout.separator()
        row = layout.row()
        row.operator_context = "INVOKE_REGION_WIN"
        row.operator("mesh.partwheel_parts")
        state, entry = registry.state(context.active_object.data)
        if entry:
            self._describe(context, entry.hierarchy)
        column = layout.column(align=True)
        for line in STATES[state]:
            column.label(text=line)
        if state in {State.NONE, State.CHANGED} and builds.refused_as_sheet(context.active_object.data):
            for line in SHEET:
                column.label(text=line)
            column.operator("mesh.partwheel_build", text="Take as Thin Solid").open_surfaces = True
        if entry and entry.hierarchy.summary.rung == "coarse":
            column.operator("mesh.partwheel_build", text="Find Exactly").exactly = True
        row = layout.row(align=True)
        row.operator("mesh.partwheel_build", text=BUILD.get(state, "Build"))
        if state != State.NONE:
            row.operator("mesh.partwheel_clear", text="", icon="X")

    def _describe(self, context, hierarchy):
        column = self.layout.column(align=True)
        column.label(text=f"{len(hierarchy.order):,} faces, {len(hierarchy.tetrahedra):,} tets")
        seconds = sum(hierarchy.seconds.values())
        column.label(text=f"Built in {seconds:.1f} s" if seconds else "Came with the file")
        column.label(text=RUNGS[hierarchy.summary.rung])
        if hierarchy.account:
            trouble.draw_lines(context, column, hierarchy.account)


CLASSES = (VIEW3D_PT_partwheel,)
