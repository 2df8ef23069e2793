# SPDX-License-Identifier: GPL-3.0-or-later
"""A partwheel.Solid fitted to the Blender mesh that it is a part of: where each vertex, corner and polygon comes from."""

from typing import NamedTuple

import numpy as np

from ..mesh import arrays
from partwheel import PartwheelError, Solid, Status, duplicate_faces
from ..mesh.pieces import Origins, Plan
from ..mesh.errors import Refused


class Fitted(NamedTuple):
    """A partwheel.Solid of which every face is of a polygon of the mesh. between (n,2): the mesh's vertices that each of its
    is midway between, mostly the same twice; -1: none. alias (V,): the vertex that each of the mesh's is taken for, or
    None: itself. against (F,): which polygons are wound the other way than the solid."""

    solid: Solid
    between: np.ndarray
    alias: np.ndarray
    against: np.ndarray


def solid_of(hierarchy, tet_first, tet_last, faces=None):
    """The partwheel.Solid of a slice; faces: as for solids.part()."""
    if faces is None:
        return hierarchy.solid_of_slice(tet_first, tet_last)
    return hierarchy.solid_of_faces(tet_first, tet_last, faces)


def solids_of(hierarchy, slices, faces=None):
    """The same of each of several slices, matching where they meet; None for one that has no tetrahedron left. faces: for
    a single slice."""
    return hierarchy.solids(slices) if len(slices) > 1 else [solid_of(hierarchy, *slices[0], faces)]


def facets(hierarchy, tet_first, tet_last, faces=None):
    """(vertices (n,3), triangles (m,3)) of those facets of a slice that are inside the whole, wound outwards; None if it
    has no tetrahedron left. faces: as above."""
    try:
        found = solid_of(hierarchy, tet_first, tet_last, faces)
    except PartwheelError as error:
        if error.status != Status.EMPTY:
            raise
        return None
    return found.vertices, found.triangles[found.beyond >= 0]


def exactly(mesh, hierarchy, solid, alone):
    """The Fitted of a Solid of the exact rung."""
    between = hierarchy.source[solid.ends]
    plain = (between[:, 0] == between[:, 1])[solid.triangles].all(axis=1) & (solid.faces >= 0)
    turned = False
    if plain.any():  # all are wound alike
        example = int(plain.argmax())
        polygon = list(mesh.polygons[solid.faces[example]].vertices)
        corners = between[solid.triangles[example], 0]
        turned = not _ascending(np.array([[polygon.index(vertex) for vertex in corners]]))[0]
    return _turned_like_mesh(Fitted(solid, between, None, np.full(len(mesh.polygons), turned)), alone)


def originals(mesh, hierarchy):
    """(F,) of each polygon the one that it is a duplicate of, or itself."""
    if hierarchy.summary.rung == "exact":
        return np.arange(len(mesh.polygons))
    return duplicate_faces(*arrays.surface(mesh))


def unbroken(mesh, hierarchy, slices, options, faces, alone):
    """For each slice its Fitted, or None where the repair changed one of its polygons, or where that is of no use. If
    alone, what the repair added is caps of it, and duplicates are there once; else what was added is not there."""
    if hierarchy.summary.rung != "repaired" or options.smooth:
        return [None] * len(slices)
    surface = arrays.surface(mesh)
    _, first, place = np.unique(surface.vertices, axis=0, return_index=True, return_inverse=True)
    alias = first[place.ravel()]
    between = np.where(hierarchy.source < 0, -1, alias[hierarchy.source])
    original = duplicate_faces(*surface)
    once = original[surface.faces] == surface.faces
    copies = np.stack([surface.faces[~once], *alias[surface.triangles[~once]].T], axis=1)
    triangles, of = alias[surface.triangles[once]], surface.faces[once]

    def matched(solid):
        # The far side of a wall between two cells has no face.
        outer = (solid.beyond < 0) & (solid.faces >= 0)
        return _matched(triangles, np.where(outer[:, None], _whole(between[solid.ends[solid.triangles]]), -1))

    match, turned = matched(hierarchy.solid_of_slice(0, len(hierarchy.tetrahedra)))
    wanted, there, against = (np.bincount(of[which], minlength=surface.face_count)
                              for which in (slice(None), match[match >= 0], match[turned]))
    lost = ((wanted == 0) | (there != wanted) | (against % np.maximum(wanted, 1) != 0))[original]
    against = against > 0
    if not alone:  # then the mesh stays wound as it is
        lost |= against != (2 * against.sum() > len(against))
    made = []
    found = solids_of(hierarchy, slices, faces)
    for (tet_first, tet_last), solid in zip(slices, found):
        if solid is None or (lost & _inside(hierarchy, tet_first, tet_last, faces)).any():
            made.append(None)
            continue
        match, _ = matched(solid)
        own = np.where(match >= 0, of[match], -1)
        own[(own >= 0) & lost[own]] = -1
        added = (solid.beyond < 0) & (own < 0)
        keep = np.ones(len(own), bool) if alone else ~added
        solid = Solid(solid.vertices, solid.triangles[keep], solid.ends, own[keep],
                      np.where(added, 0, solid.beyond)[keep])
        if not alone:
            solid = _with_copies(solid, between, copies, original, wanted)
        made.append(_turned_like_mesh(Fitted(solid, between[solid.ends], alias, against), alone))
    return made


def _with_copies(solid, between, copies, original, wanted):
    """The Solid with the triangles of duplicates as well, where it has all of their originals. copies (n,4): the face and
    the corners of each, vertices of the mesh; wanted (F,): how many triangles a face has."""
    outer = solid.faces >= 0
    there = np.bincount(solid.faces[outer], minlength=len(wanted)) == wanted
    copies = copies[there[original[copies[:, 0]]]]
    if not len(copies):
        return solid
    # The corners of an original, by face and vertex of the mesh.
    corners = solid.triangles[outer].ravel()
    count = 1 + max(int(between.max()), int(copies[:, 1:].max()))
    known, first = np.unique(np.repeat(solid.faces[outer], 3).astype(np.int64) * count
                             + between[solid.ends[corners, 0]], return_index=True)
    wanted_keys = original[copies[:, :1]].astype(np.int64) * count + copies[:, 1:]
    place = np.minimum(np.searchsorted(known, wanted_keys), len(known) - 1)
    whole = (known[place] == wanted_keys).all(axis=1)
    added = corners[first[place[whole]]]
    return Solid(np.asarray(solid.vertices), np.concatenate([solid.triangles, added]).astype(np.int32), solid.ends,
                 np.concatenate([solid.faces, copies[whole, 0]]).astype(np.int32),
                 np.concatenate([solid.beyond, np.full(whole.sum(), -1)]).astype(np.int32))


def _turned_like_mesh(fitted, alone):
    """What stays of a mesh stays wound as it is, so caps are turned where the mesh is inside out; what is alone has its
    polygons turned outwards."""
    if alone or not fitted.against.any():
        return fitted
    solid = fitted.solid._replace(triangles=fitted.solid.triangles[:, ::-1])
    return fitted._replace(solid=solid, against=np.zeros_like(fitted.against))


def _whole(ends):
    """(T,3) the corners of the triangles that those with these corners are, or are a piece of, wound alike; -1 where they
    are of none. ends (T,3,2): the vertices that each corner is midway between, mostly the same twice."""
    corners = np.where(ends[..., 0] == ends[..., 1], ends[..., 0], -1)
    for t in np.flatnonzero((corners < 0).any(axis=1) & (ends >= 0).all(axis=(1, 2))):
        names, place = np.unique(ends[t], return_inverse=True)
        if len(names) == 3:
            shares = np.eye(3)[place.reshape(3, 2)].mean(axis=1)  # of each corner, where in the whole it lies
            corners[t] = names if np.linalg.det(shares) > 0 else names[::-1]
    return corners


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


def of_solid(mesh, fitted, alone, facets):
    """The pieces.Plan of a Fitted: the polygons that lie in it whole stay, those that are cut become triangles; and
    its caps (if facets)."""
    solid, between, alias, against = fitted
    outer = solid.faces >= 0
    faces, corners = solid.faces[outer], solid.triangles[outer]
    source = np.where(solid.ends[:, 0] == solid.ends[:, 1], between[:, 0], -1)

    # Where the surface is cut apart, one source vertex is several: the first keeps Blender's.
    first = np.full(len(mesh.vertices) + 1, -1)  # the last: of vertices that are no source vertex
    first[source[::-1]] = np.arange(len(source))[::-1]
    is_first = (first[source] == np.arange(len(source))) & (source >= 0)

    begin, totals = arrays.polygon_sizes(mesh)
    triangles = np.bincount(faces, minlength=len(totals))
    # With a corner that is not the polygon's own; with one at which the surface is cut apart.
    strange = arrays.mask(len(totals), faces[(source < 0)[corners].any(axis=1)])
    parted = arrays.mask(len(totals), faces[~is_first[corners].all(axis=1)])
    whole = (triangles == totals - 2) & ~strange
    large = whole[faces] & (totals[faces] > 3)
    of, _ = _corners_of(faces[large], corners[large], len(source))
    whole &= (totals <= 3) | (np.bincount(of, minlength=len(totals)) == totals)
    stays, apart = np.flatnonzero(whole & ~parted), np.flatnonzero(whole & parted)
    cut, split = ~whole[faces], (~whole | parted)[faces]
    caps = solid.triangles[solid.beyond >= 0] if facets else np.empty((0, 3), np.int32)

    def outwards(polygons):
        """The loops of whole polygons; of those that are wound against the solid in the other order."""
        loops = _loops_of(begin, totals, polygons)
        if not against.any():
            return loops
        of = np.repeat(polygons, totals[polygons])
        return np.where(against[of], begin[of] + (begin[of] - loops) % totals[of], loops)

    # Solid vertices that are not only corners of polygons that stay.
    used = np.unique(np.concatenate([corners[split].ravel(), caps.ravel()]))
    loops = outwards(stays)
    vertex, keep, wires = _kept(mesh, loops, alone, alias)
    keep[source[used[is_first[used]]]] = True
    kept = np.flatnonzero(keep)
    numbers = np.cumsum(keep, dtype=np.int32) - 1  # of the mesh's vertices: those of the plan
    new = used[~is_first[used]]
    ends = between[new]
    ends[(ends < 0).any(axis=1)] = -1
    middle = np.flatnonzero(ends[:, 0] != ends[:, 1])
    origins = Origins(np.concatenate([kept, ends[:, 0]]), len(kept) + middle, ends[middle, 1])
    places = solid.vertices[new].astype(np.float32)
    number = np.zeros(len(source), np.int32)  # of the solid's vertices: those of the plan
    number[is_first] = numbers[source[is_first]]
    number[new] = len(kept) + np.arange(len(new))

    parts = [_Corners(Origins(loops), numbers[vertex[loops]], totals[stays], stays)]
    # The loops of polygons that don't stay, by polygon and vertex.
    others = np.flatnonzero((triangles > 0) & ~(whole & ~parted))
    theirs = _loops_of(begin, totals, others)
    key = np.repeat(others, totals[others]) * len(mesh.vertices) + vertex[theirs]
    order = np.argsort(key)

    def loop_of(face, at):
        return theirs[order[np.searchsorted(key, face.astype(np.int64) * len(mesh.vertices) + at, sorter=order)]]

    of_apart = (whole & parted)[faces]
    replaced, by = _corners_of(faces[of_apart], corners[of_apart], len(source))
    in_loop = np.zeros(len(vertex), np.int32)
    in_loop[loop_of(replaced, source[by])] = number[by]
    loops = outwards(apart)
    parts.append(_Corners(Origins(loops), in_loop[loops], totals[apart], apart))
    at = corners[cut].ravel()
    one, other = (loop_of(np.repeat(faces[cut], 3), between[at, k]) for k in (0, 1))
    middle = np.flatnonzero(one != other)
    parts.append(_Corners(Origins(one, middle, other[middle]), number[at], np.full(cut.sum(), 3), faces[cut]))
    parts.append(_Corners(Origins(np.full(caps.size, -1)), number[caps.ravel()], np.full(len(caps), 3),
                          np.full(len(caps), -1)))
    return _plan(mesh, parts, 0 if against.any() else len(stays), origins, places, wires, numbers, alias)


def _loops_of(begin, totals, polygons):
    """The loops of polygons, in turn. begin, totals (F,): the first loop of each of the mesh's, and how many it has."""
    sizes = totals[polygons]
    if len(sizes) and (sizes == sizes[0]).all():
        return (begin[polygons][:, None] + np.arange(sizes[0])).ravel()
    ends = np.cumsum(sizes)
    return np.arange(len(sizes) and ends[-1]) + np.repeat(begin[polygons] - (ends - sizes), sizes)


def _corners_of(faces, corners, count):
    """Of triangles (T,3) with the faces that they are of, each pair of a face and one of its corners, once."""
    pairs = np.unique(np.repeat(faces, 3).astype(np.int64) * count + corners.ravel())
    return np.divmod(pairs, count)


def of_faces(mesh, hierarchy, tet_first, tet_last, faces, alone, original=None):
    """The pieces.Plan of the slice's polygons alone, or of those that it is to have in their place. original: as
    originals() gives it, where duplicates are to be there once."""
    inside = _inside(hierarchy, tet_first, tet_last, faces)
    if original is not None:
        inside = inside & (original == np.arange(len(original)))
    inside = np.flatnonzero(inside)
    if not len(inside):
        raise Refused("This part has no face of the mesh. Take a larger one.")
    begin, totals = arrays.polygon_sizes(mesh)
    loops = _loops_of(begin, totals, inside)
    vertex, keep, wires = _kept(mesh, loops, alone)
    numbers = np.cumsum(keep, dtype=np.int32) - 1
    part = _Corners(Origins(loops), numbers[vertex[loops]], totals[inside], inside)
    return _plan(mesh, [part], len(inside), Origins(np.flatnonzero(keep)), np.empty((0, 3), np.float32), wires, numbers)


def has_faces(hierarchy, tet_first, tet_last):
    """Whether a slice, or several, have any."""
    return bool(_inside(hierarchy, tet_first, tet_last).any())


def _inside(hierarchy, tet_first, tet_last, faces=None):
    """(F,) which faces are of a slice of the tetrahedra, or of several, or with the two exchanged of the rest, or are
    those (F,) bool."""
    leaf = hierarchy.leaf
    if np.ndim(tet_first):
        return np.any([(leaf >= first) & (leaf < last) for first, last in zip(tet_first, tet_last)], axis=0)
    if faces is not None:
        return faces if tet_first < tet_last else ~faces
    if tet_first < tet_last:
        return (leaf >= tet_first) & (leaf < tet_last)
    return (leaf >= tet_first) | (leaf < tet_last)


class _Corners(NamedTuple):
    """Some of a Plan's polygons: the Origins of their loops, corners (L,), how many corners each has (P,), and the
    polygons (P,)."""

    loops: Origins
    corners: np.ndarray
    totals: np.ndarray
    polygons: np.ndarray


def _kept(mesh, loops, alone, alias=None):
    """((L,) the vertex of each loop, by alias if there is one, (V,) whether it is of one of the loops that stay, or has
    no face and stays, edges without a face that stay). What has no face goes if alone."""
    vertex = own = arrays.read(mesh.loops, "vertex_index", np.int32)
    if alias is not None:
        vertex = alias[own]
    keep = arrays.mask(len(mesh.vertices), vertex[loops])
    wires = np.empty(0, np.int64)
    if not alone:
        edges = arrays.read(mesh.loops, "edge_index", np.int32)
        wires = np.flatnonzero(np.bincount(edges, minlength=len(mesh.edges)) == 0)
        ends = arrays.edge_vertices(mesh)
        loose = np.ones(len(keep), bool)
        loose[own] = loose[ends] = False
        keep[ends[wires]] = keep[loose] = True
    return vertex, keep, wires


def _plan(mesh, parts, whole, origins, places, wires, numbers, alias=None):
    """The Plan of _Corners, of which the first has whole polygons as they are, or none. places (m,3): of the last of
    the vertices, the others are the mesh's own."""
    starts = np.cumsum([0] + [len(part.corners) for part in parts])
    loops = Origins(*(np.concatenate(each) for each in zip(*(
        (part.loops.first, start + part.loops.at, part.loops.other) for part, start in zip(parts, starts)))))
    corners, totals, polygons = (np.concatenate(each) for each in list(zip(*parts))[1:])
    own = arrays.read(mesh.vertices, "co", np.float32, 3)
    kept = origins.first[:len(origins.first) - len(places)]
    places = np.concatenate([own[kept], places])
    return Plan(places, origins, loops, corners, np.cumsum(totals) - totals, polygons, whole, wires, numbers, alias)
