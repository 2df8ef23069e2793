# SPDX-License-Identifier: GPL-3.0-or-later
"""object.partwheel_unite: placed parts and the object they were placed on become one closed mesh."""

import bpy

from ..parts import builds
from . import union
from partwheel import Error
from ..mesh.datablocks import dispose
from ..mesh.poll import check_poll, poll_is_editable
from ..words.say import rpt_

NO_OTHERS = "Select the parts, and then the mesh object that they are to become part of, in Object Mode."


def find_parts(operator):
    """Has the parts of the active object found, whose mesh is a union that this operator made."""
    try:
        builds.drop_outdated()  # of the union before, when the last operation is repeated with other options
        bpy.ops.mesh.partwheel_find("INVOKE_DEFAULT")
    except Exception as error:  # any: they are united all the same
        operator.report({"WARNING"}, str(error))


class OBJECT_OT_partwheel_unite(bpy.types.Operator):
    """Unite the other selected solids with the active one into a single closed mesh"""

    bl_idname = "object.partwheel_unite"
    bl_label = "Unite Solids"
    bl_options = {"REGISTER", "UNDO"}

    blend: bpy.props.FloatProperty(
        name="Blend", description="Width of a smooth transition on either side of each seam, times the seam's radius; "
        "0: the seam stays a crease", default=0, min=0, soft_max=1)
    build: bpy.props.BoolProperty(
        name="Find Parts", description="Find the parts of the united mesh at once, in a process of its own",
        default=True)
    keep: bpy.props.BoolProperty(name="Keep Parts", description="Leave the other objects as they are", default=False)

    @classmethod
    def poll(cls, context):
        # Not that others are selected: afterwards they are gone, and Blender polls before it repeats an operator.
        target = context.active_object
        return check_poll(cls, context.mode == "OBJECT" and target is not None and target.type == "MESH",
                          NO_OTHERS) and poll_is_editable(cls, target)

    @staticmethod
    def others(context):
        return [obj for obj in context.selected_objects if obj != context.active_object and obj.type == "MESH"]

    def execute(self, context):
        target, others = context.active_object, self.others(context)
        if not others:
            self.report({"ERROR"}, rpt_(NO_OTHERS))
            return {"CANCELLED"}
        for sentence in union.losses(target, others):
            self.report({"WARNING"}, sentence)
        try:
            solver = union.unite(target, others, self.blend)
        except Error as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if not self.keep:
            for other in others:
                dispose(other)
        if self.build:
            find_parts(self)
        self.report({"INFO"}, rpt_("{name} is one closed mesh now, of {count:,} faces (solver {solver}).").format(
            name=target.name, count=len(target.data.polygons), solver=solver.title()))
        return {"FINISHED"}


CLASSES = (OBJECT_OT_partwheel_unite,)
