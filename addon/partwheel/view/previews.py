# SPDX-License-Identifier: GPL-3.0-or-later
"""Preview objects of running operators, and objects hidden while they run.

All are marked and removed or restored when the operator ends. If Blender ends first and saves a recovery file, that is
done when the file is opened."""

import bpy
from bpy.app.handlers import persistent

from ..mesh import remove_object

MARK = "partwheel_preview"
PREVIEW, HIDDEN, WAS_SELECTED, WAS_ACTIVE = 0, 1, 2, 4  # values of the mark: flags of hidden objects


def mark_preview(obj: bpy.types.Object) -> bpy.types.Object:
    """Make a new object, with a mesh of its own, a preview, and return it."""
    obj[MARK] = PREVIEW
    for block in (obj, obj.data):
        if hasattr(block, "is_runtime_data"):  # Blender 4.2 and later: not saved in files
            block.is_runtime_data = True
    view = bpy.context.space_data
    if view and view.type == "VIEW_3D" and view.local_view:
        obj.local_view_set(view, True)
    return obj


def hide_original(obj: bpy.types.Object) -> None:
    """Hide the object until remove_previews(). Blender may then have no active object."""
    obj[MARK] = HIDDEN | WAS_SELECTED * obj.select_get() | WAS_ACTIVE * (obj == bpy.context.view_layer.objects.active)
    obj.hide_viewport = True


@persistent
def remove_previews(*_: object) -> None:
    """Remove all previews. Show hidden objects again, selected and active as before."""
    for obj in [obj for obj in bpy.data.objects if MARK in obj and not obj.library]:
        if obj.type != "MESH" or not isinstance(obj[MARK], int):  # not created by the add-on
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
