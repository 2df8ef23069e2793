# SPDX-License-Identifier: GPL-3.0-or-later
"""Box and lasso over whole parts: Blender's own gestures, and then each part that they touched is selected, or taken
away, as a whole: the part that a click there takes, and as many notches as the part that was picked last."""

from collections import Counter

import bpy
import numpy as np

from ..mesh import arrays
from ..mesh.poll import check_poll
from ..mesh.selection import Selections
from ..parts import picks
from ..pick import states
from ..pick.build import build_and_wait

ASKED = 20_000  # of so many of the faces, a quarter of a second's worth, it is asked which part a click takes
GRAZED = 0.1  # a part of which less than this share is touched, and which is less of what is touched, is left out
_before = []  # the Selections of before the gesture, between the first and the last step of a macro
MODES = [("SET", "Set", "Select these parts and nothing else"), ("ADD", "Extend", "Add them to what is selected"),
         ("SUB", "Subtract", "Take them away from what is selected")]


class _InEditMode:
    @classmethod
    def poll(cls, context):
        return check_poll(cls, context.mode == "EDIT_MESH" and context.edit_object, "Parts are selected in Edit Mode of a mesh.")


class MESH_OT_partwheel_gather_begin(_InEditMode, bpy.types.Operator):
    """Remember what is selected"""

    bl_idname = "mesh.partwheel_gather_begin"
    bl_label = "Parts: What Is Selected"
    bl_options = {"INTERNAL"}

    def execute(self, context):
        _before[:] = [Selections(context.objects_in_mode_unique_data)]
        return {"FINISHED"}


class MESH_OT_partwheel_gather(_InEditMode, bpy.types.Operator):
    """Make of what a gesture has selected the whole parts that it touched"""

    bl_idname = "mesh.partwheel_gather"
    bl_label = "Whole Parts"
    bl_options = {"INTERNAL"}

    mode: bpy.props.EnumProperty(
        name="Mode", description="What becomes of the selection before", items=MODES, default="SET")

    def execute(self, context):
        before = _before.pop()
        with arrays.use_snapshot():
            touched = {obj: before.touched(obj, self.mode == "SET") for obj in context.objects_in_mode_unique_data}
            before.restore()
            parts = {obj: self._parts(context, obj, faces) for obj, faces in touched.items()}
            if any(faces is None for faces in parts.values()):
                return {"CANCELLED"}
            before.select_in_each(parts, self.mode == "ADD", self.mode == "SUB")
        return {"FINISHED"}

    def _parts(self, context, obj, touched):
        """The faces of all parts that touched ones belong to; None and a report if there are no parts."""
        if not len(touched):
            return touched
        hierarchy = build_and_wait(self, context, obj)
        if not hierarchy:
            return None
        level = _level(picks.get_pick(obj))
        step = len(touched) // ASKED + 1
        return _joined(hierarchy, {face: states.pick_face(hierarchy, face, level).node for face in touched[::step].tolist()},
                       step)


def _level(pick):
    """Notches from what the click alone took."""
    if not pick:
        return 0
    stops, start = pick.hierarchy.wheel(pick.face)
    return np.flatnonzero(stops == pick.node)[0] - start if pick.node in stops else 0


def _joined(hierarchy, takes, step):
    """The faces of the nodes that the touched faces take ({face: node}, of each step-th): those of most of them first. Faces in these
    already don't count any more: the few at a finger's end from which a click takes the hand."""
    inside = np.zeros(len(hierarchy.order), bool)
    touched, taken = (np.array(list(each)) for each in (takes.keys(), takes.values()))
    for node, _ in sorted(Counter(takes.values()).items(), key=lambda each: (-each[1], each[0])):
        left = np.count_nonzero(~inside[touched[taken == node]])
        faces = hierarchy.faces(node)
        if left and left >= GRAZED * min(len(touched), len(faces) / step):
            inside[faces] = True
    return np.flatnonzero(inside)


class MESH_OT_partwheel_box(_InEditMode, bpy.types.Macro):
    """Select all parts (segments, regions) that a box touches, by as many notches as the part that was picked last"""

    bl_idname = "mesh.partwheel_box"
    bl_label = "Select Parts by Box"
    bl_options = {"REGISTER", "UNDO"}


class MESH_OT_partwheel_lasso(_InEditMode, bpy.types.Macro):
    """Select all parts (segments, regions) that a lasso touches, by as many notches as the part that was picked last"""

    bl_idname = "mesh.partwheel_lasso"
    bl_label = "Select Parts by Lasso"
    bl_options = {"REGISTER", "UNDO"}


CLASSES = (MESH_OT_partwheel_gather_begin, MESH_OT_partwheel_gather, MESH_OT_partwheel_box, MESH_OT_partwheel_lasso)


def register():
    for macro, gesture in ((MESH_OT_partwheel_box, "VIEW3D_OT_select_box"),
                           (MESH_OT_partwheel_lasso, "VIEW3D_OT_select_lasso")):
        for step in ("MESH_OT_partwheel_gather_begin", gesture, "MESH_OT_partwheel_gather"):
            macro.define(step)


def unregister():
    _before.clear()
