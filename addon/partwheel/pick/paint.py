# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_paint: a part becomes a face set, mask, vertex group or paint mask, in the modes that have them."""

import bpy
import numpy as np

from ..mesh import Refused, poll_in_modes
from ..view.visible_surface import find_sculpted_multires
from ..translations.lookup import iface_
from .face_picker import PaintModePicker
from .pick import PartPicker
from .writers import HAS_CONTENT, HAS_LEVEL_MASKS, WRITERS, write_level_mask
from . import states

# Mode of the context -> what a part can become; the first is the default.
TARGETS_BY_MODE = {
    "SCULPT": ("MASK", "FACE_SET"), "PAINT_WEIGHT": ("VERTEX_GROUP", "PAINT_MASK"), "PAINT_VERTEX": ("PAINT_MASK",),
    "PAINT_TEXTURE": ("PAINT_MASK",),
}
TARGET_LABELS = {"MASK": "Mask", "FACE_SET": "Face Set", "VERTEX_GROUP": "Vertex Group", "PAINT_MASK": "Paint Mask"}


class MESH_OT_partwheel_paint(PartPicker, bpy.types.Operator):
    """Pick a part with a click and the mouse wheel, and make it a face set, a mask or a vertex group"""

    bl_idname = "mesh.partwheel_paint"
    bl_label = "Part by Wheel"
    picker = PaintModePicker(TARGETS_BY_MODE)

    write: bpy.props.EnumProperty(
        name="Create", default="AUTO", description="What the part becomes",
        items=(("AUTO", "Automatic", "A mask in Sculpt Mode, a vertex group in Weight Paint, else a paint mask"),
               ("MASK", TARGET_LABELS["MASK"], "Masked against sculpting"),
               ("FACE_SET", TARGET_LABELS["FACE_SET"], "A new face set"),
               ("VERTEX_GROUP", TARGET_LABELS["VERTEX_GROUP"], "Weight 1 in a new vertex group named after the part; Extend adds "
                "it to the active group, Deselect removes it from there"),
               ("PAINT_MASK", TARGET_LABELS["PAINT_MASK"], "The only faces that can be painted on")))

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_in_modes(cls, context, TARGETS_BY_MODE, "Go to Sculpt Mode or a paint mode of a mesh first.")

    def _apply(self, context: bpy.types.Context, obj: bpy.types.Object, faces: np.ndarray,
               picked: states.PickedPart) -> set[str]:
        return self._write(context, obj, faces, picked.node)

    def on_miss(self, context: bpy.types.Context) -> set[str]:
        """As in Edit Mode, a click that misses the mesh clears the mask."""
        obj, target_kind = context.active_object, self._get_target_kind(context)
        has_content = target_kind in HAS_CONTENT and (
            HAS_CONTENT[target_kind](obj.data)
            or HAS_LEVEL_MASKS and target_kind == "MASK" and find_sculpted_multires(obj))
        if self.extend or self.deselect or not has_content:
            return {"CANCELLED"}
        return self._write(context, obj, [], -1)

    def _get_target_kind(self, context: bpy.types.Context) -> str:
        return TARGETS_BY_MODE[context.mode][0] if self.write == "AUTO" else self.write

    def _write(self, context: bpy.types.Context, obj: bpy.types.Object, faces: np.ndarray | list,
               node: int) -> set[str]:
        target_kind = self._get_target_kind(context)
        if target_kind not in TARGETS_BY_MODE[context.mode]:
            raise Refused("{results} can't be created in this mode. Choose something else in Create.",
                          results=iface_(TARGET_LABELS[target_kind]))
        levels = target_kind == "MASK" and find_sculpted_multires(obj)
        if levels and not HAS_LEVEL_MASKS:
            raise Refused("Here, Blender can't write and undo a mask of the multires modifier's levels. Make the part a face set "
                          "instead: the tool's header and the menu Face Sets have it.")
        # Sculpt Mode has its own data besides the mesh, and reads the mesh only when it is entered.
        sculpting = context.mode == "SCULPT"
        if sculpting:
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            write = write_level_mask if levels else WRITERS[target_kind]
            message = write(obj, faces, node, self.extend, self.deselect)
        finally:
            if sculpting:
                bpy.ops.object.mode_set(mode="SCULPT")
        if message:
            self.report({"INFO"}, message)
        return {"FINISHED"}
