# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender mesh as numpy arrays: without modifiers, in the space of its object. Reads only, except for write
functions.

read_cage_positions() alone takes modifiers into account. V, E, L and F count vertices, edges, loops (corners) and
polygons of the mesh, T its triangles."""

import hashlib
from collections.abc import Callable, Sequence
from typing import NamedTuple

import bmesh
import bpy
from mathutils.kdtree import KDTree
import numpy as np

from partwheel.components import to_mask
from partwheel.polygons import triangulate
from partwheel.weld import weld_coincident_vertices
from .elements import (find_attribute, read, read_attribute, read_corner_vertices, read_edge_vertices as read_edge_vertices,
                       read_positions, write as write)
from .marks import describe_marks
from .mesh_state import ignore_reports

# Modifiers whose result begins with the vertices of their input, moved or not.
VERTEX_PRESERVING_MODIFIERS = {
    "ARRAY", "MIRROR", "MULTIRES", "SOLIDIFY", "SUBSURF", "ARMATURE", "CAST", "CORRECTIVE_SMOOTH", "CURVE", "DISPLACE",
    "HOOK", "LAPLACIANDEFORM", "LAPLACIANSMOOTH", "LATTICE", "MESH_DEFORM", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH",
    "SURFACE_DEFORM", "WARP", "WAVE"}
# A triangle is degenerate if twice its area, divided by the square of its longest side, is at most this.
DEGENERATE_RATIO = 1e-9


class MeshSurface(NamedTuple):
    """The arguments of Hierarchy.build()."""

    vertices: np.ndarray  # (V, 3) float64
    triangles: np.ndarray  # (T, 3) int32
    faces: np.ndarray  # (T,) int32, the polygon of each triangle
    face_count: int  # of polygons


class Fingerprint(NamedTuple):
    """Digests of 16 bytes of what a hierarchy depends on."""

    topology: bytes  # which polygons use which vertices, independent of where the vertices are
    positions: bytes  # where they are, and the marks in use


def update_mesh(obj: bpy.types.Object) -> bpy.types.Mesh:
    """Return the object's mesh; in Edit Mode, write the edits back into it first, which takes half a second for a million
    faces. The order of elements stays the same. Must not be called while Blender draws."""
    if obj.mode == "EDIT":
        _write_back(obj.update_from_editmode)
    return obj.data


def flush_sculpt_strokes(obj: bpy.types.Object) -> None:
    """In Sculpt Mode, write strokes on the levels of Multiresolution into the mesh. Not while Blender draws."""
    if obj.mode == "SCULPT":
        _write_back(bpy.ops.ed.flush_edits)


def _write_back(write: Callable[[], object]) -> None:
    layer = bpy.context.view_layer
    layer.update()  # so that earlier edits are reported first
    with ignore_reports():
        write()
        layer.update()


def make_mask(count: int, indices: np.ndarray | Sequence) -> np.ndarray:
    """Return a (count,) bool array that is True at the indices, an array or list of any shape."""
    return to_mask(count, np.asarray(indices, np.int64))


def read_polygon_sizes(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return (first corner of each polygon (F,), number of its corners (F,))."""
    begin = read(mesh.polygons, "loop_start", np.int32)
    return begin, np.diff(begin, append=np.int32(len(mesh.loops)))


def mask_elements_of_faces(mesh: bpy.types.Mesh, is_chosen: np.ndarray, elements: str = "vertices",
                           index: str = "vertex_index") -> np.ndarray:
    """Return a mask (V,) or (E,) of the vertices or edges of the chosen faces, is_chosen (F,)."""
    corners = np.repeat(is_chosen, read_polygon_sizes(mesh)[1])
    return make_mask(len(getattr(mesh, elements)), read(mesh.loops, index, np.int32)[corners])


def find_coincident_vertices(mesh: bpy.types.Mesh, positions: np.ndarray | None = None, sheets: bool = False) -> np.ndarray:
    """Return old_to_new (V,) of partwheel.weld.weld_coincident_vertices(). positions (V, 3): instead of the mesh's own."""
    positions = read_positions(mesh) if positions is None else positions
    return weld_coincident_vertices(positions, read_triangles(mesh)[0], sheets)


def ensure_attribute(mesh: bpy.types.Mesh, name: str, kind: str, domain: str) -> bpy.types.Attribute:
    """Return the attribute as find_attribute() does; if missing, create it, replacing any other of its name."""
    attribute = find_attribute(mesh, name, kind, domain)
    if not attribute and name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    return attribute or mesh.attributes.new(name, kind, domain)


def read_face_integers(mesh: bpy.types.Mesh, name: str) -> np.ndarray | None:
    """Return the values of a face attribute, (F,) int32, or None without it. Also in Edit Mode, where only a bmesh has them."""
    if mesh.is_editmode:
        faces = bmesh.from_edit_mesh(mesh).faces
        layer = faces.layers.int.get(name)
        return None if layer is None else np.array([face[layer] for face in faces], np.int32)
    return read_attribute(mesh, name, "INT", "FACE")


def read_material_indices(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the material slot of each polygon, (F,) int32."""
    indices = read_attribute(mesh, "material_index", "INT", "FACE")
    return np.zeros(len(mesh.polygons), np.int32) if indices is None else indices


def write_material_indices(mesh: bpy.types.Mesh, indices: np.ndarray) -> None:
    if indices.any() or find_attribute(mesh, "material_index", "INT", "FACE"):
        ensure_attribute(mesh, "material_index", "INT", "FACE").data.foreach_set("value", indices)


def read_triangles(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return (vertices of Blender's triangles (T, 3) int32, polygon of each (T,) int32)."""
    if len(mesh.loops) == 3 * len(mesh.polygons):
        starts, sizes = read_polygon_sizes(mesh)
        if (sizes == 3).all():
            return read_corner_vertices(mesh).reshape(-1, 3), np.arange(len(starts), dtype=np.int32)
    mesh.calc_loop_triangles()
    return (read(mesh.loop_triangles, "vertices", np.int32, 3),
            read(mesh.loop_triangles, "polygon_index", np.int32))


def create_kd_tree(positions: np.ndarray, numbers: np.ndarray | None = None) -> KDTree:
    """Return a tree that finds the nearest of the positions (n, 3), with these numbers (n,) or 0 to n - 1."""
    tree = KDTree(len(positions))
    for number, position in zip(range(len(positions)) if numbers is None else numbers.tolist(), positions.tolist()):
        tree.insert(position, number)
    tree.balance()
    return tree


def mesh_volume(mesh: bpy.types.Mesh) -> float:
    """Return the volume that the mesh encloses, in its own unit cubed."""
    return enclosed_volume(read_positions(mesh).astype(float), read_triangles(mesh)[0])


def enclosed_volume(vertices: np.ndarray, triangles: np.ndarray) -> float:
    """Return the volume inside these triangles (n, 3), below 0 if they are inside out; 0 without vertices."""
    if not len(vertices):
        return 0.0
    centered = vertices - vertices.mean(axis=0)
    a, b, c = (centered[column] for column in triangles.T)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def read_surface(mesh: bpy.types.Mesh) -> MeshSurface:
    """Return the MeshSurface of the mesh, triangulated by Blender. Polygons of which Blender makes degenerate
    triangles, for example with three collinear corners, are triangulated again. With shape keys the positions are those
    of the basis."""
    vertices = read_positions(mesh).astype(np.float64)
    corner_vertices, faces = read_triangles(mesh)
    degenerate = np.unique(faces[_is_degenerate(vertices, corner_vertices)]) if len(faces) > len(mesh.polygons) else faces[:0]
    polygons = [(face, list(mesh.polygons[face].vertices)) for face in degenerate.tolist()]
    retriangulated = [(face, triangle) for face, corners in polygons for triangle in triangulate(vertices[corners], corners)]
    if retriangulated:
        is_kept = ~np.isin(faces, degenerate)
        corner_vertices = np.vstack([corner_vertices[is_kept], np.array([triangle for _, triangle in retriangulated], np.int32)])
        faces = np.concatenate([faces[is_kept], np.array([face for face, _ in retriangulated], np.int32)])
    return MeshSurface(vertices, corner_vertices, faces, len(mesh.polygons))


def _is_degenerate(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return a mask (T,) of the degenerate triangles. Works coordinate by coordinate: np.cross takes four times as
    long, noticeable for millions of triangles."""
    ends = [vertices[:, k][triangles] for k in range(3)]
    ab, ac = ([end[:, k] - end[:, 0] for end in ends] for k in (1, 2))
    bc = [far - near for near, far in zip(ab, ac)]
    normal = [ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]]
    squared = [sum(component * component for component in side) for side in (normal, ab, ac, bc)]
    return np.sqrt(squared[0]) <= DEGENERATE_RATIO * np.maximum(np.maximum(squared[1], squared[2]), squared[3])


def read_custom_normals(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """Return the normal of each loop, (L, 3) float32, if the mesh has custom normals; else None."""
    if not mesh.has_custom_normals:
        return None
    if hasattr(mesh, "corner_normals"):
        return read(mesh.corner_normals, "vector", np.float32, 3)
    mesh.calc_normals_split()
    normals = read(mesh.loops, "normal", np.float32, 3)
    mesh.free_normals_split()
    return normals


def write_custom_normals(mesh: bpy.types.Mesh, normals: np.ndarray) -> None:
    """Set the normal of each loop, (L, 3); a zero vector means the normal that Blender computes."""
    if hasattr(mesh, "use_auto_smooth"):  # before Blender 4.1
        mesh.use_auto_smooth = True
    mesh.normals_split_custom_set(normals)


def compute_fingerprint(mesh: bpy.types.Mesh, obj: bpy.types.Object | None = None) -> Fingerprint:
    """Hash the mesh, O(V + E + L). It must be up to date. obj: an object with it, if it is in Edit Mode."""
    topology = hashlib.blake2b(np.int64(len(mesh.vertices)).tobytes(), digest_size=16)
    topology.update(read_polygon_sizes(mesh)[1])
    topology.update(read_corner_vertices(mesh))
    positions = hashlib.blake2b(read_positions(mesh), digest_size=16)
    positions.update(describe_marks(mesh, obj))
    return Fingerprint(topology.digest(), positions.digest())


def find_cage_modifiers(obj: bpy.types.Object) -> list[bpy.types.Modifier]:
    """Return the modifiers that act in Edit Mode, if at least one of them is shown on the cage; else []."""
    modifiers = [modifier for modifier in obj.modifiers if modifier.show_viewport and modifier.show_in_editmode]
    return modifiers if any(modifier.show_on_cage for modifier in modifiers) else []


def read_cage_positions(obj: bpy.types.Object) -> np.ndarray | None:
    """Return the vertex positions on the cage that Edit Mode shows, (V, 3) float32, in the space of the object. None
    without modifiers on the cage, or if they don't preserve vertices. Blender gives no access to the cage, so this is
    the mesh after all modifiers; those after the cage move it little. Must not be called while Blender draws."""
    modifiers = find_cage_modifiers(obj) if obj.mode == "EDIT" else []
    if not modifiers:
        return None
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh, count = evaluated.to_mesh(), len(bmesh.from_edit_mesh(obj.data).verts)
    try:
        are_preserved = len(mesh.vertices) >= count and all(
            modifier.type in VERTEX_PRESERVING_MODIFIERS for modifier in modifiers)
        if not are_preserved and len(mesh.vertices) != count:
            return None
        return read_positions(mesh)[:count]
    finally:
        evaluated.to_mesh_clear()


def read_edited_positions(obj: bpy.types.Object) -> np.ndarray:
    """Return the vertex positions that an edit changes, (V, 3) float32, in the space of the object: those of the active
    shape key, if there is one. The mesh must be up to date."""
    key = obj.active_shape_key
    return read(key.data if key else obj.data.vertices, "co", np.float32, 3)
