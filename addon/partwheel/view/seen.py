# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen of an object: the triangles that Blender draws, with modifiers, poses and shape keys, and the face of
the object's own mesh that each belongs to.

Where modifiers make other polygons, a double of the object is evaluated for a moment, in a scene of its own, on whose
faces their numbers are written: modifiers copy those as any other attribute. The user's own data is not touched.
"""

import contextlib
from typing import NamedTuple

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from ..mesh import apart, arrays

NO_FACE = -1
ORIGIN = "partwheel_origin"  # of each face of the double: its number + 1, for 0 is what faces from elsewhere get
# Modifiers that may lose it, for they make the surface anew about where it was; and how far beside that of before a new
# triangle may lie, as a share of the bounding box's diagonal.
REMAKING, BESIDE = {"NODES", "REMESH", "SKIN"}, 0.03


class Seen(NamedTuple):
    """positions (V,3) float32 in the object's own space; triangles (T,3); faces (T,) the face of the object's mesh that
    each belongs to, NO_FACE where modifiers have put it there. What is hidden is left out."""

    positions: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray


class _Evaluated(NamedTuple):
    """What modifiers make of a mesh; faces: those of the result. origins (F,): as ORIGIN tells, NO_FACE for those from
    elsewhere; None if it is lost."""

    positions: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    topology: bytes
    origins: np.ndarray


def seen(obj):
    """The Seen of an object. In Edit Mode its mesh must be up to date. Not to be called while Blender draws."""
    mesh, sculpted = obj.data, None
    if obj.mode == "EDIT":
        return _visible(obj, arrays.shown_positions(obj), *arrays.triangles(mesh))
    if obj.mode == "SCULPT":
        if not (obj.modifiers or mesh.shape_keys or obj.parent_type in {"ARMATURE", "LATTICE"}):
            # Then strokes go into the mesh itself, and Blender draws that.
            positions = arrays.read(mesh.vertices, "co", np.float32, 3)
            return _visible(obj, positions, *arrays.triangles(mesh))
        sculpted = sculpted_levels(obj)
    if sculpted:
        with _double(obj) as (double, layer):
            _as_sculpted(double, sculpted.name)
            result = _evaluated(double, apart.depsgraph(layer))
            return _visible(obj, result.positions, result.triangles, _origins(double, layer, result))
    result = _evaluated(obj, bpy.context.evaluated_depsgraph_get())
    faces = result.faces
    if result.topology != arrays.fingerprint(mesh).topology:
        with _double(obj) as (double, layer):
            faces = _origins(double, layer, result)
    return _visible(obj, result.positions, result.triangles, faces)


def sculpted_levels(obj):
    """The multires modifier whose levels Sculpt Mode works on, or None."""
    return next((each for each in obj.modifiers
                 if each.type == "MULTIRES" and each.show_viewport and each.sculpt_levels), None)


def _visible(obj, positions, triangles, faces):
    hidden = arrays.read(obj.data.polygons, "hide", bool)
    if obj.mode != "OBJECT" and hidden.any():
        kept = (faces == NO_FACE) | ~hidden[faces]
        triangles, faces = triangles[kept], faces[kept]
    return Seen(positions, triangles, faces)


def _evaluated(obj, depsgraph):
    """The _Evaluated of an object as it is now."""
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        layer = mesh.attributes.get(ORIGIN)
        kept = layer is not None and layer.domain == "FACE"
        return _Evaluated(arrays.read(mesh.vertices, "co", np.float32, 3), *arrays.triangles(mesh),
                          arrays.fingerprint(mesh).topology,
                          arrays.read(layer.data, "value", np.int32) - 1 if kept else None)
    finally:
        evaluated.to_mesh_clear()


@contextlib.contextmanager
def _double(obj):
    """(an object that is evaluated as this one is in Object Mode, its faces numbered; the view layer that it is in): gone
    afterwards."""
    arrays.strokes_up_to_date(obj)
    mesh, double = obj.data.copy(), obj.copy()
    try:
        double.data = mesh
        numbers = arrays.needed_attribute(mesh, ORIGIN, "INT", "FACE")
        numbers.data.foreach_set("value", np.arange(1, len(mesh.polygons) + 1, dtype=np.int32))
        with apart.scene_apart(double) as layer:
            yield double, layer
    finally:
        bpy.data.objects.remove(double)
        bpy.data.meshes.remove(mesh)


def _as_sculpted(double, name):
    """Sets a double's modifiers as Sculpt Mode shows them for the multires modifier of this name."""
    after = False
    for modifier in double.modifiers:
        if modifier.name == name:
            modifier.levels, after = modifier.sculpt_levels, True
        elif after:
            modifier.show_viewport = False


def _origins(double, layer, result):
    """(T,) the face that each triangle of an _Evaluated comes from, NO_FACE where that can't be told; double, layer: as of
    _double(), of the object that it was made of."""
    numbered = _evaluated(double, apart.depsgraph(layer))
    if numbered.topology == result.topology and numbered.origins is not None:
        return numbered.origins[result.faces]
    for modifier in double.modifiers:
        if modifier.type in REMAKING:
            modifier.show_viewport = False
    before = _evaluated(double, apart.depsgraph(layer))
    if before.origins is None:
        return np.full(len(result.faces), NO_FACE)
    tree = BVHTree.FromPolygons(before.positions.tolist(), before.triangles.tolist(), all_triangles=True)
    limit = BESIDE * float(np.linalg.norm(np.ptp(before.positions, axis=0)))
    nearest = (tree.find_nearest(place, limit)[2] for place in
               result.positions[result.triangles].mean(axis=1).tolist())
    origins = before.origins[before.faces]
    return np.array([NO_FACE if index is None else origins[index] for index in nearest], np.int32)
