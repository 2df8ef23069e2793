# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a Blender mesh as a closed mesh of its own, and the mesh without it: polygons keep all their layers.

On the exact rung the part is partwheel's Solid: the polygons that lie in it whole stay as they are, those that are cut
become triangles with their attributes, and the caps close it. On the repaired rung too, where the repair has left all
of its polygons as they are; what the repair added is a cap then. Else, and where the mesh was filled from points, it is
the mesh's own polygons: doubles welded, wound alike, set apart where more than two meet at an edge, joined with the
facets inside, every other border filled. Either way each edge has two faces: polygons that are duplicates are in a part
once, and what is left of a mesh without a part keeps them.
"""

from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from ..mesh import arrays, pieces
from . import bridging, closing, fitting
from ..mesh.errors import Refused

CAP = "partwheel_cap"  # the attribute of faces that closes what was cut
CAP_MATERIAL = "Partwheel Cap"
WELD = 1e-7  # doubles are at most this part of the diagonal apart
_LOOP = "partwheel_loop"  # while we work: 1 + the source's loop that each loop was


class Options(NamedTuple):
    """smooth: caps that go on as the surface about them does, in place of the tetrahedra's own flat ones. material:
    caps get a material slot of their own."""

    smooth: bool = False
    material: bool = False


def part(obj, hierarchy, tet_first, tet_last, options=Options(), faces=None):
    """A new mesh: the part tetrahedra[tet_first:tet_last] of the object's mesh, as it now is. faces (F,) bool: the faces
    that it is to have in place of its own, see partwheel's solid_of_faces(). Raises PartwheelError."""
    return parts(obj, hierarchy, [(tet_first, tet_last)], options, faces)[0]


def parts(obj, hierarchy, slices, options=Options(), faces=None):
    """New meshes, one for each slice (tet_first, tet_last), or several each as arrays (n,); with caps that match
    exactly, where they aren't smooth. None for a slice that has no tetrahedron left, or where they can't be solids no
    face, unless it is the only one. faces: as above, for a single slice."""
    mesh = arrays.up_to_date(obj)
    exact = hierarchy.summary.rung == "exact"
    if not exact:
        found = fitting.unbroken(mesh, hierarchy, slices, options, faces, alone=True)
    else:
        found = [solid and fitting.exactly(mesh, hierarchy, solid, alone=True)
                 for solid in fitting.solids_of(hierarchy, slices, faces)]
    made = []
    try:
        for each, solid in zip(slices, found):
            if solid is None and (exact or len(slices) > 1 and not fitting.has_faces(hierarchy, *each)):
                made.append(None)
                continue
            new, normals = _carved(mesh, hierarchy, solid, *each, options, faces, alone=True)
            made.append(new)
            if normals is not None:
                arrays.set_custom_normals(new, normals)
    except Exception:
        for new in filter(None, made):
            bpy.data.meshes.remove(new)
        raise
    return made


def remove(obj, hierarchy, tet_first, tet_last, options=Options(), faces=None):
    """Takes the part out of the object's mesh, which must not be in Edit Mode, and closes the hole. faces: as for part().
    Raises PartwheelError or Refused before anything has changed."""
    target = obj.data
    check_resolution(obj)
    if hierarchy.summary.rung == "exact":
        solid = fitting.exactly(target, hierarchy, fitting.solid_of(hierarchy, tet_last, tet_first, faces), alone=False)
    else:
        solid = fitting.unbroken(target, hierarchy, [(tet_last, tet_first)], options, faces, alone=False)[0]
    made, normals = _carved(target, hierarchy, solid, tet_last, tet_first, options, faces, alone=False)
    if options.material and len(made.materials) > len(target.materials):
        _cap_slot(target)
    pieces.replace_geometry(target, made)
    bpy.data.meshes.remove(made)
    if normals is not None:
        arrays.set_custom_normals(target, normals)
    target.update()


def check_resolution(obj):
    """Raises Refused if the object's mesh can't be given other faces without a loss that nobody would expect."""
    if any(other.data == obj.data and any(each.type == "MULTIRES" and each.total_levels for each in other.modifiers)
           for other in bpy.data.objects):
        raise Refused("{name} is sculpted in several resolutions, which would be lost. Apply its Multiresolution modifier "
                      "first.", name=obj.name)


def _carved(mesh, hierarchy, solid, tet_first, tet_last, options, faces, alone):
    """(new mesh: what is in the slice, closed; its custom normals (L,3), if the mesh has any). solid: the Fitted of
    the slice, or None: its polygons alone, closed. alone: without what has no face."""
    exact = solid is not None
    turned = np.zeros(len(mesh.polygons), bool)
    if exact:
        plan, turned = fitting.of_solid(mesh, solid, alone, facets=not options.smooth), solid.against
    else:
        original = fitting.originals(mesh, hierarchy) if alone else None
        plan = fitting.of_faces(mesh, hierarchy, tet_first, tet_last, faces, alone, original)
    normals = arrays.custom_normals(mesh)
    made, loops = pieces.assembled(mesh, plan, f"{mesh.name} part", not alone), plan.loops.first
    try:
        caps = np.flatnonzero(plan.polygons < 0)
        if not exact or options.smooth:
            facets = fitting.facets(hierarchy, tet_first, tet_last, faces) if alone and not options.smooth else None
            caps, loops = _closed(made, loops, mesh, facets, options.smooth, exact, alone)
        if options.material and len(caps):
            indices = arrays.material_indices(made)
            indices[caps] = _cap_slot(made)
            arrays.set_material_indices(made, indices)
        _mark(made, caps)
    except Exception:
        bpy.data.meshes.remove(made)
        raise
    if normals is not None:
        normals[np.repeat(turned, arrays.polygon_sizes(mesh)[1])] *= -1
        normals = np.where(loops[:, None] < 0, 0, normals[loops])  # 0: as Blender computes them
    return made, normals


def _closed(made, loops, mesh, facets, smooth, exact, alone):
    """Closes the borders of a mesh made of another's polygons, by facets near them, or else by new faces; where the
    polygons are of no use as a solid, all that were open before stay so, unless alone. (its caps, (L,) the loop of the
    other that each of its is, -1 for new ones)"""
    with pieces.edited(made, made) as bm:
        number = bm.loops.layers.int.new(_LOOP)
        for loop, source in zip((loop for face in bm.faces for loop in face.loops), loops.tolist()):
            loop[number] = source + 1
        open_before = set()
        if not exact:
            open_before = _mended(bm, loops, mesh, alone)
        if exact or alone:
            closing.set_apart(bm)
        bridged = bridging.bridge(bm, facets) if facets else []
        caps = bridged + closing.fill(bm, smooth, open_before)
        if (exact or alone) and any(len(edge.link_faces) != 2 for edge in bm.edges if edge.link_faces):
            raise Refused("This part can't be closed: its border crosses itself. Take a larger or smaller one.")
        if alone and not exact:
            closing.turn_outwards(bm, bridged)
        bm.faces.index_update()
        caps = np.array([face.index for face in caps], np.int32)
        number = bm.loops.layers.int[_LOOP]
        loops = np.array([loop[number] - 1 for face in bm.faces for loop in face.loops], np.int32)
        bm.loops.layers.int.remove(number)
    return caps, loops


def _mended(bm, loops, mesh, alone):
    """Wound alike and doubles welded, if alone; else it is the edges that stay open, since they were before: what is left
    of a broken mesh is as broken as before, and only the new hole is closed."""
    if not alone:
        edge = arrays.read(mesh.loops, "edge_index", np.int32)
        was_open = np.bincount(edge, minlength=len(mesh.edges))[edge[loops]] == 1
        return {loop.edge for loop, was in zip((loop for face in bm.faces for loop in face.loops), was_open.tolist())
                if was}
    size = max((max(vert.co[axis] for vert in bm.verts) - min(vert.co[axis] for vert in bm.verts)) for axis in range(3))
    bmesh.ops.remove_doubles(bm, verts=[vert for vert in bm.verts if vert.is_boundary], dist=WELD * size)
    known = set()
    twice = [face for face in bm.faces if (verts := frozenset(face.verts)) in known or known.add(verts)]
    bmesh.ops.delete(bm, geom=twice, context="FACES_ONLY")
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces[:])
    return set()


# ---- Marks and materials, and which loop was which


def _cap_slot(mesh):
    for slot, material in enumerate(mesh.materials):
        if material and material.name.startswith(CAP_MATERIAL):
            return slot
    material = bpy.data.materials.get(CAP_MATERIAL) or bpy.data.materials.new(CAP_MATERIAL)
    if not len(mesh.materials):
        mesh.materials.append(None)  # what the other faces had
    mesh.materials.append(material)
    return len(mesh.materials) - 1


def _mark(mesh, caps):
    layer = arrays.needed_attribute(mesh, CAP, "BOOLEAN", "FACE")  # a new one is False
    marks = arrays.read(layer.data, "value", bool)
    marks[caps] = True
    layer.data.foreach_set("value", marks)
