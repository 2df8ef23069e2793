# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel in the 3D view's sidebar: the active mesh's hierarchy, and what can be done with a selected part."""

import bpy

from .. import session
from .menu import draw_handoffs


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
        hierarchy, fits = session.peek(context.active_object)
        if hierarchy and fits:
            layout.label(text=f"{len(hierarchy.order)} faces, {len(hierarchy.tetrahedra)} tets")
            layout.label(text=f"Built in {sum(hierarchy.seconds.values()):.1f} s")
        else:
            layout.label(text="The mesh has changed" if hierarchy else "No parts yet")
        layout.operator("mesh.partwheel_build", text="Rebuild" if hierarchy else "Build")
        if context.mode == "EDIT_MESH":
            column = layout.column()
            column.operator_context = "INVOKE_REGION_WIN"
            column.operator("mesh.partwheel_select")
            draw_handoffs(column)


def register():
    bpy.utils.register_class(VIEW3D_PT_partwheel)


def unregister():
    bpy.utils.unregister_class(VIEW3D_PT_partwheel)
