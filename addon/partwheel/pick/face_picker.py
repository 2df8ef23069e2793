# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects a click picks from in each mode, and which face is under the mouse."""

from collections.abc import Container

import bpy

from ..mesh import MeshSnapshot, find_object
from ..view import picking
from .view_cache import cast_ray, find_nearest_face, get_view_cache


class EditModePicker:
    """Picks from the objects in Edit Mode."""

    def find_objects(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        """Return the objects that can be picked from, the active first; of those that share a mesh, the edited one."""
        if context.mode != "EDIT_MESH":
            return []
        return sorted(context.objects_in_mode_unique_data, key=lambda obj: obj != context.edit_object)

    def find_group_candidates(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        """Return the mesh objects that the wheel may add above the whole object."""
        return self.find_objects(context)

    def find_face(self, context: bpy.types.Context, event: bpy.types.Event) -> picking.FaceHit | None:
        """Return the first face under the mouse, or None."""
        view = picking.find_view_under_mouse(context, event)
        if not view:
            return None
        area, *pixel = view
        visible = [obj for obj in self.find_objects(context) if obj.visible_get(viewport=area.spaces.active)]
        return find_nearest_face(visible, *pixel)


class PaintModePicker(EditModePicker):
    """Picks from the active object in these modes of the context."""

    def __init__(self, modes: Container[str]) -> None:
        self.modes = modes

    def find_objects(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return [context.active_object] if context.mode in self.modes else []

    def find_group_candidates(self, _context: bpy.types.Context) -> list[bpy.types.Object]:
        return []


class ObjectModePicker:
    """Picks from one object in Object Mode, also from its instances. name: its full name; "": the active object."""

    def __init__(self, name: str = "") -> None:
        self.name = name

    def find_objects(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        obj = find_object(self.name) if self.name else context.active_object
        return [obj] if context.mode == "OBJECT" and obj is not None and obj.type == "MESH" else []

    def find_group_candidates(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return [obj for obj in context.selectable_objects if obj.type == "MESH"]

    def find_face(self, context: bpy.types.Context, event: bpy.types.Event) -> picking.FaceHit | None:
        view, (obj,) = picking.find_view_under_mouse(context, event), self.find_objects(context)
        hit = view and picking.find_surface_under(context, *view)
        if not hit or hit.obj != obj:
            return None
        return cast_ray(get_view_cache(MeshSnapshot(obj)), hit, *view[1:])
