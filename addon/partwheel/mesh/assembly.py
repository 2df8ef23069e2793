# SPDX-License-Identifier: GPL-3.0-or-later
"""Assembles a mesh from elements of another one, with all their layers, by whole arrays.

A bmesh would take ten times as long. Only copy_multires_levels() needs one: Python can't write multires displacements."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from . import arrays
from .arrays import read, read_corner_vertices, write
from partwheel.weld import is_welding
from .datablocks import copy_animation, copy_settings, has_strips_without_action, local_copy, rename

# Attribute type -> (field, dtype, width)
_TYPES = {
    "FLOAT": ("value", np.float32, 1), "INT": ("value", np.int32, 1), "INT8": ("value", np.int32, 1),
    "BOOLEAN": ("value", bool, 1), "FLOAT2": ("vector", np.float32, 2), "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT_COLOR": ("color", np.float32, 4), "BYTE_COLOR": ("color", np.float32, 4), "INT16_2D": ("value", np.int32, 2),
    "INT32_2D": ("value", np.int32, 2), "QUATERNION": ("value", np.float32, 4), "FLOAT4X4": ("value", np.float32, 16),
}
_TOPOLOGY = {"position", ".edge_verts", ".corner_vert", ".corner_edge", ".corner_normal"}
_SELECTION = {".select_vert", ".select_edge", ".select_poly"}
# Properties of elements that are no attributes in older versions: (elements, field, dtype).
_ELEMENT_PROPERTIES = []
if bpy.app.version < (5, 0, 0):
    _ELEMENT_PROPERTIES += [("edges", "use_freestyle_mark", bool), ("polygons", "use_freestyle_mark", bool)]
if bpy.app.version < (4, 0, 0):
    _ELEMENT_PROPERTIES += [("vertices", "bevel_weight", np.float32), ("edges", "bevel_weight", np.float32),
                            ("edges", "crease", np.float32), ("edges", "use_seam", bool), ("edges", "use_edge_sharp", bool),
                            ("polygons", "use_smooth", bool)]
# Layers that only a bmesh can create; newer versions lack some of them:
# collection -> (elements, bmesh elements, bmesh layer, fields: (name, dtype, width, default)).
_BMESH_LAYERS = {
    "skin_vertices": ("vertices", "verts", "skin", [("radius", np.float32, 2, 0.25), ("use_root", bool, 1, False),
                                                    ("use_loose", bool, 1, False)]),
    "vertex_paint_masks": ("vertices", "verts", "paint_mask", [("value", np.float32, 1, 0)]),
    "vertex_creases": ("vertices", "verts", "crease", [("value", np.float32, 1, 0)]),
    "face_maps": ("polygons", "faces", "face_map", [("value", np.int32, 1, -1)]),
}
if bpy.app.version >= (4, 0, 0):  # the others are attributes
    _BMESH_LAYERS = {"skin_vertices": _BMESH_LAYERS["skin_vertices"]}


@contextmanager
def edit_as_bmesh(mesh: bpy.types.Mesh | None, into: bpy.types.Mesh | None = None) -> Iterator[bmesh.types.BMesh]:
    """Yield a bmesh of the mesh, or an empty one, and write it into another mesh, or the same, at the end."""
    bm = bmesh.new()
    try:
        if mesh:
            bm.from_mesh(mesh)
        yield bm
        if into:
            bm.to_mesh(into)
    finally:
        bm.free()


class MeshPlan(NamedTuple):
    """A mesh of n vertices, L corners and P polygons, and the sources of each."""

    positions: np.ndarray  # (n, 3)
    source_vertices: np.ndarray  # (n,), -1: new
    source_loops: np.ndarray  # (L,) of each corner; -1: new
    corner_vertices: np.ndarray  # (L,) vertex of each corner
    polygon_starts: np.ndarray  # (P,) first corner of each polygon
    source_polygons: np.ndarray  # (P,), -1: new, shaded flat
    n_unchanged: int  # the first polygons, equal to their sources corner by corner
    loose_edges: np.ndarray  # (w,) source edges without a face
    old_to_new: np.ndarray  # (V,) vertex of each source vertex that those polygons or edges use
    welded_to: np.ndarray | None = None  # (V,) source vertex that each source vertex is welded to; None: itself


def assemble_mesh(mesh: bpy.types.Mesh, plan: MeshPlan, name: str, selection: bool) -> bpy.types.Mesh:
    """Return a new mesh by the plan, with the source's materials, settings, properties and, if wanted, selection."""
    result = local_copy(mesh)
    rename(result, name)
    if result.shape_keys and not has_strips_without_action(result.shape_keys):
        clear_shape_keys(result)
    result.clear_geometry()
    copy_animation(mesh, result)  # which is cleared as well
    _create_bmesh_layers(mesh, result)
    of_edge, ends, edge_from = _build_edges(mesh, plan)
    if result.shape_keys:
        with edit_as_bmesh(None, result) as bm:  # only a bmesh can add vertices to shape keys, too
            for _ in range(len(plan.positions)):
                bm.verts.new()
    else:
        result.vertices.add(len(plan.positions))
    _copy_vertex_groups(mesh, result, plan.source_vertices)
    for elements, count in ((result.edges, len(ends)), (result.loops, len(plan.corner_vertices)),
                            (result.polygons, len(plan.polygon_starts))):
        elements.add(count)
    write(result.vertices, "co", plan.positions)
    write(result.edges, "vertices", ends)
    write(result.loops, "vertex_index", plan.corner_vertices.astype(np.int32))
    write(result.loops, "edge_index", of_edge)
    write(result.polygons, "loop_start", plan.polygon_starts.astype(np.int32))
    if bpy.app.version < (4, 0, 0):
        totals = np.diff(plan.polygon_starts, append=len(plan.corner_vertices))
        write(result.polygons, "loop_total", totals.astype(np.int32))
    origins = {"POINT": plan.source_vertices, "CORNER": plan.source_loops, "EDGE": edge_from, "FACE": plan.source_polygons}
    _copy_attributes(mesh, result, origins, _TOPOLOGY if selection else _TOPOLOGY | _SELECTION)
    sources = {"vertices": plan.source_vertices, "edges": edge_from, "polygons": plan.source_polygons}
    for kind, field, dtype in _ELEMENT_PROPERTIES:
        values = read(getattr(mesh, kind), field, dtype)
        if values.any():
            getattr(result, kind).foreach_set(field, _gather(values, sources[kind]))
    _copy_bmesh_layers(mesh, result, sources)
    _copy_shape_keys(mesh, result, plan)
    _set_active_layers(result, _find_active_layers(mesh))
    result.update()
    return result


def _build_edges(mesh: bpy.types.Mesh, plan: MeshPlan) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (edge from each corner to the next (L,), vertices of the edges (m, 2), source edge of each or -1 (m,))."""
    loop_sources, count = plan.source_loops, len(plan.corner_vertices)
    numbers, all_ends = _read_loop_edges(mesh, plan.welded_to), arrays.read_edge_vertices(mesh)
    # Edges of unchanged polygons are the source's.
    rest = int(plan.polygon_starts[plan.n_unchanged]) if plan.n_unchanged < len(plan.polygon_starts) else count
    of_edge = np.empty(count, np.int32)
    source = numbers[loop_sources[:rest]]
    used_edges = np.flatnonzero(arrays.make_mask(len(all_ends), source))
    new_index = np.empty(len(all_ends), np.int32)
    new_index[used_edges] = np.arange(len(used_edges))
    of_edge[:rest] = new_index[source]
    ends = all_ends[used_edges] if plan.welded_to is None else plan.welded_to[all_ends[used_edges]]
    ends = plan.old_to_new[ends]

    # In other polygons, an edge is the source's if the next corner is the source's next one, or its previous one:
    # then it is the edge of the previous corner.
    following = np.arange(rest + 1, count + 1)
    ends_of_polygons = np.append(plan.polygon_starts[plan.n_unchanged + 1:], count)
    following[ends_of_polygons[:len(plan.polygon_starts) - plan.n_unchanged] - 1 - rest] = (
        plan.polygon_starts[plan.n_unchanged:])
    begin, totals = arrays.read_polygon_sizes(mesh)
    after = np.arange(1, len(mesh.loops) + 1, dtype=np.int32)
    after[begin + totals - 1] = begin
    loop, next_loop = loop_sources[rest:], loop_sources[following]
    is_source_edge = (loop >= 0) & (next_loop >= 0)
    is_reversed = is_source_edge & (after[next_loop] == loop) & (after[loop] != next_loop)
    is_source_edge &= is_reversed | (after[loop] == next_loop)
    source = np.where(is_source_edge, numbers[np.where(is_reversed, next_loop, loop)], -1)

    # New edges may coincide with existing ones.
    low, high = (ufunc(plan.corner_vertices[rest:], plan.corner_vertices[following])
                 for ufunc in (np.minimum, np.maximum))
    touched = arrays.make_mask(len(plan.positions), [low, high])
    near = np.flatnonzero(touched[ends[:, 0]] & touched[ends[:, 1]])
    key = np.concatenate([np.sort(ends[near], axis=1), np.stack([low, high], axis=1)]).astype(np.int64)
    unique, group = np.unique(key[:, 0] * len(plan.positions) + key[:, 1], return_inverse=True)
    group = group.ravel()
    edge = np.full(len(unique), -1)
    edge[group[:len(near)]] = near
    new = np.flatnonzero(edge < 0)
    edge[new] = len(ends) + np.arange(len(new))
    of_edge[rest:] = edge[group[len(near):]]
    edge_from = np.concatenate([used_edges, np.full(len(new), -1), plan.loose_edges])
    edge_from[of_edge[rest:][is_source_edge]] = source[is_source_edge]
    ends = np.concatenate([ends, np.stack(np.divmod(unique[new], len(plan.positions)), axis=1),
                           plan.old_to_new[all_ends[plan.loose_edges]]])
    return of_edge, ends.astype(np.int32), edge_from


def _read_loop_edges(mesh: bpy.types.Mesh, welded_to: np.ndarray | None) -> np.ndarray:
    """Return the edge of each loop, (L,). By welded_to, the first of several between the same two vertices."""
    edges = read(mesh.loops, "edge_index", np.int32)
    if welded_to is None:
        return edges
    ends = np.sort(welded_to[arrays.read_edge_vertices(mesh)], axis=1)
    _, first_edge, group = np.unique(ends, axis=0, return_index=True, return_inverse=True)
    return first_edge[group.ravel()][edges]


def _gather(values: np.ndarray, sources: np.ndarray, default: float = 0) -> np.ndarray:
    """Return the values (n,) or (n, width) of sources (n,); default where there is none (-1)."""
    gathered = values[sources]
    gathered[sources < 0] = default
    return gathered


def _copy_attributes(mesh: bpy.types.Mesh, result: bpy.types.Mesh, origins: dict[str, np.ndarray],
                     exclude: set[str]) -> None:
    layers = [(attribute.name, attribute.data_type, attribute.domain) for attribute in mesh.attributes
              if attribute.name not in exclude]
    for name, kind, domain in layers:
        sources = origins[domain]
        old, new = mesh.attributes[name], result.attributes.get(name) or result.attributes.new(name, kind, domain)
        if (new.data_type, new.domain) != (kind, domain):
            continue  # Blender itself changed it: from_pydata() of 5.0 gives .select_edge another type
        if kind == "STRING":
            for item, at in zip(new.data, sources.tolist()):
                item.value = old.data[at].value if at >= 0 else ""
            continue
        field, dtype, width = _TYPES[kind]
        gathered = _gather(read(old.data, field, dtype, width), sources)
        if name == "sharp_face":
            gathered[sources < 0] = True
        new.data.foreach_set(field, gathered.ravel())
    caps = origins["FACE"] < 0
    if bpy.app.version >= (4, 0, 0) and "sharp_face" not in mesh.attributes and caps.any():
        result.attributes.new("sharp_face", "BOOLEAN", "FACE").data.foreach_set("value", caps)
    for uv in mesh.uv_layers:
        if uv.name not in result.uv_layers:
            result.uv_layers.new(name=uv.name, do_init=False)
        if bpy.app.version < (3, 5, 0):
            new = result.uv_layers[uv.name].data
            new.foreach_set("uv", _gather(read(uv.data, "uv", np.float32, 2), origins["CORNER"]).ravel())
            new.foreach_set("pin_uv", _gather(read(uv.data, "pin_uv", bool), origins["CORNER"]))


def _create_bmesh_layers(mesh: bpy.types.Mesh, result: bpy.types.Mesh) -> None:
    """Create the layers that only a bmesh can create. The result has no elements yet."""
    names = [layer[1:3] for collection, layer in _BMESH_LAYERS.items() if len(getattr(mesh, collection))]
    if names:
        with edit_as_bmesh(None, result) as bm:
            for elements, name in names:
                getattr(getattr(bm, elements).layers, name).verify()


def _copy_bmesh_layers(mesh: bpy.types.Mesh, result: bpy.types.Mesh, origins: dict[str, np.ndarray]) -> None:
    for collection, (elements, _, _, fields) in _BMESH_LAYERS.items():
        sources = origins[elements]
        for old, new in zip(getattr(mesh, collection), getattr(result, collection)):
            for field, dtype, width, default in fields:
                gathered = _gather(read(old.data, field, dtype, width), sources, default=default)
                new.data.foreach_set(field, gathered.ravel())


@contextmanager
def _temporary_object(mesh: bpy.types.Mesh) -> Iterator[bpy.types.Object]:
    """Yield an object with the mesh, for access to its vertex groups and shape keys."""
    holder = bpy.data.objects.new("partwheel", mesh)
    try:
        yield holder
    finally:
        bpy.data.objects.remove(holder)


def _copy_vertex_groups(mesh: bpy.types.Mesh, result: bpy.types.Mesh, sources: np.ndarray) -> None:
    """Copy the weights, by a bmesh: it copies all of a vertex at once, and is cheap while there are only vertices."""
    if not _copy_group_names(mesh, result):
        return
    bare = _copy_vertices_only(mesh)
    with edit_as_bmesh(bare) as old_bm:
        bpy.data.meshes.remove(bare)
        layer = old_bm.verts.layers.deform.active
        if layer is None:  # no vertex is in a group
            return
        with edit_as_bmesh(result, result) as new_bm:
            new_layer = new_bm.verts.layers.deform.verify()
            old_verts = list(old_bm.verts)
            for vert, source in zip(new_bm.verts, sources.tolist()):
                if source >= 0:
                    vert[new_layer] = old_verts[source][layer]


def _copy_group_names(mesh: bpy.types.Mesh, result: bpy.types.Mesh) -> bool:
    """Create groups of the same names and return whether there are any."""
    with _temporary_object(mesh) as old, _temporary_object(result) as new:
        new.vertex_groups.clear()
        for group in old.vertex_groups:
            new.vertex_groups.new(name=group.name).lock_weight = group.lock_weight
        return len(old.vertex_groups) > 0


def _copy_vertices_only(mesh: bpy.types.Mesh) -> bpy.types.Mesh:
    """Return a new mesh with the vertices and their layers only. Only Blender's own validation removes faces and edges
    quickly: those whose corners are all the same vertex."""
    bare = local_copy(mesh)
    if bare.shape_keys:
        clear_shape_keys(bare)
    write(bare.loops, "vertex_index", np.zeros(len(bare.loops), np.int32))
    write(bare.edges, "vertices", np.zeros(2 * len(bare.edges), np.int32))
    if bpy.app.version < (4, 0, 0):
        write(bare.polygons, "loop_total", np.zeros(len(bare.polygons), np.int32))
    bare.validate()
    return bare


def clear_shape_keys(mesh: bpy.types.Mesh) -> None:
    """Remove all shape keys, including the data-block. Blender counts one user too many of a copied mesh's keys and
    leaves them behind; a file with such keys opens with an error."""
    keys = mesh.shape_keys
    left_behind = keys.users > 1
    with _temporary_object(mesh) as holder:
        holder.shape_key_clear()
    if left_behind:
        bpy.data.batch_remove([keys])


def _copy_shape_keys(mesh: bpy.types.Mesh, result: bpy.types.Mesh, plan: MeshPlan) -> None:
    if not mesh.shape_keys:
        return
    if not result.shape_keys:  # else the copied ones, which assemble_mesh() has kept
        _create_shape_keys(mesh.shape_keys, result)
    has_source = plan.source_vertices >= 0
    for old, new in zip(mesh.shape_keys.key_blocks, result.shape_keys.key_blocks):
        positions = plan.positions.copy()
        positions[has_source] = read(old.data, "co", np.float32, 3)[plan.source_vertices[has_source]]
        new.data.foreach_set("co", positions.ravel())


def _create_shape_keys(keys: bpy.types.Key, result: bpy.types.Mesh) -> None:
    """Create shape keys with the same settings and animation."""
    with _temporary_object(result) as holder:
        for old in keys.key_blocks:
            new = holder.shape_key_add(name=old.name, from_mix=False)
            new.slider_min, new.slider_max = old.slider_min, old.slider_max  # before the value, which they clamp
            copy_settings(old, new, {"name", "relative_key"})
        for old in keys.key_blocks:
            result.shape_keys.key_blocks[old.name].relative_key = result.shape_keys.key_blocks[old.relative_key.name]
    copy_settings(keys, result.shape_keys, {"name"})
    for name in keys.keys():
        result.shape_keys[name] = keys[name]
    copy_animation(keys, result.shape_keys)


def weld_vertices(mesh: bpy.types.Mesh, old_to_new: np.ndarray) -> None:
    """Weld vertices, old_to_new (V,), so that the surface is connected there; not if a polygon would contain a vertex
    twice. Polygons, corners and all their layers stay, in their order."""
    corners = old_to_new[read_corner_vertices(mesh)].astype(np.int32)
    polygon = np.repeat(np.arange(len(mesh.polygons)), arrays.read_polygon_sizes(mesh)[1])
    if not is_welding(old_to_new) or len(np.unique(polygon * len(old_to_new) + corners)) < len(corners):
        return
    normals = arrays.read_custom_normals(mesh)
    old_ends = arrays.read_edge_vertices(mesh)
    ends = old_to_new[old_ends].astype(np.int32)
    _, first, number = np.unique(np.sort(ends, axis=1), axis=0, return_index=True, return_inverse=True)
    edges = first[number.ravel()][read(mesh.loops, "edge_index", np.int32)].astype(np.int32)
    write(mesh.edges, "vertices", np.where((ends[:, :1] == ends[:, 1:]), old_ends, ends))
    write(mesh.loops, "vertex_index", corners)
    write(mesh.loops, "edge_index", edges)
    is_double = ~arrays.make_mask(len(ends), first)
    with edit_as_bmesh(mesh, mesh) as bm:
        doubles = [edge for edge, double in zip(bm.edges, is_double.tolist()) if double and not edge.link_faces]
        bmesh.ops.delete(bm, geom=doubles, context="EDGES")
        gone = [vert for vert, new in zip(bm.verts, old_to_new.tolist()) if new != vert.index]
        bmesh.ops.delete(bm, geom=gone, context="VERTS")
    if normals is not None:
        arrays.write_custom_normals(mesh, normals)
    mesh.update()


def copy_multires_levels(mesh: bpy.types.Mesh, result: bpy.types.Mesh) -> None:
    """Copy multires displacements to polygons that both meshes have: corners at the same positions, wound alike."""
    normals = arrays.read_custom_normals(result)
    with edit_as_bmesh(result, result) as bm:
        vertex_count, face_count = len(bm.verts), len(bm.faces)
        bm.from_mesh(mesh)
        bm.verts.ensure_lookup_table()
        bm.faces.ensure_lookup_table()
        source = {}  # (position of a corner, and of the next one, the face's corners): the corner
        for face in bm.faces[face_count:]:
            source.update(zip(_corner_keys(face), face.loops))
        for face in bm.faces[:face_count]:
            corners = [source.get(key) for key in _corner_keys(face)]
            for loop, corner in zip(face.loops, corners if None not in corners else ()):
                loop.copy_from(corner)
        bmesh.ops.delete(bm, geom=bm.verts[vertex_count:], context="VERTS")
    if normals is not None:
        arrays.write_custom_normals(result, normals)


def _corner_keys(face: bmesh.types.BMFace) -> list[tuple]:
    places = [tuple(vert.co) for vert in face.verts]
    return [(place, following, frozenset(places)) for place, following in zip(places, [*places[1:], places[0]])]


def _find_active_layers(mesh: bpy.types.Mesh) -> dict[str, str]:
    """Return {role: name} of the layers that Blender shows, renders, clones and masks by."""
    uv = mesh.uv_layers
    active = {"active": uv.active, "render": next((layer for layer in uv if layer.active_render), None),
              "uv_layer_clone": mesh.uv_layer_clone, "uv_layer_stencil": mesh.uv_layer_stencil}
    colors = mesh.color_attributes
    for role in ("active_color_index", "render_color_index"):
        active[role] = colors[getattr(colors, role)] if 0 <= getattr(colors, role) < len(colors) else None
    return {role: layer.name for role, layer in active.items() if layer}


def _set_active_layers(mesh: bpy.types.Mesh, active_layers: dict[str, str]) -> None:
    """Set the active layers as far as the mesh has them."""
    for role, name in active_layers.items():
        if role.endswith("color_index"):
            if name in mesh.color_attributes:
                setattr(mesh.color_attributes, role, mesh.color_attributes.find(name))
        elif name in mesh.uv_layers:
            if role == "active":
                mesh.uv_layers.active = mesh.uv_layers[name]
            elif role == "render":
                mesh.uv_layers[name].active_render = True
            else:
                setattr(mesh, role, mesh.uv_layers[name])


def replace_geometry(target: bpy.types.Mesh, result: bpy.types.Mesh, keys: dict[str, np.ndarray] | None = None) -> None:
    """Replace the target's geometry and layers by those of result. The target's name, properties, users and shape keys
    stay. keys: {name: (V, 3)}, positions of the shape keys; None: result has the same keys."""
    n_keys, active_layers = len(target.shape_keys.key_blocks) if target.shape_keys else 0, _find_active_layers(target)
    with edit_as_bmesh(result, target):
        pass
    _set_active_layers(target, active_layers)
    if n_keys:
        # Blender maps keys by numbers that differ between the meshes once a key was removed, and mixes them up.
        with _temporary_object(target) as holder:
            for key in list(target.shape_keys.key_blocks)[n_keys:]:
                holder.shape_key_remove(key)
        for key in target.shape_keys.key_blocks:
            write(key.data, "co", keys[key.name] if keys else
                  read(result.shape_keys.key_blocks[key.name].data, "co", np.float32, 3))
