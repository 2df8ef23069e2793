# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_convex: a few convex hulls that approximate the model from outside, for collisions."""

import bpy
import numpy as np

from ..pick.build import BuildsFirst
from ..solid.copy_part import PartsOperator
from ..words.say import rpt_
from . import hulls
from partwheel import Hierarchy


class MESH_OT_partwheel_convex(PartsOperator, BuildsFirst, bpy.types.Operator):
    """Make few convex hulls that contain the model and little else: children of it, as engines want its collision"""

    bl_idname = "mesh.partwheel_convex"
    bl_label = "Convex Parts"

    by: bpy.props.EnumProperty(
        name="By", description="What decides how many hulls there are",
        items=[("HULLS", "Count", "So many hulls; fewer where more would gain nothing"),
               ("ERROR", "Error", "As few hulls as are found that go nowhere farther from the model")])
    hulls: bpy.props.IntProperty(name="Hulls", description="How many", default=16, min=1, soft_max=64, max=4096)
    error: bpy.props.FloatProperty(
        name="Error", description="How far hulls may go from the model: a share of the longest distance across it",
        default=2, min=0.1, max=100, subtype="PERCENTAGE")
    vertices: bpy.props.IntProperty(
        name="Vertices", description="Of each hull, at most: physics engines take 64 or 255", default=64, min=8,
        soft_max=255)
    primitives: bpy.props.FloatProperty(
        name="Primitives", description="Take a box, sphere, capsule or cylinder where it goes no farther than this "
        "from the hull, a share as for Error; 0: hulls alone", default=0, min=0, max=100, subtype="PERCENTAGE")
    engine: bpy.props.EnumProperty(
        name="For", description="How the hulls are named, or what they become",
        items=[("UNREAL", "Unreal", "Names that begin with UCX: its importer takes them as the model's collision"),
               ("GODOT", "Godot", "Names that end with -convcolonly: its importer makes bodies with shapes of them"),
               ("UNITY", "Unity", "Names with collider, for children that get a convex Mesh Collider there"),
               ("RIGID_BODY", "Rigid Body", "Blender's own: the model falls and rolls, and its hulls are its shape")])

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.row().prop(self, "by", expand=True)
        layout.prop(self, "error" if self.by == "ERROR" else "hulls")
        for name in ("vertices", "primitives", "engine"):
            layout.prop(self, name)

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy) -> None:
        extent = float(np.linalg.norm(np.ptp(hierarchy.vertices, axis=0)))
        limit = {"error": self.error / 100 * extent} if self.by == "ERROR" else {"hulls": self.hulls}
        convex_parts = hierarchy.convex_parts(**limit, max_vertices=self.vertices)
        objects = hulls.create_hulls(context, obj, convex_parts, self.engine, self.primitives / 100 * extent)
        volume_ratio = sum(part.hull_volume() for part in convex_parts) / hierarchy.summary.volume
        text = rpt_("{count} convex hulls around {name}, together of {times:.2f} times its volume.")
        self.report({"INFO"}, text.format(count=len(objects), name=obj.name, times=volume_ratio))


CLASSES = (MESH_OT_partwheel_convex,)
