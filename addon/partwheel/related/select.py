# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that go on from the picked part: select all similar parts, or the mirror image."""

import bpy
import numpy as np

from ..mesh import MeshSnapshot, Selections, find_object, report_errors
from ..parts import picks, registry
from ..pick import borders
from ..view import keys, picking
from ..view.in_view import InView, show_wait_cursor
from ..translations.lookup import iface_, rpt_
from . import similar_parts
from partwheel import Hierarchy
from partwheel.likeness import THRESHOLD


class _PartBasedSelection(picks.NeedsPick):
    """Mixin for operators that select nodes in addition to the picked part."""

    extend: bpy.props.BoolProperty(
        name="Extend", description="Add to the selection instead of replacing it", default=True)


def _faces_of_nodes(snapshot: MeshSnapshot, hierarchy: Hierarchy, nodes: list[int], snap: bool) -> np.ndarray:
    return np.concatenate([borders.get_part_faces(snapshot, hierarchy, node, snap) for node in nodes])


class MESH_OT_partwheel_similar(_PartBasedSelection, InView, bpy.types.Operator):
    """Select all parts (segments, regions) similar to the last pick, in all edited objects: fingers, legs, horns"""

    bl_idname = "mesh.partwheel_similar"
    bl_label = "Select Similar Parts"

    threshold: bpy.props.FloatProperty(
        name="Threshold", description="Minimum similarity of selected parts: 1 is the same shape and size; lower "
                                      "values select more parts",
        default=THRESHOLD, min=0, max=1, subtype="FACTOR")

    # ---- Without a window

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.edit_object
        self._find(context, obj)
        self._select(context, self._count_similar())
        return {"FINISHED"}

    def _find(self, context: bpy.types.Context, obj: bpy.types.Object) -> None:
        """Finds the similar parts of all edited objects. Raises Refused."""
        snapshot = MeshSnapshot(obj)
        others = [MeshSnapshot(other) for other in context.objects_in_mode_unique_data if other != obj]
        self.hierarchy, _ = picks.resolve_node(snapshot, -1)
        self.pick = picks.get_pick(snapshot)
        self.similar = similar_parts.find_similar(snapshot, self.hierarchy, self.pick.node, others)
        self.selections = Selections([snapshot, *others])
        not_searched = [other.obj.name for other in others if not registry.get_hierarchy(other)]
        if not_searched:
            text = rpt_("Not searched, since they have no parts yet: {names}. Find their parts first.")
            self.report({"WARNING"}, text.format(names=", ".join(not_searched)))

    def _count_similar(self) -> int:
        """The number of parts above the threshold; these come first."""
        return sum(part.likeness >= self.threshold for part in self.similar)

    def _select(self, context: bpy.types.Context, count: int) -> None:
        """Selects the picked part and the count most similar ones."""
        self.count = count
        active_obj = context.edit_object
        nodes = {active_obj: [self.pick.node]}
        for part in self.similar[:count]:
            nodes.setdefault(find_object(part.name), []).append(part.node)
        faces = {obj: _faces_of_nodes(MeshSnapshot(obj), registry.find_hierarchy(obj.data), obj_nodes, self.pick.snap)
                 for obj, obj_nodes in nodes.items()}
        self.selections.select_in_each(faces, self.extend, active={active_obj: self.pick.face})

    # ---- With the wheel

    def on_start(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        obj = context.edit_object
        self.object_name, self.selections = obj.name_full, None
        with show_wait_cursor(context):
            self._find(context, obj)
        self.scroll = keys.NotchCounter()
        return self._set_count(context, self._count_similar())

    def _set_count(self, context: bpy.types.Context, count: int) -> set[str]:
        """Selects count similar parts, and sets the threshold between the last one and the next."""
        count = min(max(count, 0), len(self.similar))
        if count != self._count_similar():
            bounds = [1.0, *(part.likeness for part in self.similar), 0.0]
            self.threshold = (bounds[count] + bounds[count + 1]) / 2
        self._select(context, count)
        self._show_status(context, iface_("{count} parts, similarity at least {threshold:.2f}").format(
            count=count + 1, threshold=self.threshold), keys.SIMILAR)
        return {"RUNNING_MODAL"}

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in keys.SYSTEM or event.type in keys.MOVES:
            return {"PASS_THROUGH"}
        is_over_view = picking.find_view_under_mouse(context, event) is not None
        is_plain = not (event.shift or event.ctrl or event.alt or event.oskey)
        if event.type == "TRACKPADPAN" and is_over_view and is_plain:
            return self._set_count(context, self.count + self.scroll.add_pixels(event.mouse_y - event.mouse_prev_y))
        if event.type in keys.NAVIGATE.events or event.type in keys.WHEEL_STEPS and not (is_over_view and is_plain):
            return {"PASS_THROUGH"}
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return {"RUNNING_MODAL"}
        if event.type in keys.CANCEL.events:
            return {"CANCELLED"}
        if event.type in keys.WHEEL_STEPS:
            return self._set_count(context, self.count + keys.WHEEL_STEPS[event.type])
        if event.type in keys.MODIFIERS:
            return {"RUNNING_MODAL"}
        if event.type in keys.CONFIRM.events or event.type == "LEFTMOUSE" and is_over_view:
            return {"FINISHED"}
        return {"FINISHED", "PASS_THROUGH"}  # any other key keeps its meaning in Blender

    def on_cancel(self, context: bpy.types.Context) -> None:
        if self.selections and self.can_continue(context):
            self.selections.restore()

    def can_continue(self, context: bpy.types.Context) -> bool:
        obj = context.edit_object
        return obj is not None and obj.name_full == self.object_name and self.selections.is_valid()


class MESH_OT_partwheel_mirrored(_PartBasedSelection, bpy.types.Operator):
    """Select the part (segment, region) on the other side of the model, across its own plane of symmetry"""

    bl_idname = "mesh.partwheel_mirrored"
    bl_label = "Select Mirrored Part"
    bl_options = {"REGISTER", "UNDO"}

    plane: bpy.props.IntProperty(name="Plane", description="Symmetry plane: 0 is the best one", min=0, max=2)
    # Adjust Last Operation repeats the operator with the part that was picked then.
    node: bpy.props.IntProperty(default=-1, options={"HIDDEN", "SKIP_SAVE"})

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.edit_object
        snapshot = MeshSnapshot(obj)
        hierarchy, self.node = picks.resolve_node(snapshot, self.node)
        images = similar_parts.find_mirror_images(snapshot, hierarchy, self.node)
        self.plane = min(self.plane, len(images) - 1)
        node, pick = images[self.plane].node, picks.get_pick(snapshot)
        snap = bool(pick and pick.snap)
        nodes = [self.node, node] if self.extend else [node]
        face = int(hierarchy.faces(node)[0])
        Selections.of_edited(context, snapshot).select(
            obj, _faces_of_nodes(snapshot, hierarchy, nodes, snap), face, self.extend)
        if not self.extend:
            picks.remember(snapshot, face, node, snap)
        return {"FINISHED"}
