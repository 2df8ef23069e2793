# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_swap: the picked part is exchanged for a compatible one of another object. The wheel goes through what
is offered; meanwhile one sees what would be left of the object, and the part offered stands in its place."""

import bpy

from ..mesh import mesh_identity
from ..solid import composition
from ..pick.build import waited_for
from ..view import keys, previews
from . import swapping
from partwheel import Error
from ..mesh.errors import Refused
from ..mesh.poll import poll_is_editable
from ..solid.copy_part import PartOperator
from ..view.in_view import waiting
from ..words.say import iface_
from .adjusting import Adjusting
from .unite import find_parts


class MESH_OT_partwheel_swap(Adjusting, PartOperator, bpy.types.Operator):
    """Exchange the picked part for one of another object that fits its border; the wheel goes through what there is"""

    bl_idname = "mesh.partwheel_swap"
    bl_label = "Swap with Compatible Part"
    lost_message = "{operator} stopped: the object is no longer the active one."
    was_edited, preview, taken = False, None, keys.OFFER.events
    removes_faces = True

    other: bpy.props.StringProperty(
        name="From", description="The object that the new part comes from; none: those selected, or else all others",
        options={"SKIP_SAVE"})
    other_node: bpy.props.IntProperty(
        name="New Part", description="The new part's number in that object; -1: the most compatible one",
        default=-1, min=-1, options={"SKIP_SAVE"})
    whole: bpy.props.BoolProperty(
        name="All of It", description="The object is a part itself, copied as a solid before", default=False,
        options={"SKIP_SAVE", "HIDDEN"})
    scale: bpy.props.FloatProperty(
        name="Size", description="Times the size at which the borders fit", default=1, min=1e-4, options={"SKIP_SAVE"})
    mirror: bpy.props.BoolProperty(
        name="Mirror", description="Take the part's mirror image", default=False, options={"SKIP_SAVE"})

    blend: bpy.props.FloatProperty(
        name="Blend", description="Width of a smooth transition on either side of the seam, times its radius",
        default=0, min=0, soft_max=1)
    build: bpy.props.BoolProperty(
        name="Find Parts", description="Find the parts of the new mesh at once, in a process of its own", default=True)

    @classmethod
    def poll(cls, context):
        return super().poll(context) and poll_is_editable(cls, context.active_object)

    def run(self, context, obj, hierarchy):
        place = swapping.Place(obj, hierarchy, self.node, self.snap)
        self._swap(place, self._chosen(context, place, obj))

    def _chosen(self, context, place, obj):
        """The Offer that the options name."""
        other = mesh_identity.resolve_object(self.other) if self.other else None
        if self.other and (other is None or other.type != "MESH"):
            raise Refused("There is no mesh object {name}.", name=self.other)
        if other and (self.whole or self.other_node >= 0):
            return place.offer(other, None if self.whole else self.other_node)
        return place.offers([other] if other else swapping.sources(context, obj))[0]

    def _swap(self, place, offer):
        self.other, self.whole = offer.name, offer.node is None
        self.other_node = -1 if self.whole else offer.node
        for sentence in composition.bound_modifier_messages(mesh_identity.find_object(place.name)):
            self.report({"WARNING"}, sentence)
        place.swap(offer, self._adjustment(), self.blend)
        if self.build:
            find_parts(self)

    def _adjustment(self):
        return swapping.Adjustment(self.scale, self.angle, self.depth, self.mirror)

    # ---- With the wheel --------------------------------------------------------------------------------------------

    def on_start(self, context, _event):
        obj = context.active_object
        with waiting(context):
            self.check(obj)
            if not waited_for(self, context, obj):
                return {"CANCELLED"}
            hierarchy = self.require_hierarchy(obj)
            other = mesh_identity.resolve_object(self.other)
            others = [other] if other else swapping.sources(context, obj)
            self.was_edited = obj.mode == "EDIT"
            if self.was_edited:
                bpy.ops.object.mode_set(mode="OBJECT")
            self.place = swapping.Place(obj, hierarchy, self.node, self.snap)
            self.offers, self.index = self.place.offers(others), 0
            self.preview = Preview(self.place)
            self._call_before_saving(previews.end)
            self._show(context)
        return {"RUNNING_MODAL"}

    def can_continue(self, context):
        active = context.view_layer.objects.active  # none while it is hidden, in some versions
        obj = mesh_identity.find_object(self.place.name)
        return (obj is not None and context.view_layer.objects.get(obj.name) == obj and active in (None, obj)
                and context.mode == "OBJECT")

    def on_event(self, context, event):
        if not self.preview.there():  # a file was saved meanwhile, or a step undone
            self._show(context)
        return Adjusting.on_event(self, context, event)

    def _changed(self, event, sign):
        if event.type in keys.OFFER.events:
            self.index = min(max(self.index + sign, 0), len(self.offers) - 1)
        return event.type in keys.OFFER.events

    def _show(self, context, problem=""):
        offer = self.offers[self.index]
        self.preview.show(offer, self._adjustment())
        state = [iface_("{name}, part {number} of {count}, {likeness:.0%} alike").format(
            name=offer.name, number=self.index + 1, count=len(self.offers), likeness=offer.score), self._adjustments()]
        self._show_status(context, problem or ", ".join(state + [iface_("mirrored")] * self.mirror), keys.SWAPPING)

    def on_confirm(self, context):
        previews.end()
        if self.was_edited:
            # Undo steps of Edit Mode hold its mesh alone.
            bpy.ops.ed.undo_push(message="Leave Edit Mode")
        try:
            self._swap(self.place, self.offers[self.index])
        except Error as error:  # another part may do
            self.report({"ERROR"}, str(error))
            self._show(context, str(error))
            return {"RUNNING_MODAL"}
        return {"FINISHED"}

    def on_cancel(self, context):
        previews.end()
        if self.was_edited and context.active_object and context.active_object.mode == "OBJECT":
            bpy.ops.object.mode_set(mode="EDIT")


class Preview:
    """In place of the object one with what is left of it without the part; and beside it the parts offered so far, of
    which one is seen. The object itself is hidden and not touched."""

    def __init__(self, place):
        self.place, self.rest, self.shown = place, "", {}

    def there(self):
        return self.rest in bpy.data.objects

    def show(self, offer, adjustment):
        if not self.there():
            self._create()
        wanted = offer.name, offer.node
        for each, name in self.shown.items():
            bpy.data.objects[name].hide_viewport = each != wanted
        if wanted in self.shown:
            self.place.put(bpy.data.objects[self.shown[wanted]], offer, adjustment)
        else:
            self.shown[wanted] = previews.show(self.place.stand_in(offer, adjustment)).name

    def _create(self):
        obj = mesh_identity.find_object(self.place.name)
        mesh = self.place.rest()
        rest = obj.copy()  # with its modifiers and materials
        rest.data = mesh
        composition.target_collection(obj).objects.link(rest)
        self.rest, self.shown = previews.show(rest).name, {}
        previews.hide(obj)


CLASSES = (MESH_OT_partwheel_swap,)
