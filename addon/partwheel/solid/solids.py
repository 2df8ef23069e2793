# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a Blender mesh as a closed mesh of its own, and the mesh without it. Polygons keep all their layers.

If the mesh was filled exactly, the part is partwheel's Solid: whole polygons stay as they are, cut polygons become
triangles with the same attributes, and caps close it. The same holds after a repair that left all of the part's
polygons unchanged; faces that the repair added become caps. In all other cases (another repair, or filled from
points), the part is the mesh's own polygons: coincident vertices are welded, faces are wound alike, non-manifold
edges are split, the facets inside are joined to them, and every other boundary loop is filled. Either way each edge
has two faces. Duplicate polygons appear once in a part; the mesh that a part is removed from keeps them."""

from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from ..mesh import Refused, arrays, assembly, rollback_on_error
from . import bridging, closing, fitting
from partwheel import Hierarchy

CAP_ATTRIBUTE = "partwheel_cap"  # face attribute: True on faces that close a cut
CAP_MATERIAL_NAME = "Partwheel Cap"
WELD_DISTANCE = 1e-7  # largest distance of coincident vertices, by the size of the mesh
_LOOP_LAYER = "partwheel_loop"  # temporary layer: 1 + the source loop of each loop


class CapOptions(NamedTuple):
    """smooth: faired caps that continue the surface, instead of the tetrahedra's own facets. material: caps get a
    material slot of their own."""

    smooth: bool = False
    material: bool = False


@rollback_on_error()
def create_meshes(obj: bpy.types.Object, hierarchy: Hierarchy, slices: list[tuple], options: CapOptions = CapOptions(),
                  faces: np.ndarray | None = None) -> list[bpy.types.Mesh | None]:
    """New meshes of the object's current one, one for each slice of tetrahedra (first, last), where both may be arrays
    (n,) of several slices. Caps match exactly, unless they are smooth. None for a slice without tetrahedra; also for one of
    several slices that has no faces and can't be a solid. faces (F,) bool: for a single slice, faces to have instead of its
    own, see Hierarchy.solid_of_slice(). Raises PartwheelError."""
    mesh = arrays.update_mesh(obj)
    is_exact = hierarchy.summary.is_exact
    if not is_exact:
        solids = fitting.map_repaired_solids(mesh, hierarchy, slices, options.smooth, faces, standalone=True)
    else:
        solids = [solid and fitting.map_exact_solid(mesh, hierarchy, solid, standalone=True)
                  for solid in fitting.slice_solids(hierarchy, slices, faces)]
    original = None if is_exact or all(solids) else fitting.duplicate_originals(mesh, hierarchy)
    meshes = []
    for tets, solid in zip(slices, solids):
        if solid is None and (is_exact or len(slices) > 1 and not fitting.face_mask(hierarchy, tets).any()):
            meshes.append(None)
            continue
        new, normals = _create_closed_mesh(mesh, hierarchy, solid, tets, options, faces, True, original)
        meshes.append(new)
        if normals is not None:
            arrays.write_custom_normals(new, normals)
    return meshes


def remove_from_mesh(obj: bpy.types.Object, hierarchy: Hierarchy, tets: tuple[int, int],
                     options: CapOptions = CapOptions(), faces: np.ndarray | None = None) -> None:
    """Removes the part from the object's mesh, which must not be in Edit Mode, and closes the hole. faces: as for
    create_meshes(). Raises PartwheelError or Refused before any change."""
    target, rest = obj.data, tets[::-1]
    check_no_multires(obj)
    if hierarchy.summary.is_exact:
        solid = fitting.map_exact_solid(target, hierarchy, hierarchy.solid_of_slice(*rest, faces), standalone=False)
    else:
        solid = fitting.map_repaired_solids(target, hierarchy, [rest], options.smooth, faces, standalone=False)[0]
    new, normals = _create_closed_mesh(target, hierarchy, solid, rest, options, faces, False)
    if options.material and len(new.materials) > len(target.materials):
        _cap_material_slot(target)
    assembly.replace_geometry(target, new)
    bpy.data.meshes.remove(new)
    if normals is not None:
        arrays.write_custom_normals(target, normals)
    target.update()


def has_multires_levels(obj: bpy.types.Object) -> bool:
    return any(modifier.type == "MULTIRES" and modifier.total_levels for modifier in obj.modifiers)


def check_no_multires(obj: bpy.types.Object) -> None:
    """Raises Refused if changing the faces of the object's mesh would lose multires details."""
    if any(other.data == obj.data and has_multires_levels(other) for other in bpy.data.objects):
        raise Refused("{name} has a Multiresolution modifier, whose details would be lost. Apply the modifier first.",
                      name=obj.name)


def _create_closed_mesh(mesh: bpy.types.Mesh, hierarchy: Hierarchy, solid: fitting.MappedSolid | None, tets: tuple,
                        options: CapOptions, faces: np.ndarray | None, standalone: bool,
                        original: np.ndarray | None = None) -> tuple[bpy.types.Mesh, np.ndarray | None]:
    """(new mesh: the slice, closed; its custom normals (L, 3), if the mesh has any). solid: the slice's MappedSolid,
    or None: its polygons, closed. standalone: without loose edges and vertices. original: see fitting.plan_of_faces()."""
    is_exact = solid is not None
    is_reversed = np.zeros(len(mesh.polygons), bool)
    if is_exact:
        is_reversed = solid.is_reversed
        plan = fitting.plan_of_solid(mesh, solid, standalone, with_caps=not options.smooth)
    else:
        plan = fitting.plan_of_faces(mesh, fitting.face_mask(hierarchy, tets, faces), standalone, original)
    normals = arrays.read_custom_normals(mesh)
    new, loops = assembly.assemble_mesh(mesh, plan, f"{mesh.name} part", not standalone), plan.source_loops
    caps = np.flatnonzero(plan.source_polygons < 0)
    if not is_exact or options.smooth or solid.has_sheets:
        facets = None
        if standalone and not options.smooth and not is_exact:
            facets = fitting.inner_facets(hierarchy, tets, faces)
        added, loops = _close_boundary(new, loops, mesh, facets, options.smooth, is_exact, standalone)
        caps = np.concatenate([caps, added])
    _continue_weights(new, caps)
    _continue_look(new, caps)
    if options.material and len(caps):
        indices = arrays.read_material_indices(new)
        indices[caps] = _cap_material_slot(new)
        arrays.write_material_indices(new, indices)
    layer = arrays.ensure_attribute(new, CAP_ATTRIBUTE, "BOOLEAN", "FACE")  # False in a new attribute
    marks = arrays.read(layer.data, "value", bool)
    marks[caps] = True
    layer.data.foreach_set("value", marks)
    if normals is not None:
        normals[np.repeat(is_reversed, arrays.read_polygon_sizes(mesh)[1])] *= -1
        normals = np.where(loops[:, None] < 0, 0, normals[loops])  # 0: computed by Blender
    return new, normals


def _close_boundary(new: bpy.types.Mesh, loops: np.ndarray, mesh: bpy.types.Mesh,
                    facets: tuple[np.ndarray, np.ndarray] | None, smooth: bool, is_exact: bool,
                    standalone: bool) -> tuple[np.ndarray, np.ndarray]:
    """Closes a mesh made from another's polygons, by facets near its boundary, else by new faces. If the polygons are
    unusable as a solid, all boundary edges from before stay open, unless standalone. (its caps; (L,) source loop of
    each loop, -1: new)"""
    with assembly.edit_as_bmesh(new, new) as bm:
        loop_layer = bm.loops.layers.int.new(_LOOP_LAYER)
        for loop, source in zip((loop for face in bm.faces for loop in face.loops), loops.tolist()):
            loop[loop_layer] = source + 1
        excluded_edges = set()
        if not is_exact:
            excluded_edges = _repair_polygons(bm, loops, mesh, standalone)
        if is_exact or standalone:
            closing.split_non_manifold(bm)
        bridges = bridging.bridge(bm, facets) if facets else []
        caps = bridges + closing.fill_boundary_loops(bm, smooth, excluded_edges)
        if (is_exact or standalone) and any(len(edge.link_faces) != 2 for edge in bm.edges if edge.link_faces):
            raise Refused("This part can't be closed: its border crosses itself. Choose a larger or smaller one.")
        if standalone and not is_exact:
            closing.orient_outward(bm, bridges)
        bm.faces.index_update()
        caps = np.array([face.index for face in caps], np.int32)
        loop_layer = bm.loops.layers.int[_LOOP_LAYER]
        loops = np.array([loop[loop_layer] - 1 for face in bm.faces for loop in face.loops], np.int32)
        bm.loops.layers.int.remove(loop_layer)
    return caps, loops


def _repair_polygons(bm: bmesh.types.BMesh, loops: np.ndarray, mesh: bpy.types.Mesh,
                     standalone: bool) -> set[bmesh.types.BMEdge]:
    """If standalone, welds coincident vertices, removes duplicate faces and winds all alike; returns no edges.
    Otherwise returns the edges that were open before: a broken mesh stays as broken as it was, and only the new hole
    is closed."""
    if not standalone:
        edge = arrays.read(mesh.loops, "edge_index", np.int32)
        was_open = np.bincount(edge, minlength=len(mesh.edges))[edge[loops]] == 1
        bm_loops = (loop for face in bm.faces for loop in face.loops)
        return {loop.edge for loop, is_open in zip(bm_loops, was_open.tolist()) if is_open}
    size = max((max(vert.co[axis] for vert in bm.verts) - min(vert.co[axis] for vert in bm.verts)) for axis in range(3))
    bmesh.ops.remove_doubles(bm, verts=[vert for vert in bm.verts if vert.is_boundary], dist=WELD_DISTANCE * size)
    vertex_sets = set()
    duplicates = [face for face in bm.faces if (verts := frozenset(face.verts)) in vertex_sets
                  or vertex_sets.add(verts)]
    bmesh.ops.delete(bm, geom=duplicates, context="FACES_ONLY")
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces[:])
    return set()


# ---- Weights and look of caps


def _continue_weights(mesh: bpy.types.Mesh, caps: np.ndarray) -> None:
    """Gives each new vertex of caps the weights of the nearest vertex of the surface: bones move a cap with what it closes."""
    corners = arrays.read_corner_vertices(mesh)
    of_cap = np.repeat(arrays.make_mask(len(mesh.polygons), caps), arrays.read_polygon_sizes(mesh)[1])
    outer = np.unique(corners[~of_cap])
    inner = np.setdiff1d(corners[of_cap], outer)
    if not len(inner) or not len(outer):
        return
    with assembly.edit_as_bmesh(mesh) as bm:
        layer = bm.verts.layers.deform.active
        if layer is None:  # no vertex is in a group
            return
        bm.verts.ensure_lookup_table()
        others = arrays.create_kd_tree(arrays.read_positions(mesh)[outer], outer)
        for vert in (bm.verts[vertex] for vertex in inner.tolist()):
            if not vert[layer]:  # others are vertices of the model, with weights of their own
                vert[layer] = bm.verts[others.find(vert.co)[1]][layer]
        bm.to_mesh(mesh)


def _continue_look(mesh: bpy.types.Mesh, caps: np.ndarray) -> None:
    """Gives each cap polygon the material, and at all corners the UVs and colors, of the nearest other polygon:
    elsewhere in a texture, it would have any color."""
    colors = [attribute.name for attribute in mesh.color_attributes if attribute.domain == "CORNER"]
    is_cap = arrays.make_mask(len(mesh.polygons), caps)
    if not len(caps) or is_cap.all() or not colors and not mesh.uv_layers and len(mesh.materials) < 2:
        return
    centers = arrays.read(mesh.polygons, "center", np.float32, 3)
    others = arrays.create_kd_tree(centers[~is_cap], np.flatnonzero(~is_cap))
    nearest = np.array([others.find(center)[1] for center in centers[is_cap]], np.int32)
    indices = arrays.read_material_indices(mesh)
    indices[is_cap] = indices[nearest]
    arrays.write_material_indices(mesh, indices)
    begin, sizes = arrays.read_polygon_sizes(mesh)
    loops, sources = np.flatnonzero(np.repeat(is_cap, sizes)), np.repeat(begin[nearest], sizes[is_cap])
    for layer in mesh.uv_layers:
        uvs = arrays.read(layer.data, "uv", np.float32, 2)
        uvs[loops] = uvs[sources]
        layer.data.foreach_set("uv", uvs.ravel())
    for name in colors:
        data = mesh.color_attributes[name].data  # not earlier: another new attribute may move it
        # One by one: reading and writing all would round those of the other polygons.
        for loop, source in zip(loops.tolist(), sources.tolist()):
            data[loop].color = data[source].color


def _cap_material_slot(mesh: bpy.types.Mesh) -> int:
    """Index of the slot of the cap material, which is added if missing."""
    for slot, material in enumerate(mesh.materials):
        if material and material.name.startswith(CAP_MATERIAL_NAME):
            return slot
    material = bpy.data.materials.get(CAP_MATERIAL_NAME) or bpy.data.materials.new(CAP_MATERIAL_NAME)
    if not len(mesh.materials):
        mesh.materials.append(None)  # the other faces had no material
    mesh.materials.append(material)
    return len(mesh.materials) - 1
