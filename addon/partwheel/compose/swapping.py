# SPDX-License-Identifier: GPL-3.0-or-later
"""Exchanges a part for a compatible one of another object, and finds the candidates. partwheel.compatible compares;
solids, composition, placement and union remove, copy, place and unite. In Object Mode; undo is up to the caller."""

from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..mesh import MeshSnapshot, Refused, arrays, find_object, local_copy, remove_object, rollback_on_error
from ..parts import registry
from ..solid import composition
from ..solid.solids import CapOptions
from . import placement, union
from partwheel import Hierarchy, compatible


class Candidate(NamedTuple):
    """A part that can stand in."""

    name: str  # its object's full name
    node: int | None  # of that object's hierarchy; None for the object itself, a part that was cut out before
    score: float  # 1 for the same shape, down to 0
    shape: compatible.PartShape


class Adjustment(NamedTuple):
    """Changes of the fitted pose, as in placement.Pose."""

    scale: float = 1.0
    angle: float = 0.0
    depth: float = 0.0  # beyond what closes gaps between curved borders
    mirror: bool = False  # the mirror image stands in


class SwapTarget:
    """A part of an object that is to be exchanged. snap: its border, and the stand-in's, move to the creases nearby."""

    def __init__(self, obj: bpy.types.Object, hierarchy: Hierarchy, node: int, snap: bool = False) -> None:
        """Raises Refused or PartwheelError."""
        if node == len(hierarchy.parent) - 1:
            raise Refused("The part is the whole model: nothing would be left to put another part on. Pick a "
                          "smaller one.")
        composition.update_matrices()
        self.name, self.hierarchy, self.node, self.snap = obj.name_full, hierarchy, node, snap
        self._fits = {}  # (name, node, mirrored) -> matrix of the candidate's fit
        self._cut_shapes = {}  # (name, node) -> PartShape with snapped border
        self.shape = _node_shape(obj, hierarchy, node, snap)
        if not self.shape:
            raise Refused("The part has no border with the rest of the model, so no other part can be fitted to it. "
                          "Pick a part that is connected to the rest.")

    def find_candidates(self, others: list[bpy.types.Object]) -> list[Candidate]:
        """The Candidates of these mesh objects, the most compatible first, without near duplicates. Of the part's own
        object, only parts that don't overlap it. Raises Refused if no object has parts."""
        candidates, n_with_parts = [], 0
        for other in others:
            parts = _part_shapes(other)
            if parts is None:
                continue
            n_with_parts += 1
            hierarchy, parts = parts
            if other.name_full == self.name:
                parts = [entry for entry in parts if entry[0] is not None
                         and compatible.node_overlap(hierarchy, entry[0], self.node) == 0]
            shapes = dict(parts)
            # One of several nodes that overlap much is enough. None: the whole object.
            for match in compatible.rank_parts(self.shape, parts, lambda *nodes: None not in nodes and (
                    compatible.node_overlap(hierarchy, *nodes) >= compatible.MIN_OVERLAP)):
                candidates.append(Candidate(other.name_full, match.key, match.score, shapes[match.key]))
                if not self.snap:
                    self._fits[other.name_full, match.key, False] = match.matrix
        if not n_with_parts:
            raise Refused("No other object has parts. Find the parts of the object that the new part comes from, "
                          "and select this object, too; or paste a part that was copied as a solid.")
        if not candidates:
            raise Refused("No part there has a border that fits the picked part's.")
        return sorted(candidates, key=lambda candidate: -candidate.score)

    def find_candidate(self, other: bpy.types.Object, node: int | None) -> Candidate:
        """The Candidate for this node of an object, or for the object itself. Raises Refused or PartwheelError."""
        hierarchy = registry.get_hierarchy(MeshSnapshot(other))
        if node is None:
            shape = _whole_shape(other)
        elif hierarchy and 0 <= node < len(hierarchy.parent):
            shape = _node_shape(other, hierarchy, node)
        else:
            raise Refused("{name} has no part {number}.", name=other.name, number=node)
        if not shape:
            raise Refused("That part of {name} has no border that fits the picked part's.", name=other.name)
        match = compatible.rank_parts(self.shape, [(node, shape)])[0]
        if not self.snap:
            self._fits[other.name_full, node, False] = match.matrix
        return Candidate(other.name_full, node, match.score, shape)

    def create_rest_mesh(self) -> bpy.types.Mesh:
        """A new mesh: the object's without the part, closed. Raises Refused or PartwheelError."""
        return composition.create_rest_mesh(find_object(self.name), self.hierarchy, self.node, self.snap)

    @rollback_on_error()
    def create_stand_in(self, candidate: Candidate, adjustment: Adjustment = Adjustment()) -> bpy.types.Object:
        """A new object with the candidate's mesh in the part's place, without modifiers: the part's object has them."""
        obj, source = find_object(self.name), find_object(candidate.name)
        composition.update_matrices()
        if candidate.node is None:
            name, mesh = source.name, local_copy(source.data)
        else:
            hierarchy = _candidate_hierarchy(candidate)
            name = f"{source.name} part"
            mesh = composition.create_part_mesh(source, hierarchy, candidate.node, CapOptions(), self.snap)
        new = composition.create_bare_object(source, mesh, name, composition.target_collections(obj)[0])
        for new_slot, slot in zip(new.material_slots, source.material_slots):
            new_slot.link, new_slot.material = slot.link, slot.material
        self.move_stand_in(new, candidate, adjustment)
        return new

    def move_stand_in(self, new: bpy.types.Object, candidate: Candidate, adjustment: Adjustment) -> None:
        """Moves an object of create_stand_in()."""
        loop, key = self.shape.main, (candidate.name, candidate.node, adjustment.mirror)
        shape = self._cut_shape(candidate)
        if key not in self._fits:
            self._fits[key] = compatible.fit(self.shape, shape, adjustment.mirror).matrix
        depth = adjustment.depth + compatible.gap(self.shape, shape, self._fits[key])
        start = Matrix(self._fits[key]) @ composition.without_shear(find_object(candidate.name).matrix_world)
        new.matrix_world = placement.placement_matrix(start, loop, Vector(loop.center), -Vector(loop.normal),
                                                      adjustment.scale, adjustment.angle, depth)

    def _cut_shape(self, candidate: Candidate) -> compatible.PartShape:
        """The candidate's shape with a snapped border. Ranking goes without: snapping all would be slow."""
        if not self.snap or candidate.node is None:
            return candidate.shape
        key = candidate.name, candidate.node
        if key not in self._cut_shapes:
            self._cut_shapes[key] = _node_shape(find_object(candidate.name), _candidate_hierarchy(candidate),
                                                candidate.node, snap=True) or candidate.shape
        return self._cut_shapes[key]

    @rollback_on_error()
    def swap(self, candidate: Candidate, adjustment: Adjustment, blend: float) -> None:
        """Removes the part from the object's mesh and unites the rest with the candidate. blend: as for union.unite(). Raises
        an Error before any change."""
        rest, new = self.create_rest_mesh(), self.create_stand_in(candidate, adjustment)
        union.unite(find_object(self.name), [new], blend, rest)
        bpy.data.meshes.remove(rest)
        remove_object(new)


def _candidate_hierarchy(candidate: Candidate) -> Hierarchy:
    """The hierarchy of the candidate's object. Raises Refused."""
    hierarchy = registry.get_hierarchy(MeshSnapshot(find_object(candidate.name)))
    if not hierarchy or candidate.node >= len(hierarchy.parent):
        raise Refused("{name} has changed and has other parts now. Start again.", name=candidate.name)
    return hierarchy


def sources(context: bpy.types.Context, target: bpy.types.Object) -> list[bpy.types.Object]:
    """The mesh objects that parts may come from: the other selected ones, or else all other visible ones."""
    visible = [obj for obj in context.view_layer.objects if obj != target and obj.type == "MESH" and obj.visible_get()]
    return [obj for obj in visible if obj.select_get()] or visible


def _part_shapes(obj: bpy.types.Object) -> tuple[Hierarchy | None, list[tuple]] | None:
    """(hierarchy or None, [(node or None, PartShape), ...]) of an object; None if it neither has parts nor is one."""
    hierarchy, whole_shape = registry.get_hierarchy(MeshSnapshot(obj)), _whole_shape(obj)
    if not hierarchy and not whole_shape:
        return None
    parts = [(None, whole_shape)] if whole_shape else []
    return hierarchy, parts + (_node_shapes(obj, hierarchy, compatible.candidate_nodes(hierarchy)) if hierarchy else [])


def _node_shapes(obj: bpy.types.Object, hierarchy: Hierarchy, nodes: list[int],
                 snap: bool = False) -> list[tuple[int, compatible.PartShape]]:
    """[(node, PartShape), ...] in the world, without nodes that can't be cut out. snap: with borders in creases."""
    positions = np.array(hierarchy.vertices)
    has_source = hierarchy.source >= 0
    mesh_positions = arrays.read_positions(arrays.update_mesh(obj))
    positions[has_source] = mesh_positions[hierarchy.source[has_source]]
    matrix = np.array(obj.matrix_world)
    size = _half_diagonal(positions, matrix)
    shapes = [(node, compatible.part_shape(hierarchy, node, positions, matrix, size,
                                      composition.snapped_faces(obj, hierarchy, node, snap))) for node in nodes]
    return [(node, shape) for node, shape in shapes if shape]


def _node_shape(obj: bpy.types.Object, hierarchy: Hierarchy, node: int,
                snap: bool = False) -> compatible.PartShape | None:
    """The PartShape of one node; None if it can't be compared."""
    return next((shape for _, shape in _node_shapes(obj, hierarchy, [node], snap) if shape.is_usable), None)


def _whole_shape(obj: bpy.types.Object) -> compatible.PartShape | None:
    """The PartShape of an object that is a part, closed by caps; None for any other."""
    mesh = obj.data
    caps = placement.cap_faces(mesh)
    if obj.mode == "EDIT" or caps is None or not caps.any() or union.find_defect(mesh):
        return None
    triangles, polygons = arrays.read_triangles(mesh)
    positions, matrix = arrays.read_positions(mesh).astype(float), np.array(obj.matrix_world)
    shape = compatible.PartShape(positions, triangles, caps[polygons], matrix, _half_diagonal(positions, matrix))
    return shape if shape.is_usable else None


def _half_diagonal(positions: np.ndarray, matrix: np.ndarray) -> float:
    """Half the diagonal of the bounding box of positions (n, 3), in the world."""
    world_positions = positions @ matrix[:3, :3].T
    return float(np.linalg.norm(world_positions.max(axis=0) - world_positions.min(axis=0)) / 2)
