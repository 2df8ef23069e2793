# SPDX-License-Identifier: GPL-3.0-or-later
"""The visible surface of an object: the triangles that Blender draws, with modifiers, poses and shape keys, and the
face of the object's own mesh that each triangle belongs to.

Where modifiers change polygons, a temporary copy of the object is evaluated in a scene of its own. Its faces carry
their indices as an attribute, which modifiers copy like any other. The user's data is not touched."""

from collections.abc import Iterator
import contextlib
from typing import NamedTuple

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from ..mesh import arrays, local_copy, temporary_scene

NO_FACE = -1
SOURCE_FACE_ATTRIBUTE = "partwheel_origin"  # face index + 1; generated faces get 0
# Modifiers that may lose the attribute because they create a new surface near the old one; and the maximum distance of a
# new triangle from it, as a fraction of the bounding box's diagonal.
REMESHING_MODIFIERS, MAX_SOURCE_DISTANCE = {"NODES", "REMESH", "SKIN"}, 0.03


class VisibleSurface(NamedTuple):
    """The visible surface, without hidden faces."""

    positions: np.ndarray  # (V, 3) float32 in the space of the object
    triangles: np.ndarray  # (T, 3)
    faces: np.ndarray  # (T,) the object's face of each triangle; NO_FACE if modifiers have generated it


class _EvaluatedMesh(NamedTuple):
    """The result of the modifiers."""

    positions: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray  # (T,) of the result
    topology: bytes
    origins: np.ndarray | None  # (F,) source face of each face; NO_FACE if generated; None if the attribute was lost


def compute_visible_surface(obj: bpy.types.Object) -> VisibleSurface:
    """Return the VisibleSurface; in Edit Mode of the mesh, which must be up to date. Not while Blender draws."""
    mesh, sculpted = obj.data, None
    if obj.mode == "EDIT":
        cage = arrays.read_cage_positions(obj)
        positions = arrays.read_edited_positions(obj) if cage is None else cage
        return _remove_hidden_faces(obj, positions, *arrays.read_triangles(mesh))
    if obj.mode == "SCULPT":
        if not (obj.modifiers or mesh.shape_keys or obj.parent_type in {"ARMATURE", "LATTICE"}):
            # Strokes change the mesh itself, and Blender draws that.
            positions = arrays.read_positions(mesh)
            return _remove_hidden_faces(obj, positions, *arrays.read_triangles(mesh))
        sculpted = find_sculpted_multires(obj)
    if sculpted:
        with _temporary_copy(obj) as (copy, layer):
            _set_sculpt_levels(copy, sculpted.name)
            result = _evaluate_mesh(copy, temporary_scene.update_depsgraph(layer))
            return _remove_hidden_faces(obj, result.positions, result.triangles, _find_source_faces(copy, layer, result))
    result = _evaluate_mesh(obj, bpy.context.evaluated_depsgraph_get())
    faces = result.faces
    if result.topology != arrays.compute_fingerprint(mesh).topology:
        with _temporary_copy(obj) as (copy, layer):
            faces = _find_source_faces(copy, layer, result)
    return _remove_hidden_faces(obj, result.positions, result.triangles, faces)


def read_displayed_triangles(obj: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Return (positions (V, 3) float32 in the space of the object, triangles (T, 3)) as Object Mode and Edit Mode display
    them, without the faces that they belong to, which takes less time. Must not be called while Blender draws."""
    if obj.mode == "EDIT":
        arrays.update_mesh(obj)
        surface = compute_visible_surface(obj)
        return surface.positions, surface.triangles
    result = _evaluate_mesh(obj, bpy.context.evaluated_depsgraph_get())
    return result.positions, result.triangles


def find_sculpted_multires(obj: bpy.types.Object) -> bpy.types.Modifier | None:
    """Return the Multiresolution modifier whose levels Sculpt Mode edits, or None."""
    return next((modifier for modifier in obj.modifiers
                 if modifier.type == "MULTIRES" and modifier.show_viewport and modifier.sculpt_levels), None)


def _remove_hidden_faces(obj: bpy.types.Object, positions: np.ndarray, triangles: np.ndarray,
                         faces: np.ndarray) -> VisibleSurface:
    hidden = arrays.read(obj.data.polygons, "hide", bool)
    if obj.mode != "OBJECT" and hidden.any():
        is_shown = (faces == NO_FACE) | ~hidden[faces]
        triangles, faces = triangles[is_shown], faces[is_shown]
    return VisibleSurface(positions, triangles, faces)


def _evaluate_mesh(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> _EvaluatedMesh:
    """Return the _EvaluatedMesh of an object in its current state."""
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        numbers = arrays.read_attribute(mesh, SOURCE_FACE_ATTRIBUTE, "INT", "FACE")
        return _EvaluatedMesh(arrays.read_positions(mesh), *arrays.read_triangles(mesh),
                              arrays.compute_fingerprint(mesh).topology,
                              None if numbers is None else numbers - 1)
    finally:
        evaluated.to_mesh_clear()


@contextlib.contextmanager
def _temporary_copy(obj: bpy.types.Object) -> Iterator[tuple[bpy.types.Object, bpy.types.ViewLayer]]:
    """Yield (copy of the object as Object Mode evaluates it, with numbered faces; its view layer). Removed at the end."""
    arrays.flush_sculpt_strokes(obj)
    mesh, copy = local_copy(obj.data), obj.copy()
    try:
        copy.data = mesh
        numbers = arrays.ensure_attribute(mesh, SOURCE_FACE_ATTRIBUTE, "INT", "FACE")
        numbers.data.foreach_set("value", np.arange(1, len(mesh.polygons) + 1, dtype=np.int32))
        with temporary_scene.create_temporary_scene(copy) as layer:
            yield copy, layer
    finally:
        bpy.data.objects.remove(copy)
        bpy.data.meshes.remove(mesh)


def _set_sculpt_levels(copy: bpy.types.Object, name: str) -> None:
    """Set the copy's modifiers as Sculpt Mode shows them for the Multiresolution modifier of this name."""
    after = False
    for modifier in copy.modifiers:
        if modifier.name == name:
            modifier.levels, after = modifier.sculpt_levels, True
        elif after:
            modifier.show_viewport = False


def _find_source_faces(copy: bpy.types.Object, layer: bpy.types.ViewLayer, result: _EvaluatedMesh) -> np.ndarray:
    """Return the source face (T,) of each triangle of an _EvaluatedMesh; NO_FACE if unknown. copy, layer: from
    _temporary_copy() of the same object."""
    numbered = _evaluate_mesh(copy, temporary_scene.update_depsgraph(layer))
    if numbered.topology == result.topology and numbered.origins is not None:
        return numbered.origins[result.faces]
    for modifier in copy.modifiers:
        if modifier.type in REMESHING_MODIFIERS:
            modifier.show_viewport = False
    before = _evaluate_mesh(copy, temporary_scene.update_depsgraph(layer))
    if before.origins is None:
        return np.full(len(result.faces), NO_FACE)
    tree = BVHTree.FromPolygons(before.positions.tolist(), before.triangles.tolist(), all_triangles=True)
    limit = MAX_SOURCE_DISTANCE * float(np.linalg.norm(np.ptp(before.positions, axis=0)))
    nearest = (tree.find_nearest(place, limit)[2] for place in
               result.positions[result.triangles].mean(axis=1).tolist())
    origins = before.origins[before.faces]
    return np.array([NO_FACE if index is None else origins[index] for index in nearest], np.int32)
