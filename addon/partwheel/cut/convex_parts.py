# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_convex, mesh.partwheel_convex_part: convex hulls around the model, or one part, for collisions."""

from typing import Any

import bpy
import numpy as np

from ..mesh import Computation, Steps
from ..mesh.labels import SOURCES, read_labels
from ..pick.build import BuildsFirst
from ..solid.copy_part import PartOperator, PartsOperator
from ..translations.lookup import rpt_
from . import hulls
from partwheel import ConvexPart, Hierarchy
from partwheel.cut import Cut


class HullProperties:
    """Properties of operators that create hulls."""

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
    keep_open: bpy.props.FloatProperty(
        name="Keep Open", description="Radius of a ball, relative as for Error: openings that it passes stay free, as "
                                      "far as there are enough hulls; 0: any", min=0, max=100, subtype="PERCENTAGE")
    primitives: bpy.props.FloatProperty(
        name="Primitives", description="Replace a hull by a box, sphere, capsule or cylinder within this distance "
                                       "from it, relative as for Error; 0: hulls only", min=0, max=100,
        subtype="PERCENTAGE")
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
        for name in ("vertices", "keep_open", "primitives", "engine"):
            layout.prop(self, name)

    def _create(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy,
                groups: list[hulls.HullGroup]) -> None:
        share = _diagonal(hierarchy) / 100
        tolerance = self.error if self.by == "ERROR" else self.keep_open
        objects = hulls.create_hulls(context, obj, groups, self.engine, self.primitives * share, tolerance * share)
        parts = [part for group in groups for part in group.parts]
        text = rpt_("{count} convex hulls around {name} with {times:.2f} times its volume.")
        self.report({"INFO"}, text.format(count=len(objects), name=obj.name, times=hulls.volume_ratio(parts)))
        n_covering = sum((part.error or 0) > self.keep_open / 100 * _diagonal(hierarchy) for part in parts)
        if self.keep_open and n_covering:
            text = rpt_("{count} hulls may cover openings that the ball passes. Ask for more hulls.")
            self.report({"WARNING"}, text.format(count=n_covering))


class MESH_OT_partwheel_convex(HullProperties, PartsOperator, BuildsFirst, bpy.types.Operator):
    """Create convex hulls that fit tightly around the model, as children of it, for collisions in game engines"""

    bl_idname = "mesh.partwheel_convex"
    bl_label = "Convex Parts"

    each: bpy.props.EnumProperty(
        name="For Each", description="What gets hulls of its own: as many, or as close, each",
        items=[("MODEL", "Model", "The whole model"), *((source, *SOURCES[source]) for source in SOURCES if source != "ATTRIBUTE")])

    def draw(self, context: bpy.types.Context) -> None:
        super().draw(context)
        self.layout.prop(self, "each")

    def plan(self, obj: bpy.types.Object, hierarchy: Hierarchy) -> Steps:
        if self.each == "MODEL":
            return (yield _compute(self, hierarchy))
        cut, parts = Cut.from_labels(hierarchy, read_labels(obj, self.each).of_face), []
        for number in range(len(cut)):
            parts += yield _compute(self, hierarchy, slices=np.stack(cut.slices(number), axis=1))
        return parts

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy,
            convex_parts: list[ConvexPart]) -> None:
        self._create(context, obj, hierarchy, [hulls.HullGroup(convex_parts)])


class MESH_OT_partwheel_convex_part(HullProperties, PartOperator, BuildsFirst, bpy.types.Operator):
    """Create convex hulls around the picked part, with a count or error of its own; the rest keeps its number of hulls"""

    bl_idname = "mesh.partwheel_convex_part"
    bl_label = "Convex Parts of This Part"

    def plan(self, obj: bpy.types.Object, hierarchy: Hierarchy) -> Steps:
        part = hierarchy.tet_slice(self.node)
        other_parts, n_replaced = hulls.find_other_parts(obj, part)
        groups = [hulls.HullGroup((yield _compute(self, hierarchy, slices=[part])), part)]
        rest = hulls.find_rest([part, *other_parts], len(hierarchy.tetrahedra))
        if n_replaced and rest:
            groups.append(hulls.HullGroup((yield _compute(self, hierarchy, hulls=n_replaced, error=None, slices=rest))))
        return groups

    def run(self, context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy,
            groups: list[hulls.HullGroup]) -> None:
        self._create(context, obj, hierarchy, groups)


def _compute(options: HullProperties, hierarchy: Hierarchy, **part: Any) -> Computation:
    """part: options of Hierarchy.convex_parts() in place of these."""
    diagonal = _diagonal(hierarchy)
    limit = {"error": options.error / 100 * diagonal} if options.by == "ERROR" else {"hulls": options.hulls}
    return Computation(hierarchy.convex_parts, **{**limit, **part}, max_vertices=options.vertices,
                       keep_open=options.keep_open / 100 * diagonal)


def _diagonal(hierarchy: Hierarchy) -> float:
    return float(np.linalg.norm(np.ptp(hierarchy.vertices, axis=0)))
