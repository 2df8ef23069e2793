# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows users the faces and vertices that an error of the library names: selected in Edit Mode, else in words."""

import bmesh
import bpy
import numpy as np

from ..translations.lookup import rpt_


def point_out(obj: bpy.types.Object, error: Exception) -> str:
    """Select the faces or vertices of the object's current mesh that an error names and nothing else, in Edit Mode, as
    an undo step. Return a sentence on that; outside Edit Mode on where they are, how many, and how to select them. ""
    if the error names none."""
    faces, vertices = (list(dict.fromkeys(getattr(error, kind, ()))) for kind in ("faces", "vertices"))
    if not faces and not vertices:
        return ""
    if obj.mode == "EDIT":
        _select(obj, faces, vertices)
        return (rpt_("Faces that are the cause are selected: {count}.") if faces else
                rpt_("Vertices that are the cause are selected: {count}.")).format(count=len(faces or vertices))
    mesh = obj.data
    points = [mesh.polygons[face].center for face in faces] or [mesh.vertices[vertex].co for vertex in vertices]
    place = np.mean([obj.matrix_world @ point for point in points], axis=0)
    sentences = [(rpt_("Faces that are the cause: {count}, numbers {numbers}.") if faces else
                  rpt_("Vertices that are the cause: {count}, numbers {numbers}.")).format(
                      count=len(points), numbers=", ".join(map(str, faces or vertices)))]
    if np.isfinite(place).all():
        sentences.append(rpt_("They are near {place} in the scene.").format(
            place=", ".join(f"{value:.4g}" for value in place)))
    return " ".join([*sentences, rpt_("To select them, find the parts in Edit Mode.")])


def _select(obj: bpy.types.Object, faces: list[int], vertices: list[int]) -> None:
    settings = bpy.context.tool_settings
    bm = bmesh.from_edit_mesh(obj.data)
    for elements in (bm.faces, bm.edges, bm.verts):
        for element in elements:
            element.select_set(False)
    bm.select_history.clear()
    if not faces and not settings.mesh_select_mode[0]:
        settings.mesh_select_mode = True, False, False
        bm = bmesh.from_edit_mesh(obj.data)
    elements = bm.faces if faces else bm.verts
    elements.ensure_lookup_table()
    for index in faces or vertices:
        elements[index].hide_set(False)
        elements[index].select_set(True)
    bm.select_flush_mode()
    if faces:
        bm.faces.active = bm.faces[faces[0]]
    bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)
    bpy.ops.ed.undo_push(message="Select Faulty Faces" if faces else "Select Faulty Vertices")
