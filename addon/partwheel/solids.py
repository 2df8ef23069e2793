# SPDX-License-Identifier: GPL-3.0-or-later
"""A part of a Blender mesh as a closed mesh of its own, and the mesh without it: polygons keep all their layers.

On the exact rung the part is core's Solid: the polygons that lie in it whole stay as they are, those that are cut
become triangles with their attributes, and the caps close it. On the repaired rung too, where the repair has left all
of its polygons as they are; what the repair added is a cap then. Else, and on the wrapped rung, it is the mesh's own
polygons: doubles welded, wound alike, set apart where more than two meet at an edge, every border filled. Either way
each edge has two faces.
"""

from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from . import mesh_arrays, pieces
from .core import Solid
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


def part(obj, hierarchy, tet_first, tet_last, options=Options(), faces=None):
    """A new mesh: the part tetrahedra[tet_first:tet_last] of the object's mesh, as it now is. faces (F,) bool: the faces
    that it is to have in place of its own, see core's solid_of_faces(). Raises PartwheelError."""
    return parts(obj, hierarchy, [(tet_first, tet_last)], options, faces)[0]


def parts(obj, hierarchy, slices, options=Options(), faces=None):
    """New meshes, one for each slice (tet_first, tet_last); with caps that match exactly, where they aren't smooth.
    None for a slice that has no tetrahedron left, unless it is the only one. faces: as above, for a single slice."""
    mesh = mesh_arrays.up_to_date(obj)
    exact = hierarchy.summary.rung == "exact"
    if not exact:
        found = _unbroken(mesh, hierarchy, slices, options, faces, alone=True)
    else:
        found = hierarchy.solids(slices) if len(slices) > 1 else [_solid(hierarchy, *slices[0], faces)]
        found = [solid and _exactly(mesh, hierarchy, solid, alone=True) for solid in found]
    made = []
    try:
        for each, solid in zip(slices, found):
            if exact and solid is None:
                made.append(None)
                continue
            new, normals = _carved(mesh, hierarchy, solid, *each, options, faces, alone=True)
            made.append(new)
            if normals is not None:
                mesh_arrays.set_custom_normals(new, normals)
    except Exception:
        for new in filter(None, made):
            bpy.data.meshes.remove(new)
        raise
    return made


def _solid(hierarchy, tet_first, tet_last, faces):
    if faces is None:
        return hierarchy.solid_of_slice(tet_first, tet_last)
    return hierarchy.solid_of_faces(tet_first, tet_last, faces)


def remove(obj, hierarchy, tet_first, tet_last, options=Options(), faces=None):
    """Takes the part out of the object's mesh, which must not be in Edit Mode, and closes the hole. faces: as for part().
    Raises PartwheelError or NotClosed before anything has changed."""
    target = obj.data
    check_resolution(obj)
    if hierarchy.summary.rung == "exact":
        solid = _exactly(target, hierarchy, _solid(hierarchy, tet_last, tet_first, faces), alone=False)
    else:
        solid = _unbroken(target, hierarchy, [(tet_last, tet_first)], options, faces, alone=False)[0]
    made, normals = _carved(target, hierarchy, solid, tet_last, tet_first, options, faces, alone=False)
    if options.material and len(made.materials) > len(target.materials):
        _cap_slot(target)
    pieces.replace_geometry(target, made)
    bpy.data.meshes.remove(made)
    if normals is not None:
        mesh_arrays.set_custom_normals(target, normals)
    target.update()


def check_resolution(obj):
    """Raises NotClosed if the object's mesh can't be given other faces without a loss that nobody would expect."""
    if any(other.data == obj.data and any(each.type == "MULTIRES" and each.total_levels for each in other.modifiers)
           for other in bpy.data.objects):
        raise NotClosed(f"{obj.name} is sculpted in several resolutions, which would be lost. Apply its "
                        "Multiresolution modifier first, or copy the part.")


def _carved(mesh, hierarchy, solid, tet_first, tet_last, options, faces, alone):
    """(new mesh: what is in the slice, closed; its custom normals (L,3), if the mesh has any). solid: the _Fitted of
    the slice, or None: its polygons alone, closed. alone: without what has no face."""
    exact = solid is not None
    turned = np.zeros(len(mesh.polygons), bool)
    if exact:
        plan, turned = _of_solid(mesh, solid, alone, facets=not options.smooth), solid.against
    else:
        plan = _of_faces(mesh, hierarchy, tet_first, tet_last, faces, alone)
    normals = mesh_arrays.custom_normals(mesh)
    made, loops = pieces.assembled(mesh, plan, f"{mesh.name} part"), plan.loops[:, 0]
    try:
        caps = np.flatnonzero(plan.polygons < 0)
        if not exact or options.smooth:
            caps, loops = _closed(made, loops, mesh, options.smooth, exact, alone)
        if options.material and len(caps):
            indices = mesh_arrays.material_indices(made)
            indices[caps] = _cap_slot(made)
            mesh_arrays.set_material_indices(made, indices)
        _mark(made, caps)
    except Exception:
        bpy.data.meshes.remove(made)
        raise
    if normals is not None:
        normals[np.repeat(turned, mesh_arrays.polygon_sizes(mesh)[1])] *= -1
        normals = np.where(loops[:, None] < 0, 0, normals[loops])  # 0: as Blender computes them
    return made, normals


def _closed(made, loops, mesh, smooth, exact, alone):
    """Closes the borders of a mesh made of another's polygons; where those are of no use as a solid, all that were open
    before stay so, unless alone. (its caps, (L,) the loop of the other that each of its is, -1 for new ones)"""
    bm = bmesh.new()
    try:
        bm.from_mesh(made)
        number = bm.loops.layers.int.new(_LOOP)
        for loop, source in zip((loop for face in bm.faces for loop in face.loops), loops.tolist()):
            loop[number] = source + 1
        open_before = set()
        if not exact:
            open_before = _mended(bm, loops, mesh, alone)
        if exact or alone:
            _set_apart(bm)
        caps = _fill(bm, smooth, open_before)
        if (exact or alone) and any(len(edge.link_faces) != 2 for edge in bm.edges if edge.link_faces):
            raise NotClosed("This part can't be closed: its border crosses itself. Take a larger or smaller one.")
        bm.faces.index_update()
        caps = np.array([face.index for face in caps], np.int32)
        number = bm.loops.layers.int[_LOOP]
        loops = np.array([loop[number] - 1 for face in bm.faces for loop in face.loops], np.int32)
        bm.loops.layers.int.remove(number)
        bm.to_mesh(made)
    finally:
        bm.free()
    return caps, loops


def _mended(bm, loops, mesh, alone):
    """Wound alike and doubles welded, if alone; else it is the edges that stay open, since they were before: what is
    left of a broken mesh is as broken as before, and only the new hole is closed."""
    if not alone:
        edge = read(mesh.loops, "edge_index", np.int32)
        was_open = np.bincount(edge, minlength=len(mesh.edges))[edge[loops]] == 1
        return {loop.edge for loop, was in zip((loop for face in bm.faces for loop in face.loops), was_open.tolist())
                if was}
    size = max((max(vert.co[axis] for vert in bm.verts) - min(vert.co[axis] for vert in bm.verts)) for axis in range(3))
    bmesh.ops.remove_doubles(bm, verts=[vert for vert in bm.verts if vert.is_boundary], dist=WELD * size)
    bmesh.ops.recalc_face_normals(bm, faces=bm.faces[:])
    return set()


# ---- Where each vertex and polygon comes from


class _Fitted(NamedTuple):
    """A core.Solid of which every face is of a polygon of the mesh. between (n,2): the mesh's vertices that each of its
    is midway between, mostly the same twice; -1: none. alias (V,): the vertex that each of the mesh's is taken for, or
    None: itself. against (F,): which polygons are wound the other way than the solid."""

    solid: Solid
    between: np.ndarray
    alias: np.ndarray
    against: np.ndarray


def _exactly(mesh, hierarchy, solid, alone):
    """The _Fitted of a Solid of the exact rung."""
    between = hierarchy.source[solid.ends]
    corners = between[solid.triangles]
    plain = (solid.faces >= 0) & (corners[..., 0] == corners[..., 1]).all(axis=1)
    turned = False
    if plain.any():  # all are wound alike
        example = int(plain.argmax())
        polygon = list(mesh.polygons[solid.faces[example]].vertices)
        turned = not _ascending(np.array([[polygon.index(vertex) for vertex in corners[example, :, 0]]]))[0]
    return _turned_like_mesh(_Fitted(solid, between, None, np.full(len(mesh.polygons), turned)), alone)


def _unbroken(mesh, hierarchy, slices, options, faces, alone):
    """For each slice its _Fitted, or None where the repair changed one of its polygons, or where that is of no use. If
    alone, what the repair added is caps of it; else it is not there."""
    if hierarchy.summary.rung != "repaired" or options.smooth:
        return [None] * len(slices)
    surface = mesh_arrays.surface(mesh)
    _, first, place = np.unique(surface.vertices, axis=0, return_index=True, return_inverse=True)
    alias = first[place.ravel()]
    between = np.where(hierarchy.source < 0, -1, alias[hierarchy.source])
    triangles = alias[surface.triangles]

    def matched(solid):
        corners = between[solid.ends[solid.triangles]]
        corners = np.where((corners[..., 0] == corners[..., 1]) & (solid.beyond < 0)[:, None], corners[..., 0], -1)
        return _matched(triangles, corners)

    match, turned = matched(hierarchy.solid_of_slice(0, len(hierarchy.tetrahedra)))
    wanted, there, against = (np.bincount(surface.faces[of], minlength=surface.face_count)
                              for of in (slice(None), match[match >= 0], match[turned]))
    lost = (wanted == 0) | (there != wanted) | (against % np.maximum(wanted, 1) != 0)
    against = against > 0
    if not alone:  # then the mesh stays wound as it is
        lost |= against != (2 * against.sum() > len(against))
    made = []
    found = hierarchy.solids(slices) if faces is None else [_solid(hierarchy, *slices[0], faces)]
    for (tet_first, tet_last), solid in zip(slices, found):
        if solid is None or (lost & _inside(hierarchy, tet_first, tet_last, faces)).any():
            made.append(None)
            continue
        match, _ = matched(solid)
        own = np.where(match >= 0, surface.faces[match], -1)
        own[(own >= 0) & lost[own]] = -1
        added = (solid.beyond < 0) & (own < 0)
        keep = np.ones(len(own), bool) if alone else ~added
        solid = Solid(solid.vertices, solid.triangles[keep], solid.ends, own[keep],
                      np.where(added, 0, solid.beyond)[keep])
        made.append(_turned_like_mesh(_Fitted(solid, between[solid.ends], alias, against), alone))
    return made


def _turned_like_mesh(fitted, alone):
    """What stays of a mesh stays wound as it is, so caps are turned where the mesh is inside out; what is alone has its
    polygons turned outwards."""
    if alone or not fitted.against.any():
        return fitted
    solid = fitted.solid._replace(triangles=fitted.solid.triangles[:, ::-1])
    return fitted._replace(solid=solid, against=np.zeros_like(fitted.against))


def _matched(own, other):
    """((S,) which of the triangles own each of the others is, or -1, (S,) whether it is there, wound the other way).
    One that is in own twice is none of them."""
    rows = np.sort(np.concatenate([own, other]), axis=1)
    _, number = np.unique(rows, axis=0, return_inverse=True)
    number = number.ravel()
    mine, theirs = number[:len(own)], number[len(own):]
    at = np.full(number.max() + 1, -1)
    at[mine] = np.arange(len(own))
    at[np.bincount(mine, minlength=len(at)) > 1] = -1
    match = at[theirs]
    return match, (match >= 0) & (_ascending(own)[match] != _ascending(other))


def _ascending(triangles):
    """(T,) whether the corners' numbers go up, when one begins with the least."""
    return (triangles < np.roll(triangles, -1, axis=1)).sum(axis=1) == 2


def _of_solid(mesh, fitted, alone, facets):
    """The pieces.Plan of a _Fitted: the polygons that lie in it whole stay, those that are cut become triangles; and
    its caps (if facets)."""
    solid, between, alias, against = fitted
    own = np.flatnonzero(solid.faces >= 0)
    faces, corners = solid.faces[own], solid.triangles[own]
    source = np.where(solid.ends[:, 0] == solid.ends[:, 1], between[:, 0], -1)

    # Where the surface is cut apart, one source vertex is several: the first keeps Blender's.
    first = np.full(len(mesh.vertices) + 1, -1)  # the last: of vertices that are no source vertex
    first[source[::-1]] = np.arange(len(source))[::-1]
    is_first = (first[source] == np.arange(len(source))) & (source >= 0)

    _, totals = mesh_arrays.polygon_sizes(mesh)
    triangles = np.bincount(faces, minlength=len(totals))
    strange = np.zeros(len(totals), bool)  # with a corner that is not the polygon's own
    strange[faces[(source[corners] < 0).any(axis=1)]] = True
    parted = np.zeros(len(totals), bool)  # with a corner at which the surface is cut apart
    parted[faces[~is_first[corners].all(axis=1)]] = True
    whole = (triangles == totals - 2) & ~strange
    large = whole[faces] & (totals[faces] > 3)
    of, _ = _corners_of(faces[large], corners[large], len(source))
    whole &= (totals <= 3) | (np.bincount(of, minlength=len(totals)) == totals)
    stays, apart = whole & ~parted, whole & parted
    cut, caps = ~whole[faces], solid.triangles[solid.beyond >= 0]
    if not facets:
        caps = caps[:0]

    begin = np.cumsum(totals) - totals
    polygon = np.repeat(np.arange(len(totals)), totals)

    def outwards(loops):
        """Loops of whole polygons in turn, those of polygons that are wound against the solid in the other order."""
        if not against.any():
            return loops
        of = polygon[loops]
        return np.where(against[of], begin[of] + (begin[of] - loops) % totals[of], loops)

    # Solid vertices that are not only corners of polygons that stay.
    used = np.unique(np.concatenate([corners[~stays[faces]].ravel(), caps.ravel()]))
    vertex, keep, loops, wires = _kept(mesh, stays, totals, alone, alias)
    keep[source[used[is_first[used]]]] = True
    kept = np.flatnonzero(keep)
    new = used[~is_first[used]]
    origins = np.concatenate([np.repeat(kept[:, None], 2, axis=1), between[new]])
    origins[(origins < 0).any(axis=1)] = -1
    places = solid.vertices[new].astype(np.float32)
    number = np.zeros(len(source), np.int32)  # solid vertex -> vertex of the plan
    number[is_first] = (np.cumsum(keep) - 1)[source[is_first]]
    number[new] = len(kept) + np.arange(len(new))

    loops = outwards(loops)
    parts = [_Corners(np.repeat(loops[:, None], 2, axis=1), (np.cumsum(keep) - 1)[vertex[loops]], totals[stays],
                      np.flatnonzero(stays))]
    # The loops of polygons that don't stay, by polygon and vertex.
    theirs = np.flatnonzero((apart | (triangles > 0) & ~whole)[polygon])
    key = polygon[theirs].astype(np.int64) * len(mesh.vertices) + vertex[theirs]
    order = np.argsort(key)

    def loop_of(face, at):
        return theirs[order[np.searchsorted(key, face.astype(np.int64) * len(mesh.vertices) + at, sorter=order)]]

    replaced, by = _corners_of(faces[apart[faces]], corners[apart[faces]], len(source))
    in_loop = np.zeros(len(vertex), np.int32)
    in_loop[loop_of(replaced, source[by])] = number[by]
    loops = outwards(np.flatnonzero(apart[polygon]))
    parts.append(_Corners(np.repeat(loops[:, None], 2, axis=1), in_loop[loops], totals[apart], np.flatnonzero(apart)))
    at = corners[cut].ravel()
    loops = np.stack([loop_of(np.repeat(faces[cut], 3), between[at, k]) for k in (0, 1)], axis=1)
    parts.append(_Corners(loops, number[at], np.full(cut.sum(), 3), faces[cut]))
    parts.append(_Corners(np.full((caps.size, 2), -1), number[caps.ravel()], np.full(len(caps), 3),
                          np.full(len(caps), -1)))
    return _plan(mesh, parts, kept, origins, places, wires, alias)


def _corners_of(faces, corners, count):
    """Of triangles (T,3) with the faces that they are of, each pair of a face and one of its corners, once."""
    pairs = np.unique(np.repeat(faces, 3).astype(np.int64) * count + corners.ravel())
    return np.divmod(pairs, count)


def _of_faces(mesh, hierarchy, tet_first, tet_last, faces, alone):
    """The pieces.Plan of the slice's polygons alone, or of those that it is to have in their place."""
    inside = _inside(hierarchy, tet_first, tet_last, faces)
    if not inside.any():
        raise NotClosed("This part has no face of the mesh. Take a larger one.")
    _, totals = mesh_arrays.polygon_sizes(mesh)
    vertex, keep, loops, wires = _kept(mesh, inside, totals, alone)
    kept = np.flatnonzero(keep)
    part = _Corners(np.repeat(loops[:, None], 2, axis=1), (np.cumsum(keep) - 1)[vertex[loops]], totals[inside],
                    np.flatnonzero(inside))
    return _plan(mesh, [part], kept, np.repeat(kept[:, None], 2, axis=1), np.empty((0, 3), np.float32), wires)


def _inside(hierarchy, tet_first, tet_last, faces=None):
    """(F,) which faces are of a slice of the tetrahedra, or with the two exchanged of the rest. faces: see part()."""
    leaf = hierarchy.leaf
    if faces is not None:
        return faces if tet_first < tet_last else ~faces
    if tet_first < tet_last:
        return (leaf >= tet_first) & (leaf < tet_last)
    return (leaf >= tet_first) | (leaf < tet_last)


class _Corners(NamedTuple):
    """Some of a Plan's polygons: loops (L,2), corners (L,), how many corners each polygon has (P,), polygons (P,)."""

    loops: np.ndarray
    corners: np.ndarray
    totals: np.ndarray
    polygons: np.ndarray


def _kept(mesh, stays, totals, alone, alias=None):
    """((L,) the vertex of each loop, by alias if there is one, (V,) whether it is of a polygon that stays, or has no
    face and stays, the loops of polygons that stay, edges without a face that stay). What has no face goes if alone."""
    vertex = own = read(mesh.loops, "vertex_index", np.int32)
    if alias is not None:
        vertex = alias[own]
    loops = np.flatnonzero(np.repeat(stays, totals))
    keep = np.zeros(len(mesh.vertices), bool)
    keep[vertex[loops]] = True
    wires = np.empty(0, np.int64)
    if not alone:
        wires = np.flatnonzero(np.bincount(read(mesh.loops, "edge_index", np.int32), minlength=len(mesh.edges)) == 0)
        ends = mesh_arrays.edge_vertices(mesh)
        loose = np.ones(len(keep), bool)
        loose[own] = loose[ends] = False
        keep[ends[wires]] = keep[loose] = True
    return vertex, keep, loops, wires


def _plan(mesh, parts, kept, origins, places, wires, alias=None):
    loops, corners, totals, polygons = (np.concatenate(each) for each in zip(*parts))
    begin = np.cumsum(totals) - totals
    own = read(mesh.vertices, "co", np.float32, 3)
    wire_ends = np.empty((0, 2), np.int64)
    if len(wires):
        wire_ends = np.searchsorted(kept, mesh_arrays.edge_vertices(mesh)[wires])
    return pieces.Plan(np.concatenate([own[kept], places]), origins, loops, corners, begin, polygons, wires, wire_ends,
                       alias)


# ---- What closes a border


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


def _new_vert(bm, place):
    vert = bm.verts.new(place)
    for key in bm.verts.layers.shape.values():
        vert[key] = vert.co
    return vert


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
