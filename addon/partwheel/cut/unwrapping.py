# SPDX-License-Identifier: GPL-3.0-or-later
"""A cut as seams, and Blender's unwrapping along them. Outside Edit Mode; undo is up to the caller."""

from typing import NamedTuple

import bpy
import numpy as np

from ..mesh import Computation, Refused, Steps, arrays, assembly, temporary_scene
from partwheel.cut import Cut, refine_seams, seams
from partwheel.cut.seams import MAX_REFINEMENTS
from partwheel.weld import weld_coincident_vertices

MAX_UV_MAPS = 8  # UV maps of a mesh in Blender
ONLY_MAP_NAME = "UVMap"  # of the new UV map if it is the only one
PARTS_MAP_NAME = "Parts"  # of the new UV map beside others


class SeamPlan(NamedTuple):
    """edges (n, 2): vertices of the seams. uvs (2 L,): of all loops, or None."""

    edges: np.ndarray
    uvs: np.ndarray | None


def plan_seams(obj: bpy.types.Object, cut: Cut, unwrap: bool) -> Steps:
    """Steps that return the SeamPlan: along the parts' borders, and as many more seams as each part needs to lie flat.
    unwrap: also UVs from these seams. They change nothing. Raises Refused for too many UV maps, and an Error."""
    mesh = obj.data
    if unwrap and PARTS_MAP_NAME not in mesh.uv_layers and len(mesh.uv_layers) == MAX_UV_MAPS:
        raise Refused("{name} has {count} UV maps, the most that Blender allows: remove one.",
                      name=obj.name, count=MAX_UV_MAPS)
    surface = arrays.read_surface(mesh)
    edges = yield Computation(seams, *surface, cut)
    if not unwrap:
        return SeamPlan(edges, None)
    loops = _corner_loops(mesh, surface)
    old_to_new = weld_coincident_vertices(surface.vertices, surface.triangles)
    uvs = _unwrap_copy(obj, edges, old_to_new)
    for _ in range(MAX_REFINEMENTS):
        refined = yield Computation(refine_seams, *surface, cut, edges, uvs.reshape(-1, 2)[loops].astype(float))
        if np.array_equal(refined, edges):
            break
        edges = refined
        uvs = _unwrap_copy(obj, edges, old_to_new)
    return SeamPlan(edges, uvs)


def write_seams(mesh: bpy.types.Mesh, plan: SeamPlan) -> None:
    """Replaces the mesh's seams, and writes the UVs to a new active UV map; other maps stay, and so does the rendered one."""
    _set_seams(mesh, plan.edges)
    if plan.uvs is not None:
        uv_map = mesh.uv_layers.get(PARTS_MAP_NAME) or mesh.uv_layers.new(
            name=PARTS_MAP_NAME if mesh.uv_layers else ONLY_MAP_NAME, do_init=False)
        uv_map.data.foreach_set("uv", plan.uvs)
        mesh.uv_layers.active = uv_map
    mesh.update()


def _set_seams(mesh: bpy.types.Mesh, seam_edges: np.ndarray) -> None:
    """Seams at the edges with these vertices (n, 2), and nowhere else."""
    ends, count = np.sort(arrays.read_edge_vertices(mesh), axis=1).astype(np.int64), len(mesh.vertices)
    mesh.edges.foreach_set("use_seam", np.isin(ends @ [count, 1], np.asarray(seam_edges, np.int64) @ [count, 1]))


def _corner_loops(mesh: bpy.types.Mesh, surface: arrays.MeshSurface) -> np.ndarray:
    """(T, 3) the loop of each corner of a surface's triangles."""
    count, vertices = len(mesh.vertices), arrays.read_corner_vertices(mesh)
    faces = np.repeat(np.arange(len(mesh.polygons)), arrays.read(mesh.polygons, "loop_total", np.int32))
    keys = faces * count + vertices
    order = np.argsort(keys, kind="stable")
    return order[np.searchsorted(keys[order], surface.faces[:, None] * np.int64(count) + surface.triangles)]


def _unwrap_copy(source: bpy.types.Object, edges: np.ndarray, old_to_new: np.ndarray) -> np.ndarray:
    """(2 L,) UVs of an object's mesh by seams at these edges (n, 2), by Blender's operator on a copy in a scene of its
    own: selection, hidden elements, mode and modifiers don't matter. old_to_new (V,): the welded vertices."""
    copy = bpy.data.meshes.new_from_object(source)  # unlike mesh.copy(), without shape keys
    _set_seams(copy, edges)
    assembly.weld_vertices(copy, old_to_new)
    try:
        while copy.uv_layers:
            copy.uv_layers.remove(copy.uv_layers[0])
        copy.uv_layers.new()
        with temporary_scene.edit_in_temporary_scene(copy):
            bpy.ops.mesh.reveal(select=False)
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.uv.unwrap(method="ANGLE_BASED")
        return arrays.read(copy.uv_layers[0].data, "uv", np.float32, 2).ravel()
    finally:
        bpy.data.meshes.remove(copy)
