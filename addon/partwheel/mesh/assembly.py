# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh put together from pieces of another, with all their layers, by whole arrays: a bmesh of the same costs ten
times as much. (Not taken along: multires displacements, which Python can't write.)"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from . import arrays
from .arrays import read, write
from .datablocks import copy_animation, copy_settings

# Type of an attribute -> (its field, type of its numbers, how many they are, whether a mean has a meaning)
_TYPES = {
    "FLOAT": ("value", np.float32, 1, True), "INT": ("value", np.int32, 1, False),
    "INT8": ("value", np.int32, 1, False),
    "BOOLEAN": ("value", bool, 1, False), "FLOAT2": ("vector", np.float32, 2, True),
    "FLOAT_VECTOR": ("vector", np.float32, 3, True), "FLOAT_COLOR": ("color", np.float32, 4, True),
    "BYTE_COLOR": ("color", np.float32, 4, True), "INT16_2D": ("value", np.int32, 2, False),
    "INT32_2D": ("value", np.int32, 2, False), "QUATERNION": ("value", np.float32, 4, False),
    "FLOAT4X4": ("value", np.float32, 16, False),
}
_TOPOLOGY = {"position", ".edge_verts", ".corner_vert", ".corner_edge", ".corner_normal"}
_SELECTION = {".select_vert", ".select_edge", ".select_poly"}
# What was no attribute but a property of the elements, in Blenders that had it so.
_ELEMENT_PROPERTIES = {"vertices": [], "edges": [], "polygons": []}
if bpy.app.version < (5, 0, 0):
    _ELEMENT_PROPERTIES["edges"] = [("use_freestyle_mark", bool)]
    _ELEMENT_PROPERTIES["polygons"] = [("use_freestyle_mark", bool)]
if bpy.app.version < (4, 0, 0):
    _ELEMENT_PROPERTIES["vertices"] += [("bevel_weight", np.float32)]
    _ELEMENT_PROPERTIES["edges"] += [("use_seam", bool), ("use_edge_sharp", bool), ("crease", np.float32),
                                     ("bevel_weight", np.float32)]
    _ELEMENT_PROPERTIES["polygons"] += [("use_smooth", bool)]
# Where the mesh itself knows whether it has any.
_HAS_PROPERTY = {("vertices", "bevel_weight"): "has_bevel_weight_vertex", ("edges", "bevel_weight"): "has_bevel_weight_edge",
                 ("edges", "crease"): "has_crease_edge"}
# What is a collection of layers of its own, which only a bmesh makes; without some of them in newer Blenders:
# collection -> (elements, the bmesh's, its name there, fields: (name, type, how many, of a new element)).
_BMESH_LAYERS = {
    "skin_vertices": ("vertices", "verts", "skin", [("radius", np.float32, 2, 0.25), ("use_root", bool, 1, False),
                                                    ("use_loose", bool, 1, False)]),
    "vertex_paint_masks": ("vertices", "verts", "paint_mask", [("value", np.float32, 1, 0)]),
    "vertex_creases": ("vertices", "verts", "crease", [("value", np.float32, 1, 0)]),
    "face_maps": ("polygons", "faces", "face_map", [("value", np.int32, 1, -1)]),
}
if bpy.app.version >= (4, 0, 0):  # the others are attributes
    _BMESH_LAYERS = {"skin_vertices": _BMESH_LAYERS["skin_vertices"]}


_EMPTY = np.empty(0, np.int64)


@contextmanager
def edit_as_bmesh(mesh: bpy.types.Mesh | None, into: bpy.types.Mesh | None = None) -> Iterator[bmesh.types.BMesh]:
    """A bmesh of the mesh, or of nothing, for a while; what was done with it is written into another, or the same."""
    bm = bmesh.new()
    try:
        if mesh:
            bm.from_mesh(mesh)
        yield bm
        if into:
            bm.to_mesh(into)
    finally:
        bm.free()


class ElementSources(NamedTuple):
    """Where n elements come from: first (n,) the source's that each is, -1 for new ones; but those at (k,) are midway
    between that one and other (k,)."""

    source: np.ndarray
    midpoint_rows: np.ndarray = _EMPTY
    midpoint_source: np.ndarray = _EMPTY


class MeshPlan(NamedTuple):
    """A mesh of n vertices, L corners and P polygons, and where each comes from:

    places (n,3)
    vertices, loops: Origins        of the vertices and of the corners
    corners (L,), begin (P,)        the vertex of each corner, and the first corner of each polygon
    polygons (P,)                   the source's; -1: new, and then flat
    whole                           so many polygons at the beginning are the source's own, corner for corner
    wires (w,)                      the source's edges that have no face
    number (V,)                     the vertex that each of the source's is, where those polygons or edges have it
    alias (V,)                      the source's vertex that each of the source's is taken for; None: itself
    """

    positions: np.ndarray
    vertices: ElementSources
    loops: ElementSources
    corner_vertices: np.ndarray
    polygon_starts: np.ndarray
    source_polygons: np.ndarray
    n_unchanged: int
    loose_edges: np.ndarray
    old_to_new: np.ndarray
    welded_to: np.ndarray = None


def assemble_mesh(mesh: bpy.types.Mesh, plan: MeshPlan, name: str, selection: bool) -> bpy.types.Mesh:
    """A new mesh: materials, settings and properties are the source's; and what is selected, if selection."""
    made = mesh.copy()
    made.name = name
    if made.shape_keys:
        clear_shape_keys(made)
    made.clear_geometry()
    _create_bmesh_layers(mesh, made)
    of_edge, ends, edge_from = _build_edges(mesh, plan)
    made.vertices.add(len(plan.positions))
    _copy_vertex_groups(mesh, made, plan.vertices)
    for elements, count in ((made.edges, len(ends)), (made.loops, len(plan.corner_vertices)), (made.polygons, len(plan.polygon_starts))):
        elements.add(count)
    write(made.vertices, "co", plan.positions)
    write(made.edges, "vertices", ends)
    write(made.loops, "vertex_index", plan.corner_vertices.astype(np.int32))
    write(made.loops, "edge_index", of_edge)
    write(made.polygons, "loop_start", plan.polygon_starts.astype(np.int32))
    if bpy.app.version < (4, 0, 0):
        write(made.polygons, "loop_total", np.diff(plan.polygon_starts, append=len(plan.corner_vertices)).astype(np.int32))
    origins = {"POINT": plan.vertices, "CORNER": plan.loops, "EDGE": ElementSources(edge_from), "FACE": ElementSources(plan.source_polygons)}
    _copy_attributes(mesh, made, origins, _TOPOLOGY if selection else _TOPOLOGY | _SELECTION)
    first = {"vertices": plan.vertices.source, "edges": edge_from, "polygons": plan.source_polygons}
    _copy_element_properties(mesh, made, first)
    _copy_bmesh_layers(mesh, made, first)
    _copy_shape_keys(mesh, made, plan)
    _set_active_layers(made, _find_active_layers(mesh))
    made.update()
    return made


def _build_edges(mesh: bpy.types.Mesh, plan: MeshPlan) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """((L,) the edge from each corner to the next, (m,2) the edges' vertices, (m,) the source edge of each, or -1)"""
    own, count = plan.loops.source, len(plan.corner_vertices)
    numbers, all_ends = _read_loop_edges(mesh, plan.welded_to), arrays.read_edge_vertices(mesh)
    # Of whole polygons they are the source's.
    rest = int(plan.polygon_starts[plan.n_unchanged]) if plan.n_unchanged < len(plan.polygon_starts) else count
    of_edge = np.empty(count, np.int32)
    source = numbers[own[:rest]]
    used = np.flatnonzero(arrays.make_mask(len(all_ends), source))
    place = np.empty(len(all_ends), np.int32)
    place[used] = np.arange(len(used))
    of_edge[:rest] = place[source]
    ends = all_ends[used] if plan.welded_to is None else plan.welded_to[all_ends[used]]
    ends = plan.old_to_new[ends]

    # Of the others it is the source's if the next corner is the source's next one, or the one before: then it is the
    # one before's.
    following = np.arange(rest + 1, count + 1)
    following[np.append(plan.polygon_starts[plan.n_unchanged + 1:], count)[:len(plan.polygon_starts) - plan.n_unchanged] - 1 - rest] = (
        plan.polygon_starts[plan.n_unchanged:])
    begin, totals = arrays.read_polygon_sizes(mesh)
    after = np.arange(1, len(mesh.loops) + 1, dtype=np.int32)
    after[begin + totals - 1] = begin
    single = own >= 0
    single[plan.loops.midpoint_rows] = False
    here, beyond = own[rest:], own[following]
    plain = single[rest:] & single[following]
    back = plain & (after[beyond] == here) & (after[here] != beyond)
    plain &= back | (after[here] == beyond)
    source = np.where(plain, numbers[np.where(back, beyond, here)], -1)

    # Among them an edge may be one that is already there.
    low, high = (each(plan.corner_vertices[rest:], plan.corner_vertices[following]) for each in (np.minimum, np.maximum))
    touched = arrays.make_mask(len(plan.positions), [low, high])
    near = np.flatnonzero(touched[ends[:, 0]] & touched[ends[:, 1]])
    key = np.concatenate([np.sort(ends[near], axis=1), np.stack([low, high], axis=1)]).astype(np.int64)
    unique, which = np.unique(key[:, 0] * len(plan.positions) + key[:, 1], return_inverse=True)
    which = which.ravel()
    edge = np.full(len(unique), -1)
    edge[which[:len(near)]] = near
    new = np.flatnonzero(edge < 0)
    edge[new] = len(ends) + np.arange(len(new))
    of_edge[rest:] = edge[which[len(near):]]
    edge_from = np.concatenate([used, np.full(len(new), -1), plan.loose_edges])
    edge_from[of_edge[rest:][plain]] = source[plain]
    ends = np.concatenate([ends, np.stack(np.divmod(unique[new], len(plan.positions)), axis=1),
                           plan.old_to_new[all_ends[plan.loose_edges]]])
    return of_edge, ends.astype(np.int32), edge_from


def _read_loop_edges(mesh: bpy.types.Mesh, alias: np.ndarray | None) -> np.ndarray:
    """(L,) the edge of each of the mesh's loops; by alias, of several between the same two vertices the first."""
    edges = read(mesh.loops, "edge_index", np.int32)
    if alias is None:
        return edges
    ends = np.sort(alias[arrays.read_edge_vertices(mesh)], axis=1)
    _, first, which = np.unique(ends, axis=0, return_index=True, return_inverse=True)
    return first[which.ravel()][edges]


def _gather(values: np.ndarray, origins: ElementSources, mean: bool = False, otherwise: float = 0) -> np.ndarray:
    """values (n,) or (n, width) at Origins: their mean, or the first's; otherwise where there is none."""
    taken = values[origins.source]
    taken[origins.source < 0] = otherwise
    if mean and len(origins.midpoint_rows):
        taken[origins.midpoint_rows] = (taken[origins.midpoint_rows] + values[origins.midpoint_source]) / 2
    return taken


def _copy_attributes(mesh: bpy.types.Mesh, made: bpy.types.Mesh, origins: dict[str, ElementSources],
                     but: set[str]) -> None:
    layers = [(each.name, each.data_type, each.domain) for each in mesh.attributes if each.name not in but]
    for name, kind, domain in layers:
        of = origins[domain]
        old, new = mesh.attributes[name], made.attributes.get(name) or made.attributes.new(name, kind, domain)
        if (new.data_type, new.domain) != (kind, domain):
            continue  # one that Blender itself keeps otherwise: from_pydata() of 5.0 spoils .select_edge
        if kind == "STRING":
            for item, at in zip(new.data, of.source.tolist()):
                item.value = old.data[at].value if at >= 0 else ""
            continue
        field, dtype, width, mean = _TYPES[kind]
        taken = _gather(read(old.data, field, dtype, width), of, mean)
        if name == "sharp_face":
            taken[of.source < 0] = True
        new.data.foreach_set(field, taken.ravel())
    caps = origins["FACE"].source < 0
    if bpy.app.version >= (4, 0, 0) and "sharp_face" not in mesh.attributes and caps.any():
        made.attributes.new("sharp_face", "BOOLEAN", "FACE").data.foreach_set("value", caps)
    for uv in mesh.uv_layers:
        if uv.name not in made.uv_layers:
            made.uv_layers.new(name=uv.name, do_init=False)
        if bpy.app.version < (3, 5, 0):
            new = made.uv_layers[uv.name].data
            new.foreach_set("uv", _gather(read(uv.data, "uv", np.float32, 2), origins["CORNER"], True).ravel())
            new.foreach_set("pin_uv", _gather(read(uv.data, "pin_uv", bool), origins["CORNER"]))


def _copy_element_properties(mesh: bpy.types.Mesh, made: bpy.types.Mesh, origins: dict[str, np.ndarray]) -> None:
    for kind, marks in _ELEMENT_PROPERTIES.items():
        for field, dtype in marks:
            if not getattr(mesh, _HAS_PROPERTY.get((kind, field), ""), True):
                continue
            values = read(getattr(mesh, kind), field, dtype)
            if values.any():
                getattr(made, kind).foreach_set(field, _gather(values, ElementSources(origins[kind])))


def _create_bmesh_layers(mesh: bpy.types.Mesh, made: bpy.types.Mesh) -> None:
    """made has no elements yet."""
    names = [each[1:3] for collection, each in _BMESH_LAYERS.items() if len(getattr(mesh, collection))]
    if names:
        with edit_as_bmesh(None, made) as bm:
            for elements, name in names:
                getattr(getattr(bm, elements).layers, name).verify()


def _copy_bmesh_layers(mesh: bpy.types.Mesh, made: bpy.types.Mesh, origins: dict[str, np.ndarray]) -> None:
    for collection, (elements, _, _, fields) in _BMESH_LAYERS.items():
        of = ElementSources(origins[elements])
        for old, new in zip(getattr(mesh, collection), getattr(made, collection)):
            for field, dtype, width, otherwise in fields:
                taken = _gather(read(old.data, field, dtype, width), of, otherwise=otherwise)
                new.data.foreach_set(field, taken.ravel())


@contextmanager
def _temporary_object(mesh: bpy.types.Mesh) -> Iterator[bpy.types.Object]:
    """An object that holds the mesh while its groups and keys are at work."""
    holder = bpy.data.objects.new("partwheel", mesh)
    try:
        yield holder
    finally:
        bpy.data.objects.remove(holder)


def _copy_vertex_groups(mesh: bpy.types.Mesh, made: bpy.types.Mesh, origins: ElementSources) -> None:
    """made has its vertices, and nothing else yet: so a bmesh, which copies a vertex's weights as one, costs little."""
    if not _copy_group_names(mesh, made):
        return
    bare = _copy_vertices_only(mesh)
    with edit_as_bmesh(bare) as olds:
        bpy.data.meshes.remove(bare)
        layer = olds.verts.layers.deform.active
        if layer is None:  # nothing is in a group
            return
        with edit_as_bmesh(made, made) as news:
            own = news.verts.layers.deform.verify()
            sources, verts = list(olds.verts), list(news.verts)
            for vert, first in zip(verts, origins.source.tolist()):
                if first >= 0:
                    vert[own] = sources[first][layer]
            for at, other in zip(origins.midpoint_rows.tolist(), origins.midpoint_source.tolist()):
                weights, beyond = verts[at][own], sources[other][layer]
                for group in {*weights.keys(), *beyond.keys()}:
                    weights[group] = (weights.get(group, 0) + beyond.get(group, 0)) / 2


def _copy_group_names(mesh: bpy.types.Mesh, made: bpy.types.Mesh) -> bool:
    """Gives made groups of the same names; whether there are any."""
    with _temporary_object(mesh) as old, _temporary_object(made) as new:
        new.vertex_groups.clear()
        for group in old.vertex_groups:
            new.vertex_groups.new(name=group.name).lock_weight = group.lock_weight
        return len(old.vertex_groups) > 0


def _copy_vertices_only(mesh: bpy.types.Mesh) -> bpy.types.Mesh:
    """A new mesh: the vertices with their layers, and nothing else. Nothing but Blender's own validation takes faces
    away quickly: those, and edges, whose corners are all one vertex."""
    bare = mesh.copy()
    if bare.shape_keys:
        clear_shape_keys(bare)
    write(bare.loops, "vertex_index", np.zeros(len(bare.loops), np.int32))
    write(bare.edges, "vertices", np.zeros(2 * len(bare.edges), np.int32))
    if bpy.app.version < (4, 0, 0):
        write(bare.polygons, "loop_total", np.zeros(len(bare.polygons), np.int32))
    bare.validate()
    return bare


def clear_shape_keys(mesh: bpy.types.Mesh) -> None:
    """Blender counts one user too many of a copied mesh's keys, and leaves them behind: a file with such a key opens with
    an error."""
    keys = mesh.shape_keys
    left_behind = keys.users > 1
    with _temporary_object(mesh) as holder:
        holder.shape_key_clear()
    if left_behind:
        bpy.data.batch_remove([keys])


def _copy_shape_keys(mesh: bpy.types.Mesh, made: bpy.types.Mesh, plan: MeshPlan) -> None:
    if not mesh.shape_keys:
        return
    with _temporary_object(made) as holder:
        for old in mesh.shape_keys.key_blocks:
            new = holder.shape_key_add(name=old.name, from_mix=False)
            places = plan.positions.copy()
            own = plan.vertices.source >= 0
            old_places = read(old.data, "co", np.float32, 3)
            places[own] = _gather(old_places, plan.vertices, True)[own]
            new.data.foreach_set("co", places.ravel())
            new.slider_min, new.slider_max = old.slider_min, old.slider_max  # or they bound the value
            copy_settings(old, new, {"name", "relative_key"})
        for old in mesh.shape_keys.key_blocks:
            made.shape_keys.key_blocks[old.name].relative_key = made.shape_keys.key_blocks[old.relative_key.name]
    copy_settings(mesh.shape_keys, made.shape_keys, {"name"})
    for name in mesh.shape_keys.keys():
        made.shape_keys[name] = mesh.shape_keys[name]
    copy_animation(mesh.shape_keys, made.shape_keys)


def _find_active_layers(mesh: bpy.types.Mesh) -> dict[str, str]:
    """The names of the layers that Blender shows, renders, clones and masks by."""
    uv = mesh.uv_layers
    found = {"active": uv.active, "render": next((each for each in uv if each.active_render), None),
             "uv_layer_clone": mesh.uv_layer_clone, "uv_layer_stencil": mesh.uv_layer_stencil}
    colors = mesh.color_attributes
    for role in ("active_color_index", "render_color_index"):
        found[role] = colors[getattr(colors, role)] if 0 <= getattr(colors, role) < len(colors) else None
    return {role: layer.name for role, layer in found.items() if layer}


def _set_active_layers(mesh: bpy.types.Mesh, chosen: dict[str, str]) -> None:
    """Only those that the mesh has, too."""
    for role, name in chosen.items():
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


def replace_geometry(target: bpy.types.Mesh, made: bpy.types.Mesh, keys: dict[str, np.ndarray] | None = None) -> None:
    """Puts a mesh's geometry, with all layers, into another, whose name, properties and users stay, and shape keys but for the
    places. keys: {name: (V,3) places} for them; None: made has the same."""
    kept, chosen = len(target.shape_keys.key_blocks) if target.shape_keys else 0, _find_active_layers(target)
    with edit_as_bmesh(made, target):
        pass
    _set_active_layers(target, chosen)
    if kept:
        # Blender goes by numbers of the keys that are others in each mesh, once one was removed: it mixes them up.
        with _temporary_object(target) as holder:
            for key in list(target.shape_keys.key_blocks)[kept:]:
                holder.shape_key_remove(key)
        for key in target.shape_keys.key_blocks:
            write(key.data, "co", keys[key.name] if keys else
                  read(made.shape_keys.key_blocks[key.name].data, "co", np.float32, 3))
