# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a Blender mesh as a closed mesh of its own, and the mesh without it: polygons keep all their layers.

On the exact rung the part is core's Solid: the polygons that lie in it whole stay as they are, those that are cut
become triangles with their attributes, and the caps close it. On the other rungs it is the mesh's own polygons: doubles
welded, wound alike, set apart where more than two meet at an edge, every border filled. Either way each edge has two faces.
"""

from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from . import mesh_arrays
from .mesh_arrays import read

CAP = "partwheel_cap"  # the attribute of faces that closes what was cut
CAP_MATERIAL = "Partwheel Cap"
RINGS = 4  # of faces in a smooth cap, between its border and its middle
STEPS = 200  # of fairing
WELD = 1e-7  # doubles are at most this part of the diagonal apart
_LOOP = "partwheel_loop"  # while we work: 1 + the source's loop that each loop was


class Options(NamedTuple):
    """smooth: caps that go on as the surface about them does, in place of the tetrahedra's own flat ones. material:
    caps get a material slot of their own."""

    smooth: bool = False
    material: bool = False


class NotClosed(Exception):
    """A part that can't be made a solid. str() is a sentence for the user."""


def part(obj, hierarchy, tet_first, tet_last, options=Options()):
    """A new mesh: the part tetrahedra[tet_first:tet_last] of the object's mesh, as it now is. Raises PartwheelError."""
    mesh = mesh_arrays.up_to_date(obj)
    made = mesh.copy()
    made.name = f"{mesh.name} part"
    try:
        _carve(mesh, made, hierarchy, tet_first, tet_last, options, alone=True)
    except Exception:
        bpy.data.meshes.remove(made)
        raise
    return made


def remove(obj, hierarchy, tet_first, tet_last, options=Options()):
    """Takes the part out of the object's mesh, which must not be in Edit Mode, and closes the hole. Raises
    PartwheelError before anything has changed."""
    _carve(obj.data, obj.data, hierarchy, tet_last, tet_first, options, alone=False)


def _carve(mesh, target, hierarchy, tet_first, tet_last, options, alone):
    """Makes of target, which is the mesh or a copy, what is in the slice, closed. alone: loose elements go too."""
    exact = hierarchy.summary.rung == "exact"
    solid = hierarchy.solid_of_slice(tet_first, tet_last) if exact else None
    normals = mesh_arrays.custom_normals(mesh)
    bm = bmesh.new()
    try:
        bm.from_mesh(mesh)
        if normals is not None:
            _number_loops(bm)
        open_before = set()
        if exact:
            caps = _keep_solid(bm, mesh, hierarchy, solid, alone, facets=not options.smooth)
        else:
            open_before = _keep_faces(bm, hierarchy, tet_first, tet_last, alone)
        if not exact or options.smooth:
            if exact or alone:
                _set_apart(bm)
            caps = _fill(bm, options.smooth, open_before)
            if (exact or alone) and any(len(edge.link_faces) != 2 for edge in bm.edges if edge.link_faces):
                raise NotClosed("This part can't be closed: its border crosses itself. Take a larger or smaller one.")
        bm.faces.index_update()
        indices = np.fromiter((face.index for face in caps), np.int32, len(caps))
        if options.material and len(indices):
            slot = _cap_slot(target)
            for face in caps:
                face.material_index = slot
        loops = _take_loop_numbers(bm) if normals is not None else None
        bm.to_mesh(target)
    finally:
        bm.free()
    _mark(target, indices)
    if normals is not None:
        chosen = normals[np.maximum(loops, 0)]
        chosen[loops < 0] = 0  # as Blender computes them
        mesh_arrays.set_custom_normals(target, chosen)
    target.update()


# ---- The exact rung: core's Solid


def _keep_solid(bm, mesh, hierarchy, solid, alone, facets):
    """Leaves only the solid's polygons, cuts those that lie in it in part, and adds its caps (if facets)."""
    polygons = list(bm.faces)
    own = np.flatnonzero(solid.faces >= 0)
    faces, corners = solid.faces[own], solid.triangles[own]
    source = np.where(solid.ends[:, 0] == solid.ends[:, 1], hierarchy.source[solid.ends[:, 0]], -1)

    # Where the surface is cut apart, one source vertex is several: the first keeps Blender's.
    _, firsts = np.unique(source, return_index=True)
    is_first = np.zeros(len(source), bool)
    is_first[firsts] = True
    is_first &= source >= 0

    totals = read(mesh.polygons, "loop_total", np.int32)
    triangles = np.bincount(faces, minlength=len(totals))
    pairs = np.unique(np.repeat(faces, 3).astype(np.int64) * len(source) + corners.ravel())
    of, at = np.divmod(pairs, len(source))  # a face, and a corner of the solid that it has
    strange = np.zeros(len(totals), bool)  # with a corner that is not the polygon's own
    strange[of[source[at] < 0]] = True
    whole = (triangles == totals - 2) & (np.bincount(of, minlength=len(totals)) == totals) & ~strange
    parted = np.zeros(len(totals), bool)  # with a corner at which the surface is cut apart
    parted[of[~is_first[at]]] = True
    stays = whole & ~parted

    # Those that are not only corners of polygons that stay.
    rest = corners[~stays[faces]].ravel()
    verts = _vertices(bm, hierarchy, solid, source, is_first,
                      np.union1d(rest, solid.triangles[solid.beyond >= 0]) if facets else np.unique(rest))
    new_corner = {}
    apart = (whole & parted)[of]
    for face, corner in zip(of[apart].tolist(), at[apart].tolist()):
        new_corner.setdefault(face, {})[int(source[corner])] = verts[corner]
    for face, replaced in new_corner.items():
        old = polygons[face]
        copy_face(bm, old, [(replaced[loop.vert.index], loop) for loop in old.loops])
    cut = ~whole[faces]
    for face, triangle in zip(faces[cut].tolist(), corners[cut].tolist()):
        old = polygons[face]
        loops = {loop.vert.index: loop for loop in old.loops}
        copy_face(bm, old, [(verts[corner], loops[int(source[corner])] if source[corner] >= 0 else
                             tuple(loops[int(hierarchy.source[end])] for end in solid.ends[corner]))
                            for corner in triangle])
    caps = []
    if facets:
        for triangle in solid.triangles[solid.beyond >= 0].tolist():
            cap = bm.faces.new([verts[corner] for corner in triangle])
            cap.smooth = False
            caps.append(cap)
    _delete(bm, [face for face, keep in zip(polygons, stays.tolist()) if not keep], alone)
    return caps


def _vertices(bm, hierarchy, solid, source, is_first, used):
    """Solid vertex -> BMVert, of these: Blender's own where there is one, a copy of it where the surface is cut apart,
    else new."""
    verts = {}
    own = list(bm.verts)
    for corner in used.tolist():
        vertex = int(source[corner])
        if is_first[corner]:
            verts[corner] = own[vertex]
        elif vertex >= 0:
            verts[corner] = bm.verts.new(own[vertex].co, own[vertex])
        else:
            a, b = (int(hierarchy.source[end]) for end in solid.ends[corner])
            if a >= 0 and b >= 0:
                middle = bm.verts.new((own[a].co + own[b].co) / 2, own[a])
                middle.copy_from_vert_interp((own[a], own[b]), 0.5)
                verts[corner] = middle
            else:
                verts[corner] = _new_vert(bm, solid.vertices[corner])
    return verts


def _new_vert(bm, place):
    vert = bm.verts.new(place)
    for key in bm.verts.layers.shape.values():
        vert[key] = vert.co
    return vert


def copy_face(bm, old, corners):
    """A new face with the attributes of an old one. corners: (its vertex, the loop of old that it copies; or two, for a
    vertex midway between them)."""
    # Never copy_from(): it also copies Blender's link from an element to its Python object, and crashes later.
    for (vert, source), (after, source_after) in zip(corners, corners[1:] + corners[:1]):
        if isinstance(source, tuple):
            source = source[0]
        following = source_after[1] if isinstance(source_after, tuple) else source_after
        if source.link_loop_next == following and not bm.edges.get((vert, after)):
            bm.edges.new((vert, after), source.edge)
    new = bm.faces.new([vert for vert, _ in corners], old)
    new.smooth, new.material_index = old.smooth, old.material_index
    for loop, (_, source) in zip(new.loops, corners):
        if isinstance(source, tuple):
            _mix_layers(bm.loops.layers, *source, loop)
        else:
            _copy_layers(bm.loops.layers, source, loop)


def _copy_layers(layers, old, new):
    for kind in ("bool", "int", "float", "string", "float_vector", "color", "float_color"):
        for layer in getattr(layers, kind).values() if hasattr(layers, kind) else ():
            new[layer] = old[layer]
    for layer in layers.uv.values():
        new[layer].uv, new[layer].pin_uv = old[layer].uv, old[layer].pin_uv


def _mix_layers(layers, one, other, new):
    _copy_layers(layers, one, new)
    for kind in ("float", "float_vector", "color", "float_color"):
        for layer in getattr(layers, kind).values() if hasattr(layers, kind) else ():
            new[layer] = (one[layer] + other[layer]) / 2
    for layer in layers.uv.values():
        new[layer].uv = (one[layer].uv + other[layer].uv) / 2


def _delete(bm, faces, alone):
    wires = [edge for edge in bm.edges if edge.is_wire] if alone else []
    dots = [vert for vert in bm.verts if not vert.link_edges] if alone else []
    for geometry, context in ((faces, "FACES"), (wires, "EDGES"), (dots, "VERTS")):
        if geometry:  # even of nothing it takes its time
            bmesh.ops.delete(bm, geom=geometry, context=context)
    if wires:
        bmesh.ops.delete(bm, geom=[vert for vert in bm.verts if not vert.link_edges], context="VERTS")


# ---- The other rungs: the mesh's own polygons


def _keep_faces(bm, hierarchy, tet_first, tet_last, alone):
    """Leaves only the slice's polygons. Edges that were open before and are to stay so."""
    leaf = hierarchy.leaf
    inside = ((leaf >= tet_first) & (leaf < tet_last) if tet_first < tet_last
              else (leaf >= tet_first) | (leaf < tet_last))
    if not inside.any():
        raise NotClosed("This part has no face of the mesh. Take a larger one.")
    open_before = {edge for edge in bm.edges if edge.is_boundary}
    _delete(bm, [face for face, keep in zip(bm.faces, inside.tolist()) if not keep], alone)
    if not alone:  # what is left of a broken mesh is as broken as before; only the new hole is closed
        return {edge for edge in open_before if edge.is_valid}
    size = max((max(vert.co[axis] for vert in bm.verts) - min(vert.co[axis] for vert in bm.verts)) for axis in range(3))
    bmesh.ops.remove_doubles(bm, verts=[vert for vert in bm.verts if vert.is_boundary], dist=WELD * size)
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces[:])
    return set()


def _set_apart(bm):
    """Afterwards at most two faces meet at each edge, wound alike, and the faces about each vertex are one fan."""
    bad = [edge for edge in bm.edges
           if len(edge.link_faces) > 2 or (len(edge.link_faces) == 2 and not edge.is_contiguous)]
    if bad:
        bmesh.ops.split_edges(bm, edges=bad)
    for vert in [vert for vert in bm.verts if vert.is_boundary]:
        fans = _fans(vert)
        for fan in fans[1:]:
            bmesh.utils.vert_separate(vert, [edge for edge in fan if edge.is_boundary])


def _fans(vert):
    """The edges about a vertex in groups that are joined by faces."""
    fans, left = [], {edge for edge in vert.link_edges if edge.link_faces}
    while left:
        fan, todo = set(), [left.pop()]
        while todo:
            edge = todo.pop()
            fan.add(edge)
            for face in edge.link_faces:
                for other in face.edges:
                    if other in left and vert in other.verts:
                        left.remove(other)
                        todo.append(other)
        fans.append(fan)
    return fans


def _fill(bm, smooth, open_before):
    """Closes every other border by rings of faces around a new vertex in its middle; smooth: relaxed so that they go on
    as the surface about them does. The new faces."""
    caps, left = [], {edge for edge in bm.edges if edge.is_boundary} - open_before
    while left:
        border = _border(left.pop(), left)
        if border:
            caps += _fill_border(bm, border, RINGS if smooth else 0)
    return caps


def _border(edge, left):
    """The vertices of a border in the order that new faces run along it: against its own faces."""
    loop = edge.link_loops[0]
    start, vert = loop.link_loop_next.vert, loop.vert
    border = [start]
    while vert != start:
        border.append(vert)
        edge = next((other for other in vert.link_edges if other in left), None)
        if edge is None:
            return []
        left.remove(edge)
        vert = edge.other_vert(vert)
    return border


def _fill_border(bm, border, rings):
    middle = sum((vert.co for vert in border[1:]), border[0].co.copy()) / len(border)
    rows, caps = [border], []
    for ring in range(rings):
        share = (ring + 1) / (rings + 1)
        rows.append([_new_vert(bm, vert.co.lerp(middle, share)) for vert in border])
    top = _new_vert(bm, middle)
    count = len(border)
    for outer, inner in zip(rows, rows[1:]):
        caps += [bm.faces.new((outer[i], outer[(i + 1) % count], inner[(i + 1) % count], inner[i]))
                 for i in range(count)]
    caps += [bm.faces.new((rows[-1][i], rows[-1][(i + 1) % count], top)) for i in range(count)]
    for face in caps:
        face.smooth = rings > 0
    if rings:
        _fair(rows, top)
    return caps


def _fair(rows, top):
    """Moves the new vertices until the discrete bi-Laplacian vanishes (Kobbelt et al. 1998), so that the cap leaves the
    border as the surface arrives there. Rows of vertices from the border inwards; the border and what lies outside it
    stay."""
    border = rows[0]
    count = len(border)
    inside = np.array([[vert.co[:] for vert in row] for row in rows[1:]] )
    fixed = np.array([vert.co[:] for vert in border])
    # One row outside the border: where the surface comes from.
    new = {vert for row in rows[1:] for vert in row} | {top}
    beside = []
    for vert in border:
        around = [edge.other_vert(vert).co for edge in vert.link_edges
                  if edge.other_vert(vert) not in new and edge.other_vert(vert) not in border]
        beside.append(sum(around[1:], around[0].copy()) / len(around) if around else vert.co)
    beside = np.array([co[:] for co in beside])
    size = np.linalg.norm(inside[0] - fixed, axis=1).mean()
    away = beside - fixed
    length = np.linalg.norm(away, axis=1, keepdims=True)
    beside = fixed + away * (size / np.maximum(length, 1e-30))
    grid = np.concatenate([beside[None], fixed[None], inside])
    peak = np.array(top.co[:])
    for _ in range(STEPS):
        full = np.concatenate([grid, np.broadcast_to(peak, (1, count, 3))])
        umbrella = np.zeros_like(full)
        umbrella[1:-1] = (full[:-2] + full[2:] + np.roll(full[1:-1], 1, axis=1) + np.roll(full[1:-1], -1, axis=1)
                          ) / 4 - full[1:-1]
        umbrella[-1] = grid[-1].mean(axis=0) - peak
        second = np.zeros_like(full)
        second[2:-1] = (umbrella[1:-2] + umbrella[3:] + np.roll(umbrella[2:-1], 1, axis=1)
                        + np.roll(umbrella[2:-1], -1, axis=1)) / 4 - umbrella[2:-1]
        grid[2:] -= 0.4 * second[2:-1]
        peak = peak - 0.4 * (umbrella[-2].mean(axis=0) - umbrella[-1][0])
    for row, places in zip(rows[1:], grid[2:]):
        for vert, place in zip(row, places):
            vert.co = place
    top.co = peak


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
    known = mesh.attributes.get(CAP)
    if known and (known.domain, known.data_type) != ("FACE", "BOOLEAN"):
        mesh.attributes.remove(known)
        known = None
    layer = known or mesh.attributes.new(CAP, "BOOLEAN", "FACE")
    marks = read(layer.data, "value", bool)
    marks[caps] = True
    layer.data.foreach_set("value", marks)


def _number_loops(bm):
    layer = bm.loops.layers.int.new(_LOOP)
    number = 1
    for face in bm.faces:
        for loop in face.loops:
            loop[layer] = number
            number += 1


def _take_loop_numbers(bm):
    """(L,) the source's loop that each loop was, -1 for new ones."""
    layer = bm.loops.layers.int[_LOOP]
    numbers = np.fromiter((loop[layer] - 1 for face in bm.faces for loop in face.loops), np.int32)
    bm.loops.layers.int.remove(layer)
    return numbers
