# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender mesh as numpy arrays: as it is, without modifiers, in its object's own space. Only reads, but for normals.
Where the cage shows it under modifiers is asked for by name."""

import contextlib
import hashlib
from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from partwheel.polygons import triangulate
from partwheel.weld import weld_coincident_vertices
from .mesh_identity import mesh_key

# Modifiers whose mesh begins with the vertices of the one that they are given, moved or not.
VERTEX_PRESERVING_MODIFIERS = {"ARRAY", "MIRROR", "MULTIRES", "SOLIDIFY", "SUBSURF",
                               "ARMATURE", "CAST", "CORRECTIVE_SMOOTH", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM", "LAPLACIANSMOOTH",
                               "LATTICE", "MESH_DEFORM", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH", "SURFACE_DEFORM", "WARP", "WAVE"}
# A triangle's doubled area by the square of its longest side; below this it is taken for one without area.
DEGENERATE_RATIO = 1e-9


class MeshSurface(NamedTuple):
    """What Hierarchy.build() takes: vertices (V,3), triangles (T,3), faces (T,) the polygon of each triangle."""

    vertices: np.ndarray
    triangles: np.ndarray
    faces: np.ndarray
    face_count: int


is_writing_back = False  # while Blender tells of a change of geometry that is none: edits were written back into a mesh
# Within use_snapshot(): the meshes that are up to date, by key and mode: the Fingerprint of each, or None before that is
# asked for.
_reading = None


@contextlib.contextmanager
def use_snapshot():
    """Within it Blender writes its edits back into each mesh only once, half a second for a million faces, and the mesh
    is hashed only once, for all who ask. For a step of the add-on's, in which nobody else runs: what changes a mesh
    meanwhile says changed(), as parts.changes does for all that Blender tells of."""
    global _reading
    before, _reading = _reading, {} if _reading is None else _reading
    try:
        yield
    finally:
        _reading = before


def invalidate_snapshot():
    """What was read is not to be used any more, for a mesh, or what is selected in it, is another."""
    if _reading:
        _reading.clear()


def mark_up_to_date(obj):
    """Within use_snapshot(): update_mesh(obj) was asked for in an earlier step, and nothing of its geometry has changed since."""
    _reading[mesh_key(obj.data), obj.mode] = None


def update_mesh(obj):
    """The object's mesh; in Edit Mode after Blender wrote the edits back into it. Same order of elements in both. Not to
    be called while Blender draws."""
    if obj.mode == "EDIT" and not (_reading and (mesh_key(obj.data), obj.mode) in _reading):
        _write_back(obj.update_from_editmode)
        if _reading is not None:
            _reading[mesh_key(obj.data), obj.mode] = None
    return obj.data


def flush_sculpt_strokes(obj):
    """In Sculpt Mode the strokes on a multires modifier's levels are in the mesh then. Not to be called while Blender draws."""
    if obj.mode == "SCULPT":
        _write_back(bpy.ops.ed.flush_edits)


def _write_back(write):
    global is_writing_back
    layer = bpy.context.view_layer
    layer.update()  # what was edited before is told of first
    is_writing_back = True
    try:
        write()
        layer.update()
    finally:
        is_writing_back = False


# What Blender keeps as a layer, most of it since 4.0, and copies from there a hundred times faster: (its name, its field, its
# type). "select" and "hide" have one for each kind of elements.
_LAYERS = {"co": ("position", "vector", "FLOAT_VECTOR"), "vertex_index": (".corner_vert", "value", "INT"),
           "edge_index": (".corner_edge", "value", "INT"),
           "select": (".select_{kind}", "value", "BOOLEAN"), "hide": (".hide_{kind}", "value", "BOOLEAN")}
_KINDS = {"MeshVertices": "vert", "MeshEdges": "edge", "MeshPolygons": "poly"}
# What Blender copies as one block, ten times faster, if it is asked for without a sign.
_UNSIGNED = {"vertex_index", "edge_index", "vertices", "loop_start", "loop_total", "polygon_index"}


def read(collection, attribute, dtype, width=1):
    """One attribute of all elements: (n,) or (n, width)."""
    values = np.empty(len(collection) * width, dtype)
    layer, field = _find_layer(collection, attribute)
    if layer:
        layer.data.foreach_get(field, values)
    else:
        collection.foreach_get(attribute, values.view(np.uint32) if attribute in _UNSIGNED else values)
    return values if width == 1 else values.reshape(-1, width)


def write(collection, attribute, values):
    """Sets one attribute of all elements: values (n,) or (n, width), int32 where they are numbers of elements."""
    values = np.ascontiguousarray(values).ravel()
    layer, field = _find_layer(collection, attribute)
    if layer:
        layer.data.foreach_set(field, values)
    else:
        collection.foreach_set(attribute, values.view(np.uint32) if attribute in _UNSIGNED else values)


def make_mask(count, indices):
    """(count,) bool: True at these indices, an array or a list of any shape."""
    result = np.zeros(count, bool)
    result[np.asarray(indices, np.int64)] = True
    return result


def _find_layer(collection, attribute):
    """(what Blender keeps this attribute as, its field), or (None, "")."""
    if attribute not in _LAYERS or not isinstance(collection.data, bpy.types.Mesh):
        return None, ""
    name, field, kept_as = _LAYERS[attribute]
    layer = collection.data.attributes.get(name.format(kind=_KINDS.get(collection.bl_rna.identifier)))
    # Blender 5.0.1 may give that of the selected edges a wrong type. In Edit Mode a layer has no elements.
    fits = layer and layer.data_type == kept_as and len(layer.data) == len(collection)
    return (layer, field) if fits else (None, "")


def read_edge_vertices(mesh):
    """(E,2)"""
    return read(mesh.edges, "vertices", np.int32, 2)


def read_polygon_sizes(mesh):
    """((F,) the first corner of each polygon, (F,) how many it has)"""
    begin = read(mesh.polygons, "loop_start", np.int32)
    return begin, np.diff(begin, append=np.int32(len(mesh.loops)))


def mask_elements_of_faces(mesh, chosen, elements="vertices", index="vertex_index"):
    """(V,) or (E,) bool: the mesh's vertices or edges that faces have; chosen (F,) bool: which."""
    corners = np.repeat(chosen, read_polygon_sizes(mesh)[1])
    return make_mask(len(getattr(mesh, elements)), read(mesh.loops, index, np.int32)[corners])


def add_coincident_vertices(mesh, chosen):
    """(V,) bool: the vertices chosen (V,) bool, and those that are welded with them (partwheel.weld)."""
    old_to_new = weld_coincident_vertices(read(mesh.vertices, "co", np.float32, 3), read_triangles(mesh)[0])
    return make_mask(len(chosen), old_to_new[chosen])[old_to_new]


def find_attribute(mesh, name, kind, domain):
    """The mesh's attribute of this name, data type and domain, or None: others may have given the name to another one."""
    found = mesh.attributes.get(name)
    return found if found and (found.data_type, found.domain) == (kind, domain) else None


def ensure_attribute(mesh, name, kind, domain):
    """The same, made in place of whatever has its name."""
    found = find_attribute(mesh, name, kind, domain)
    if not found and name in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[name])
    return found or mesh.attributes.new(name, kind, domain)


def read_material_indices(mesh):
    """(F,)"""
    layer = find_attribute(mesh, "material_index", "INT", "FACE")
    return read(layer.data, "value", np.int32) if layer else np.zeros(len(mesh.polygons), np.int32)


def write_material_indices(mesh, indices):
    if indices.any() or find_attribute(mesh, "material_index", "INT", "FACE"):
        ensure_attribute(mesh, "material_index", "INT", "FACE").data.foreach_set("value", indices)


def read_triangles(mesh):
    """((T,3) the vertices of Blender's triangles, (T,) the polygon of each)"""
    if len(mesh.loops) == 3 * len(mesh.polygons):
        begin, sizes = read_polygon_sizes(mesh)
        if (sizes == 3).all():
            return read(mesh.loops, "vertex_index", np.int32).reshape(-1, 3), np.arange(len(begin), dtype=np.int32)
    mesh.calc_loop_triangles()
    return (read(mesh.loop_triangles, "vertices", np.int32, 3),
            read(mesh.loop_triangles, "polygon_index", np.int32))


def read_surface(mesh):
    """The mesh's surface as Blender triangulates it, save for polygons of which it makes triangles without area (three
    corners on a line do that). With shape keys it is the basis, whichever key is shown."""
    vertices = read(mesh.vertices, "co", np.float32, 3).astype(np.float64)
    corner_vertices, faces = read_triangles(mesh)
    thin = np.unique(faces[_is_degenerate(vertices, corner_vertices)]) if len(faces) > len(mesh.polygons) else faces[:0]
    again = [(face, triangle) for face in thin.tolist() for triangle in _triangulate_polygon(mesh.polygons[face], vertices)]
    if again:
        kept = ~np.isin(faces, thin)
        corner_vertices = np.vstack([corner_vertices[kept], np.array([triangle for _, triangle in again], np.int32)])
        faces = np.concatenate([faces[kept], np.array([face for face, _ in again], np.int32)])
    return MeshSurface(vertices, corner_vertices, faces, len(mesh.polygons))


def _is_degenerate(vertices, triangles):
    """(T,) whether a triangle has no area to speak of. Coordinate by coordinate: numpy's own cross product takes four times
    as long, which millions of them are held up by."""
    ends = [vertices[:, k][triangles] for k in range(3)]
    ab, ac = ([each[:, k] - each[:, 0] for each in ends] for k in (1, 2))
    bc = [far - near for near, far in zip(ab, ac)]
    normal = [ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2], ab[0] * ac[1] - ab[1] * ac[0]]
    squared = [sum(each * each for each in side) for side in (normal, ab, ac, bc)]
    return np.sqrt(squared[0]) <= DEGENERATE_RATIO * np.maximum(np.maximum(squared[1], squared[2]), squared[3])


def _triangulate_polygon(polygon, vertices):
    corners = list(polygon.vertices)
    return triangulate(vertices[corners], corners)


def read_custom_normals(mesh):
    """(L,3) of each loop, if the mesh has normals set by hand; else None."""
    if not mesh.has_custom_normals:
        return None
    if hasattr(mesh, "corner_normals"):
        return read(mesh.corner_normals, "vector", np.float32, 3)
    mesh.calc_normals_split()
    normals = read(mesh.loops, "normal", np.float32, 3)
    mesh.free_normals_split()
    return normals


def write_custom_normals(mesh, normals):
    """normals (L,3): of each loop; 0, 0, 0: as Blender computes it."""
    if hasattr(mesh, "use_auto_smooth"):  # before Blender 4.1
        mesh.use_auto_smooth = True
    mesh.normals_split_custom_set(normals)


class Fingerprint(NamedTuple):
    """What a hierarchy depends on, as digests of 16 bytes. topology: which polygons use which vertices, the same
    wherever the vertices are. positions: where they are."""

    topology: bytes
    positions: bytes


def compute_fingerprint(mesh):
    topology = hashlib.blake2b(np.int64(len(mesh.vertices)).tobytes(), digest_size=16)
    topology.update(read_polygon_sizes(mesh)[1])
    topology.update(read(mesh.loops, "vertex_index", np.int32))
    positions = hashlib.blake2b(read(mesh.vertices, "co", np.float32, 3), digest_size=16)
    return Fingerprint(topology.digest(), positions.digest())


def current_fingerprint(obj):
    """The Fingerprint of the object's mesh, brought up to date."""
    mesh = update_mesh(obj)
    reading = {} if _reading is None else _reading
    name = mesh_key(mesh), obj.mode
    reading[name] = reading.get(name) or compute_fingerprint(mesh)
    return reading[name]


def find_cage_modifiers(obj):
    """The object's modifiers that act in Edit Mode, if any of them is shown on the cage, else none."""
    acting = [each for each in obj.modifiers if each.show_viewport and each.show_in_editmode]
    return acting if any(each.show_on_cage for each in acting) else []


def read_cage_positions(obj):
    """(V,3) float32: where modifiers on the cage show the vertices in Edit Mode, in the object's own space; None
    without such modifiers, or if it can't be told. Not to be called while Blender draws.

    Blender lets nobody ask for the cage, so this is the mesh after all modifiers; those after the cage move it little.
    """
    modifiers = find_cage_modifiers(obj) if obj.mode == "EDIT" else []
    if not modifiers:
        return None
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh, count = evaluated.to_mesh(), len(bmesh.from_edit_mesh(obj.data).verts)
    try:
        keeping = len(mesh.vertices) >= count and all(each.type in VERTEX_PRESERVING_MODIFIERS for each in modifiers)
        if not keeping and len(mesh.vertices) != count:
            return None
        return read(mesh.vertices, "co", np.float32, 3)[:count]
    finally:
        evaluated.to_mesh_clear()


def read_edited_positions(obj):
    """(V,3) float32: the vertices that an edit of the object moves, in its own space: those of the active shape key, if
    it has one. The mesh must be up to date."""
    key = obj.active_shape_key
    return read(key.data if key else obj.data.vertices, "co", np.float32, 3)


def read_displayed_positions(obj):
    """(V,3) float32: where the vertices are shown in Edit Mode, in the object's own space: of the shape key that is
    edited, or of the cage. The mesh must be up to date. Not to be called while Blender draws."""
    cage = read_cage_positions(obj)
    return read_edited_positions(obj) if cage is None else cage
