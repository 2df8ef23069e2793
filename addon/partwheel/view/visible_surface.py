# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen of an object: the triangles that Blender draws, with modifiers, poses and shape keys, and the face of
the object's own mesh that each belongs to.

Where modifiers make other polygons, a double of the object is evaluated for a moment, in a scene of its own, on whose
faces their numbers are written: modifiers copy those as any other attribute. The user's own data is not touched.
"""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
from typing import NamedTuple

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from ..mesh import temporary_scene, arrays

NO_FACE = -1
SOURCE_FACE_ATTRIBUTE = "partwheel_origin"  # of each face of the double: its number + 1, for 0 is what faces from elsewhere get
# Modifiers that may lose it, for they make the surface anew about where it was; and how far beside that of before a new
# triangle may lie, as a share of the bounding box's diagonal.
REMESHING_MODIFIERS, MAX_SOURCE_DISTANCE = {"NODES", "REMESH", "SKIN"}, 0.03


class VisibleSurface(NamedTuple):
    """positions (V,3) float32 in the object's own space; triangles (T,3); faces (T,) the face of the object's mesh that
    each belongs to, NO_FACE where modifiers have put it there. What is hidden is left out."""

    positions: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray


class _EvaluatedMesh(NamedTuple):
    """What modifiers make of a mesh; faces: those of the result. origins (F,): as ORIGIN tells, NO_FACE for those from
    elsewhere; None if it is lost."""

    positions: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    topology: bytes
    origins: np.ndarray


def compute_visible_surface(obj: bpy.types.Object) -> VisibleSurface:
    """The Seen of an object. In Edit Mode its mesh must be up to date. Not to be called while Blender draws."""
    mesh, sculpted = obj.data, None
    if obj.mode == "EDIT":
        return _remove_hidden_faces(obj, arrays.read_displayed_positions(obj), *arrays.read_triangles(mesh))
    if obj.mode == "SCULPT":
        if not (obj.modifiers or mesh.shape_keys or obj.parent_type in {"ARMATURE", "LATTICE"}):
            # Then strokes go into the mesh itself, and Blender draws that.
            positions = arrays.read(mesh.vertices, "co", np.float32, 3)
            return _remove_hidden_faces(obj, positions, *arrays.read_triangles(mesh))
        sculpted = find_sculpted_multires(obj)
    if sculpted:
        with _temporary_copy(obj) as (double, layer):
            _set_sculpt_levels(double, sculpted.name)
            result = _evaluate_mesh(double, temporary_scene.update_depsgraph(layer))
            return _remove_hidden_faces(obj, result.positions, result.triangles, _find_source_faces(double, layer, result))
    result = _evaluate_mesh(obj, bpy.context.evaluated_depsgraph_get())
    faces = result.faces
    if result.topology != arrays.compute_fingerprint(mesh).topology:
        with _temporary_copy(obj) as (double, layer):
            faces = _find_source_faces(double, layer, result)
    return _remove_hidden_faces(obj, result.positions, result.triangles, faces)


def find_sculpted_multires(obj: bpy.types.Object) -> bpy.types.Modifier | None:
    """The multires modifier whose levels Sculpt Mode works on, or None."""
    return next((each for each in obj.modifiers
                 if each.type == "MULTIRES" and each.show_viewport and each.sculpt_levels), None)


def _remove_hidden_faces(obj: bpy.types.Object, positions: np.ndarray, triangles: np.ndarray,
                         faces: np.ndarray) -> VisibleSurface:
    hidden = arrays.read(obj.data.polygons, "hide", bool)
    if obj.mode != "OBJECT" and hidden.any():
        kept = (faces == NO_FACE) | ~hidden[faces]
        triangles, faces = triangles[kept], faces[kept]
    return VisibleSurface(positions, triangles, faces)


def _evaluate_mesh(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> _EvaluatedMesh:
    """The _Evaluated of an object as it is now."""
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        layer = mesh.attributes.get(SOURCE_FACE_ATTRIBUTE)
        kept = layer is not None and layer.domain == "FACE"
        return _EvaluatedMesh(arrays.read(mesh.vertices, "co", np.float32, 3), *arrays.read_triangles(mesh),
                              arrays.compute_fingerprint(mesh).topology,
                              arrays.read(layer.data, "value", np.int32) - 1 if kept else None)
    finally:
        evaluated.to_mesh_clear()


@contextlib.contextmanager
def _temporary_copy(obj: bpy.types.Object) -> Iterator[tuple[bpy.types.Object, bpy.types.ViewLayer]]:
    """(an object that is evaluated as this one is in Object Mode, its faces numbered; the view layer that it is in):
    gone afterwards."""
    arrays.flush_sculpt_strokes(obj)
    mesh, double = obj.data.copy(), obj.copy()
    try:
        double.data = mesh
        numbers = arrays.ensure_attribute(mesh, SOURCE_FACE_ATTRIBUTE, "INT", "FACE")
        numbers.data.foreach_set("value", np.arange(1, len(mesh.polygons) + 1, dtype=np.int32))
        with temporary_scene.create_temporary_scene(double) as layer:
            yield double, layer
    finally:
        bpy.data.objects.remove(double)
        bpy.data.meshes.remove(mesh)


def _set_sculpt_levels(double: bpy.types.Object, name: str) -> None:
    """Sets a double's modifiers as Sculpt Mode shows them for the multires modifier of this name."""
    after = False
    for modifier in double.modifiers:
        if modifier.name == name:
            modifier.levels, after = modifier.sculpt_levels, True
        elif after:
            modifier.show_viewport = False


def _find_source_faces(double: bpy.types.Object, layer: bpy.types.ViewLayer, result: _EvaluatedMesh) -> np.ndarray:
    """(T,) the face that each triangle of an _Evaluated comes from, NO_FACE where that can't be told; double, layer: as
    of _double(), of the object that it was made of."""
    numbered = _evaluate_mesh(double, temporary_scene.update_depsgraph(layer))
    if numbered.topology == result.topology and numbered.origins is not None:
        return numbered.origins[result.faces]
    for modifier in double.modifiers:
        if modifier.type in REMESHING_MODIFIERS:
            modifier.show_viewport = False
    before = _evaluate_mesh(double, temporary_scene.update_depsgraph(layer))
    if before.origins is None:
        return np.full(len(result.faces), NO_FACE)
    tree = BVHTree.FromPolygons(before.positions.tolist(), before.triangles.tolist(), all_triangles=True)
    limit = MAX_SOURCE_DISTANCE * float(np.linalg.norm(np.ptp(before.positions, axis=0)))
    nearest = (tree.find_nearest(place, limit)[2] for place in
               result.positions[result.triangles].mean(axis=1).tolist())
    origins = before.origins[before.faces]
    return np.array([NO_FACE if index is None else origins[index] for index in nearest], np.int32)
