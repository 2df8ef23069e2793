# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh put together from pieces of another, with all their layers, by whole arrays: a bmesh of the same costs ten
times as much. (Not taken along: multires displacements, which Python can't write.)"""

from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from . import mesh_arrays
from .mesh_arrays import read, write

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
_SHAPE = {"position", ".edge_verts", ".corner_vert", ".corner_edge", ".corner_normal"}
# What was no attribute but a property of the elements, in Blenders that had it so.
_MARKS = {"vertices": [], "edges": [], "polygons": []}
if bpy.app.version < (5, 0, 0):
    _MARKS["edges"] = [("use_freestyle_mark", bool)]
    _MARKS["polygons"] = [("use_freestyle_mark", bool)]
if bpy.app.version < (4, 0, 0):
    _MARKS["vertices"] += [("bevel_weight", np.float32)]
    _MARKS["edges"] += [("use_seam", bool), ("use_edge_sharp", bool), ("crease", np.float32),
                        ("bevel_weight", np.float32)]
    _MARKS["polygons"] += [("use_smooth", bool)]
# Where the mesh itself knows whether it has any.
_KNOWN = {("vertices", "bevel_weight"): "has_bevel_weight_vertex", ("edges", "bevel_weight"): "has_bevel_weight_edge",
          ("edges", "crease"): "has_crease_edge"}
# What is a collection of layers of its own, which only a bmesh makes; without some of them in newer Blenders:
# collection -> (elements, the bmesh's, its name there, fields: (name, type, how many, of a new element)).
_OWN_LAYERS = {
    "skin_vertices": ("vertices", "verts", "skin", [("radius", np.float32, 2, 0.25), ("use_root", bool, 1, False),
                                                    ("use_loose", bool, 1, False)]),
    "vertex_paint_masks": ("vertices", "verts", "paint_mask", [("value", np.float32, 1, 0)]),
    "vertex_creases": ("vertices", "verts", "crease", [("value", np.float32, 1, 0)]),
    "face_maps": ("polygons", "faces", "face_map", [("value", np.int32, 1, -1)]),
}
if bpy.app.version >= (4, 0, 0):  # the others are attributes
    _OWN_LAYERS = {"skin_vertices": _OWN_LAYERS["skin_vertices"]}


class Plan(NamedTuple):
    """A mesh of n vertices, L corners and P polygons, and where each comes from:

    places (n,3)
    vertices (n,2), loops (L,2)     the source's two in whose middle each is; mostly the same twice; -1: new
    corners (L,), begin (P,)        the vertex of each corner, and the first corner of each polygon
    polygons (P,)                   the source's; -1: new, and then flat
    wires (w,), wire_ends (w,2)     the source's edges that have no face, and their vertices
    alias (V,)                      the source's vertex that each of the source's is taken for; None: itself
    """

    places: np.ndarray
    vertices: np.ndarray
    loops: np.ndarray
    corners: np.ndarray
    begin: np.ndarray
    polygons: np.ndarray
    wires: np.ndarray
    wire_ends: np.ndarray
    alias: np.ndarray = None


def assembled(mesh, plan, name):
    """A new mesh: materials, settings and properties are the source's."""
    made = mesh.copy()
    made.name = name
    if made.shape_keys:
        _clear_keys(made)
    made.clear_geometry()
    _make_own_layers(mesh, made)
    of_edge, ends, edge_from = _edges(mesh, plan)
    for elements, count in ((made.vertices, len(plan.places)), (made.edges, len(ends)), (made.loops, len(plan.corners)),
                            (made.polygons, len(plan.begin))):
        elements.add(count)
    write(made.vertices, "co", plan.places)
    write(made.edges, "vertices", ends)
    write(made.loops, "vertex_index", plan.corners.astype(np.int32))
    write(made.loops, "edge_index", of_edge)
    write(made.polygons, "loop_start", plan.begin.astype(np.int32))
    if bpy.app.version < (4, 0, 0):
        write(made.polygons, "loop_total", np.diff(plan.begin, append=len(plan.corners)).astype(np.int32))
    twice = {"POINT": plan.vertices, "CORNER": plan.loops, "EDGE": np.repeat(edge_from[:, None], 2, axis=1),
             "FACE": np.repeat(plan.polygons[:, None], 2, axis=1)}
    _copy_attributes(mesh, made, twice)
    first = {"vertices": plan.vertices[:, 0], "edges": edge_from, "polygons": plan.polygons}
    _copy_marks(mesh, made, first)
    _copy_own_layers(mesh, made, first)
    _copy_groups(mesh, made, plan.vertices)
    _copy_keys(mesh, made, plan)
    made.update()
    return made


def _edges(mesh, plan):
    """((L,) the edge from each corner to the next, (m,2) the edges' vertices, (m,) the source edge of each, or -1)"""
    following = np.arange(1, len(plan.corners) + 1)
    following[np.append(plan.begin[1:], len(plan.corners)) - 1] = plan.begin
    low, high = np.minimum(plan.corners, plan.corners[following]), np.maximum(plan.corners, plan.corners[following])
    # A corner's edge is the source's if the next corner is the source's next one, or the one before: then it is the
    # one before's.
    begin, totals = mesh_arrays.polygon_sizes(mesh)
    after = np.arange(1, len(mesh.loops) + 1, dtype=np.int32)
    after[begin + totals - 1] = begin
    own = plan.loops[:, 0]
    plain = (own >= 0) & (own == plan.loops[:, 1]) & (plan.loops[following, 1] == plan.loops[following, 0])
    back = plain & (after[own[following]] == own) & (after[own] != own[following])
    plain &= back | (after[own] == own[following])
    source = np.where(plain, _edge_numbers(mesh, plan.alias)[np.where(back, own[following], own)], -1)

    # Mostly that is one edge here, too: no need to sort.
    example = np.full(len(mesh.edges) + 1, -1)  # the last: where there is no source
    example[source] = np.arange(len(source))
    example[-1] = -1
    of = example[source]
    alike = plain & (low[of] == low) & (high[of] == high)
    used = np.flatnonzero(example >= 0)
    number = np.zeros(len(example), np.int32)
    number[used] = np.arange(len(used))
    of_edge = number[source]
    ends = np.stack([low[example[used]], high[example[used]]], axis=1)

    # The others, among which an edge may be one that is already there.
    others = np.flatnonzero(~alike)
    touched = np.zeros(len(plan.places), bool)
    touched[low[others]] = touched[high[others]] = True
    near = np.flatnonzero(touched[ends].all(axis=1))
    key = np.concatenate([ends[near], np.stack([low[others], high[others]], axis=1)]).astype(np.int64)
    unique, which = np.unique(key[:, 0] * len(plan.places) + key[:, 1], return_inverse=True)
    which = which.ravel()
    edge = np.full(len(unique), -1)
    edge[which[:len(near)]] = near
    new = np.flatnonzero(edge < 0)
    edge[new] = len(ends) + np.arange(len(new))
    of_edge[others] = edge[which[len(near):]]
    ends = np.concatenate([ends, np.stack(np.divmod(unique[new], len(plan.places)), axis=1), plan.wire_ends])
    edge_from = np.full(len(ends), -1)
    edge_from[of_edge] = source
    edge_from[of_edge[plain]] = source[plain]
    edge_from[len(ends) - len(plan.wires):] = plan.wires
    return of_edge, ends.astype(np.int32), edge_from


def _edge_numbers(mesh, alias):
    """(L,) the edge of each of the mesh's loops; by alias, of several between the same two vertices the first."""
    edges = read(mesh.loops, "edge_index", np.int32)
    if alias is None:
        return edges
    ends = np.sort(alias[mesh_arrays.edge_vertices(mesh)], axis=1)
    _, first, which = np.unique(ends, axis=0, return_index=True, return_inverse=True)
    return first[which.ravel()][edges]


def _picked(values, origins, mean):
    """values (n,) or (n, width) at origins (m,2): their mean, or the first's; 0 where there is none."""
    at = origins[:, 0]
    taken = values[np.maximum(at, 0)]
    taken[at < 0] = 0
    between = (origins[:, 1] != at) & (at >= 0)
    if mean and between.any():
        taken[between] = (taken[between] + values[origins[between, 1]]) / 2
    return taken


def _copy_attributes(mesh, made, origins):
    layers = [(each.name, each.data_type, each.domain) for each in mesh.attributes if each.name not in _SHAPE]
    for name, kind, domain in layers:
        of = origins[domain]
        old, new = mesh.attributes[name], made.attributes.get(name) or made.attributes.new(name, kind, domain)
        if (new.data_type, new.domain) != (kind, domain):
            continue  # one that Blender itself keeps otherwise: from_pydata() of 5.0 spoils .select_edge
        if kind == "STRING":
            for item, at in zip(new.data, of[:, 0].tolist()):
                item.value = old.data[at].value if at >= 0 else ""
            continue
        field, dtype, width, mean = _TYPES[kind]
        taken = _picked(read(old.data, field, dtype, width), of, mean)
        if name == "sharp_face":
            taken[of[:, 0] < 0] = True
        new.data.foreach_set(field, taken.ravel())
    if bpy.app.version >= (4, 0, 0) and "sharp_face" not in mesh.attributes and (origins["FACE"] < 0).any():
        made.attributes.new("sharp_face", "BOOLEAN", "FACE").data.foreach_set("value", origins["FACE"][:, 0] < 0)
    for uv in mesh.uv_layers:
        if uv.name not in made.uv_layers:
            made.uv_layers.new(name=uv.name, do_init=False)
        if bpy.app.version < (3, 5, 0):
            new = made.uv_layers[uv.name].data
            new.foreach_set("uv", _picked(read(uv.data, "uv", np.float32, 2), origins["CORNER"], True).ravel())
            pins = read(uv.data, "pin_uv", bool)
            new.foreach_set("pin_uv", _picked(pins, origins["CORNER"], False))
        made.uv_layers[uv.name].active_render = uv.active_render
    if mesh.uv_layers.active_index >= 0:
        made.uv_layers.active_index = mesh.uv_layers.active_index


def _copy_marks(mesh, made, origins):
    for kind, marks in _MARKS.items():
        for field, dtype in marks:
            if not getattr(mesh, _KNOWN.get((kind, field), ""), True):
                continue
            values = read(getattr(mesh, kind), field, dtype)
            if values.any():
                at = origins[kind]
                taken = values[np.maximum(at, 0)]
                taken[at < 0] = 0
                getattr(made, kind).foreach_set(field, taken)


def _make_own_layers(mesh, made):
    """made has no elements yet."""
    names = [each[1:3] for collection, each in _OWN_LAYERS.items() if len(getattr(mesh, collection))]
    if names:
        bm = bmesh.new()
        for elements, name in names:
            getattr(getattr(bm, elements).layers, name).verify()
        bm.to_mesh(made)
        bm.free()


def _copy_own_layers(mesh, made, origins):
    for collection, (elements, _, _, fields) in _OWN_LAYERS.items():
        at = origins[elements]
        for old, new in zip(getattr(mesh, collection), getattr(made, collection)):
            for field, dtype, width, otherwise in fields:
                taken = read(old.data, field, dtype, width)[np.maximum(at, 0)]
                taken[at < 0] = otherwise
                new.data.foreach_set(field, taken.ravel())


def _held(mesh):
    """An object that holds the mesh for as long as its groups and keys are at work; the caller removes it."""
    return bpy.data.objects.new("partwheel", mesh)


def _copy_groups(mesh, made, origins):
    old, new = _held(mesh), _held(made)
    try:
        names = [group.name for group in old.vertex_groups]
        if not names:
            return
        new.vertex_groups.clear()
        groups = [new.vertex_groups.new(name=name) for name in names]
        alike = {}  # (group, weight) -> vertices: one call for all of them
        for vertex, (one, other) in enumerate(origins.tolist()):
            if one < 0:
                continue
            weights = {each.group: each.weight for each in mesh.vertices[one].groups}
            if other != one:
                beyond = {each.group: each.weight for each in mesh.vertices[other].groups}
                weights = {group: (weights.get(group, 0) + beyond.get(group, 0)) / 2 for group in {*weights, *beyond}}
            for group, weight in weights.items():
                alike.setdefault((group, weight), []).append(vertex)
        for (group, weight), vertices in alike.items():
            if group < len(groups):
                groups[group].add(vertices, weight, "REPLACE")
    finally:
        bpy.data.objects.remove(old)
        bpy.data.objects.remove(new)


def _clear_keys(mesh):
    holder = _held(mesh)
    holder.shape_key_clear()
    bpy.data.objects.remove(holder)


def _copy_keys(mesh, made, plan):
    if not mesh.shape_keys:
        return
    holder = _held(made)
    try:
        for old in mesh.shape_keys.key_blocks:
            new = holder.shape_key_add(name=old.name, from_mix=False)
            places = plan.places.copy()
            own = plan.vertices[:, 0] >= 0
            old_places = read(old.data, "co", np.float32, 3)
            places[own] = _picked(old_places, plan.vertices, True)[own]
            new.data.foreach_set("co", places.ravel())
            for name in ("value", "slider_min", "slider_max", "mute", "vertex_group", "interpolation"):
                setattr(new, name, getattr(old, name))
        for old in mesh.shape_keys.key_blocks:
            made.shape_keys.key_blocks[old.name].relative_key = made.shape_keys.key_blocks[old.relative_key.name]
        made.shape_keys.use_relative = mesh.shape_keys.use_relative
    finally:
        bpy.data.objects.remove(holder)


def replace_geometry(target, made):
    """Puts a mesh's geometry, with all layers and shape keys, into another, whose name, properties and users stay."""
    bm = bmesh.new()
    try:
        bm.from_mesh(made)
        bm.to_mesh(target)
    finally:
        bm.free()
