# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_loose: deletes floating fragments below a size. Every generated mesh has them. In a window it first
shows what will be deleted; the wheel changes the size."""

import bmesh
import bpy
import numpy as np

from ..mesh import NeedsActiveMesh, Refused, arrays, element_counts, find_object, report_errors
from ..view import keys, overlay, visible_surface
from ..view.in_view import InView
from ..translations.lookup import format_percent, iface_, rpt_
from partwheel.weld import loose_parts

DEFAULT_SIZE = 0.02
SIZE_STEP = 1.25  # factor of a notch of the wheel


def find_fragment_sizes(obj: bpy.types.Object) -> np.ndarray:
    """(F,) for each face the size of the connected component that it is in: the diagonal of its bounding box, as a
    fraction of the mesh's. Coincident border edges connect. Infinite for the largest one and, in Edit Mode, for
    those with hidden faces, which stay."""
    surface = arrays.read_surface(arrays.update_mesh(obj))
    if not surface.face_count:
        return np.empty(0)
    names, label = np.unique(loose_parts(surface.vertices, surface.triangles), return_inverse=True)
    low, high = np.full((len(names), 3), np.inf), np.full((len(names), 3), -np.inf)
    for corner in surface.triangles.T:
        np.minimum.at(low, label, surface.vertices[corner])
        np.maximum.at(high, label, surface.vertices[corner])
    sizes = np.linalg.norm(high - low, axis=1)
    sizes /= max(np.linalg.norm(high.max(axis=0) - low.min(axis=0)), 1e-300)
    sizes[sizes.argmax()] = np.inf
    result = np.full(surface.face_count, np.inf)
    result[surface.faces] = sizes[label]
    if obj.mode == "EDIT":
        is_hidden = arrays.read(obj.data.polygons, "hide", bool)[surface.faces]
        result[surface.faces[np.isin(label, label[is_hidden])]] = np.inf
    return result


def delete_loose_bits(obj: bpy.types.Object, size: float) -> int:
    """Deletes the fragments of at most this size, see find_fragment_sizes(), and returns how many faces they had. In
    Edit Mode or Object Mode; all else of the mesh stays. Raises Refused if there are none."""
    sizes = find_fragment_sizes(obj)
    is_bit = sizes <= size
    if not np.isfinite(sizes).any():
        raise Refused("{name} has no loose bits. It is in one piece, or the other pieces have hidden faces: show them (Alt H).",
                      name=obj.name)
    if not is_bit.any():
        raise Refused("{name} has no loose bits of at most {size} of its size. Choose a larger size.", name=obj.name,
                      size=format_percent(size))
    view_layer = bpy.context.view_layer
    active, was_edited = view_layer.objects.active, obj.mode == "EDIT"
    if not was_edited:  # only Edit Mode keeps shape keys, custom normals and multires levels of the other faces
        view_layer.objects.active = obj
        bpy.ops.object.mode_set(mode="EDIT")
    try:
        bm = bmesh.from_edit_mesh(obj.data)
        bmesh.ops.delete(bm, geom=[face for face, bit in zip(bm.faces, is_bit.tolist()) if bit], context="FACES")
        bmesh.update_edit_mesh(obj.data)
    finally:
        if not was_edited:
            bpy.ops.object.mode_set(mode="OBJECT")
            view_layer.objects.active = active
    return int(np.count_nonzero(is_bit))


class MESH_OT_partwheel_loose(NeedsActiveMesh, InView, bpy.types.Operator):
    """Delete floating fragments below a size, such as those of generated and scanned meshes. Shows them first"""

    bl_idname = "mesh.partwheel_loose"
    bl_label = "Delete Loose Bits"
    needs_editable = True

    size: bpy.props.FloatProperty(
        name="Size", description="Largest size of a fragment, as a fraction of the size of the mesh. The largest "
                                 "connected piece always stays",
        default=DEFAULT_SIZE, min=1e-6, max=1, soft_max=0.2, precision=4)

    @report_errors
    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.active_object
        count = delete_loose_bits(obj, self.size)
        self.report({"INFO"}, rpt_("Loose bits deleted from {name}: {count:,} faces.").format(
            count=count, name=obj.name))
        return {"FINISHED"}

    # ---- With the mouse

    def on_start(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        obj = context.active_object
        self.object_name, self.mode = obj.name_full, obj.mode
        self.counts = element_counts(obj.data)
        self.sizes, self.surface = find_fragment_sizes(obj), visible_surface.compute_visible_surface(obj)
        self._add_draw_handler(self._draw)
        return self._show(context)

    def can_continue(self, context: bpy.types.Context) -> bool:
        obj = context.active_object
        return (obj is not None and obj.name_full == self.object_name and obj.mode == self.mode
                and element_counts(obj.data) == self.counts)

    def on_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in keys.WHEEL_STEPS and event.value == "PRESS" and not (event.ctrl or event.alt or event.shift):
            self.size = self.size * SIZE_STEP ** keys.WHEEL_STEPS[event.type]
            return self._show(context)
        if event.type in keys.SYSTEM or event.type in keys.MOVES or event.type in keys.NAVIGATE.events:
            return {"PASS_THROUGH"}
        if event.value != "PRESS":
            return {"RUNNING_MODAL"}
        if event.type in keys.CANCEL.events:
            return {"CANCELLED"}
        if event.type in keys.CONFIRM.events or event.type == "LEFTMOUSE":
            return self.execute(context)
        return {"RUNNING_MODAL"}

    def _show(self, context: bpy.types.Context) -> set[str]:
        is_bit = self.sizes <= self.size
        has_face = self.surface.faces != visible_surface.NO_FACE
        triangles = self.surface.triangles[has_face][is_bit[self.surface.faces[has_face]]]
        self.bits = overlay.ObjectTriangles(self.surface.positions, triangles, lambda _obj: True)
        self._show_status(context, iface_("Loose bits of at most {size} of the size: {count:,} faces").format(
            count=np.count_nonzero(is_bit), size=format_percent(self.size)), keys.LOOSE_BITS)
        overlay.redraw_views()
        return {"RUNNING_MODAL"}

    def _draw(self) -> None:
        obj = find_object(self.object_name)
        if obj and len(self.bits.triangles) and overlay.is_visible(bpy.context, obj):
            overlay.draw_object(bpy.context, obj, self.bits)
