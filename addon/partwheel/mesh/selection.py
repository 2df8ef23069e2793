# SPDX-License-Identifier: GPL-3.0-or-later
"""The selection of a mesh in Edit Mode: sets of faces are selected by differences; the selection before comes back."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from collections import deque
from itertools import repeat

import bmesh
import bpy
import numpy as np

from . import arrays
from .mesh_identity import find_object

# Select mode -> what is selected in it: the mesh's elements and the loops' reference to them. The finest mode that is
# on rules: Blender derives the coarser elements' selection from it.
KINDS = ("VERT", "EDGE", "FACE")
ELEMENTS = {"VERT": "vertices", "EDGE": "edges", "FACE": "polygons"}
LOOP_INDEX = {"VERT": "vertex_index", "EDGE": "edge_index"}
# In units of the time to select a face: to deselect one (Blender looks at all its neighbours), and to deselect all.
DESELECT_COST, DESELECT_ALL_COST = 2, 6000


def _get_sequence(bm: bmesh.types.BMesh, kind: str) -> bmesh.types.BMElemSeq:
    sequence = {"VERT": bm.verts, "EDGE": bm.edges, "FACE": bm.faces}[kind]
    sequence.ensure_lookup_table()
    return sequence


class Selection:
    """The selection as it was when this was made, and the one this has made of it since.

    Holds no reference to Blender's data that undo or a mode change could make dangle; the object is handed to every
    method. Masks are (n,) bool, one for each vertex, edge or face of the mesh.
    """

    def __init__(self, obj: bpy.types.Object, mesh: bpy.types.Mesh | None = None) -> None:
        """mesh: the object's, if that is known to be up to date."""
        mesh = mesh or arrays.update_mesh(obj)
        bm = self._edited(obj)
        for kind in KINDS:
            _get_sequence(bm, kind).index_update()
        self.initial = {kind: _read_selected(mesh, kind) for kind in KINDS}
        # list(): with Python 3.13 the history of Blender 4.3 is not to be gone through in a comprehension.
        self.history = [(_element_kind(element), element.index) for element in list(bm.select_history)]
        self.active_face = bm.faces.active.index if bm.faces.active else None
        self.visible = ~arrays.read(mesh.polygons, "hide", bool)
        self.kind = next(kind for kind in KINDS if kind in bm.select_mode)
        if self.kind != "FACE":
            corners = arrays.read_polygon_sizes(mesh)[1]
            self.loop_face = np.repeat(np.arange(len(mesh.polygons)), corners)
            self.loop_element = arrays.read(mesh.loops, LOOP_INDEX[self.kind], np.int32)
        self.current = self.initial[self.kind]

    def _edited(self, obj: bpy.types.Object) -> bmesh.types.BMesh:
        """The object's BMesh. Kept, which undo or a mode change only make invalid: elements have a field for Python's
        references to them as long as there is one to the BMesh, and adding and removing it takes as long as a notch."""
        self._bm = bmesh.from_edit_mesh(obj.data)
        return self._bm

    def is_valid(self, obj: bpy.types.Object | None) -> bool:
        """Whether the object is still in Edit Mode with as many elements and the select mode of when this was made."""
        if obj is None or obj.type != "MESH" or obj.mode != "EDIT":
            return False
        bm = self._edited(obj)
        counts = len(bm.verts), len(bm.edges), len(bm.faces)
        return counts == tuple(len(self.initial[kind]) for kind in KINDS) and self.kind in bm.select_mode

    def select(self, obj: bpy.types.Object, faces: np.ndarray | Sequence[int], active: int | None = None,
               extend: bool = False, deselect: bool = False) -> None:
        """Selects these faces (an array of indices), hidden ones left out, and nothing else; with extend also what was
        selected before; with deselect only what was selected before and is not in these faces. active: the index of
        the face to make the active one."""
        target = chosen = arrays.make_mask(len(self.visible), faces) & self.visible
        if self.kind != "FACE":
            target = arrays.make_mask(len(self.current), self.loop_element[chosen[self.loop_face]])
        if deselect:
            target = self.initial[self.kind] & ~target
        elif extend:
            target |= self.initial[self.kind]
        bm = self._edited(obj)
        arrays.invalidate_snapshot()
        removed, kept = self.current & ~target, self.current & target
        if _is_only_edited_object(obj) and DESELECT_COST * np.count_nonzero(removed) > DESELECT_ALL_COST + np.count_nonzero(kept):
            bpy.ops.mesh.select_all(action="DESELECT")
            _set_selected(_get_sequence(bm, self.kind), target, True)
        else:
            _set_selected(_get_sequence(bm, self.kind), removed, False)
            _set_selected(_get_sequence(bm, self.kind), target & ~self.current, True)
        self.current = target
        if self.kind != "FACE":  # a face takes its edges and vertices along
            bm.select_flush_mode()
        if active is not None:
            face = _get_sequence(bm, "FACE")[active]
            bm.faces.active = face
            bm.select_history.clear()
            if self.kind == "FACE" and face.select:
                bm.select_history.add(face)
        _tag_selection_changed(obj)

    def find_changed_faces(self, obj: bpy.types.Object, only_selected: bool) -> np.ndarray:
        """(n,) the faces that have an element whose selection somebody else has changed since; only_selected: that is selected
        now. The object's mesh must be up to date."""
        now = arrays.read(getattr(obj.data, ELEMENTS[self.kind]), "select", bool)
        changed = now if only_selected else now != self.initial[self.kind]
        if self.kind != "FACE":
            changed = arrays.make_mask(len(self.visible), self.loop_face[changed[self.loop_element]])
        return np.flatnonzero(changed & self.visible)

    def restore(self, obj: bpy.types.Object) -> None:
        """Everything as it was: vertices, edges, faces, the active face and the history of picks."""
        bm = self._edited(obj)
        mesh = arrays.update_mesh(obj)
        arrays.invalidate_snapshot()
        # Blender hands a change of a face or an edge on to its vertices: so first all off, then on from fine to coarse.
        for kind in reversed(KINDS):
            elements = _get_sequence(bm, kind)
            now = arrays.read(getattr(mesh, ELEMENTS[kind]), "select", bool)
            for index in np.flatnonzero(now & ~self.initial[kind]).tolist():
                elements[index].select = False
        for kind in KINDS:
            elements = _get_sequence(bm, kind)
            for index in np.flatnonzero(self.initial[kind]).tolist():
                elements[index].select = True
        bm.select_flush_mode()  # also counts the selected elements anew
        bm.select_history.clear()
        for kind, index in self.history:
            bm.select_history.add(_get_sequence(bm, kind)[index])
        bm.faces.active = None if self.active_face is None else _get_sequence(bm, "FACE")[self.active_face]
        self.current = self.initial[self.kind]
        _tag_selection_changed(obj)


def _read_selected(mesh: bpy.types.Mesh, kind: str) -> np.ndarray:
    """(n,) bool: which elements of the mesh are selected. That none is is known at once."""
    elements = getattr(mesh, ELEMENTS[kind])
    if not (mesh.total_vert_sel or mesh.total_edge_sel or mesh.total_face_sel):
        return np.zeros(len(elements), bool)
    return arrays.read(elements, "select", bool)


def _is_only_edited_object(obj: bpy.types.Object) -> bool:
    """Whether what Blender's operators do to all that is being edited, they do to this object only."""
    return list(bpy.context.objects_in_mode_unique_data) == [obj]


def _set_selected(elements: bmesh.types.BMElemSeq, which: np.ndarray, value: bool) -> None:
    """Selects or deselects the elements where which is True. Without a loop of Python's own, for there may be many."""
    indices = np.flatnonzero(which).tolist()
    if indices:
        select_set = type(elements[indices[0]]).select_set
        deque(map(select_set, map(elements.__getitem__, indices), repeat(value)), maxlen=0)


def _element_kind(element: bmesh.types.BMVert | bmesh.types.BMEdge | bmesh.types.BMFace) -> str:
    return {bmesh.types.BMVert: "VERT", bmesh.types.BMEdge: "EDGE", bmesh.types.BMFace: "FACE"}[type(element)]


def _tag_selection_changed(obj: bpy.types.Object) -> None:
    """Tells Blender that the selection of a mesh in Edit Mode has changed."""
    if obj == bpy.context.view_layer.objects.active:
        # The setting's update function says "selection" and no more; the call below says "geometry", upon which Blender
        # evaluates modifiers and all that hangs on the mesh at every notch.
        settings = bpy.context.tool_settings
        settings.mesh_select_mode = settings.mesh_select_mode
    else:
        bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)


class Selections:
    """The selections of all meshes that are in Edit Mode together, for a part of one of them."""

    def __init__(self, objects: Iterable[bpy.types.Object], fresh: bpy.types.Object | None = None) -> None:
        """fresh: an object whose mesh is known to be up to date."""
        self._each = {obj.name_full: Selection(obj, obj.data if obj == fresh else None) for obj in objects}

    def _objects(self) -> list[tuple[bpy.types.Object | None, Selection]]:
        """(object or None, its Selection) of each."""
        return [(find_object(name), each) for name, each in self._each.items()]

    def any(self) -> bool:
        """Whether anything is selected."""
        return any(each.current.any() for each in self._each.values())

    def is_valid(self) -> bool:
        return all(each.is_valid(obj) for obj, each in self._objects())

    def select(self, obj: bpy.types.Object, faces: np.ndarray | Sequence[int], active: int | None = None,
               extend: bool = False, deselect: bool = False) -> None:
        """As Selection.select() for one of the objects; in the others nothing stays selected, unless extend or deselect
        leaves what is."""
        for other, each in self._objects():
            if other == obj:
                each.select(obj, faces, active, extend, deselect)
            elif not (extend or deselect) and each.current.any():
                each.select(other, [])

    def select_in_each(self, faces: dict[bpy.types.Object, np.ndarray], extend: bool = False, deselect: bool = False,
                       active: dict[bpy.types.Object, int] | tuple = ()) -> None:
        """As Selection.select() for each of the objects. faces: those of each, none where it isn't named; active: likewise,
        a dict."""
        for obj, each in self._objects():
            each.select(obj, faces.get(obj, ()), dict(active).get(obj), extend, deselect)

    def find_changed_faces(self, obj: bpy.types.Object, only_selected: bool) -> np.ndarray:
        """See Selection.find_changed_faces()."""
        arrays.update_mesh(obj)
        return self._each[obj.name_full].find_changed_faces(obj, only_selected)

    def restore(self) -> None:
        for obj, each in self._objects():
            each.restore(obj)


def is_exact_selection(mesh: bpy.types.Mesh, faces: np.ndarray, kind: str) -> bool:
    """Whether these faces, but for hidden ones, are selected and nothing else is: as vertices, edges or faces, kind. The mesh
    must be up to date."""
    chosen = arrays.make_mask(len(mesh.polygons), faces) & ~arrays.read(mesh.polygons, "hide", bool)
    if kind != "FACE":
        chosen = arrays.mask_elements_of_faces(mesh, chosen, ELEMENTS[kind], LOOP_INDEX[kind])
    return np.array_equal(arrays.read(getattr(mesh, ELEMENTS[kind]), "select", bool), chosen)


def predict_face_selection(mesh: bpy.types.Mesh, faces: np.ndarray, extend: bool = False,
                           deselect: bool = False) -> np.ndarray:
    """(F,) bool: what would be selected, as Selection.select() has it, in a mesh that is not in Edit Mode."""
    chosen = arrays.make_mask(len(mesh.polygons), faces) & ~arrays.read(mesh.polygons, "hide", bool)
    if not (extend or deselect):
        return chosen  # what was selected need not be read
    before = arrays.read(mesh.polygons, "select", bool)
    return before & ~chosen if deselect else before | chosen


def select_outside_edit_mode(mesh: bpy.types.Mesh, faces: np.ndarray | Sequence[int], extend: bool = False,
                             deselect: bool = False, active: int | None = None) -> None:
    """Selects that: the faces, and their edges and vertices. active: the face to make the active one."""
    chosen = predict_face_selection(mesh, faces, extend, deselect)
    arrays.write(mesh.polygons, "select", chosen)
    arrays.write(mesh.vertices, "select", arrays.mask_elements_of_faces(mesh, chosen, "vertices", "vertex_index"))
    _select_edges(mesh, arrays.mask_elements_of_faces(mesh, chosen, "edges", "edge_index"))
    if len(faces):
        mesh.polygons.active = int(faces[0]) if active is None else active
    mesh.update()


def _select_edges(mesh: bpy.types.Mesh, values: np.ndarray) -> None:
    """Blender 5.0.1 gives the attribute behind this property a wrong type, and crashes where the property is set."""
    attribute = mesh.attributes.get(".select_edge") if bpy.app.version >= (5, 0) else None
    if attribute and attribute.data_type != "BOOLEAN":
        mesh.attributes.remove(attribute)
        mesh.attributes.new(".select_edge", "BOOLEAN", "EDGE").data.foreach_set("value", values)
    else:
        arrays.write(mesh.edges, "select", values)
