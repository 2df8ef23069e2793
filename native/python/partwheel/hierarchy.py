# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchy: a mesh's tree of nearly convex parts, built by the native library, as numpy arrays and questions.

Numbers count from 0, and -1 is none. F source faces, T tetrahedra, N nodes:

    face          0..F-1    of the mesh that was built
    tetrahedron   0..T-1    in depth-first order: nodes, clusters and parts are slices of them
    node          0..N-1    of the tree that the wheel goes through; node i < T is tetrahedron i, node N-1 the whole
    cluster       0..2T-2   of the binary tree of all merges: i < T is tetrahedron i, T+m what merge m joins, 2T-2 the whole
    part          0..K-1    of a Cut

Each node is a cluster; most clusters are no node. A part that was not merged by hand is a cluster, and mostly a node.

    from          to             by
    face          node           Hierarchy.leaf[face], path(face), wheel(face)
    node          faces          Hierarchy.faces(node)
    node          tetrahedra     range(Hierarchy.tet_first[node], Hierarchy.tet_last[node])
    tetrahedra    node           Hierarchy.find_node(first, last)
    node          node           Hierarchy.parent[node], children(node)
    face          part           Cut.labels[face]
    tetrahedron   part           Cut.tet_labels[tetrahedron]
    part          faces          Cut.faces(part)
    part          tetrahedra     Cut.slices(part)
    part          clusters       Cut.parts[part]
    part          node           Cut.node(part)

What takes a node also takes cut[part], wherever that part is a node.
"""

from __future__ import annotations

import operator
from ctypes import byref, c_double, c_size_t, c_void_p
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, NamedTuple, Optional, SupportsIndex, Tuple

import numpy as np

from .library import (
    Arrays, Build, BuildOptions, Context, ConvexOptions, FillMethod, Handle, MeshView, Mode, PartwheelError, Status,
    SummaryStruct, check, load, made, told,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, DTypeLike

POLL_SECONDS = 0.1


class Summary(NamedTuple):
    """What a build found. components: parts of the solid without a common facet. cavities: enclosed regions that are
    not solid. added_vertices: points that the mesher added inside. volume, hull_volume: of the solid and of its convex
    hull, in the unit of the coordinates cubed. fill_method: "exact", "repaired" or "points", how the surface was filled with
    tetrahedra; deviation: the largest distance between the surface used and the caller's, relative to the diagonal of the
    bounding box. proxy_triangles: of the coarser copy on which the parts of a large mesh were found; 0 if there is none."""

    components: int
    cavities: int
    added_vertices: int
    volume: float
    hull_volume: float
    fill_method: str
    deviation: float
    proxy_triangles: int

    @property
    def exact(self):
        """Whether the caller's surface was used as it is."""
        return self.fill_method == "exact" and not self.proxy_triangles


class Solid(NamedTuple):
    """The closed surface around a part, outward. n vertices, m triangles:

    vertices (n,3), triangles (m,3)
    ends (n,2)      the vertex of the hierarchy that each is, twice; for one in the middle of an edge, the edge's ends
    faces (m,)      the source face that each triangle is of (if the surface was not used as it is: is nearest to), or -1
    beyond (m,)     the tetrahedron on the other side of a cap; -1 for a triangle of the surface
    """

    vertices: np.ndarray
    triangles: np.ndarray
    ends: np.ndarray
    faces: np.ndarray
    beyond: np.ndarray


class ConvexPart(NamedTuple):
    """A convex hull for a part of a solid. vertices (n,3), triangles (m,3): closed, convex, outward. volume: of the
    hull's own part of the solid. error: the largest distance of its surface from the solid, at most; None if none
    was asked for."""

    vertices: np.ndarray
    triangles: np.ndarray
    volume: float
    error: Optional[float]

    def hull_volume(self) -> float:
        corners = (self.vertices - self.vertices[0])[self.triangles]
        return float(np.linalg.det(corners).sum() / 6)


class _Memory:
    """Native memory for numpy's array interface: an array made of it is read-only and keeps the owner alive."""

    def __init__(self, owner: Any, address: Optional[int], shape: Tuple[int, ...], dtype: DTypeLike) -> None:
        self.owner = owner
        self.__array_interface__ = {
            "version": 3, "data": (address, True), "shape": shape, "typestr": np.dtype(dtype).str,
        }


def _view(owner: Any, address: Optional[int], shape: Tuple[int, ...], dtype: DTypeLike) -> np.ndarray:
    if 0 in shape:
        empty = np.empty(shape, dtype)
        empty.flags.writeable = False
        return empty
    return np.asarray(_Memory(owner, address, shape, dtype))


def _coordinates(vertices: ArrayLike) -> np.ndarray:
    vertices = np.ascontiguousarray(vertices, np.float64)
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise ValueError(f"vertices must have the shape (V, 3), not {vertices.shape}.")
    return vertices


def indices(values: ArrayLike, name: str, shape: Tuple[Optional[int], ...]) -> np.ndarray:
    """Whole numbers of 32 bits, None in the shape for any size. Raises PartwheelError, ValueError or TypeError."""
    values = np.asarray(values)
    if values.size == 0:
        values = values.astype(np.int32)
    if values.dtype.kind not in "iu":
        raise TypeError(f"{name} must be whole numbers, not {values.dtype}.")
    if values.ndim != len(shape) or any(want is not None and want != have for want, have in zip(shape, values.shape)):
        raise ValueError(f"{name} must have the shape ({', '.join('T' if n is None else str(n) for n in shape)}), "
                         f"not {values.shape}.")
    limits = np.iinfo(np.int32)
    if values.size and (values.min() < limits.min or values.max() > limits.max):
        raise PartwheelError(Status.INDEX, f"{name} has numbers of more than 32 bits: no mesh that large can be built.")
    return np.ascontiguousarray(values, np.int32)


def checked_surface(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike],
                    face_count: Optional[int]) -> Tuple[List[np.ndarray], int]:
    """What Hierarchy.build() was given, as the library takes it: ([vertices, triangles, faces if given], face_count).
    Raises PartwheelError, ValueError or TypeError."""
    vertices = _coordinates(vertices)
    triangles = indices(triangles, "triangles", (None, 3))
    arrays = [vertices, triangles]
    if faces is not None:
        arrays.append(indices(faces, "faces", (len(triangles),)))
    if face_count is None:
        face_count = len(arrays[1]) if faces is None else int(arrays[2].max(initial=-1)) + 1
    return arrays, _number(face_count)


def surface(vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
            face_count: Optional[int] = None) -> MeshView:
    """The same as a MeshView, for functions of the library."""
    arrays, face_count = checked_surface(vertices, triangles, faces, face_count)
    return mesh_view(arrays[0], arrays[1], arrays[2] if len(arrays) > 2 else None, face_count)


def mesh_view(vertices: np.ndarray, triangles: np.ndarray, faces: Optional[np.ndarray] = None,
              face_count: int = 0) -> MeshView:
    """A MeshView of arrays that are checked: (V,3) float64, (T,3) int32 and None or (T,) int32."""
    vertices, triangles = np.ascontiguousarray(vertices), np.ascontiguousarray(triangles)
    return MeshView.of(vertices, triangles, faces, face_count, lambda array: array.ctypes.data)


class Hierarchy:
    """The finished hierarchy of one surface. It never changes; any number of threads may ask it questions.

    Make one with Hierarchy.build() or Hierarchy.load(). Its arrays are read-only views of native memory, not copies;
    each keeps that memory alive. F source faces, N nodes, T tetrahedra, V vertices:

    order (F,)      source faces sorted by tetrahedron: node n holds order[first[n]:last[n]]
    leaf (F,)       the leaf of each source face
    parent (N,)     -1 at the root, which is the last node; leaf i is tetrahedron i
    first, last (N,), tet_first, tet_last (N,)
    cost_class (N,), cost (N,), height (N,)     Eq. 3 of the paper and the node's place in the dendrogram
    volume (N,), area (N,)
    score (N,)      the overlap expected with what people would take, 0 below some 600 parts and in mode PAPER
    vertices (V,3), source (V,)     source: the source vertex that each is, -1 for all others
    tetrahedra (T,4), merges (T-1,2)

    summary: a Summary. account: what was done to the surface, in sentences; "" if it was exact. seconds: stage name ->
    seconds of the build, empty after load().
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
    account: str
    seconds: Dict[str, float]

    def __init__(self, handle: Handle, seconds: Optional[Dict[str, float]] = None) -> None:
        self._handle = handle
        self.seconds = seconds or {}
        raw = Arrays()
        check(load().pw_hierarchy_arrays(handle, byref(raw)))
        faces, nodes, tets, vertices = (int(getattr(raw, name)) for name in Arrays.COUNTS)
        shapes = {
            "order": (faces,), "leaf": (faces,), "vertices": (vertices, 3), "source": (vertices,),
            "tetrahedra": (tets, 4), "merges": (tets - 1, 2),
        }
        dtypes = {"cost_class": np.uint8,
                  **dict.fromkeys(("cost", "height", "volume", "area", "vertices", "score"), np.float64)}
        for name in Arrays.POINTERS:
            setattr(self, name, _view(self._handle, getattr(raw, name), shapes.get(name, (nodes,)),
                                      dtypes.get(name, np.int32)))
        found = SummaryStruct()
        check(load().pw_hierarchy_summary(handle, byref(found)))
        summary = {name: getattr(found, name) for name in Summary._fields}
        self.summary = Summary(**summary | {"fill_method": FillMethod(summary["fill_method"]).name.lower()})
        self.account = load().pw_hierarchy_account(handle).decode()

    @classmethod
    def build(cls, vertices: ArrayLike, triangles: ArrayLike, faces: Optional[ArrayLike] = None,
              face_count: Optional[int] = None, *, quality: float = 0.0, fill_methods: int = 0, open_surfaces: bool = False,
              threads: int = 0, mode: int = Mode.REGROUPED, exactly: bool = False, exact_triangles: int = 0,
              progress: Optional[Callable[[float, str], Optional[bool]]] = None) -> Hierarchy:
        """Builds the hierarchy of a surface: as it is, or else repaired, or else filled from points on it; that of
        a large one on a coarser copy, unless exactly.

        vertices (V,3) coordinates; triangles (T,3) indices, counter-clockwise from outside; faces (T,) the source face
        of each triangle (None: every triangle is one); face_count how many there are (None: the largest + 1).
        quality: 0 adds no points inside; 1.1 or more (1.4 is usual) bounds the tetrahedra's circumradius to shortest
        edge (the paper's Figure 9); but for Mode.PAPER the parts stay those without such points.
        fill_methods: the ways allowed to a surface that can be filled, a sum of FillMethod (0: all);
        the first that works is taken.
        open_surfaces: take a sheet (plane, cloth, car door) as a thin solid, instead of refusing it with NOT_SOLID.
        threads: 0 as many as help, else at most so many; the result is the same.
        mode: Mode.REGROUPED, joined by what people take for parts, with borders in creases, and the same on both sides
        of what is its own mirror image; or Mode.PAPER, the paper's in every step.
        exactly: the parts of a large mesh are not found on a coarser copy of it, but on all of its triangles, which
        takes some ten times as long and as much memory. exact_triangles: meshes of more are large (0: 200,000).
        progress(fraction, stage): called in this thread about ten times a second while the build runs in another;
        returning True cancels the build. If it raises, the build is stopped and the exception goes on.

        Raises PartwheelError with what is wrong with the surface, or that the build was cancelled.
        """
        given, context = surface(vertices, triangles, faces, face_count), Context()
        options = BuildOptions(quality=quality, fill_methods=_number(fill_methods), open_surfaces=bool(open_surfaces),
                               threads=_number(threads), mode=_number(mode),
                               exact_triangles=-1 if exactly else _number(exact_triangles))
        build = Build(context, given, options)

        def report() -> None:
            if progress is not None and progress(*context.progress()):
                context.cancel()

        report()
        build.start()
        try:
            while not build.done.wait(POLL_SECONDS):
                report()
            report()
        finally:
            # Also after an exception of progress() or Ctrl-C: the thread reads our arrays, so it must end first.
            if not build.done.is_set():
                context.cancel()
            build.join()
        if build.error:
            raise build.error
        return cls(Handle(load().pw_hierarchy_free, build.address.value), context.seconds())

    @classmethod
    def load(cls, data: bytes) -> Hierarchy:
        """A hierarchy from the bytes that save() gave. Raises PartwheelError (DATA) for any others."""
        data = np.frombuffer(data, np.uint8)
        buffer = data if data.size else np.zeros(1, np.uint8)  # no null pointer: no bytes at all are damaged data too
        return cls(Handle(load().pw_hierarchy_free, made(load().pw_hierarchy_load, None, buffer, data.size)))

    def save(self) -> bytes:
        """The hierarchy as bytes, the same on every machine."""
        return self._ask(load().pw_hierarchy_save, np.uint8, before=[None]).tobytes()

    def __repr__(self) -> str:
        return (f"<Hierarchy of {len(self.order)} faces: {len(self.parent)} nodes, {len(self.tetrahedra)} tetrahedra, "
                f"{self.summary.fill_method}>")

    def __reduce__(self) -> Tuple[Any, ...]:
        """A copy, here or in another process, is loaded from the saved form: addresses mean nothing there."""
        return type(self).load, (self.save(),), {"seconds": self.seconds}

    def path(self, face: int) -> np.ndarray:
        """(n,) the nodes that hold a source face, from its leaf up to the root."""
        return self._ask(load().pw_hierarchy_path, np.int32, _number(face))

    def wheel(self, face: int) -> Tuple[np.ndarray, int]:
        """((n,) the stops of the wheel after a click on a source face, growing up to the root; the start's index). In
        mode PAPER all of the path, from the leaf."""
        start = c_size_t()
        stops = self._ask(load().pw_hierarchy_wheel, np.int32, _number(face), after=[byref(start)])
        return stops, start.value

    def faces(self, node: SupportsIndex) -> np.ndarray:
        """(n,) a node's source faces: a view of order."""
        address, count = told([c_void_p, c_size_t], load().pw_hierarchy_faces, self._handle, _number(node))
        return _view(self._handle, address, (count,), np.int32)

    def children(self, node: SupportsIndex) -> Tuple[int, ...]:
        """The nodes that a node was joined of.

        Parameters
        ----------
        node : the number of a node, or what stands for one

        Returns
        -------
        their numbers, by their place among the faces; () for a single tetrahedron

        Raises
        ------
        PartwheelError : there is no such node
        """
        self._slice(node)
        return tuple(sorted(np.flatnonzero(self.parent == _number(node)).tolist(), key=lambda each: self.tet_first[each]))

    def find_node(self, tet_first: int, tet_last: int) -> Optional[int]:
        """The node that is just tetrahedra[tet_first:tet_last], or None if these are no node."""
        found = np.flatnonzero((self.tet_first == tet_first) & (self.tet_last == tet_last))
        return int(found[0]) if len(found) else None

    def cut_height(self, height: float) -> np.ndarray:
        """(parts + 1,) bounds of the cut at a height: part k holds tetrahedra[bounds[k]:bounds[k+1]]."""
        return self._ask(load().pw_hierarchy_cut_height, np.int32, float(height))

    def cut_parts(self, parts: int) -> np.ndarray:
        """(parts + 1,) bounds of the cut into this many parts: the last parts - 1 merges undone."""
        return self._ask(load().pw_hierarchy_cut_parts, np.int32, _number(parts))

    def cut_least_concavity(self, parts: int) -> np.ndarray:
        """(parts + 1,) bounds of the cut into this many parts that have the least concavity in total: what suits
        approximation by convex hulls, of mode PAPER's tree best."""
        return self._ask(load().pw_hierarchy_cut_least_concavity, np.int32, _number(parts), before=[None])

    def cut_automatic(self) -> np.ndarray:
        """(parts + 1,) bounds of the cut into the parts that people would most likely take."""
        return self._ask(load().pw_hierarchy_cut_automatic, np.int32)

    def face_labels(self, bounds: np.ndarray) -> np.ndarray:
        """(F,) the part of each source face in a cut."""
        return (np.searchsorted(bounds, self.leaf, side="right") - 1).astype(np.int32)

    def hull(self, node: SupportsIndex) -> Tuple[np.ndarray, np.ndarray]:
        """A node's convex hull: (vertices (n,3), triangles (m,3)), closed, outward."""
        return self.hull_of_slice(*self._slice(node))

    def hull_of_slice(self, tet_first: int, tet_last: int) -> Tuple[np.ndarray, np.ndarray]:
        """The convex hull of tetrahedra[tet_first:tet_last], for a part of a cut: (vertices, triangles)."""
        return self._mesh(load().pw_hierarchy_hull, _number(tet_first), _number(tet_last))[1:]

    def convex_parts(self, hulls: Optional[int] = None, *, error: Optional[float] = None,
                     max_vertices: Optional[int] = None, context: Optional[Context] = None) -> List[ConvexPart]:
        """[ConvexPart, ...]: convex hulls that together contain the solid and little else, the largest first.

        Either hulls, so many, at most 4096, fewer where more would gain nothing; or error, the largest distance from the
        solid that any hull's surface may have, in the unit of the coordinates: as few as are found. max_vertices: of a
        hull, 8 or more, as engines limit them; one that had more gets a convex polytope of fewer around it. context: a
        Context, to cancel from another thread and to see the progress. See pw_hierarchy_convex_parts in
        partwheel_edit.h."""
        options = ConvexOptions(hulls=_number(hulls or 0), error=float(error or 0), max_vertices=_number(max_vertices or 0))
        parts = Handle(load().pw_convex_parts_free,
                       made(load().pw_hierarchy_convex_parts, context, self._handle, byref(options)))
        types = [c_void_p, c_size_t, c_void_p, c_size_t, c_double, c_double]
        found = []
        for index in range(told([c_size_t], load().pw_convex_parts_count, parts)[0]):
            vertices, n, triangles, m, volume, away = told(types, load().pw_convex_parts_hull, parts, index)
            found.append(ConvexPart(_view(parts, vertices, (n, 3), np.float64),
                                    _view(parts, triangles, (m, 3), np.int32), volume, away if away >= 0 else None))
        return found

    def solid(self, node: SupportsIndex) -> Solid:
        """The closed, manifold surface around a node's tetrahedra: a Solid. Where polygons are not triangles,
        tetrahedra behind a polygon that is in two parts go with the polygon. Raises PartwheelError (EMPTY) for a node
        without faces that has no tetrahedron left then."""
        return self.solid_of_slice(*self._slice(node))

    def solid_of_slice(self, tet_first: Any, tet_last: Any, middles: ArrayLike = ()) -> Solid:
        """The same around tetrahedra[tet_first:tet_last], for a part of a cut. With the two exchanged, around the rest:
        tetrahedra[tet_first:] and tetrahedra[:tet_last]. Both may be arrays (n,), of slices that are apart: around all
        of them together. middles (m,2): edges, as their vertices, that get a vertex in their middle wherever they are
        on it."""
        middles = np.array(middles, np.int32).reshape(-1, 2)
        if np.ndim(tet_first):
            slices = np.array([tet_first, tet_last], np.int32).T.copy()
            return self._solid_of(load().pw_hierarchy_solid_of_slices, slices, len(slices), middles, len(middles))
        return self._solid(load().pw_hierarchy_solid, tet_first, tet_last, middles, len(middles))

    def solid_of_faces(self, tet_first: int, tet_last: int, inside: ArrayLike) -> Solid:
        """The same for a part whose faces are others than its own: those where inside, (F,) bool, is True; also where
        the slice is the rest. See pw_hierarchy_solid_of_faces in partwheel.h."""
        inside = np.ascontiguousarray(inside, bool)
        if inside.shape != self.leaf.shape:
            raise ValueError(f"inside must have the shape {self.leaf.shape}, not {inside.shape}.")
        return self._solid(load().pw_hierarchy_solid_of_faces, tet_first, tet_last, inside, len(inside))

    def solids(self, slices: Iterable[Tuple[Any, Any]]) -> List[Optional[Solid]]:
        """The Solids around slices (tet_first, tet_last), or several each, that have nothing in common, None for
        one that has no tetrahedron left. A cap between two of them is the same triangle in both: where one has a
        vertex in the middle of an edge, all have."""
        made: List[Optional[Solid]] = []
        for each in slices:
            try:
                made.append(self.solid_of_slice(*each))
            except PartwheelError as error:
                if error.status != Status.EMPTY:
                    raise
                made.append(None)
        middles = [solid.ends[solid.ends[:, 0] != solid.ends[:, 1]] for solid in made if solid]
        if not any(map(len, middles)):
            return made
        middles = np.unique(np.sort(np.vstack(middles), axis=1), axis=0)
        return [solid and self.solid_of_slice(*each, middles) for each, solid in zip(slices, made)]

    def _solid(self, function, tet_first, tet_last, *arguments):
        return self._solid_of(function, _number(tet_first), _number(tet_last), *arguments)

    def _solid_of(self, function, *arguments):
        mesh, vertices, triangles = self._mesh(function, *arguments)
        ends, faces, beyond = told([c_void_p] * 3, load().pw_mesh_origins, mesh)
        return Solid(vertices, triangles, _view(mesh, ends, (len(vertices), 2), np.int32),
                     *(_view(mesh, each, (len(triangles),), np.int32) for each in (faces, beyond)))

    def rest(self, node: SupportsIndex) -> Solid:
        """The Solid around all tetrahedra but a node's. Raises PartwheelError (EMPTY) where nothing is left."""
        first, last = self._slice(node)
        return self.solid_of_slice(last, first)

    def _slice(self, node: SupportsIndex) -> Tuple[int, int]:
        node = _number(node)
        if node >= len(self.parent):
            raise PartwheelError(Status.ARGUMENT, f"There is no node {node}: the hierarchy has {len(self.parent)}.")
        return self.tet_first[node], self.tet_last[node]

    def _mesh(self, function, *arguments):
        """What a function makes of some of the tetrahedra: (its handle, vertices, triangles)."""
        mesh = Handle(load().pw_mesh_free, made(function, None, self._handle, *arguments))
        vertices, vertex_count, triangles, triangle_count = told([c_void_p, c_size_t] * 2, load().pw_mesh_arrays, mesh)
        return (mesh, _view(mesh, vertices, (vertex_count, 3), np.float64),
                _view(mesh, triangles, (triangle_count, 3), np.int32))

    def _ask(self, function, dtype, *arguments, before=(), after=()):
        """Calls a function that fills an array, first to learn the size, then to get it."""
        count = c_size_t()
        check(function(*before, self._handle, *arguments, None, 0, byref(count), *after))
        result = np.empty(count.value, dtype)
        check(function(*before, self._handle, *arguments, result, result.size, byref(count), *after))
        return result


def _number(value: SupportsIndex) -> int:
    """A face, node, tetrahedron or part number for C: ctypes would turn -1 into a huge number without a word."""
    value = operator.index(value)
    if value < 0:
        raise PartwheelError(Status.ARGUMENT, f"{value} is not the number of anything: numbers start at 0.")
    return value
