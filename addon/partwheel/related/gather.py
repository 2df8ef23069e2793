# SPDX-License-Identifier: GPL-3.0-or-later
"""Box and lasso for whole parts: Blender's own gestures select faces, then each touched part is selected or
deselected as a whole. The part of a face is the wheel stop at the level of the last pick."""

from collections import Counter

import bpy
import numpy as np

from ..mesh import MeshSnapshot, NeedsEditMode, Selections
from ..parts import picks
from ..pick import states
from ..pick.build import build_and_wait
from ..view import picking
from partwheel import Hierarchy

MAX_SAMPLES = 20_000  # faces whose parts are looked up, a quarter of a second
MIN_TOUCHED_FRACTION = 0.1  # of a part's faces, or of all touched faces: with fewer touched, a part is not taken
_selections_before = []  # the Selections before the gesture, between the first and the last step of a macro
MODES = [("SET", "Set", "Select these parts and nothing else"), ("ADD", "Extend", "Add these parts to the selection"),
         ("SUB", "Subtract", "Remove these parts from the selection")]


class MESH_OT_partwheel_gather_begin(NeedsEditMode, bpy.types.Operator):
    """Store the current selection"""

    bl_idname = "mesh.partwheel_gather_begin"
    bl_label = "Parts: Store Selection"
    bl_options = {"INTERNAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        _selections_before[:] = [Selections(map(MeshSnapshot, context.objects_in_mode_unique_data))]
        return {"FINISHED"}


class MESH_OT_partwheel_gather(NeedsEditMode, bpy.types.Operator):
    """Select the whole parts that a gesture touched"""

    bl_idname = "mesh.partwheel_gather"
    bl_label = "Whole Parts"
    bl_options = {"INTERNAL"}

    mode: bpy.props.EnumProperty(
        name="Mode", description="How the parts change the current selection", items=MODES, default="SET")

    def execute(self, context: bpy.types.Context) -> set[str]:
        selections = _selections_before.pop()
        touched = selections.restore_changed(self.mode == "SET")
        parts = {obj: self._touched_parts(context, obj, faces) for obj, faces in touched.items()}
        if any(faces is None for faces in parts.values()):
            return {"CANCELLED"}
        selections.select_in_each(parts, self.mode == "ADD", self.mode == "SUB")
        return {"FINISHED"}

    def _touched_parts(self, context: bpy.types.Context, obj: bpy.types.Object,
                       touched: np.ndarray) -> np.ndarray | None:
        """The faces of all parts with touched faces; None, with a report, if the object has no parts."""
        if not len(touched):
            return touched
        snapshot = MeshSnapshot(obj)
        hierarchy = build_and_wait(self, context, snapshot)
        if not hierarchy:
            return None
        view = context.region_data  # None without a window
        polygons, matrix = obj.data.polygons, obj.matrix_world

        def view_size(face: int) -> float:
            return picking.measure_view(matrix, view, matrix @ polygons[face].center) if view else 0.0

        level = 0  # notches of the pick from what the click alone takes in this view
        if pick := picks.get_pick(snapshot):
            stops, start = pick.hierarchy.wheel(pick.face, view_size(pick.face))
            level = np.flatnonzero(stops == pick.node)[0] - start if pick.node in stops else 0
        step = len(touched) // MAX_SAMPLES + 1
        nodes = {face: states.pick_face(hierarchy, face, level, view_size(face)).node for face in touched[::step].tolist()}
        return _union_of_nodes(hierarchy, nodes, step)


def _union_of_nodes(hierarchy: Hierarchy, node_of_face: dict[int, int], step: int) -> np.ndarray:
    """The union of the nodes' faces. node_of_face: {touched face: its node}, of each step-th touched face. Nodes with
    most touched faces come first; faces already in the union don't count again, so a few faces at a fingertip for
    which a click takes the hand don't add it."""
    is_inside = np.zeros(len(hierarchy.order), bool)
    touched, nodes = (np.array(list(items)) for items in (node_of_face.keys(), node_of_face.values()))
    for node, _ in sorted(Counter(node_of_face.values()).items(), key=lambda items: (-items[1], items[0])):
        n_new = np.count_nonzero(~is_inside[touched[nodes == node]])
        faces = hierarchy.faces(node)
        if n_new and n_new >= MIN_TOUCHED_FRACTION * min(len(touched), len(faces) / step):
            is_inside[faces] = True
    return np.flatnonzero(is_inside)


class MESH_OT_partwheel_box(NeedsEditMode, bpy.types.Macro):
    """Select all parts (segments, regions) that a box touches, at the level of the last pick"""

    bl_idname = "mesh.partwheel_box"
    bl_label = "Select Parts by Box"
    bl_options = {"REGISTER", "UNDO"}


class MESH_OT_partwheel_lasso(NeedsEditMode, bpy.types.Macro):
    """Select all parts (segments, regions) that a lasso touches, at the level of the last pick"""

    bl_idname = "mesh.partwheel_lasso"
    bl_label = "Select Parts by Lasso"
    bl_options = {"REGISTER", "UNDO"}


def register() -> None:
    for macro, gesture in ((MESH_OT_partwheel_box, "VIEW3D_OT_select_box"),
                           (MESH_OT_partwheel_lasso, "VIEW3D_OT_select_lasso")):
        for step in ("MESH_OT_partwheel_gather_begin", gesture, "MESH_OT_partwheel_gather"):
            macro.define(step)


def unregister() -> None:
    _selections_before.clear()
