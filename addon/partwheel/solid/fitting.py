# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps a partwheel.Solid to its Blender mesh: which vertex, corner and polygon each element comes from."""

from collections.abc import Callable
from typing import NamedTuple

import bpy
import numpy as np

from ..mesh import Refused, arrays
from ..mesh.assembly import MeshPlan
from partwheel import Hierarchy, Solid, duplicates_within_shells


class MappedSolid(NamedTuple):
    """A partwheel.Solid whose faces all come from polygons of the mesh."""

    solid: Solid
    source_vertices: np.ndarray  # (n,) the mesh vertex of each solid vertex; -1: none
    welded_to: np.ndarray | None  # (V,) the mesh vertex that each mesh vertex is welded to; None: itself
    is_reversed: np.ndarray  # (F,) bool: the polygons whose winding is opposite to the solid's
    has_sheets: bool = False  # polygons that the repair left out of the solid; they have vertices of their own, and are open


# Parameters of this module: tets is (first, last), a slice of the tetrahedra; or arrays of several; if first > last, all
# tetrahedra but last to first - 1. faces (F,) bool: faces to have instead of the slice's own, see Hierarchy.solid_of_slice().


def slice_solids(hierarchy: Hierarchy, slices: list[tuple], faces: np.ndarray | None) -> list[Solid | None]:
    """The solids of slices, matching where they meet; None for an empty one. faces: for a single slice only."""
    return hierarchy.solids(slices) if len(slices) > 1 else [hierarchy.solid_of_slice(*slices[0], faces)]


def inner_facets(hierarchy: Hierarchy, tets: tuple, faces: np.ndarray | None) -> tuple[np.ndarray, np.ndarray] | None:
    """(vertices (n, 3), triangles (m, 3)) of the slice's inner facets, wound outward; None for an empty slice."""
    solid = hierarchy.solids([tets], faces)[0]
    return solid and (solid.vertices, solid.triangles[solid.neighbor_tets >= 0])


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
    repaired = _RepairedMesh(mesh, hierarchy, standalone)
    return [solid and repaired.map_solid(solid, face_mask(hierarchy, tets, faces))
            for tets, solid in zip(slices, slice_solids(hierarchy, slices, faces))]


class _RepairedMesh:
    """A mesh, and how the repair has changed it. Coincident vertices count as one: welded_to."""

    def __init__(self, mesh: bpy.types.Mesh, hierarchy: Hierarchy, standalone: bool) -> None:
        surface, self.standalone = arrays.read_surface(mesh), standalone
        _, first, inverse = np.unique(surface.vertices, axis=0, return_index=True, return_inverse=True)
        self.vertices, self.welded_to = surface.vertices, first[inverse.ravel()]
        self.mesh_vertex = np.where(hierarchy.source < 0, -1, self.welded_to[hierarchy.source])  # of each vertex of the hierarchy
        self.original, self.shell = duplicates_within_shells(hierarchy, *surface[:3])
        is_original = self.original[surface.faces] == surface.faces
        corners = self.welded_to[surface.triangles]
        self.duplicates = np.column_stack([surface.faces[~is_original], corners[~is_original]])  # face and corners of each
        self.triangles, self.triangle_faces = corners[is_original], surface.faces[is_original]
        self._compare(hierarchy.solid_of_slice(0, len(hierarchy.tetrahedra)), surface.face_count)

    def _compare(self, whole: Solid, n_faces: int) -> None:
        """Find out which polygons the repair has changed, by the solid of the whole."""
        match, is_flipped = self._match(whole)
        # Faces whose place the repair has filled otherwise, and triangles whose corners are not at three places.
        self.is_replaced = arrays.make_mask(n_faces, whole.source_faces[(whole.source_faces >= 0) & (match < 0)])
        self.is_replaced[self.triangle_faces[(self.triangles == np.roll(self.triangles, 1, axis=1)).any(axis=1)]] = True
        self.n_expected, self.n_present, n_reversed = (
            np.bincount(self.triangle_faces[rows], minlength=n_faces) for rows in (slice(None), match[match >= 0], match[is_flipped]))
        self.is_changed = ((self.n_expected == 0) | (self.n_present != self.n_expected)
                           | (n_reversed % np.maximum(self.n_expected, 1) != 0))[self.original]
        self.is_reversed = n_reversed > 0
        if not self.standalone:  # the mesh keeps its winding
            self.is_changed |= self.is_reversed != (2 * self.is_reversed.sum() > n_faces)

    def _match(self, solid: Solid) -> tuple[np.ndarray, np.ndarray]:
        """_match_triangles() of the mesh and the solid."""
        # A wall between two cells has a source face on one side only.
        outer = (solid.neighbor_tets < 0) & (solid.source_faces >= 0)
        corners = np.where(outer[:, None], self.mesh_vertex[solid.source_vertices[solid.triangles]], -1)
        return _match_triangles(self.triangles, corners, self.shell[self.triangle_faces], self.shell[solid.source_faces])

    def map_solid(self, solid: Solid, is_own: np.ndarray) -> MappedSolid | None:
        """The MappedSolid of a slice with these faces (F,); None if the repair changed one of them."""
        is_sheet = is_own & (self.n_present == 0) & (self.original == np.arange(len(self.original)))
        if not self.standalone or (is_own & self.is_replaced).any():
            is_sheet[:] = False
        if (self.is_changed & is_own & ~is_sheet[self.original]).any():
            return None
        match, _ = self._match(solid)
        mesh_faces = np.where(match >= 0, self.triangle_faces[match], -1)
        mesh_faces[(mesh_faces >= 0) & self.is_changed[mesh_faces]] = -1
        is_added = (solid.neighbor_tets < 0) & (mesh_faces < 0)
        is_kept = np.ones(len(mesh_faces), bool) if self.standalone else ~is_added
        solid = Solid(solid.vertices, solid.triangles[is_kept], solid.source_vertices, mesh_faces[is_kept],
                      np.where(is_added, 0, solid.neighbor_tets)[is_kept])
        if not self.standalone:
            solid = self._add_duplicates(solid)
        source = self.mesh_vertex[solid.source_vertices]
        if is_sheet.any():
            solid, source = self._add_sheets(solid, source, is_sheet[self.triangle_faces])
        return _match_mesh_winding(MappedSolid(solid, source, self.welded_to, self.is_reversed, bool(is_sheet.any())),
                                   self.standalone)

    def _add_sheets(self, solid: Solid, source: np.ndarray, rows: np.ndarray) -> tuple[Solid, np.ndarray]:
        """(the Solid with these triangles of the mesh, on vertices of their own, as if they were its surface; the mesh
        vertex of each vertex, like source)"""
        used, corners = np.unique(self.triangles[rows], return_inverse=True)
        solid = _extend_solid(solid._replace(vertices=np.concatenate([solid.vertices, self.vertices[used]]),
                                             source_vertices=np.append(solid.source_vertices, np.full(len(used), -1))),
                              len(solid.vertices) + corners.reshape(-1, 3), self.triangle_faces[rows])
        return solid, np.concatenate([source, used])

    def _add_duplicates(self, solid: Solid) -> Solid:
        """The Solid with the triangles of duplicate polygons whose originals it has in full."""
        outer = solid.source_faces >= 0
        is_complete = np.bincount(solid.source_faces[outer], minlength=len(self.n_expected)) == self.n_expected
        duplicates = self.duplicates[is_complete[self.original[self.duplicates[:, 0]]]]
        if not len(duplicates):
            return solid
        # Keys of an original's corners: face * count + mesh vertex.
        corners = solid.triangles[outer].ravel()
        count = 1 + max(int(self.mesh_vertex.max()), int(duplicates[:, 1:].max()))
        known_keys, first = np.unique(np.repeat(solid.source_faces[outer], 3).astype(np.int64) * count
                                      + self.mesh_vertex[solid.source_vertices[corners]], return_index=True)
        wanted_keys = self.original[duplicates[:, :1]].astype(np.int64) * count + duplicates[:, 1:]
        index = np.minimum(np.searchsorted(known_keys, wanted_keys), len(known_keys) - 1)
        is_whole = (known_keys[index] == wanted_keys).all(axis=1)
        return _extend_solid(solid, corners[first[index[is_whole]]], duplicates[is_whole, 0])


def _extend_solid(solid: Solid, triangles: np.ndarray, faces: np.ndarray) -> Solid:
    """The Solid with more outer triangles (n, 3), of these faces (n,)."""
    return solid._replace(triangles=np.concatenate([solid.triangles, triangles]).astype(np.int32),
                          source_faces=np.concatenate([solid.source_faces, faces]).astype(np.int32),
                          neighbor_tets=np.append(solid.neighbor_tets, np.full(len(faces), -1)).astype(np.int32))


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
    """The MeshPlan of a MappedSolid: polygons in it whole stay, cut ones become triangles; with_caps: its caps."""
    solid, source, welded_to, is_reversed, _ = mapped
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

    # Solid vertices that are corners of other faces than unchanged polygons.
    solid_corners = np.unique(np.concatenate([corners[is_changed].ravel(), caps.ravel()]))
    loops = _outward_loops(begin, totals, unchanged, is_reversed)
    vertex, is_kept, wires = _kept_elements(mesh, loops, standalone, welded_to)
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
    loops = _outward_loops(begin, totals, split_polygons, is_reversed)
    parts.append(_PolygonGroup(loops, in_loop[loops], totals[split_polygons], split_polygons))
    at = corners[is_cut].ravel()
    parts.append(_PolygonGroup(find_loop(np.repeat(faces[is_cut], 3), source[at]), from_solid[at],
                               np.full(is_cut.sum(), 3), faces[is_cut]))
    parts.append(_PolygonGroup(np.full(caps.size, -1), from_solid[caps.ravel()], np.full(len(caps), 3),
                               np.full(len(caps), -1)))
    return _concatenate(mesh, parts, 0 if is_reversed.any() else len(unchanged), source_vertices, positions, wires,
                        from_mesh, welded_to)


def _classify_polygons(faces: np.ndarray, corners: np.ndarray, totals: np.ndarray, source: np.ndarray,
                       is_first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Masks of the polygons (P,) that lie in a solid whole, and of those with a corner where the surface is split.

    faces, corners : (n,), (n, 3) the solid's outer triangles
    totals : (P,) corners of each polygon
    source : mesh vertex of each solid vertex, or -1
    is_first : whether it is the first copy of its mesh vertex"""
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
    """The loops of the polygons, one after the other. begin, totals (F,): first loop and loop count of each."""
    sizes = totals[polygons]
    if len(sizes) and (sizes == sizes[0]).all():
        return (begin[polygons][:, None] + np.arange(sizes[0])).ravel()
    ends = np.cumsum(sizes)
    return np.arange(len(sizes) and ends[-1]) + np.repeat(begin[polygons] - (ends - sizes), sizes)


def _outward_loops(begin: np.ndarray, totals: np.ndarray, polygons: np.ndarray, is_reversed: np.ndarray) -> np.ndarray:
    """_polygon_loops(), in reversed order where the winding is opposite to the solid's, is_reversed (F,)."""
    loops, faces = _polygon_loops(begin, totals, polygons), np.repeat(polygons, totals[polygons])
    return np.where(is_reversed[faces], begin[faces] + (begin[faces] - loops) % totals[faces], loops)


def _unique_corners(faces: np.ndarray, corners: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(faces, corners): each pair of a face and one of its corners once, from triangles (T, 3) and their faces (T,)."""
    pairs = np.unique(np.repeat(faces, 3).astype(np.int64) * count + corners.ravel())
    return np.divmod(pairs, count)


def plan_of_faces(mesh: bpy.types.Mesh, inside: np.ndarray, standalone: bool, original: np.ndarray | None = None) -> MeshPlan:
    """The MeshPlan of these polygons, inside (F,). original: from duplicate_originals(), to have duplicates once."""
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


def face_mask(hierarchy: Hierarchy, tets: tuple, faces: np.ndarray | None = None) -> np.ndarray:
    """(F,) bool: the faces of a slice of tetrahedra, of several, or of the rest; or the given faces instead."""
    leaf, (first, last) = hierarchy.leaf, tets
    if np.ndim(first):
        return np.any([(leaf >= start) & (leaf < end) for start, end in zip(first, last)], axis=0)
    if faces is not None:
        return faces if first < last else ~faces
    return (leaf >= first) & (leaf < last) if first < last else (leaf >= first) | (leaf < last)


class _PolygonGroup(NamedTuple):
    """Some of a MeshPlan's polygons."""

    loops: np.ndarray  # (L,) sources of their loops
    corners: np.ndarray  # (L,)
    totals: np.ndarray  # (P,) corner counts
    polygons: np.ndarray  # (P,) sources


def _kept_elements(mesh: bpy.types.Mesh, loops: np.ndarray, standalone: bool,
                   welded_to: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """((L,) the vertex of each loop, after welded_to; (V,) whether it is kept; edges without faces that are kept). Kept
    are vertices of the given loops and, unless standalone, loose vertices and edges."""
    loop_vertices = arrays.read_corner_vertices(mesh)
    vertex = loop_vertices if welded_to is None else welded_to[loop_vertices]
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
                 welded_to: np.ndarray | None = None) -> MeshPlan:
    """The MeshPlan of several _PolygonGroups; the first n_whole polygons are unchanged. positions (m, 3): of the last
    vertices; all before are the mesh's own."""
    loops, corners, totals, polygons = (np.concatenate(columns) for columns in zip(*parts))
    kept_vertices = source_vertices[:len(source_vertices) - len(positions)]
    positions = np.concatenate([arrays.read_positions(mesh)[kept_vertices], positions])
    return MeshPlan(positions, source_vertices, loops, corners, np.cumsum(totals) - totals, polygons, n_whole, wires,
                    plan_vertices, welded_to)
