# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that only show what a tool would do, and the object that is hidden for them. All of it is marked, and goes
when the tool ends; should Blender end first and save by itself, when that file is opened."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from ..mesh.datablocks import remove_object

MARK = "partwheel_preview"
PREVIEW, HIDDEN, WAS_SELECTED, WAS_ACTIVE = 0, 1, 2, 4  # what was hidden, with what it was before


def mark_preview(obj: bpy.types.Object) -> bpy.types.Object:
    """A new object with a mesh of its own is a preview from now on; it."""
    obj[MARK] = PREVIEW
    for each in (obj, obj.data):
        if hasattr(each, "is_runtime_data"):  # from Blender 4.2 on: files are written without it
            each.is_runtime_data = True
    view = bpy.context.space_data
    if view and view.type == "VIEW_3D" and view.local_view:
        obj.local_view_set(view, True)
    return obj


def hide_original(obj: bpy.types.Object) -> None:
    """Until end(). Blender may then have no active object."""
    obj[MARK] = HIDDEN | WAS_SELECTED * obj.select_get() | WAS_ACTIVE * (obj == bpy.context.view_layer.objects.active)
    obj.hide_viewport = True


@persistent
def remove_previews(*_: object) -> None:
    """No preview is left, and what was hidden is seen again, selected and active if it was."""
    for obj in [obj for obj in bpy.data.objects if MARK in obj and not obj.library]:
        if obj.type != "MESH" or not isinstance(obj[MARK], int):  # not ours
            del obj[MARK]
            continue
        if obj[MARK] == PREVIEW:
            remove_object(obj)
            continue
        obj.hide_viewport = False
        layer = bpy.context.view_layer
        layer.update()
        if obj.name in layer.objects:
            obj.select_set(bool(obj[MARK] & WAS_SELECTED))
            layer.objects.active = obj if obj[MARK] & WAS_ACTIVE else layer.objects.active
        del obj[MARK]


HANDLERS = {"load_post": remove_previews}


def unregister() -> None:
    remove_previews()
