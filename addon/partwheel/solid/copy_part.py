# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_copy, mesh.partwheel_remove, mesh.partwheel_split: parts as solids."""

import bpy

from ..mesh import arrays
from ..mesh.datablocks import all_or_nothing
from ..mesh.errors import Refused
from ..mesh.poll import NeedsActiveMesh, poll_is_editable
from ..mesh.selection import KINDS, is_selected
from ..parts import picks, registry
from ..pick import borders
from ..pick.build import Beside, waited_for
from . import composition, solids
from partwheel import Error
from partwheel.likeness import nearest

OVERLAP = 0.9  # of what is selected with a part, to be taken for it


class OnParts(NeedsActiveMesh):
    """What operators on an object with parts share: Edit Mode, errors."""

    bl_options = {"REGISTER", "UNDO"}
    edits = False  # whether it changes the mesh itself: then Edit Mode goes on afterwards

    def execute(self, context):
        obj = context.active_object
        try:
            self.check(obj)
            if not waited_for(self, context, obj):
                return {"CANCELLED"}
            hierarchy = self.hierarchy(obj)
            for sentence in self.losses(obj):
                self.report({"WARNING"}, sentence)
            with all_or_nothing():
                self._outside_edit_mode(context, obj, hierarchy)
        except Error as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def _outside_edit_mode(self, context, obj, hierarchy):
        was_edited = obj.mode == "EDIT"
        if was_edited:
            bpy.ops.object.mode_set(mode="OBJECT")
            if not self.edits:
                # Undo steps of Edit Mode hold its mesh alone: without this one, undo would leave the new objects.
                bpy.ops.ed.undo_push(message="Leave Edit Mode")
        self.work(context, obj, hierarchy)
        if was_edited and self.edits:
            bpy.ops.object.mode_set(mode="EDIT")

    def losses(self, _obj):
        """Sentences on what will be lost."""
        return []

    def _lacking(self, context):
        self.check(context.active_object)
        return super()._lacking(context)

    def check(self, obj):
        """Raises Refused for what can be told before its parts are found."""

    def hierarchy(self, obj):
        return registry.needed(obj)


class OnPart(OnParts):
    """The same for operators that cut a part out: a node, or the one that was picked last, or else the selected one.
    takes_away: whether its faces are gone from the mesh then, so that they must be what the user has selected."""

    takes_away = False

    snap: bpy.props.BoolProperty(
        name="Snap Border", description="Move the border of the part to the creases nearby, as far as what is inside "
        "lets it be there", default=True)
    node: bpy.props.IntProperty(
        name="Part", description="The part's number; -1: the part that was picked last",
        default=-1, min=-1, options={"SKIP_SAVE"})

    def check(self, obj):
        if self.node < 0 and not picks.picked_as_told(obj) and not _selected(obj):
            raise Refused(picks.NO_PICK)

    def hierarchy(self, obj):
        by_user, pick = self.node < 0, picks.picked(obj)
        if by_user and not pick and _selected(obj):
            found = registry.needed(obj)
            self.node, overlap = nearest(found, arrays.read(obj.data.polygons, "select", bool))
            if overlap < OVERLAP:
                raise Refused("What is selected is no part. Pick one with Select Part by Wheel, and confirm it.")
        found, node = picks.chosen(obj, self.node)
        if by_user and self.takes_away and not _is_selected(obj, found, node, [pick.snap] if pick else [False, True]):
            raise Refused("Only a part that is selected as a whole, and nothing else with it, can be taken away. Pick it anew "
                          "with Select Part by Wheel, and confirm it.")
        self.node = node
        return found


def _selected(obj):
    """Whether faces are: where none was picked since the last edit, they say which part is meant."""
    return obj.mode == "EDIT" and obj.data.total_face_sel > 0


def _is_selected(obj, hierarchy, node, snaps):
    """Whether a part's faces are what is selected, with one of these borders: its own, or that in creases."""
    modes = bpy.context.tool_settings.mesh_select_mode
    kind = next(kind for kind, on in zip(KINDS, modes) if on)
    return any(is_selected(obj.data, borders.faces(obj, hierarchy, node, snap), kind) for snap in snaps)


class _Caps:
    """The options of what makes caps."""

    smooth: bpy.props.BoolProperty(
        name="Smooth Caps", description="Close the part with a smooth surface, instead of the flat facets inside the "
        "solid that divide it from the rest", default=False)
    material: bpy.props.BoolProperty(
        name="Cap Material", description="Give the caps a material of their own", default=False)

    def caps(self):
        return solids.Options(self.smooth, self.material)


class MESH_OT_partwheel_copy(OnPart, Beside, _Caps, bpy.types.Operator):
    """Copy the picked part as a solid: a new object, closed where it was cut; Ctrl C, Ctrl V take it to other files"""

    bl_idname = "mesh.partwheel_copy"
    bl_label = "Copy Part as Solid"

    def losses(self, obj):
        return composition.losses(obj)

    def work(self, context, obj, hierarchy):
        only(context, [composition.copied(obj, hierarchy, self.node, self.caps(), self.snap)])


class MESH_OT_partwheel_remove(OnPart, Beside, _Caps, bpy.types.Operator):
    """Take the picked part out of the mesh and close the hole"""

    bl_idname = "mesh.partwheel_remove"
    bl_label = "Remove Part"
    edits = takes_away = True

    @classmethod
    def poll(cls, context):
        return super().poll(context) and poll_is_editable(cls, context.active_object)

    def losses(self, obj):
        return composition.bound(obj)

    def work(self, context, obj, hierarchy):
        composition.removed(obj, hierarchy, self.node, self.caps(), self.snap)


class MESH_OT_partwheel_split(OnParts, Beside, _Caps, bpy.types.Operator):
    """Make each part of a cut an object of its own: closed solids that fit each other exactly"""

    bl_idname = "mesh.partwheel_split"
    bl_label = "Split into Solids"

    by: bpy.props.EnumProperty(
        name="By", description="What decides where to cut",
        items=[("PARTS", "Parts", "Into so many parts, those that were joined last"),
               ("LEAST_CONCAVITY", "Nearly Convex", "Into so many parts, those that are nearest to convex in total"),
               ("HEIGHT", "Height", "Into the largest parts of at most this concavity")],
    )
    parts: bpy.props.IntProperty(name="Parts", description="How many parts", default=6, min=1, soft_max=64, max=4096)
    height: bpy.props.FloatProperty(
        name="Height", description="Largest concavity of a part: the volume between it and its convex hull", default=0,
        min=0)
    explode: bpy.props.FloatProperty(
        name="Explode", description="How far the parts are moved apart, by their distance from the middle", default=0,
        min=0, soft_max=2)
    hide: bpy.props.BoolProperty(name="Hide Original", description="Hide the object that was split", default=True)

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "by")
        layout.prop(self, "height" if self.by == "HEIGHT" else "parts")
        for name in ("explode", "hide", "smooth", "material"):
            layout.prop(self, name)

    def losses(self, obj):
        return composition.losses(obj)

    def work(self, context, obj, hierarchy):
        count = min(self.parts, len(hierarchy.tetrahedra))
        into = {"PARTS": hierarchy.cut_parts, "LEAST_CONCAVITY": hierarchy.cut_least_concavity}
        bounds = hierarchy.cut_height(self.height) if self.by == "HEIGHT" else into[self.by](count)
        made = composition.split(obj, hierarchy, bounds, self.caps(), self.explode)
        only(context, made)
        if self.hide:
            obj.hide_set(True)


def only(context, objects):
    """Selects these objects and no other; the first becomes active."""
    for other in context.selected_objects:
        other.select_set(False)
    for new in objects:
        new.select_set(True)
    context.view_layer.objects.active = objects[0]


CLASSES = (MESH_OT_partwheel_copy, MESH_OT_partwheel_remove, MESH_OT_partwheel_split)
