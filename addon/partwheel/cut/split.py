# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_split: the parts of a cut as solids, without a preview; siblings, not parented to each other."""

import bpy

from ..mesh import Computation, Steps
from ..pick.build import BuildsFirst
from ..solid import composition
from ..solid.copy_part import CapProperties, PartsOperator, select_only
from . import objects
from partwheel import Hierarchy
from partwheel.cut import Cut


class MESH_OT_partwheel_split(PartsOperator, BuildsFirst, CapProperties, bpy.types.Operator):
    """Make each part of a cut a separate object: closed solids that fit each other exactly"""

    bl_idname = "mesh.partwheel_split"
    bl_label = "Split into Solids"
    loss_messages = staticmethod(composition.loss_messages)

    by: bpy.props.EnumProperty(
        name="By", description="What decides where to cut",
        items=[("PARTS", "Parts", "Number of parts; the last merges are undone"),
               ("LEAST_CONCAVITY", "Nearly Convex", "Number of parts, which are as nearly convex as possible in total"),
               ("HEIGHT", "Height", "The largest parts that have at most this concavity")])
    parts: bpy.props.IntProperty(name="Parts", description="How many parts", default=6, min=1, soft_max=64, max=4096)
    height: bpy.props.FloatProperty(
        name="Height", description="Largest concavity of a part: the volume between it and its convex hull", min=0)
    explode: bpy.props.FloatProperty(
        name="Explode", description="Distance by which the parts move apart, times their distance from the center",
        min=0, soft_max=2)
    hide: bpy.props.BoolProperty(name="Hide Original", description="Hide the object that was split", default=True)

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "by")
        layout.prop(self, "height" if self.by == "HEIGHT" else "parts")
        for name in ("explode", "hide", "smooth", "material"):
            layout.prop(self, name)

    def plan(self, _obj: bpy.types.Object, hierarchy: Hierarchy) -> Steps:
        count = min(self.parts, len(hierarchy.tetrahedra))
        if self.by == "LEAST_CONCAVITY":
            bounds = yield Computation(hierarchy.cut_least_concavity, count)
        else:
            bounds = hierarchy.cut_height(self.height) if self.by == "HEIGHT" else hierarchy.cut_parts(count)
        return Cut.from_labels(hierarchy, hierarchy.face_labels(bounds))

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, _hierarchy: Hierarchy, cut: Cut) -> None:
        new_objects = objects.create_siblings(obj, cut, self.cap_options(), self.explode)
        select_only(context, new_objects)
        if self.hide:
            obj.hide_set(True)
        for message in objects.difference_messages(obj, cut, new_objects, self.smooth):
            self.report({"WARNING"}, message)
