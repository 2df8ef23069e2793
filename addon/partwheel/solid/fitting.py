# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps a partwheel.Solid to the Blender mesh it is a part of: which vertex, corner and polygon each element comes
from."""

from typing import Callable, NamedTuple

import bpy
import numpy as np

from ..mesh import Refused, arrays
from ..mesh.assembly import MeshPlan
from partwheel import Hierarchy, PartwheelError, Solid, Status, duplicates_within_shells


class MappedSolid(NamedTuple):
    """A partwheel.Solid whose faces all come from polygons of the mesh.

    source_vertices (n,): the mesh vertex of each solid vertex; -1: none.
    alias (V,): the mesh vertex that each mesh vertex is merged into; None: no merging.
    is_reversed (F,) bool: the polygons whose winding is opposite to the solid's.
    has_sheets: it has polygons that the repair left out of the solid. They have vertices of their own, and are open.
    """

    solid: Solid
    source_vertices: np.ndarray
    alias: np.ndarray | None
    is_reversed: np.ndarray
    has_sheets: bool = False


def slice_solid(hierarchy: Hierarchy, tet_first: int, tet_last: int, faces: np.ndarray | None = None) -> Solid:
    """The partwheel.Solid of a slice of tetrahedra. faces: as for solids.create_mesh()."""
    if faces is None:
        return hierarchy.solid_of_slice(tet_first, tet_last)
    return hierarchy.solid_of_faces(tet_first, tet_last, faces)


def slice_solids(hierarchy: Hierarchy, slices: list[tuple], faces: np.ndarray | None = None) -> list[Solid | None]:
    """The solids of several slices, matching where they meet; None for a slice without tetrahedra. faces: for a
    single slice only."""
    return hierarchy.solids(slices) if len(slices) > 1 else [slice_solid(hierarchy, *slices[0], faces)]


def inner_facets(hierarchy: Hierarchy, tet_first: int, tet_last: int,
                 faces: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray] | None:
    """(vertices (n, 3), triangles (m, 3)) of the slice's facets inside the whole, wound outward; None if the slice is
    empty."""
    try:
        solid = slice_solid(hierarchy, tet_first, tet_last, faces)
    except PartwheelError as error:
        if error.status != Status.EMPTY:
            raise
        return None
    return solid.vertices, solid.triangles[solid.neighbor_tets >= 0]


def map_exact_solid(mesh: bpy.types.Mesh, hierarchy: Hierarchy, solid: Solid, standalone: bool) -> MappedSolid:
    """The MappedSolid of a Solid that was filled exactly."""
    source = hierarchy.source[solid.source_vertices]
    is_outer = solid.source_faces >= 0
    is_reversed = False
    if is_outer.any():  # the winding is consistent: one triangle is enough
        example = int(is_outer.argmax())
        polygon = list(mesh.polygons[solid.source_faces[example]].vertices)
        corners = source[solid.triangles[example]]
        is_reversed = not _is_ascending(np.array([[polygon.index(vertex) for vertex in corners]]))[0]
    return _match_mesh_winding(MappedSolid(solid, source, None, np.full(len(mesh.polygons), is_reversed)), standalone)


def duplicate_originals(mesh: bpy.types.Mesh, hierarchy: Hierarchy) -> np.ndarray:
    """(F,) for each polygon, the one that it is a duplicate of, or itself."""
    return duplicates_within_shells(hierarchy, *arrays.read_surface(mesh)[:3])[0]


def map_repaired_solids(mesh: bpy.types.Mesh, hierarchy: Hierarchy, slices: list[tuple], smooth: bool,
                        faces: np.ndarray | None, standalone: bool) -> list[MappedSolid | None]:
    """For each slice its MappedSolid; None if the repair changed one of its polygons, or the fill method is another.

    standalone: faces that the repair added become caps, duplicate polygons appear once, and polygons that the repair
    left out are sheets. Otherwise added faces are left out."""
    if hierarchy.summary.fill_method == "points" and hierarchy.summary.shells == 1 or hierarchy.summary.proxy_triangles or smooth:
        return [None] * len(slices)
    surface = arrays.read_surface(mesh)
    _, first, inverse = np.unique(surface.vertices, axis=0, return_index=True, return_inverse=True)
    alias = first[inverse.ravel()]
    mesh_vertex = np.where(hierarchy.source < 0, -1, alias[hierarchy.source])  # of each vertex of the hierarchy
    original, shell = duplicates_within_shells(hierarchy, *surface[:3])
    is_original = original[surface.faces] == surface.faces
    duplicates = np.stack([surface.faces[~is_original], *alias[surface.triangles[~is_original]].T], axis=1)
    triangles, triangle_faces = alias[surface.triangles[is_original]], surface.faces[is_original]

    def match_solid(solid: Solid) -> tuple[np.ndarray, np.ndarray]:
        # Of a wall between two cells, only one side has a source face.
        outer = (solid.neighbor_tets < 0) & (solid.source_faces >= 0)
        corners = np.where(outer[:, None], mesh_vertex[solid.source_vertices[solid.triangles]], -1)
        return _match_triangles(triangles, corners, shell[triangle_faces], shell[solid.source_faces])

    whole = hierarchy.solid_of_slice(0, len(hierarchy.tetrahedra))
    match, is_flipped = match_solid(whole)
    # Faces whose place the repair has filled otherwise, and triangles whose corners are not at three places.
    is_replaced = arrays.make_mask(surface.face_count, whole.source_faces[(whole.source_faces >= 0) & (match < 0)])
    is_replaced[triangle_faces[(triangles == np.roll(triangles, 1, axis=1)).any(axis=1)]] = True
    n_expected, n_present, is_reversed = (np.bincount(triangle_faces[rows], minlength=surface.face_count)
                                          for rows in (slice(None), match[match >= 0], match[is_flipped]))
    is_changed = ((n_expected == 0) | (n_present != n_expected)
                  | (is_reversed % np.maximum(n_expected, 1) != 0))[original]
    is_reversed = is_reversed > 0
    if not standalone:  # the mesh keeps its winding
        is_changed |= is_reversed != (2 * is_reversed.sum() > len(is_reversed))
    mapped = []
    for (tet_first, tet_last), solid in zip(slices, slice_solids(hierarchy, slices, faces)):
        is_own = _face_mask(hierarchy, tet_first, tet_last, faces)
        is_sheet = is_own & (n_present == 0) & (original == np.arange(len(original)))
        if not standalone or (is_own & is_replaced).any():
            is_sheet[:] = False
        if solid is None or (is_changed & is_own & ~is_sheet[original]).any():
            mapped.append(None)
            continue
        match, _ = match_solid(solid)
        mesh_faces = np.where(match >= 0, triangle_faces[match], -1)
        mesh_faces[(mesh_faces >= 0) & is_changed[mesh_faces]] = -1
        is_added = (solid.neighbor_tets < 0) & (mesh_faces < 0)
        is_kept = np.ones(len(mesh_faces), bool) if standalone else ~is_added
        solid = Solid(solid.vertices, solid.triangles[is_kept], solid.source_vertices, mesh_faces[is_kept],
                      np.where(is_added, 0, solid.neighbor_tets)[is_kept])
        if not standalone:
            solid = _add_duplicates(solid, mesh_vertex, duplicates, original, n_expected)
        source = mesh_vertex[solid.source_vertices]
        if is_sheet.any():
            solid, source = _add_sheets(solid, source, surface.vertices, triangles[is_sheet[triangle_faces]],
                                        triangle_faces[is_sheet[triangle_faces]])
        mapped.append(_match_mesh_winding(MappedSolid(solid, source, alias, is_reversed, bool(is_sheet.any())), standalone))
    return mapped


def _add_sheets(solid: Solid, source: np.ndarray, vertices: np.ndarray, triangles: np.ndarray,
                faces: np.ndarray) -> tuple[Solid, np.ndarray]:
    """(the Solid with these triangles of the mesh, on vertices of their own, as if they were its surface; the mesh vertex
    of each vertex, like source)"""
    used, corners = np.unique(triangles, return_inverse=True)
    added = len(solid.vertices) + corners.reshape(-1, 3)
    solid = Solid(np.concatenate([solid.vertices, vertices[used]]), np.concatenate([solid.triangles, added]).astype(np.int32),
                  np.concatenate([solid.source_vertices, np.full(len(used), -1)]),
                  np.concatenate([solid.source_faces, faces]).astype(np.int32),
                  np.concatenate([solid.neighbor_tets, np.full(len(faces), -1)]).astype(np.int32))
    return solid, np.concatenate([source, used])


def _add_duplicates(solid: Solid, mesh_vertex: np.ndarray, duplicates: np.ndarray, original: np.ndarray,
                    n_triangles: np.ndarray) -> Solid:
    """The Solid with the triangles of duplicate polygons whose originals it has in full. mesh_vertex: of each vertex of
    the hierarchy; duplicates (n, 4): face and corners (mesh vertices); n_triangles (F,): triangles per face."""
    outer = solid.source_faces >= 0
    is_complete = np.bincount(solid.source_faces[outer], minlength=len(n_triangles)) == n_triangles
    duplicates = duplicates[is_complete[original[duplicates[:, 0]]]]
    if not len(duplicates):
        return solid
    # Keys of an original's corners: face * count + mesh vertex.
    corners = solid.triangles[outer].ravel()
    count = 1 + max(int(mesh_vertex.max()), int(duplicates[:, 1:].max()))
    known_keys, first = np.unique(np.repeat(solid.source_faces[outer], 3).astype(np.int64) * count
                                  + mesh_vertex[solid.source_vertices[corners]], return_index=True)
    wanted_keys = original[duplicates[:, :1]].astype(np.int64) * count + duplicates[:, 1:]
    index = np.minimum(np.searchsorted(known_keys, wanted_keys), len(known_keys) - 1)
    is_whole = (known_keys[index] == wanted_keys).all(axis=1)
    added_corners = corners[first[index[is_whole]]]
    return Solid(np.asarray(solid.vertices), np.concatenate([solid.triangles, added_corners]).astype(np.int32),
                 solid.source_vertices,
                 np.concatenate([solid.source_faces, duplicates[is_whole, 0]]).astype(np.int32),
                 np.concatenate([solid.neighbor_tets, np.full(is_whole.sum(), -1)]).astype(np.int32))


def _match_mesh_winding(mapped: MappedSolid, standalone: bool) -> MappedSolid:
    """What stays of a mesh keeps its winding, so the solid turns to it if the mesh is inside out. A standalone solid
    keeps its polygons outward."""
    if standalone or not mapped.is_reversed.any():
        return mapped
    solid = mapped.solid._replace(triangles=mapped.solid.triangles[:, ::-1])
    return mapped._replace(solid=solid, is_reversed=np.zeros_like(mapped.is_reversed))


def _match_triangles(own: np.ndarray, other: np.ndarray, own_shell: np.ndarray,
                     other_shell: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """((S,) index of each other triangle among its shell's in own, or -1; (S,) whether it is there with the opposite
    winding). A triangle that is in own twice matches none."""
    sorted_corners = np.sort(np.concatenate([own, other]), axis=1)
    _, number = np.unique(np.column_stack([sorted_corners, np.concatenate([own_shell, other_shell])]), axis=0,
                          return_inverse=True)
    number = number.ravel()
    own_numbers, other_numbers = number[:len(own)], number[len(own):]
    own_index = np.full(number.max() + 1, -1)
    own_index[own_numbers] = np.arange(len(own))
    own_index[np.bincount(own_numbers, minlength=len(own_index)) > 1] = -1
    match = own_index[other_numbers]
    return match, (match >= 0) & (_is_ascending(own)[match] != _is_ascending(other))


def _is_ascending(triangles: np.ndarray) -> np.ndarray:
    """(T,) whether the corner numbers ascend, starting at the smallest."""
    return (triangles < np.roll(triangles, -1, axis=1)).sum(axis=1) == 2


def plan_of_solid(mesh: bpy.types.Mesh, mapped: MappedSolid, standalone: bool, with_caps: bool) -> MeshPlan:
    """The assembly.MeshPlan of a MappedSolid: polygons that lie in it whole stay, cut ones become triangles; with its
    caps if with_caps."""
    solid, source, alias, is_reversed, _ = mapped
    outer = solid.source_faces >= 0
    faces, corners = solid.source_faces[outer], solid.triangles[outer]

    # Where the surface is split, a source vertex has several copies; the first one keeps its index.
    first = np.full(len(mesh.vertices) + 1, -1)  # the last entry is for solid vertices without a source vertex
    first[source[::-1]] = np.arange(len(source))[::-1]
    is_first = (first[source] == np.arange(len(source))) & (source >= 0)

    begin, totals = arrays.read_polygon_sizes(mesh)
    n_triangles = np.bincount(faces, minlength=len(totals))
    is_whole, has_split_corner = _classify_polygons(faces, corners, totals, source, is_first)
    unchanged = np.flatnonzero(is_whole & ~has_split_corner)
    split_polygons = np.flatnonzero(is_whole & has_split_corner)
    is_cut, is_changed = ~is_whole[faces], (~is_whole | has_split_corner)[faces]
    caps = solid.triangles[solid.neighbor_tets >= 0] if with_caps else np.empty((0, 3), np.int32)

    def outward_loops(polygons: np.ndarray) -> np.ndarray:
        """The loops of whole polygons, in reversed order where the winding is opposite to the solid's."""
        loops = _polygon_loops(begin, totals, polygons)
        if not is_reversed.any():
            return loops
        ngon_faces = np.repeat(polygons, totals[polygons])
        return np.where(is_reversed[ngon_faces], begin[ngon_faces] + (begin[ngon_faces] - loops) % totals[ngon_faces],
                        loops)

    # Solid vertices that are corners of other faces than unchanged polygons.
    solid_corners = np.unique(np.concatenate([corners[is_changed].ravel(), caps.ravel()]))
    loops = outward_loops(unchanged)
    vertex, is_kept, wires = _kept_elements(mesh, loops, standalone, alias)
    is_kept[source[solid_corners[is_first[solid_corners]]]] = True
    kept_vertices = np.flatnonzero(is_kept)
    from_mesh = np.cumsum(is_kept, dtype=np.int32) - 1  # mesh vertex -> plan vertex
    new = solid_corners[~is_first[solid_corners]]
    source_vertices = np.concatenate([kept_vertices, source[new]])
    positions = solid.vertices[new].astype(np.float32)
    from_solid = np.zeros(len(source), np.int32)  # solid vertex -> plan vertex
    from_solid[is_first] = from_mesh[source[is_first]]
    from_solid[new] = len(kept_vertices) + np.arange(len(new))

    parts = [_PolygonGroup(loops, from_mesh[vertex[loops]], totals[unchanged], unchanged)]
    changed_polygons = np.flatnonzero((n_triangles > 0) & ~(is_whole & ~has_split_corner))
    find_loop = _loop_finder(mesh, vertex, begin, totals, changed_polygons)
    is_split = (is_whole & has_split_corner)[faces]
    replaced_faces, replacements = _unique_corners(faces[is_split], corners[is_split], len(source))
    in_loop = np.zeros(len(vertex), np.int32)
    in_loop[find_loop(replaced_faces, source[replacements])] = from_solid[replacements]
    loops = outward_loops(split_polygons)
    parts.append(_PolygonGroup(loops, in_loop[loops], totals[split_polygons], split_polygons))
    at = corners[is_cut].ravel()
    parts.append(_PolygonGroup(find_loop(np.repeat(faces[is_cut], 3), source[at]), from_solid[at],
                               np.full(is_cut.sum(), 3), faces[is_cut]))
    parts.append(_PolygonGroup(np.full(caps.size, -1), from_solid[caps.ravel()], np.full(len(caps), 3),
                               np.full(len(caps), -1)))
    return _concatenate(mesh, parts, 0 if is_reversed.any() else len(unchanged), source_vertices, positions, wires,
                        from_mesh, alias)


def _classify_polygons(faces: np.ndarray, corners: np.ndarray, totals: np.ndarray, source: np.ndarray,
                       is_first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Masks of the polygons (P,) that lie in a solid whole, and of those with a corner where the surface is split.

    faces, corners : (n,), (n, 3) the solid's outer triangles
    totals : (P,) corners of each polygon
    source : mesh vertex of each solid vertex, or -1
    is_first : whether it is the first copy of its mesh vertex
    """
    has_foreign_corner = arrays.make_mask(len(totals), faces[(source < 0)[corners].any(axis=1)])
    has_split_corner = arrays.make_mask(len(totals), faces[~is_first[corners].all(axis=1)])
    is_whole = (np.bincount(faces, minlength=len(totals)) == totals - 2) & ~has_foreign_corner
    is_large = is_whole[faces] & (totals[faces] > 3)
    ngon_faces, _ = _unique_corners(faces[is_large], corners[is_large], len(source))
    is_whole &= (totals <= 3) | (np.bincount(ngon_faces, minlength=len(totals)) == totals)
    return is_whole, has_split_corner


def _loop_finder(mesh: bpy.types.Mesh, vertex: np.ndarray, begin: np.ndarray, totals: np.ndarray,
                 polygons: np.ndarray) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """A function that returns the loop of each pair of a polygon, one of polygons, and a vertex of it."""
    loops = _polygon_loops(begin, totals, polygons)
    key = np.repeat(polygons, totals[polygons]) * len(mesh.vertices) + vertex[loops]
    order = np.argsort(key)

    def find_loop(face: np.ndarray, at: np.ndarray) -> np.ndarray:
        return loops[order[np.searchsorted(key, face.astype(np.int64) * len(mesh.vertices) + at, sorter=order)]]

    return find_loop


def _polygon_loops(begin: np.ndarray, totals: np.ndarray, polygons: np.ndarray) -> np.ndarray:
    """The loops of the polygons, one after the other. begin, totals (F,): first loop and loop count of each of the
    mesh's polygons."""
    sizes = totals[polygons]
    if len(sizes) and (sizes == sizes[0]).all():
        return (begin[polygons][:, None] + np.arange(sizes[0])).ravel()
    ends = np.cumsum(sizes)
    return np.arange(len(sizes) and ends[-1]) + np.repeat(begin[polygons] - (ends - sizes), sizes)


def _unique_corners(faces: np.ndarray, corners: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(faces, corners): each pair of a face and one of its corners once, from triangles (T, 3) and their faces (T,)."""
    pairs = np.unique(np.repeat(faces, 3).astype(np.int64) * count + corners.ravel())
    return np.divmod(pairs, count)


def plan_of_faces(mesh: bpy.types.Mesh, hierarchy: Hierarchy, tet_first: int, tet_last: int, faces: np.ndarray | None,
                  standalone: bool, original: np.ndarray | None = None) -> MeshPlan:
    """The assembly.MeshPlan of the slice's own polygons, or of the given faces. original: from duplicate_originals(),
    to have duplicates once."""
    inside = _face_mask(hierarchy, tet_first, tet_last, faces)
    if original is not None:
        inside = inside & (original == np.arange(len(original)))
    inside = np.flatnonzero(inside)
    if not len(inside):
        raise Refused("This part has no faces of the mesh. Choose a larger one.")
    begin, totals = arrays.read_polygon_sizes(mesh)
    loops = _polygon_loops(begin, totals, inside)
    vertex, is_kept, wires = _kept_elements(mesh, loops, standalone)
    plan_vertices = np.cumsum(is_kept, dtype=np.int32) - 1
    part = _PolygonGroup(loops, plan_vertices[vertex[loops]], totals[inside], inside)
    return _concatenate(mesh, [part], len(inside), np.flatnonzero(is_kept),
                        np.empty((0, 3), np.float32), wires, plan_vertices)


def has_faces(hierarchy: Hierarchy, tet_first: int | np.ndarray, tet_last: int | np.ndarray) -> bool:
    """Whether a slice, or several, have source faces."""
    return bool(_face_mask(hierarchy, tet_first, tet_last).any())


def _face_mask(hierarchy: Hierarchy, tet_first: int | np.ndarray, tet_last: int | np.ndarray,
               faces: np.ndarray | None = None) -> np.ndarray:
    """(F,) bool: the faces of a slice of tetrahedra, of several (as arrays), or, for first > last, of the rest; or
    the given faces instead."""
    leaf = hierarchy.leaf
    if np.ndim(tet_first):
        return np.any([(leaf >= first) & (leaf < last) for first, last in zip(tet_first, tet_last)], axis=0)
    if faces is not None:
        return faces if tet_first < tet_last else ~faces
    if tet_first < tet_last:
        return (leaf >= tet_first) & (leaf < tet_last)
    return (leaf >= tet_first) | (leaf < tet_last)


class _PolygonGroup(NamedTuple):
    """Some of a MeshPlan's polygons: the sources of their loops (L,), their corners (L,), corner counts (P,), and source
    polygons (P,)."""

    loops: np.ndarray
    corners: np.ndarray
    totals: np.ndarray
    polygons: np.ndarray


def _kept_elements(mesh: bpy.types.Mesh, loops: np.ndarray, standalone: bool,
                   alias: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """((L,) the vertex of each loop, after alias; (V,) whether it is kept; edges without faces that are kept). Kept
    are vertices of the given loops and, unless standalone, loose vertices and edges."""
    loop_vertices = arrays.read(mesh.loops, "vertex_index", np.int32)
    vertex = loop_vertices if alias is None else alias[loop_vertices]
    is_kept = arrays.make_mask(len(mesh.vertices), vertex[loops])
    wires = np.empty(0, np.int64)
    if not standalone:
        edges = arrays.read(mesh.loops, "edge_index", np.int32)
        wires = np.flatnonzero(np.bincount(edges, minlength=len(mesh.edges)) == 0)
        ends = arrays.read_edge_vertices(mesh)
        is_loose = np.ones(len(is_kept), bool)
        is_loose[loop_vertices] = is_loose[ends] = False
        is_kept[ends[wires]] = is_kept[is_loose] = True
    return vertex, is_kept, wires


def _concatenate(mesh: bpy.types.Mesh, parts: list[_PolygonGroup], n_whole: int, source_vertices: np.ndarray,
                 positions: np.ndarray, wires: np.ndarray, plan_vertices: np.ndarray,
                 alias: np.ndarray | None = None) -> MeshPlan:
    """The MeshPlan of several _PolygonGroups; the first n_whole polygons are unchanged. positions (m, 3): of the last
    vertices; all before are the mesh's own."""
    loops, corners, totals, polygons = (np.concatenate(columns) for columns in zip(*parts))
    mesh_positions = arrays.read(mesh.vertices, "co", np.float32, 3)
    kept_vertices = source_vertices[:len(source_vertices) - len(positions)]
    positions = np.concatenate([mesh_positions[kept_vertices], positions])
    return MeshPlan(positions, source_vertices, loops, corners, np.cumsum(totals) - totals, polygons, n_whole, wires,
                    plan_vertices, alias)
