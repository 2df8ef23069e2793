# SPDX-License-Identifier: GPL-3.0-or-later
"""A cut as seams, and the mesh unwrapped along them by Blender. Outside Edit Mode; undo is the caller's."""

import bpy
import numpy as np

from ..mesh import apart, arrays
from ..mesh.errors import Refused
from partwheel.cut import seams, unwrap_cut
from partwheel.weld import is_welding, weld_coincident_vertices

MOST_MAPS = 8  # UV maps that a mesh can have
NAME, BESIDE = "UVMap", "Parts"  # of the first UV map; of ours, where there are others


def mark(obj, cut, unwrap):
    """Seams along the borders of the parts, in place of all that there were, and as many more as each part needs to lie
    flat. unwrap: a UV map by them, the active one; others stay, also the one that is rendered. Returns a function that
    takes it all back. Raises Refused if there are too many UV maps, and an Error; nothing has changed then."""
    mesh = obj.data
    own = mesh.uv_layers.get(BESIDE) if mesh.uv_layers else None
    if unwrap and not own and len(mesh.uv_layers) == MOST_MAPS:
        raise Refused("{name} has {count} UV maps, no more are possible: remove one.", name=obj.name, count=MOST_MAPS)
    before = arrays.read(mesh.edges, "use_seam", bool)
    added, active, old = None, mesh.uv_layers.active_index, None
    surface = arrays.surface(mesh)
    if not unwrap:
        _set(mesh, seams(*surface, cut))
    else:
        loops, places = _loops(mesh, surface), None
        old_to_new = weld_coincident_vertices(surface.vertices, surface.triangles)

        def by_blender(ends):
            nonlocal places
            _set(mesh, ends)
            places = _unwrapped(obj, old_to_new)
            return places.reshape(-1, 2)[loops].astype(float)

        unwrap_cut(*surface, cut, by_blender)
        if own:
            old = arrays.read(own.data, "uv", np.float32, 2).ravel()
        else:
            own = mesh.uv_layers.new(name=BESIDE if mesh.uv_layers else NAME, do_init=False)
            added = own.name
        own.data.foreach_set("uv", places)
        mesh.uv_layers.active = own
    mesh.update()

    def take_back():
        mesh.edges.foreach_set("use_seam", before)
        if added:
            mesh.uv_layers.remove(mesh.uv_layers[added])
        elif old is not None:
            mesh.uv_layers[BESIDE].data.foreach_set("uv", old)
        mesh.uv_layers.active_index = active

    return take_back


def _set(mesh, chosen):
    """Seams where these vertices (n,2) are the ends of edges, and nowhere else."""
    ends, count = np.sort(arrays.edge_vertices(mesh), axis=1).astype(np.int64), len(mesh.vertices)
    mesh.edges.foreach_set("use_seam", np.isin(ends @ [count, 1], np.asarray(chosen, np.int64) @ [count, 1]))


def _loops(mesh, surface):
    """(T,3) the loop of each corner of a surface's triangles."""
    count, vertices = len(mesh.vertices), arrays.read(mesh.loops, "vertex_index", np.int32)
    faces = np.repeat(np.arange(len(mesh.polygons)), arrays.read(mesh.polygons, "loop_total", np.int32))
    keys = faces * count + vertices
    order = np.argsort(keys, kind="stable")
    return order[np.searchsorted(keys[order], surface.faces[:, None] * np.int64(count) + surface.triangles)]


def _weld(mesh, old_to_new):
    """Coincident vertices become one, so that the surface hangs together there; unless a polygon would get a corner twice.
    Polygons and loops keep their order, edges that are no more needed are left without a polygon."""
    corners = old_to_new[arrays.read(mesh.loops, "vertex_index", np.int32)].astype(np.int32)
    polygon = np.repeat(np.arange(len(mesh.polygons)), arrays.polygon_sizes(mesh)[1])
    if not is_welding(old_to_new) or len(np.unique(polygon * len(old_to_new) + corners)) < len(corners):
        return
    before = arrays.edge_vertices(mesh)
    ends = old_to_new[before].astype(np.int32)
    _, first, number = np.unique(np.sort(ends, axis=1), axis=0, return_index=True, return_inverse=True)
    edges = first[number.ravel()][arrays.read(mesh.loops, "edge_index", np.int32)].astype(np.int32)
    arrays.write(mesh.edges, "vertices", np.where((ends[:, :1] == ends[:, 1:]), before, ends))
    arrays.write(mesh.loops, "vertex_index", corners)
    arrays.write(mesh.loops, "edge_index", edges)
    mesh.update()


def _unwrapped(original, old_to_new):
    """(2 L,) UVs of an object's mesh by its seams: Blender's operator on a copy, in a scene of its own, so that neither
    what is selected, hidden or edited nor the modifiers of an object matter. old_to_new (V,): the welded vertices."""
    copy = bpy.data.meshes.new_from_object(original)  # mesh.copy() leaves shape keys behind
    _weld(copy, old_to_new)
    obj = bpy.data.objects.new("Unwrap", copy)
    try:
        while copy.uv_layers:
            copy.uv_layers.remove(copy.uv_layers[0])
        copy.uv_layers.new()
        with apart.scene_apart(obj) as layer:
            layer.objects.active = obj
            context = {"scene": layer.id_data, "view_layer": layer, "object": obj, "active_object": obj}
            with bpy.context.temp_override(**context, edit_object=None, mode="OBJECT"):
                bpy.ops.object.mode_set(mode="EDIT")
            with bpy.context.temp_override(**context, edit_object=obj):
                bpy.ops.mesh.reveal(select=False)
                bpy.ops.mesh.select_all(action="SELECT")
                bpy.ops.uv.unwrap(method="ANGLE_BASED")
                bpy.ops.object.mode_set(mode="OBJECT")
        return arrays.read(copy.uv_layers[0].data, "uv", np.float32, 2).ravel()
    finally:
        bpy.data.objects.remove(obj)
        bpy.data.meshes.remove(copy)
