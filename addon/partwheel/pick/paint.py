# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_paint: a part becomes a face set, a mask, a vertex group or a paint mask, in the modes that have them."""

import bpy

from ..mesh.refusing import Refused, can, changeable
from .pick import PartPicker
from .preview import Preview
from .writers import WRITERS
from ..words.say import iface_, rpt_

# Mode of the context -> what a part can become there, the first by default.
WAYS = {
    "SCULPT": ("FACE_SET", "MASK"), "PAINT_WEIGHT": ("VERTEX_GROUP", "PAINT_MASK"), "PAINT_VERTEX": ("PAINT_MASK",),
    "PAINT_TEXTURE": ("PAINT_MASK",),
}
BECOMES = {"FACE_SET": "Face Set", "MASK": "Mask", "VERTEX_GROUP": "Vertex Group", "PAINT_MASK": "Paint Mask"}


class MESH_OT_partwheel_paint(PartPicker, bpy.types.Operator):
    """Pick a part with a click and the mouse wheel, and make it a face set, a mask or a vertex group"""

    bl_idname = "mesh.partwheel_paint"
    bl_label = "Part by Wheel"
    bl_options = {"REGISTER", "UNDO"}

    write: bpy.props.EnumProperty(
        name="Make It", default="AUTO", description="What the part becomes",
        items=(("AUTO", "Usual", "A face set in Sculpt Mode, a vertex group in Weight Paint, else a paint mask"),
               ("FACE_SET", BECOMES["FACE_SET"], "A new face set"),
               ("MASK", BECOMES["MASK"], "Masked against sculpting"),
               ("VERTEX_GROUP", BECOMES["VERTEX_GROUP"], "Weight 1 in a new vertex group, named after the part; with Extend in "
                "the active one, with Deselect none there"),
               ("PAINT_MASK", BECOMES["PAINT_MASK"], "The only faces that can be painted on")),
    )

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return (can(cls, context.mode in WAYS and obj is not None and obj.type == "MESH",
                    "This is for Sculpt Mode and the paint modes of a mesh.")
                and changeable(cls, obj)
                and can(cls, not obj.use_dynamic_topology_sculpting,
                        "Dynamic topology changes the faces all the time: switch it off first."))

    def _apply(self, context, obj, faces, picked):
        return self._write(context, obj, faces, picked.node)

    def _objects(self, context):
        return [context.active_object] if context.mode in WAYS else []

    def _aim(self, context, obj):
        return Preview(obj)

    def _commit(self, context):
        return self._write(context, self._object(context), self.faces, self.state.node)

    def _write(self, context, obj, faces, node):
        ways = WAYS[context.mode]
        way = ways[0] if self.write == "AUTO" else self.write
        if way not in ways:
            self.report({"ERROR"}, rpt_("Parts can't become this in this mode: {made}.").format(made=iface_(BECOMES[way])))
            return {"CANCELLED"}
        # Sculpt Mode keeps data of its own beside the mesh's: it reads the mesh anew when it is entered.
        sculpting = context.mode == "SCULPT"
        if sculpting:
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            said = WRITERS[way](obj, faces, node, self.extend, self.deselect)
        except Refused as reason:
            self.report({"ERROR"}, str(reason))
            return {"CANCELLED"}
        finally:
            if sculpting:
                bpy.ops.object.mode_set(mode="SCULPT")
        if said:
            self.report({"INFO"}, said)
        return {"FINISHED"}


CLASSES = (MESH_OT_partwheel_paint,)
