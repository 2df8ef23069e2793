# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_convex: a few convex hulls that approximate the model from outside, for collisions."""

import bpy
import numpy as np

from ..mesh.computation import Computation, Steps
from ..pick.build import BuildsFirst
from ..solid.copy_part import PartsOperator
from ..words.say import rpt_
from . import hulls
from partwheel import ConvexPart, Hierarchy


class MESH_OT_partwheel_convex(PartsOperator, BuildsFirst, bpy.types.Operator):
    """Create convex hulls that fit tightly around the model, as children of it, for collisions in game engines"""

    bl_idname = "mesh.partwheel_convex"
    bl_label = "Convex Parts"

    by: bpy.props.EnumProperty(
        name="By", description="What decides how many hulls there are",
        items=[("HULLS", "Count", "Number of hulls; fewer if more would not improve the fit"),
               ("ERROR", "Error", "As few hulls as possible within this distance from the model")])
    hulls: bpy.props.IntProperty(name="Hulls", description="How many", default=16, min=1, soft_max=64, max=4096)
    error: bpy.props.FloatProperty(
        name="Error", description="Largest distance of the hulls from the model, relative to the size of the model",
        default=2, min=0.1, max=100, subtype="PERCENTAGE")
    vertices: bpy.props.IntProperty(
        name="Vertices", description="Most vertices of a hull: physics engines accept 64 or 255", default=64, min=8,
        soft_max=255)
    primitives: bpy.props.FloatProperty(
        name="Primitives", description="Replace a hull by a box, sphere, capsule or cylinder within this distance "
                                       "from it, relative as for Error; 0: hulls only",
        default=0, min=0, max=100, subtype="PERCENTAGE")
    engine: bpy.props.EnumProperty(
        name="For", description="How the hulls are named, or what they become",
        items=[("UNREAL", "Unreal", "Names that start with UCX: the importer uses them as the model's collision"),
               ("GODOT", "Godot", "Names that end with -convcolonly: the importer creates bodies with these "
                                  "shapes"),
               ("UNITY", "Unity", "Names with collider, for children that get a convex Mesh Collider"),
               ("RIGID_BODY", "Rigid Body", "Blender's rigid body: the model falls and rolls with the hulls as its "
                                            "shape")])

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.row().prop(self, "by", expand=True)
        layout.prop(self, "error" if self.by == "ERROR" else "hulls")
        for name in ("vertices", "primitives", "engine"):
            layout.prop(self, name)

    def plan(self, _obj: bpy.types.Object, hierarchy: Hierarchy) -> Steps:
        limit = {"error": self.error / 100 * _diagonal(hierarchy)} if self.by == "ERROR" else {"hulls": self.hulls}
        return (yield Computation(hierarchy.convex_parts, **limit, max_vertices=self.vertices))

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy,
            convex_parts: list[ConvexPart]) -> None:
        objects = hulls.create_hulls(context, obj, convex_parts, self.engine,
                                     self.primitives / 100 * _diagonal(hierarchy))
        volume_ratio = sum(part.hull_volume() for part in convex_parts) / hierarchy.summary.volume
        text = rpt_("{count} convex hulls around {name} with {times:.2f} times its volume.")
        self.report({"INFO"}, text.format(count=len(objects), name=obj.name, times=volume_ratio))


def _diagonal(hierarchy: Hierarchy) -> float:
    """The diagonal of the model's bounding box."""
    return float(np.linalg.norm(np.ptp(hierarchy.vertices, axis=0)))


CLASSES = (MESH_OT_partwheel_convex,)
