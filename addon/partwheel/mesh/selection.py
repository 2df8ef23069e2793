# SPDX-License-Identifier: GPL-3.0-or-later
"""Selections of meshes: in Edit Mode changed by differences and restored; outside it written into the mesh."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from collections import deque
from itertools import repeat

import bmesh
import bpy
import numpy as np

from . import arrays
from .mesh_state import find_object
from .snapshot import MeshSnapshot

# Select mode -> elements of the mesh, and the loops' index of them. The finest active mode counts: Blender derives the
# selection of coarser elements from it.
KINDS = ("VERT", "EDGE", "FACE")
ELEMENTS = {"VERT": "vertices", "EDGE": "edges", "FACE": "polygons"}
LOOP_INDEX = {"VERT": "vertex_index", "EDGE": "edge_index"}
# Costs in units of the time to select a face: of deselecting one (Blender visits all its neighbors), and all.
DESELECT_COST, DESELECT_ALL_COST = 2, 6000


def _get_sequence(bm: bmesh.types.BMesh, kind: str) -> bmesh.types.BMElemSeq:
    sequence = {"VERT": bm.verts, "EDGE": bm.edges, "FACE": bm.faces}[kind]
    sequence.ensure_lookup_table()
    return sequence


class Selection:
    """The selection of a mesh in Edit Mode when the object was created, and the selection made since.

    Holds no reference to Blender's data, which undo or a mode change would make dangle; every method takes the object, or
    a snapshot of it.
    Masks are (n,) bool, one value per vertex, edge or face."""

    def __init__(self, snapshot: MeshSnapshot) -> None:
        mesh, bm = snapshot.update_mesh(), self._edited(snapshot.obj)
        for kind in KINDS:
            _get_sequence(bm, kind).index_update()
        self.initial = {kind: _read_selected(mesh, kind) for kind in KINDS}
        # list(): with Python 3.13, a comprehension can't iterate over the history of Blender 4.3.
        self.history = [(type(element).__name__[2:].upper(), element.index) for element in list(bm.select_history)]
        self.active_face = bm.faces.active.index if bm.faces.active else None
        self.visible = ~arrays.read(mesh.polygons, "hide", bool)
        self.kind = next(kind for kind in KINDS if kind in bm.select_mode)
        if self.kind != "FACE":
            corners = arrays.read_polygon_sizes(mesh)[1]
            self.loop_face = np.repeat(np.arange(len(mesh.polygons)), corners)
            self.loop_element = arrays.read(mesh.loops, LOOP_INDEX[self.kind], np.int32)
        self.current = self.initial[self.kind]

    def _edited(self, obj: bpy.types.Object) -> bmesh.types.BMesh:
        """Return the object's BMesh and keep a reference to it. While a Python reference to the BMesh exists, each
        element has a field for its own; adding and removing that takes as long as a notch of the wheel. Undo or a mode
        change only invalidates the reference."""
        self._bm = bmesh.from_edit_mesh(obj.data)
        return self._bm

    def is_valid(self, obj: bpy.types.Object | None) -> bool:
        """Return whether the object is in Edit Mode with the original element counts and select mode."""
        if obj is None or obj.type != "MESH" or obj.mode != "EDIT":
            return False
        bm = self._edited(obj)
        counts = len(bm.verts), len(bm.edges), len(bm.faces)
        return counts == tuple(len(self.initial[kind]) for kind in KINDS) and self.kind in bm.select_mode

    def select(self, obj: bpy.types.Object, faces: np.ndarray | Sequence[int], active: int | None = None,
               extend: bool = False, deselect: bool = False) -> None:
        """Select these faces (indices) except hidden ones, and nothing else. extend: also what was selected originally.
        deselect: what was selected originally, minus these faces. active: index of the new active face."""
        target = is_chosen = arrays.make_mask(len(self.visible), faces) & self.visible
        if self.kind != "FACE":
            target = arrays.make_mask(len(self.current), self.loop_element[is_chosen[self.loop_face]])
        if deselect:
            target = self.initial[self.kind] & ~target
        elif extend:
            target |= self.initial[self.kind]
        bm = self._edited(obj)
        removed, remaining = self.current & ~target, self.current & target
        is_only_edited = list(bpy.context.objects_in_mode_unique_data) == [obj]  # as the operator acts on all of them
        if (is_only_edited
                and DESELECT_COST * np.count_nonzero(removed) > DESELECT_ALL_COST + np.count_nonzero(remaining)):
            bpy.ops.mesh.select_all(action="DESELECT")
            _set_selected(_get_sequence(bm, self.kind), target, True)
        else:
            _set_selected(_get_sequence(bm, self.kind), removed, False)
            _set_selected(_get_sequence(bm, self.kind), target & ~self.current, True)
        self.current = target
        if self.kind != "FACE":  # selecting a face also selects its edges and vertices
            bm.select_flush_mode()
        if active is not None:
            face = _get_sequence(bm, "FACE")[active]
            bm.faces.active = face
            bm.select_history.clear()
            if self.kind == "FACE" and face.select:
                bm.select_history.add(face)
        _tag_selection_changed(obj)

    def find_changed_faces(self, snapshot: MeshSnapshot, only_selected: bool) -> np.ndarray:
        """Return the faces (n,) with an element whose selection has changed since. only_selected: to selected."""
        is_selected = arrays.read(getattr(snapshot.update_mesh(), ELEMENTS[self.kind]), "select", bool)
        changed = is_selected if only_selected else is_selected != self.initial[self.kind]
        if self.kind != "FACE":
            changed = arrays.make_mask(len(self.visible), self.loop_face[changed[self.loop_element]])
        return np.flatnonzero(changed & self.visible)

    def restore(self, snapshot: MeshSnapshot) -> None:
        """Restore the selection of vertices, edges and faces, the active face and the selection history."""
        mesh, bm = snapshot.update_mesh(), self._edited(snapshot.obj)
        # Blender propagates changes of faces and edges to their vertices: so deselect first, then select, fine to coarse.
        for kind in reversed(KINDS):
            elements = _get_sequence(bm, kind)
            is_selected = arrays.read(getattr(mesh, ELEMENTS[kind]), "select", bool)
            for index in np.flatnonzero(is_selected & ~self.initial[kind]).tolist():
                elements[index].select = False
        for kind in KINDS:
            elements = _get_sequence(bm, kind)
            for index in np.flatnonzero(self.initial[kind]).tolist():
                elements[index].select = True
        bm.select_flush_mode()  # also updates the counts of selected elements
        bm.select_history.clear()
        for kind, index in self.history:
            bm.select_history.add(_get_sequence(bm, kind)[index])
        bm.faces.active = None if self.active_face is None else _get_sequence(bm, "FACE")[self.active_face]
        self.current = self.initial[self.kind]
        _tag_selection_changed(snapshot.obj)


def _read_selected(mesh: bpy.types.Mesh, kind: str) -> np.ndarray:
    """Return a mask (n,) of the selected elements. O(1) to find out that there are none, apart from the array."""
    elements = getattr(mesh, ELEMENTS[kind])
    if not (mesh.total_vert_sel or mesh.total_edge_sel or mesh.total_face_sel):
        return np.zeros(len(elements), bool)
    return arrays.read(elements, "select", bool)


def _set_selected(elements: bmesh.types.BMElemSeq, mask: np.ndarray, value: bool) -> None:
    """Select or deselect the elements where the mask is True. There may be many, so without a Python loop."""
    indices = np.flatnonzero(mask).tolist()
    if indices:
        select_set = type(elements[indices[0]]).select_set
        deque(map(select_set, map(elements.__getitem__, indices), repeat(value)), maxlen=0)


def _tag_selection_changed(obj: bpy.types.Object) -> None:
    """Notify Blender that the selection of a mesh in Edit Mode has changed."""
    if obj == bpy.context.view_layer.objects.active:
        # This setting's update function tags the selection only. The call below tags the geometry, so that Blender would
        # evaluate modifiers at every notch.
        settings = bpy.context.tool_settings
        settings.mesh_select_mode = settings.mesh_select_mode
    else:
        bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)


class Selections:
    """The selections of all meshes that are edited together, for picking a part of one of them."""

    def __init__(self, snapshots: Iterable[MeshSnapshot]) -> None:
        self._selections = {snapshot.obj.name_full: Selection(snapshot) for snapshot in snapshots}

    @classmethod
    def of_edited(cls, context: bpy.types.Context, snapshot: MeshSnapshot) -> Selections:
        """Return the Selections of all edited objects. snapshot: of one of them; its trust_reports holds for all."""
        return cls(snapshot if obj == snapshot.obj else MeshSnapshot(obj, snapshot.trust_reports)
                   for obj in context.objects_in_mode_unique_data)

    def _objects(self) -> list[tuple[bpy.types.Object | None, Selection]]:
        """Return (object or None, its Selection) for each object."""
        return [(find_object(name), selection) for name, selection in self._selections.items()]

    def any(self) -> bool:
        return any(selection.current.any() for selection in self._selections.values())

    def is_valid(self) -> bool:
        return all(selection.is_valid(obj) for obj, selection in self._objects())

    def select(self, obj: bpy.types.Object, faces: np.ndarray | Sequence[int], active: int | None = None,
               extend: bool = False, deselect: bool = False, group: frozenset = frozenset()) -> None:
        """Select as Selection.select() for one object, and all faces of the other objects with the full names in group.
        Deselect the rest, except with extend or deselect."""
        whole = {find_object(name): np.arange(len(selection.visible)) for name, selection in self._selections.items()
                 if name in group}
        self.select_in_each({**whole, obj: faces}, extend, deselect, {obj: active})

    def select_in_each(self, faces: dict[bpy.types.Object, np.ndarray], extend: bool, deselect: bool = False,
                       active: dict[bpy.types.Object, int] | tuple = ()) -> None:
        """Select as Selection.select() for each object. faces: per object, none if missing; active: its new
        active face."""
        for obj, selection in self._objects():
            before = selection.initial[selection.kind] if extend or deselect else np.zeros_like(selection.current)
            if obj in faces or not np.array_equal(selection.current, before):
                selection.select(obj, faces.get(obj, ()), dict(active).get(obj), extend, deselect)

    def selected_before(self, obj: bpy.types.Object) -> np.ndarray:
        """Return the faces (n,) of an object that were selected originally."""
        return np.flatnonzero(self._selections[obj.name_full].initial["FACE"])

    def restore(self) -> None:
        for obj, selection in self._objects():
            selection.restore(MeshSnapshot(obj))

    def restore_changed(self, only_selected: bool) -> dict[bpy.types.Object, np.ndarray]:
        """Restore the selections, and return the faces that Selection.find_changed_faces() finds in each object before."""
        changed = {}
        for obj, selection in self._objects():
            snapshot = MeshSnapshot(obj)
            changed[obj] = selection.find_changed_faces(snapshot, only_selected)
            selection.restore(snapshot)
        return changed


def is_exact_selection(mesh: bpy.types.Mesh, faces: np.ndarray, kind: str) -> bool:
    """Return whether exactly these faces are selected, but for hidden ones, by this kind, in an up-to-date mesh."""
    is_chosen = arrays.make_mask(len(mesh.polygons), faces) & ~arrays.read(mesh.polygons, "hide", bool)
    if kind != "FACE":
        is_chosen = arrays.mask_elements_of_faces(mesh, is_chosen, ELEMENTS[kind], LOOP_INDEX[kind])
    return np.array_equal(arrays.read(getattr(mesh, ELEMENTS[kind]), "select", bool), is_chosen)


def predict_face_selection(mesh: bpy.types.Mesh, faces: np.ndarray, extend: bool,
                           deselect: bool) -> np.ndarray:
    """Return a mask (F,) of what Selection.select() would select, for a mesh that is not in Edit Mode."""
    is_chosen = arrays.make_mask(len(mesh.polygons), faces) & ~arrays.read(mesh.polygons, "hide", bool)
    if not (extend or deselect):
        return is_chosen  # no need to read the selection
    before = arrays.read(mesh.polygons, "select", bool)
    return before & ~is_chosen if deselect else before | is_chosen


def select_outside_edit_mode(mesh: bpy.types.Mesh, faces: np.ndarray | Sequence[int], extend: bool = False,
                             deselect: bool = False, active: int | None = None) -> None:
    """Select what predict_face_selection() returns: faces, their edges and vertices. active: the new active face."""
    is_chosen = predict_face_selection(mesh, faces, extend, deselect)
    arrays.write(mesh.polygons, "select", is_chosen)
    arrays.write(mesh.vertices, "select", arrays.mask_elements_of_faces(mesh, is_chosen))
    _select_edges(mesh, arrays.mask_elements_of_faces(mesh, is_chosen, "edges", "edge_index"))
    if len(faces):
        mesh.polygons.active = int(faces[0]) if active is None else active
    mesh.update()


def _select_edges(mesh: bpy.types.Mesh, values: np.ndarray) -> None:
    """Write the selection of edges. Blender 5.0.1 gives the attribute a wrong type and crashes when it is set."""
    attribute = mesh.attributes.get(".select_edge") if bpy.app.version >= (5, 0) else None
    if attribute and attribute.data_type != "BOOLEAN":
        mesh.attributes.remove(attribute)
        mesh.attributes.new(".select_edge", "BOOLEAN", "EDGE").data.foreach_set("value", values)
    else:
        arrays.write(mesh.edges, "select", values)
