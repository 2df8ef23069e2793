# SPDX-License-Identifier: GPL-3.0-or-later
"""object.partwheel_unite: unites placed parts and the object they were placed on into one mesh."""

import bpy

from ..parts import builds
from . import union
from ..mesh import Refused, poll_in_modes, remove_object, report_errors
from ..translations.lookup import rpt_

NOTHING_TO_UNITE = "In Object Mode, select the parts, and then the mesh object to unite them with."


def find_parts(operator: bpy.types.Operator) -> None:
    """Starts a search for the parts of the active object, whose mesh the operator has just united."""
    try:
        builds.cancel_outdated()  # of the earlier union, when Adjust Last Operation repeats the operator
        bpy.ops.mesh.partwheel_find("INVOKE_DEFAULT")
    except Exception as error:  # any: the union is done anyway
        operator.report({"WARNING"}, str(error))


class OBJECT_OT_partwheel_unite(bpy.types.Operator):
    """Unite the other selected objects with the active one into a single mesh, closed if possible"""

    bl_idname = "object.partwheel_unite"
    bl_label = "Unite Solids"
    bl_options = {"REGISTER", "UNDO"}

    blend: bpy.props.FloatProperty(
        name="Blend", description="Width of a smooth transition on either side of each seam, in radii of the seam; "
                                  "0: the seam stays a crease", min=0, soft_max=1)
    build: bpy.props.BoolProperty(
        name="Find Parts", description="Find the parts of the united mesh afterward, in the background",
        default=True)
    keep: bpy.props.BoolProperty(name="Keep Parts", description="Keep the other objects")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        # Not whether others are selected: the operator removes them, and Blender polls before it repeats an operator.
        return poll_in_modes(cls, context, {"OBJECT"}, NOTHING_TO_UNITE)

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        target = context.active_object
        others = [obj for obj in context.selected_objects if obj != target and obj.type == "MESH"]
        if not others:
            raise Refused(NOTHING_TO_UNITE)
        for sentence in union.loss_messages(target, others):
            self.report({"WARNING"}, sentence)
        solver = union.unite(target, others, self.blend)
        if not self.keep:
            for other in others:
                remove_object(other)
        if self.build:
            find_parts(self)
        text = (rpt_("{name} is now one mesh with {count:,} faces (solver {solver}). It isn't closed: there are holes, "
                     "or edges with more than two faces.") if union.find_defect(target.data) else
                rpt_("{name} is now one closed mesh with {count:,} faces (solver {solver})."))
        self.report({"INFO"}, text.format(name=target.name, count=len(target.data.polygons), solver=solver))
        return {"FINISHED"}
