# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_select: picking in Edit Mode."""

import bpy
import numpy as np

from ..mesh import MeshSnapshot, NeedsEditMode, Selections
from ..view import keys
from .face_picker import EditModePicker
from .pick import PartPicker
from . import states


class MESH_OT_partwheel_select(NeedsEditMode, PartPicker, bpy.types.Operator):
    """Pick a part of the mesh with a click, then make it larger or smaller with the mouse wheel"""

    bl_idname = "mesh.partwheel_select"
    bl_label = "Select Part by Wheel"
    commands, picker = keys.COMMANDS, EditModePicker()

    def _apply(self, context: bpy.types.Context, obj: bpy.types.Object, faces: np.ndarray,
               picked: states.PickedPart) -> set[str]:
        self.create_target(context, MeshSnapshot(obj)).select(obj, faces, picked.face, self.extend, self.deselect, picked.group)
        return {"FINISHED"}

    def create_target(self, context: bpy.types.Context, snapshot: MeshSnapshot) -> Selections:
        return Selections.of_edited(context, snapshot)

    def on_miss(self, context: bpy.types.Context) -> set[str]:
        """As with Blender's select tools, a click that misses all meshes deselects all."""
        selections = Selections.of_edited(context, MeshSnapshot(context.edit_object, trust_reports=True))
        if self.extend or self.deselect or not selections.any():
            return {"CANCELLED"}
        selections.select(context.edit_object, [])
        return {"FINISHED"}

    def _commit(self, context: bpy.types.Context) -> set[str]:
        """Make the object of the part the active one, as Blender's selecting does."""
        context.view_layer.objects.active = self._find_object(context)
        return {"FINISHED"}
