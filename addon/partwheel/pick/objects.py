# SPDX-License-Identifier: GPL-3.0-or-later
"""Picking in Object Mode.

object.partwheel_pick, the tool's operator, selects the part in its mesh, where it stays highlighted for further
operators. object.partwheel_select enters Edit Mode with the part."""

from collections.abc import Sequence

import bpy
import numpy as np

from ..mesh import MeshSnapshot, arrays, check_poll, find_object, read_only_reason, select_outside_edit_mode
from ..mesh.selection import predict_face_selection
from ..view import keys, picking
from ..translations.lookup import rpt_
from .hover import highlight
from .face_picker import ObjectModePicker
from .pick import PartPicker, PreviewTarget
from .view_cache import keep_view_cache
from . import states


class _InObjectMode(PartPicker):
    """Base of both operators: picks from the object under the mouse."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return check_poll(cls, context.mode == "OBJECT", "Go to Object Mode first.")

    picker = ObjectModePicker()

    def start_picker(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        obj = self._find_target(context, event)
        if obj:
            self.picker = ObjectModePicker(obj.name_full)
        return obj is not None

    def _find_target(self, context: bpy.types.Context, event: bpy.types.Event) -> bpy.types.Object | None:
        """Return the object under the mouse, else the active one, if editable; otherwise report why and return None."""
        view = picking.find_view_under_mouse(context, event)
        hit = view and picking.find_surface_under(context, *view)
        obj = hit.obj if hit else context.active_object
        space = view[0].spaces.active if view else context.space_data
        is_visible = obj is not None and obj.visible_get(viewport=space)
        if obj is None or obj.type != "MESH" or not (hit or is_visible):
            reason = rpt_("There is no mesh under the mouse.")
        elif not is_visible:
            reason = rpt_("{name} is an instance, and this 3D view does not show its original: edit it there.").format(
                name=obj.name)
        else:
            reason = read_only_reason(obj)
        if reason:
            self.report({"WARNING"}, reason)
        return None if reason else obj


class OBJECT_OT_partwheel_select(_InObjectMode, bpy.types.Operator):
    """Pick a part of the mesh under the mouse in Object Mode, then enter Edit Mode with the part selected"""

    bl_idname = "object.partwheel_select"
    bl_label = "Select Part by Wheel"
    bl_options = set()  # the pick in Edit Mode is registered and undone, see _enter_edit_mode()
    commands, confirm_events = keys.COMMANDS, frozenset({"TAB"})  # confirming enters Edit Mode

    def _apply(self, context: bpy.types.Context, obj: bpy.types.Object, _faces: np.ndarray,
               picked: states.PickedPart) -> set[str]:
        """Enter Edit Mode with the picked part: two undo steps, of which the second has the panel of the last
        operation. Of a group, those objects enter it that can be edited there."""
        group = [other for other in _find_members(context, picked.group)
                 if other.data != obj.data and not read_only_reason(other)]
        _select_objects(context, obj, group, self.extend or self.deselect)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.ed.undo_push(message="Toggle Edit Mode")
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", True, face_index=self.face_index, level=self.level,
                                      snap=self.snap, extend=self.extend, deselect=self.deselect)
        return {"FINISHED"}


class OBJECT_OT_partwheel_pick(_InObjectMode, bpy.types.Operator):
    """Pick a part of the mesh under the mouse to copy, swap or divide it; it is also selected in Edit Mode"""

    bl_idname = "object.partwheel_pick"
    bl_label = "Pick Part by Wheel"

    def create_target(self, context: bpy.types.Context, snapshot: MeshSnapshot) -> PreviewTarget:
        return _HighlightTarget(snapshot.obj)

    def on_miss(self, context: bpy.types.Context) -> set[str]:
        """As in Edit Mode, a click that misses all meshes deselects all."""
        obj = context.active_object
        if self.extend or self.deselect or not arrays.read(obj.data.polygons, "select", bool).any():
            return {"CANCELLED"}
        snapshot = MeshSnapshot(obj)
        with keep_view_cache(snapshot):
            select_outside_edit_mode(obj.data, [])
            context.view_layer.update()
        snapshot.state.pick = None
        highlight.update(context)
        return {"FINISHED"}

    def _apply(self, context: bpy.types.Context, obj: bpy.types.Object, faces: np.ndarray,
               picked: states.PickedPart) -> set[str]:
        _select_objects(context, obj, _find_members(context, picked.group), self.extend, self.deselect)
        context.view_layer.update()
        with keep_view_cache(MeshSnapshot(obj)):
            select_outside_edit_mode(obj.data, faces, self.extend, self.deselect, picked.face)
            context.view_layer.update()
        if not bpy.app.background:
            highlight.show_selected(obj)
        return {"FINISHED"}


class _HighlightTarget(PreviewTarget):
    """Highlights what else is picked, as far as it will stay picked."""

    def __init__(self, obj: bpy.types.Object) -> None:
        super().__init__(obj)
        self.before = np.flatnonzero(arrays.read(obj.data.polygons, "select", bool)), obj.data.polygons.active

    def select(self, obj: bpy.types.Object, faces: np.ndarray, _face: int, extend: bool, deselect: bool, *_: object) -> None:
        is_chosen = predict_face_selection(obj.data, faces, extend, deselect)
        highlight.show(obj, np.flatnonzero(is_chosen & ~arrays.make_mask(len(is_chosen), faces)))

    def selected_before(self, _obj: bpy.types.Object) -> np.ndarray:
        return self.before[0]

    def restore(self) -> None:
        """Restore also the selection that an error during confirmation has changed."""
        (faces, active), mesh = self.before, find_object(self.name).data
        if not np.array_equal(np.flatnonzero(arrays.read(mesh.polygons, "select", bool)), faces):
            select_outside_edit_mode(mesh, faces, active=active)
        highlight.target = None
        highlight.update(bpy.context)


def _find_members(context: bpy.types.Context, group: frozenset) -> list[bpy.types.Object]:
    """Return the objects of the view layer with these full names; None stands there for one that was just deleted."""
    return [obj for obj in filter(None, context.view_layer.objects) if obj.name_full in group]


def _select_objects(context: bpy.types.Context, obj: bpy.types.Object, group: Sequence[bpy.types.Object], extend: bool,
                    deselect: bool = False) -> None:
    """Make the object active, and select it and the group. Deselect the others, unless the object alone is picked and was
    selected, or with extend or deselect. deselect: deselect the group instead, if there is one."""
    if not (extend or deselect or obj.select_get() and not group):
        for other in context.selected_objects:
            other.select_set(False)
    for member in {obj, *group}:
        member.select_set(not (deselect and group))
    context.view_layer.objects.active = obj
