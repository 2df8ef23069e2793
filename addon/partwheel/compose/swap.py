# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_swap: exchanges the picked part for a compatible one of another object. The wheel goes through the
candidates; a preview shows the rest of the object and the candidate in the part's place."""

import bpy

from ..mesh import MeshSnapshot, Refused, find_object, go_to_object_mode, resolve_object
from ..solid import composition
from ..pick.build import build_and_wait
from ..view import keys, previews
from . import swapping
from partwheel import Error, Hierarchy
from ..solid.copy_part import PartOperator
from ..view.in_view import show_wait_cursor
from ..translations.lookup import iface_
from .adjusting import Adjusting
from .unite import find_parts


class MESH_OT_partwheel_swap(Adjusting, PartOperator, bpy.types.Operator):
    """Exchange the picked part for one of another object that fits its border; the wheel goes through the candidates"""

    bl_idname = "mesh.partwheel_swap"
    bl_label = "Swap with Compatible Part"
    lost_message = "{operator} stopped: the object is no longer the active one."
    was_edited, preview, ctrl_size_events = False, None, keys.OFFER.events
    needs_editable = removes_faces = True

    other: bpy.props.StringProperty(
        name="From", description="The object that the new part comes from; none: the other selected objects, or "
                                 "else all others",
        options={"SKIP_SAVE"})
    other_node: bpy.props.IntProperty(
        name="New Part", description="Number of the new part in its object; -1: the most compatible part",
        default=-1, min=-1, options={"SKIP_SAVE"})
    whole: bpy.props.BoolProperty(
        name="Whole Object", description="Use the object itself, a part that was copied as a solid",
        options={"SKIP_SAVE", "HIDDEN"})
    scale: bpy.props.FloatProperty(
        name="Size", description="Factor of the size at which the borders fit",
        default=1, min=1e-4, options={"SKIP_SAVE"})
    mirror: bpy.props.BoolProperty(name="Mirror", description="Use the part's mirror image", options={"SKIP_SAVE"})

    blend: bpy.props.FloatProperty(
        name="Blend", description="Width of a smooth transition on either side of the seam, in radii of the seam",
        min=0, soft_max=1)
    build: bpy.props.BoolProperty(
        name="Find Parts", description="Find the parts of the new mesh afterward, in the background", default=True)

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy, _plan: None) -> None:
        swap_target = swapping.SwapTarget(obj, hierarchy, self.node, self.snap)
        self._swap(swap_target, self._candidate_from_options(context, swap_target, obj))

    def _candidate_from_options(self, context: bpy.types.Context, swap_target: swapping.SwapTarget,
                                obj: bpy.types.Object) -> swapping.Candidate:
        """The Candidate that the options define. Raises Refused."""
        other = self._find_other()
        if other and (self.whole or self.other_node >= 0):
            return swap_target.find_candidate(other, None if self.whole else self.other_node)
        return swap_target.find_candidates([other] if other else swapping.sources(context, obj))[0]

    def _find_other(self) -> bpy.types.Object | None:
        """The object that the new part must come from, if the options name one. Raises Refused."""
        other = resolve_object(self.other)
        if self.other and (other is None or other.type != "MESH"):
            raise Refused("There is no mesh object {name}.", name=self.other)
        return other

    def _swap(self, swap_target: swapping.SwapTarget, candidate: swapping.Candidate) -> None:
        self.other, self.whole = candidate.name, candidate.node is None
        self.other_node = -1 if self.whole else candidate.node
        for sentence in composition.bound_modifier_messages(find_object(swap_target.name)):
            self.report({"WARNING"}, sentence)
        swap_target.swap(candidate, self._adjustment(), self.blend)
        if self.build:
            find_parts(self)

    def _adjustment(self) -> swapping.Adjustment:
        return swapping.Adjustment(self.scale, self.angle, self.depth, self.mirror)

    # ---- With the wheel

    def on_start(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        obj = context.active_object
        with show_wait_cursor(context):
            self.check(obj)
            if not build_and_wait(self, context, MeshSnapshot(obj)):
                return {"CANCELLED"}
            hierarchy = self.require_hierarchy(obj)
            other = self._find_other()
            others = [other] if other else swapping.sources(context, obj)
            self.was_edited = obj.mode == "EDIT"
            if self.was_edited:
                bpy.ops.object.mode_set(mode="OBJECT")
            self.swap_target = swapping.SwapTarget(obj, hierarchy, self.node, self.snap)
            self.candidates, self.index = self.swap_target.find_candidates(others), 0
            self.preview = SwapPreview(self.swap_target)
            self._call_before_saving(previews.remove_previews)
            self._show(context)
        return {"RUNNING_MODAL"}

    def can_continue(self, context: bpy.types.Context) -> bool:
        active = context.view_layer.objects.active  # None while it is hidden, in some versions
        obj = find_object(self.swap_target.name)
        return (obj is not None and context.view_layer.objects.get(obj.name) == obj and active in (None, obj)
                and context.mode == "OBJECT")

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not self.preview.exists():  # after saving or undo
            self._show(context)
        return Adjusting.on_event(self, context, event)

    def _on_other_key(self, event: bpy.types.Event, sign: int) -> bool:
        if event.type in keys.OFFER.events:
            self.index = min(max(self.index + sign, 0), len(self.candidates) - 1)
        return event.type in keys.OFFER.events

    def _show(self, context: bpy.types.Context, problem: str = "") -> None:
        candidate = self.candidates[self.index]
        self.preview.show(candidate, self._adjustment())
        state = [iface_("{name}, part {number} of {count}, {likeness:.0%} similar").format(
            name=candidate.name, number=self.index + 1, count=len(self.candidates), likeness=candidate.score),
                 self._adjustment_text()]
        self._show_status(context, problem or ", ".join(state + [iface_("mirrored")] * self.mirror), keys.SWAPPING)

    def on_confirm(self, context: bpy.types.Context) -> set[str]:
        previews.remove_previews()
        if self.was_edited:  # undo must return to Edit Mode
            bpy.ops.object.mode_set(mode="EDIT")
            go_to_object_mode(context.active_object)
        try:
            self._swap(self.swap_target, self.candidates[self.index])
        except Error as error:  # another candidate may work
            self.report({"ERROR"}, str(error))
            self._show(context, str(error))
            return {"RUNNING_MODAL"}
        return {"FINISHED"}

    def on_cancel(self, context: bpy.types.Context) -> None:
        previews.remove_previews()
        if self.was_edited and context.active_object and context.active_object.mode == "OBJECT":
            bpy.ops.object.mode_set(mode="EDIT")


class SwapPreview:
    """Replaces the object in the view by a preview of the rest without the part, and shows one candidate at a time.
    The object itself is hidden and unchanged."""

    def __init__(self, swap_target: swapping.SwapTarget) -> None:
        self.swap_target, self.rest, self.shown = swap_target, "", {}

    def exists(self) -> bool:
        return self.rest in bpy.data.objects

    def show(self, candidate: swapping.Candidate, adjustment: swapping.Adjustment) -> None:
        if not self.exists():
            self._create_rest()
        key = candidate.name, candidate.node
        for shown_key, name in self.shown.items():
            bpy.data.objects[name].hide_viewport = shown_key != key
        if key in self.shown:
            self.swap_target.move_stand_in(bpy.data.objects[self.shown[key]], candidate, adjustment)
        else:
            self.shown[key] = previews.mark_preview(self.swap_target.create_stand_in(candidate, adjustment)).name

    def _create_rest(self) -> None:
        obj = find_object(self.swap_target.name)
        mesh = self.swap_target.create_rest_mesh()
        rest = obj.copy()  # with its modifiers and materials
        rest.data = mesh
        composition.target_collections(obj)[0].objects.link(rest)
        self.rest, self.shown = previews.mark_preview(rest).name, {}
        previews.hide_original(obj)
