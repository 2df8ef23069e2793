# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that go on from the part that was picked last to others: all that are alike, the one on the other side."""

import bpy
import numpy as np

from ..mesh import arrays
from ..mesh.mesh_identity import find_object
from ..mesh.errors import Refused
from ..mesh.selection import Selections
from ..parts import picks, registry
from ..pick import borders
from ..view import keys, picking
from ..view.in_view import InView, show_wait_cursor
from ..words.say import iface_, rpt_
from . import others
from partwheel.likeness import THRESHOLD


class _FromPart(picks.NeedsPick):
    """Selects nodes beside the part in hand."""

    extend: bpy.props.BoolProperty(
        name="Extend", description="Add to what is selected, instead of replacing it", default=True)

    def _faces(self, obj, hierarchy, nodes, snap):
        return np.concatenate([borders.get_part_faces(obj, hierarchy, node, snap) for node in nodes])


class MESH_OT_partwheel_similar(_FromPart, InView, bpy.types.Operator):
    """Select all parts (segments, regions) like the one picked last, in each object being edited: fingers, legs, horns"""

    bl_idname = "mesh.partwheel_similar"
    bl_label = "Select Similar Parts"
    bl_options = {"REGISTER", "UNDO"}

    threshold: bpy.props.FloatProperty(
        name="Threshold", description="How alike parts are that are selected: 1 is the same shape and size, less is "
        "more parts", default=THRESHOLD, min=0, max=1, subtype="FACTOR")

    # ---- Without a window

    def execute(self, context):
        obj = context.edit_object
        try:
            self._start(context, obj)
        except Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._show(context, self._count())
        return {"FINISHED"}

    def _start(self, context, obj):
        with arrays.use_snapshot():
            self.hierarchy, _ = picks.resolve_node(obj, -1)
            self.pick = picks.get_pick(obj)
            edited = list(context.objects_in_mode_unique_data)
            self.alike = others.alike(obj, self.hierarchy, self.pick.node, [each for each in edited if each != obj])
            self.selections = Selections(edited, obj)
            lacking = [each.name for each in edited if not registry.get_hierarchy(each)]
        if lacking:
            self.report({"WARNING"}, rpt_("Not searched, for no parts are known there yet: {names}. Find them first.").format(
                names=", ".join(lacking)))

    def _count(self):
        """How many parts are alike from the threshold on: they come first."""
        return sum(each.likeness >= self.threshold for each in self.alike)

    def _show(self, context, count):
        self.count = count
        own = context.edit_object
        nodes = {own: [self.pick.node]}
        for each in self.alike[:count]:
            nodes.setdefault(find_object(each.name), []).append(each.node)
        faces = {obj: self._faces(obj, registry.find_hierarchy(obj.data), those, self.pick.snap) for obj, those in nodes.items()}
        self.selections.select_in_each(faces, self.extend, active={own: self.pick.face})

    # ---- With the wheel

    def on_start(self, context, _event):
        obj = context.edit_object
        self.object_name, self.selections = obj.name_full, None
        with show_wait_cursor(context):
            self._start(context, obj)
        self.scroll = keys.NotchCounter(keys.SCROLL_STEP)
        return self._to(context, self._count())

    def _to(self, context, count):
        """So many parts beside the one in hand; the threshold is between the last one and the next."""
        count = min(max(count, 0), len(self.alike))
        if count != self._count():
            ends = [1.0, *(each.likeness for each in self.alike), 0.0]
            self.threshold = (ends[count] + ends[count + 1]) / 2
        self._show(context, count)
        self._show_status(context, iface_("{count} parts, alike from {threshold:.2f} on").format(
            count=count + 1, threshold=self.threshold), keys.SIMILAR)
        return {"RUNNING_MODAL"}

    def on_event(self, context, event):
        if event.type in keys.SYSTEM or event.type in keys.MOVES:
            return {"PASS_THROUGH"}
        over = picking.find_view_under_mouse(context, event) is not None
        plain = not (event.shift or event.ctrl or event.alt or event.oskey)
        if event.type == "TRACKPADPAN" and over and plain:
            return self._to(context, self.count + self.scroll.notches(event.mouse_y - event.mouse_prev_y))
        if event.type in keys.NAVIGATE.events or event.type in keys.WHEEL_STEPS and not (over and plain):
            return {"PASS_THROUGH"}
        if event.value not in {"PRESS", "DOUBLE_CLICK"}:
            return {"RUNNING_MODAL"}
        if event.type in keys.CANCEL.events:
            return {"CANCELLED"}
        if event.type in keys.WHEEL_STEPS:
            return self._to(context, self.count + keys.WHEEL_STEPS[event.type])
        if event.type in keys.MODIFIERS:
            return {"RUNNING_MODAL"}
        if event.type in keys.CONFIRM.events or event.type == "LEFTMOUSE" and over:
            return {"FINISHED"}
        return {"FINISHED", "PASS_THROUGH"}  # any other key means what it always means

    def on_cancel(self, context):
        if self.selections and self.can_continue(context):
            self.selections.restore()

    def can_continue(self, context):
        obj = context.edit_object
        return obj is not None and obj.name_full == self.object_name and self.selections.fits()


class MESH_OT_partwheel_mirrored(_FromPart, bpy.types.Operator):
    """Select the part (segment, region) on the other side of the model, across its own plane of symmetry"""

    bl_idname = "mesh.partwheel_mirrored"
    bl_label = "Select Mirrored Part"
    bl_options = {"REGISTER", "UNDO"}

    plane: bpy.props.IntProperty(
        name="Plane", description="Of the planes in which the model is its own mirror image, the best one first",
        default=1, min=1, max=3)
    # The panel of the last operation does it again with the part that was in hand then.
    node: bpy.props.IntProperty(default=-1, options={"HIDDEN", "SKIP_SAVE"})

    def execute(self, context):
        obj = context.edit_object
        try:
            hierarchy, self.node = picks.resolve_node(obj, self.node)
            images = others.images(obj, hierarchy, self.node)
        except Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.plane = min(self.plane, len(images))
        node, pick = images[self.plane - 1].node, picks.get_pick(obj)
        snap = bool(pick and pick.snap)
        nodes = [self.node, node] if self.extend else [node]
        face = int(hierarchy.faces(node)[0])
        Selections(context.objects_in_mode_unique_data, obj).select(
            obj, self._faces(obj, hierarchy, nodes, snap), face, self.extend)
        if not self.extend:
            picks.remember(obj, face, node, snap)
        return {"FINISHED"}


CLASSES = (MESH_OT_partwheel_similar, MESH_OT_partwheel_mirrored)
