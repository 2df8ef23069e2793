# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchy: the tree of nearly convex parts of a mesh, built by the native library, with numpy arrays and queries.

Ids start at 0; -1 means none. F source faces, T tetrahedra, N nodes:

    face          0..F-1    of the source mesh
    tetrahedron   0..T-1    in depth-first order: nodes, clusters and parts are slices of them
    node          0..N-1    of the dendrogram, through which the wheel steps; node i < T is tetrahedron i, node N-1 the root
    cluster       0..2T-2   of the merge tree: i < T is tetrahedron i, T+m the result of merge m, 2T-2 the root
    part          0..K-1    of a Cut

Each node is a cluster; most clusters are not nodes. A part that was not merged by hand is a cluster, and usually a
node.

    from          to             by
    face          node           Hierarchy.leaf[face], path(face), wheel(face)
    node          faces          Hierarchy.faces(node)
    node          tetrahedra     range(*Hierarchy.tet_slice(node))
    tetrahedra    node           Hierarchy.find_node(first, last)
    node          node           Hierarchy.parent[node], children(node)
    face          part           Cut.labels[face]
    tetrahedron   part           Cut.tet_labels[tetrahedron]
    part          faces          Cut.faces(part)
    part          tetrahedra     Cut.slices(part)
    part          clusters       Cut.parts[part]
    part          node           Cut.node(part)

Functions that take a node also take cut[part] if that part is a node.
"""

from __future__ import annotations

import operator
from ctypes import byref, c_double, c_size_t, c_void_p
from typing import Any, Callable, Dict, Iterable, List, NamedTuple, Optional, Sequence, SupportsFloat, SupportsIndex, Tuple

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from . import library
from .library import (Build, BuildOptions, Context, FillMethod, Handle, MeshView, Mode, PartwheelError, Status, call_with_outputs,
                      check, create_handle, load)
from .marks import Marks

POLL_SECONDS = 0.1  # between two progress reports of a build


class Summary(NamedTuple):
    """The result of a build in numbers.

    components : number of connected components of the solid (by common facets)
    cavities : number of enclosed regions outside the solid
    added_vertices : number of points that the mesher added inside
    volume, hull_volume : of the solid and of its convex hull
    fill_method : "exact", "repaired", "points" or "sheet"; of an assembly, the last of these that a shell took
    deviation : largest distance between the filled surface and the source mesh, relative to the diagonal of the
        bounding box
    proxy_triangles : number of triangles of the coarser copy of a large mesh; 0 if the source mesh was used
    shells : number of connected components of the source mesh, each with its cavities, after welding coincident border
        edges; each is a subtree of the hierarchy. 1 in Mode.PAPER
    sheets : number of shells that were filled as thin solids
    """

    components: int
    cavities: int
    added_vertices: int
    volume: float
    hull_volume: float
    fill_method: str
    deviation: float
    proxy_triangles: int
    shells: int
    sheets: int

    @property
    def is_exact(self) -> bool:
        """Whether the caller's surface was used as it is."""
        return self.fill_method == "exact" and not self.proxy_triangles


class Solid(NamedTuple):
    """The closed surface of a part, oriented outward, with n vertices and m triangles:

    vertices (n,3), triangles (m,3)
    source_vertices (n,)  the hierarchy's vertex; several may be the same, where the surface touches itself
    source_faces (m,)     the source face of each triangle, or the nearest one if the surface was not filled exactly; -1 in caps
    neighbor_tets (m,)    for a triangle of a cap, the tetrahedron on its other side; -1 for a triangle of the surface
    """

    vertices: np.ndarray
    triangles: np.ndarray
    source_vertices: np.ndarray
    source_faces: np.ndarray
    neighbor_tets: np.ndarray


class ConvexPart(NamedTuple):
    """A hull of a convex decomposition.

    vertices : (n, 3)
    triangles : (m, 3), closed, oriented outward
    volume : of the part of the solid that the hull stands for
    error : upper bound on the distance of the hull's surface from the solid; None
        unless error or keep_open was requested
    """

    vertices: np.ndarray
    triangles: np.ndarray
    volume: float
    error: Optional[float]

    def hull_volume(self) -> float:
        """The volume of the hull itself."""
        corners = (self.vertices - self.vertices[0])[self.triangles]
        return float(np.linalg.det(corners).sum() / 6)


class _NativeArray:
    """Native memory with numpy's array interface. Arrays created from it are read-only and keep the owner alive."""

    def __init__(self, owner: Any, address: Optional[int], shape: Tuple[int, ...], dtype: DTypeLike) -> None:
        self.owner = owner
        self.__array_interface__ = {
            "version": 3, "data": (address, True), "shape": shape, "typestr": np.dtype(dtype).str,
        }


def _view(owner: Any, address: Optional[int], shape: Tuple[int, ...], dtype: DTypeLike) -> np.ndarray:
    """A read-only view of native memory that keeps its owner alive."""
    if 0 in shape:
        empty = np.empty(shape, dtype)
        empty.flags.writeable = False
        return empty
    return np.asarray(_NativeArray(owner, address, shape, dtype))


def to_array(values: ArrayLike, name: str, dtype: DTypeLike, *shapes: Tuple[Optional[int], ...]) -> np.ndarray:
    """Converts to a contiguous array of one of these shapes; None: any size. Raises ValueError, which has the name."""
    array = np.asarray(values, dtype, order="C")
    if not any(len(shape) == array.ndim and all(size in (None, actual) for size, actual in zip(shape, array.shape))
               for shape in shapes):
        expected = " or ".join(str(shape).replace("None", "n") for shape in shapes)
        raise ValueError(f"{name} must have the shape {expected}, not {array.shape}.")
    return array


def to_indices(values: ArrayLike, name: str, shape: Tuple[Optional[int], ...]) -> np.ndarray:
    """Converts integers to a contiguous int32 array of a shape; None: any size. Raises PartwheelError if one does not fit 32
    bits, ValueError for another shape, TypeError for other types; messages have the name."""
    values = np.asarray(values)
    if values.size == 0:
        values = values.astype(np.int32)
    if values.dtype.kind not in "iu":
        raise TypeError(f"{name} must be integers, not {values.dtype}.")
    values = to_array(values, name, values.dtype, shape)
    limits = np.iinfo(np.int32)
    if values.size and (values.min() < limits.min or values.max() > limits.max):
        raise PartwheelError(Status.INDEX, f"{name} has numbers that don't fit into 32 bits. Split the mesh.")
    return np.ascontiguousarray(values, np.int32)


def check_surface(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike],
                  face_count: Optional[int]) -> Tuple[List[np.ndarray], int]:
    """Converts the arguments of Hierarchy.build() for the library: ([vertices (V, 3) float64, triangles (T, 3) int32, faces
    (T,) int32 unless None], face_count). Raises PartwheelError, ValueError, TypeError."""
    vertices = to_array(vertices, "vertices", np.float64, (None, 3))
    triangles = to_indices(triangles, "triangles", (None, 3))
    arrays = [vertices, triangles]
    if faces is not None:
        arrays.append(to_indices(faces, "faces", (len(triangles),)))
    if face_count is None:
        face_count = len(arrays[1]) if faces is None else int(arrays[2].max(initial=-1)) + 1
    return arrays, _to_number(face_count, "face_count")


def check_options(quality: float = 0.0, fill_methods: int = 0, open_surfaces: bool = True, threads: int = 0,
                  mode: int = Mode.LEARNED, full_resolution: bool = False, exact_triangles: int = 0,
                  keep_inner_walls: bool = False) -> Dict[str, Any]:
    """Converts arguments of Hierarchy.build() to the fields of BuildOptions. Raises PartwheelError, TypeError."""
    return {"quality": _to_float(quality, "quality"), "fill_methods": _to_number(fill_methods, "fill_methods"),
            "refuse_sheets": not open_surfaces, "threads": _to_number(threads, "threads"), "mode": _to_number(mode, "mode"),
            "exact_triangles": -1 if full_resolution else _to_number(exact_triangles, "exact_triangles"),
            "keep_inner_walls": bool(keep_inner_walls)}


def check_marks(marks: Sequence[Marks]) -> List[Tuple[str, np.ndarray, np.ndarray, bool]]:
    """Converts marks for the library: name, edges (n, 2) int32, strengths (n,) float32 and chosen of each kind. Raises
    PartwheelError (an index does not fit 32 bits), ValueError or TypeError (an array has a wrong shape or type)."""
    result = []
    for name, edges, strengths, chosen in marks:
        pairs = to_indices(np.reshape(edges, (-1, 2)) if np.size(edges) == 0 else edges, "edges", (None, 2))
        numbers = np.ones(len(pairs), np.float32) if strengths is None else np.ascontiguousarray(strengths, np.float32)
        if numbers.shape != (len(pairs),):
            raise ValueError(f"The marks {name!r} must have one strength for each edge.")
        result.append((name, pairs, numbers, bool(chosen)))
    return result


def to_mesh_view(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
                 face_count: Optional[int] = None) -> MeshView:
    """Converts the arguments of Hierarchy.build() to a MeshView. Parameters and errors: see check_surface()."""
    (points, corners, *face_of_triangle), count = check_surface(vertices, triangles, faces, face_count)
    return MeshView.of(points, corners, face_of_triangle[0] if face_of_triangle else None, count, lambda array: array.ctypes.data)


class Hierarchy:
    """The hierarchy of one surface. Immutable; any number of threads may query it.

    Create one with Hierarchy.build() or Hierarchy.load(). Its arrays are read-only views of native memory, which they
    keep alive. F source faces, N nodes, T tetrahedra, V vertices:

    order (F,)      source faces sorted by tetrahedron: node n contains order[first[n]:last[n]]
    leaf (F,)       the leaf of each source face
    parent (N,)     -1 at the root, which is the last node; leaf i is tetrahedron i
    first, last (N,), tet_first, tet_last (N,)
    cost_class (N,), cost (N,), height (N,)     cost by Eq. 3 of the paper, and the height in the dendrogram
    volume (N,), area (N,)
    score (N,)      expected overlap with a part that a person would cut; 0 below the initial parts and in mode PAPER
    vertices (V,3), source (V,)     source: the source vertex of each vertex, or -1
    tetrahedra (T,4), merges (T-1,2)

    summary: a Summary. notes: sentences about changes to the surface; "" if it was filled exactly. seconds: stage
    name -> seconds of the build; empty after load().
    """

    order: np.ndarray
    leaf: np.ndarray
    parent: np.ndarray
    first: np.ndarray
    last: np.ndarray
    tet_first: np.ndarray
    tet_last: np.ndarray
    cost_class: np.ndarray
    cost: np.ndarray
    height: np.ndarray
    volume: np.ndarray
    area: np.ndarray
    score: np.ndarray
    vertices: np.ndarray
    source: np.ndarray
    tetrahedra: np.ndarray
    merges: np.ndarray
    summary: Summary
    notes: str
    seconds: Dict[str, float]

    def __init__(self, handle: Handle, seconds: Optional[Dict[str, float]] = None) -> None:
        self._handle = handle
        self.seconds = seconds or {}
        raw = library.Arrays()
        check(load().pw_hierarchy_arrays(handle, byref(raw)))
        faces, nodes, tets, vertices = (raw.face_count, raw.node_count, raw.tetrahedron_count, raw.vertex_count)
        shapes = {
            "order": (faces,), "leaf": (faces,), "vertices": (vertices, 3), "source": (vertices,),
            "tetrahedra": (tets, 4), "merges": (tets - 1, 2),
        }
        dtypes = {"cost_class": np.uint8,
                  **dict.fromkeys(("cost", "height", "volume", "area", "vertices", "score"), np.float64)}
        for name, kind in raw._fields_:
            if kind is c_void_p:
                setattr(self, name, _view(handle, getattr(raw, name), shapes.get(name, (nodes,)), dtypes.get(name, np.int32)))
        struct = library.Summary()
        check(load().pw_hierarchy_summary(handle, byref(struct)))
        summary: Dict[str, Any] = {name: getattr(struct, name) for name in Summary._fields}
        summary["fill_method"] = str(FillMethod(struct.fill_method).name).lower()
        self.summary = Summary(**summary)
        self.notes = load().pw_hierarchy_notes(handle).decode()

    @classmethod
    def build(cls, vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
              face_count: Optional[int] = None, *, quality: float = 0.0, fill_methods: int = 0, open_surfaces: bool = True,
              threads: int = 0, mode: int = Mode.LEARNED, full_resolution: bool = False, exact_triangles: int = 0,
              keep_inner_walls: bool = False, marks: Sequence[Marks] = (),
              progress: Optional[Callable[[float, str], Optional[bool]]] = None) -> Hierarchy:
        """Builds the hierarchy of a surface.

        Parameters
        ----------
        vertices : (V, 3) coordinates
        triangles : (T, 3) indices of vertices, counter-clockwise seen from outside
        faces : (T,) the source face of each triangle; None: every triangle is one
        face_count : number of source faces; None: the largest + 1
        quality : 0: no points are added inside; 1.1 or more (1.4 is usual): upper bound on circumradius / shortest edge
            of the tetrahedra (the paper's Figure 9). The default mode finds the same parts with and without such points
        fill_methods : the allowed ways to fill the surface, a sum of FillMethod; the first that works is taken; 0: all
        open_surfaces : False: raise PartwheelError (NOT_SOLID) for a mesh of nothing but sheets (plane, cloth, leaf), instead
            of filling them as thin solids
        threads : the most threads; 0: chosen automatically. The result does not depend on it
        mode : Mode.LEARNED: parts as people see them, with borders in creases, and symmetric on symmetric models; or
            Mode.PAPER: the paper's tree
        full_resolution : find the parts of a large mesh on all of its triangles, not on a coarser copy; takes about ten times
            the time and memory
        exact_triangles : a mesh with more triangles is large; 0: 200,000
        keep_inner_walls : True: find parts on all walls of a shell with a double wall. False: on the outer wall; each inner
            face goes with the outer face in front of it
        marks : edges where something besides the shape divides the surface, one Marks for each kind
        progress : progress(fraction, stage) is called about ten times a second in this thread while the build runs in
            another; True cancels the build. If it raises, the build is stopped and the exception propagates

        Raises
        ------
        PartwheelError : what is wrong with the surface, or that the build was canceled
        ValueError, TypeError : an array has a wrong shape or type
        """
        mesh, context = to_mesh_view(vertices, triangles, faces, face_count), Context()
        options = BuildOptions(**check_options(quality, fill_methods, open_surfaces, threads, mode, full_resolution,
                                               exact_triangles, keep_inner_walls))
        options.set_marks(check_marks(marks), lambda array: array.ctypes.data)

        def report() -> None:
            if progress is not None and progress(*context.progress()):
                context.cancel()

        build = Build(context, mesh, options)
        build.run_to_end(report, POLL_SECONDS)
        if build.error:
            raise build.error
        return cls(Handle(load().pw_hierarchy_free, build.address.value), context.seconds())

    @classmethod
    def load(cls, data: bytes) -> Hierarchy:
        """Loads a hierarchy from the bytes of save(). Raises PartwheelError (DATA) for any other bytes."""
        data = np.frombuffer(data, np.uint8)
        buffer = data if data.size else np.zeros(1, np.uint8)  # not null: empty data is damaged data, too
        return cls(create_handle(load().pw_hierarchy_free, load().pw_hierarchy_load, None, buffer, data.size))

    def save(self) -> bytes:
        """The saved form of the hierarchy, identical on every machine."""
        return self._query(load().pw_hierarchy_save, np.uint8, before=[None]).tobytes()

    def __repr__(self) -> str:
        return (f"<Hierarchy of {len(self.order)} faces: {len(self.parent)} nodes, {len(self.tetrahedra)} tetrahedra, "
                f"{self.summary.fill_method}>")

    def __reduce__(self) -> Tuple[Any, ...]:
        """Copies and pickles by the saved form."""
        return type(self).load, (self.save(),), {"seconds": self.seconds}

    def path(self, face: int) -> np.ndarray:
        """(n,) the path of a source face: the nodes that contain it, from its leaf to the root."""
        return self._query(load().pw_hierarchy_path, np.int32, _to_number(face, "face"))

    def wheel(self, face: int, view: float = 0.0) -> Tuple[np.ndarray, int]:
        """The wheel stops of a source face.

        Parameters
        ----------
        face : the source face that is clicked
        view : what fits into the smaller side of the view at the depth of the face, a length; 0: not known. The closer the
            view, the smaller the part that a click selects; the stops stay the same. See pw_hierarchy_wheel

        Returns
        -------
        stops : (n,) nodes, from small to the root; in mode PAPER the whole path
        start : index of the start level, which a click selects
        """
        start = c_size_t()
        stops = self._query(load().pw_hierarchy_wheel, np.int32, _to_number(face, "face"), _to_float(view, "view"),
                            after=[byref(start)])
        return stops, start.value

    def faces(self, node: SupportsIndex) -> np.ndarray:
        """(n,) the source faces of a node: a view of order."""
        address, count = call_with_outputs([c_void_p, c_size_t], load().pw_hierarchy_faces, self._handle, _to_number(node, "node"))
        return _view(self._handle, address, (count,), np.int32)

    def children(self, node: SupportsIndex) -> Tuple[int, ...]:
        """The ids of a node's children, in the order of their tetrahedra; () for a leaf. Raises PartwheelError if there is no
        such node."""
        self.tet_slice(node)
        children = np.flatnonzero(self.parent == _to_number(node, "node")).tolist()
        return tuple(sorted(children, key=lambda child: self.tet_first[child]))

    def tet_slice(self, node: SupportsIndex) -> Tuple[int, int]:
        """(tet_first, tet_last): a node has the tetrahedra from the first to before the last. Raises PartwheelError."""
        node = _to_number(node, "node")
        if node >= len(self.parent):
            raise PartwheelError(Status.ARGUMENT, f"There is no node {node}: the hierarchy has {len(self.parent)}.")
        return int(self.tet_first[node]), int(self.tet_last[node])

    def find_node(self, tet_first: int, tet_last: int) -> Optional[int]:
        """The node that consists of tetrahedra[tet_first:tet_last]; None if there is none."""
        nodes = np.flatnonzero((self.tet_first == tet_first) & (self.tet_last == tet_last))
        return int(nodes[0]) if len(nodes) else None

    def with_part(self, faces: ArrayLike) -> Hierarchy:
        """A hierarchy in which some source faces are a node with score 1, so that the wheel stops there.

        Parameters
        ----------
        faces : (n,) the source faces. Faces of one tetrahedron go together, with most of their area

        Returns
        -------
        a new hierarchy; other nodes stay, unless they have faces of the part and others, but not all of the part: see
        pw_hierarchy_with_part in partwheel_edit.h

        Raises
        ------
        PartwheelError : the part is empty, has pieces of several shells, or the mode is PAPER
        """
        numbers = to_indices(faces, "faces", (None,))
        return Hierarchy(create_handle(load().pw_hierarchy_free, load().pw_hierarchy_with_part, None, self._handle,
                                       numbers, numbers.size))

    def cut_height(self, height: float) -> np.ndarray:
        """(parts + 1,) bounds of the cut at a height: part k contains tetrahedra[bounds[k]:bounds[k+1]]."""
        return self._query(load().pw_hierarchy_cut_height, np.int32, _to_float(height, "height"))

    def cut_parts(self, parts: int) -> np.ndarray:
        """(parts + 1,) bounds of the cut into this many parts, which undoes the last parts - 1 merges."""
        return self._query(load().pw_hierarchy_cut_parts, np.int32, _to_number(parts, "parts"))

    def cut_least_concavity(self, parts: int, context: Optional[Context] = None) -> np.ndarray:
        """(parts + 1,) bounds of the cut into this many parts with the least total concavity: for approximation by
        convex hulls; best with the tree of mode PAPER. context : to cancel from another thread and to read the progress"""
        return self._query(load().pw_hierarchy_cut_least_concavity, np.int32, _to_number(parts, "parts"), before=[context])

    def cut_automatic(self) -> np.ndarray:
        """(parts + 1,) bounds of the automatic segmentation: the cut that the scores suggest."""
        return self._query(load().pw_hierarchy_cut_automatic, np.int32)

    def face_labels(self, bounds: np.ndarray) -> np.ndarray:
        """(F,) the part of each source face in a cut."""
        return (np.searchsorted(bounds, self.leaf, side="right") - 1).astype(np.int32)

    def hull(self, node: SupportsIndex) -> Tuple[np.ndarray, np.ndarray]:
        """The convex hull of a node: (vertices (n, 3), triangles (m, 3)), closed, oriented outward."""
        return self.hull_of_slice(*self.tet_slice(node))

    def hull_of_slice(self, tet_first: int, tet_last: int) -> Tuple[np.ndarray, np.ndarray]:
        """The convex hull of tetrahedra[tet_first:tet_last], such as a part of a cut; see hull()."""
        return self._mesh(load().pw_hierarchy_hull, _to_number(tet_first, "tet_first"), _to_number(tet_last, "tet_last"))[1:]

    def convex_parts(self, hulls: Optional[int] = None, *, error: Optional[float] = None,
                     max_vertices: Optional[int] = None, keep_open: Optional[float] = None,
                     slices: ArrayLike = (), threads: int = 0, context: Optional[Context] = None) -> List[ConvexPart]:
        """Convex decomposition: hulls that together contain the solid and little else; see pw_hierarchy_convex_parts in
        partwheel_edit.h.

        Parameters
        ----------
        hulls : number of hulls, at most 4096; the result has fewer if more would gain nothing
        error : instead of hulls: the largest distance of a hull's surface from the solid, in the unit of the
            coordinates; the result has as few hulls as the method finds
        max_vertices : of a hull, 8 or more; a hull with more is replaced by a convex polytope around it with fewer
        keep_open : the radius of a ball: a hull whose error is at most this covers no opening that the ball passes; a hull
            with a larger error does, because there were too few hulls
        slices : (n, 2) disjoint slices of the tetrahedra, such as [tet_slice(node)]: only this part of the solid; errors are
            still distances from the whole solid
        threads : the most threads; 0: chosen automatically. The result does not depend on it
        context : to cancel from another thread and to read the progress

        Returns
        -------
        [ConvexPart, ...], the largest first

        Raises
        ------
        PartwheelError : an argument is invalid, or the call was canceled
        """
        chosen = np.array(slices, np.int32).reshape(-1, 2)
        options = library.ConvexOptions(slices=chosen.ctypes.data if len(chosen) else None, slice_count=len(chosen),
                                        threads=_to_number(threads, "threads"))
        for name, count in (("hulls", hulls), ("max_vertices", max_vertices)):
            setattr(options, name, _to_number(count or 0, name))
        for name, length in (("error", error), ("keep_open", keep_open)):
            setattr(options, name, _to_float(length or 0, name))
        parts = create_handle(load().pw_convex_parts_free, load().pw_hierarchy_convex_parts, context, self._handle,
                              byref(options))
        types = [c_void_p, c_size_t, c_void_p, c_size_t, c_double, c_double]
        convex_parts = []
        for index in range(call_with_outputs([c_size_t], load().pw_convex_parts_count, parts)[0]):
            vertices, n, triangles, m, volume, distance = call_with_outputs(types, load().pw_convex_parts_hull, parts, index)
            convex_parts.append(ConvexPart(_view(parts, vertices, (n, 3), np.float64),
                                           _view(parts, triangles, (m, 3), np.int32),
                                           volume, distance if distance >= 0 else None))
        return convex_parts

    def solid(self, node: SupportsIndex) -> Solid:
        """The closed, manifold surface around a node's tetrahedra.

        A polygon whose tetrahedra are in two parts belongs to one of them, with these tetrahedra. Raises PartwheelError
        (EMPTY) if the node then has no tetrahedra left."""
        return self.solid_of_slice(*self.tet_slice(node))

    def solid_of_slice(self, tet_first: Any, tet_last: Any, inside: Optional[ArrayLike] = None) -> Solid:
        """The Solid around tetrahedra[tet_first:tet_last], such as a part of a cut.

        Parameters
        ----------
        tet_first, tet_last : the slice. If tet_first > tet_last, the rest: tetrahedra[tet_first:] and
            tetrahedra[:tet_last]. (n,) arrays: the union of disjoint slices
        inside : (F,) bool, the source faces to have instead of the slice's own: see pw_hierarchy_solid_of_faces in
            partwheel.h; for a single slice

        Raises
        ------
        PartwheelError : no tetrahedra are left (EMPTY)
        ValueError : inside has another shape
        """
        if np.ndim(tet_first):
            slices = np.array([tet_first, tet_last], np.int32).T.copy()
            return self._solid(load().pw_hierarchy_solid_of_slices, slices, len(slices))
        bounds = _to_number(tet_first, "tet_first"), _to_number(tet_last, "tet_last")
        if inside is None:
            return self._solid(load().pw_hierarchy_solid, *bounds)
        inside = to_array(inside, "inside", bool, self.leaf.shape)
        return self._solid(load().pw_hierarchy_solid_of_faces, *bounds, inside, len(inside))

    def solids(self, slices: Iterable[Tuple[Any, Any]], inside: Optional[ArrayLike] = None) -> List[Optional[Solid]]:
        """The Solids of disjoint slices (tet_first, tet_last), see solid_of_slice(); None for a slice without
        tetrahedra. Two neighbors have the same triangles in their common cap."""
        result: List[Optional[Solid]] = []
        for bounds in slices:
            try:
                result.append(self.solid_of_slice(*bounds, inside))
            except PartwheelError as error:
                if error.status != Status.EMPTY:
                    raise
                result.append(None)
        return result

    def _solid(self, function: Any, *arguments: Any) -> Solid:
        """The Solid that a function of the library creates."""
        mesh, vertices, triangles = self._mesh(function, *arguments)
        sources, faces, tets = call_with_outputs([c_void_p] * 3, load().pw_mesh_origins, mesh)
        return Solid(vertices, triangles, _view(mesh, sources, (len(vertices),), np.int32),
                     *(_view(mesh, address, (len(triangles),), np.int32) for address in (faces, tets)))

    def rest(self, node: SupportsIndex) -> Solid:
        """The Solid of all tetrahedra outside a node. Raises PartwheelError (EMPTY) if there are none."""
        first, last = self.tet_slice(node)
        return self.solid_of_slice(last, first)

    def _mesh(self, function: Any, *arguments: Any) -> Tuple[Handle, np.ndarray, np.ndarray]:
        """The mesh that a function of the library creates: (handle, vertices, triangles)."""
        mesh = create_handle(load().pw_mesh_free, function, None, self._handle, *arguments)
        vertices, vertex_count, triangles, triangle_count = call_with_outputs([c_void_p, c_size_t] * 2,
                                                                              load().pw_mesh_arrays, mesh)
        return (mesh, _view(mesh, vertices, (vertex_count, 3), np.float64),
                _view(mesh, triangles, (triangle_count, 3), np.int32))

    def _query(self, function: Any, dtype: DTypeLike, *arguments: Any, before: Sequence[Any] = (),
               after: Sequence[Any] = ()) -> np.ndarray:
        """Calls a function that fills an array: first for the size, then for the data."""
        count = c_size_t()
        check(function(*before, self._handle, *arguments, None, 0, byref(count), *after))
        result = np.empty(count.value, dtype)
        check(function(*before, self._handle, *arguments, result, result.size, byref(count), *after))
        return result


def _to_number(value: SupportsIndex, name: str) -> int:
    """A number for C, which would silently take -1 or 2**64 for others. Raises PartwheelError, TypeError; messages have the
    name."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be an integer, not {value!r}.") from None
    if not 0 <= number <= np.iinfo(np.int32).max:
        raise PartwheelError(Status.ARGUMENT, f"{name} must be from 0 to {np.iinfo(np.int32).max}, not {number}.")
    return number


def _to_float(value: SupportsFloat, name: str) -> float:
    """A number for C, which judges it. Raises TypeError; the message has the name."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a number, not {value!r}.") from None
