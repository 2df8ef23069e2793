# SPDX-License-Identifier: GPL-3.0-or-later
"""A part exchanged for a compatible one of another object: which there are, and the exchange itself. The comparing is
partwheel.compatible's; removing, copying, placing and uniting are those of solids, composition, placement and union. In
Object Mode; the caller looks after undo."""

from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..mesh import arrays
from ..mesh.datablocks import all_or_nothing, dispose
from ..parts import registry
from ..solid import composition
from . import placement, union
from partwheel import compatible
from ..mesh.mesh_identity import find_object
from ..mesh.errors import Refused


class Offer(NamedTuple):
    """A part that can stand in. name: its object's, in full; node: of that one's hierarchy, or None for the object as
    it is, one that was cut out as a part before; score: from 1, the same shape, down to 0; shape: the PartShape."""

    name: str
    node: int
    score: float
    shape: compatible.PartShape


class Adjustment(NamedTuple):
    """What is changed about the place that was found, as in placement.Pose; depth: beyond what closes gaps between bent
    borders; mirror: the mirror image stands in."""

    scale: float = 1.0
    angle: float = 0.0
    depth: float = 0.0
    mirror: bool = False


class Place:
    """A part of an object that is to be exchanged. snap: its border, and that of the part that stands in, are moved to
    the creases nearby."""

    def __init__(self, obj, hierarchy, node, snap=False):
        """Raises Refused, or PartwheelError."""
        if node == len(hierarchy.parent) - 1:
            raise Refused("The part is the whole model: nothing would be left to put another part on. Pick a "
                             "smaller one.")
        composition.update_matrices()
        self.name, self.hierarchy, self.node, self.snap = obj.name_full, hierarchy, node, snap
        self._fits = {}  # (name, node, mirrored) -> matrix, of what was offered
        self._cut = {}  # (name, node) -> Shape, of what was put here
        self.shape = _shape(obj, hierarchy, node, snap)
        if not self.shape:
            raise Refused("The part has no border with the rest of the model, so there is nothing to fit another "
                             "part to. Pick one that was grown from the model, not a piece of its own.")

    def offers(self, others):
        """The Offers of these mesh objects, the most compatible first, and none that is nearly the same part of its
        object as a better one. Of the object itself parts beside the one to be exchanged. Raises Refused if no
        object has parts."""
        found, having = [], 0
        for other in others:
            parts = _parts(other)
            if parts is None:
                continue
            having += 1
            hierarchy, parts = parts
            if other.name_full == self.name:
                parts = [each for each in parts if each[0] is not None
                         and compatible.node_overlap(hierarchy, each[0], self.node) == 0]
            shapes = dict(parts)
            for match in compatible.rank_parts(self.shape, parts, lambda one, two: _same(hierarchy, one, two)):
                found.append(Offer(other.name_full, match.key, match.score, shapes[match.key]))
                if not self.snap:
                    self._fits[other.name_full, match.key, False] = match.matrix
        if not having:
            raise Refused("No other object has parts. Find the parts of the one that the new part comes from, and "
                             "select it too; or paste a part that was copied as a solid.")
        if not found:
            raise Refused("No part there has a border that could be fitted to this one's.")
        return sorted(found, key=lambda offer: -offer.score)

    def offer(self, other, node=None):
        """The Offer of this node of an object, or of the object itself, a part. Raises Refused or PartwheelError."""
        hierarchy = registry.hierarchy(other)
        if node is None:
            shape = _whole(other)
        elif hierarchy and 0 <= node < len(hierarchy.parent):
            shape = _shape(other, hierarchy, node)
        else:
            raise Refused("{name} has no part {number}.", name=other.name, number=node)
        if not shape:
            raise Refused("That part of {name} has no border that could be fitted to this one's.", name=other.name)
        match = compatible.rank_parts(self.shape, [(node, shape)])[0]
        if not self.snap:
            self._fits[other.name_full, node, False] = match.matrix
        return Offer(other.name_full, node, match.score, shape)

    def rest(self):
        """A new mesh: the object's without the part, closed. Raises Refused or PartwheelError."""
        return composition.create_rest_mesh(find_object(self.name), self.hierarchy, self.node, self.snap)

    @all_or_nothing()
    def stand_in(self, offer, adjustment=Adjustment()):
        """A new object beside this part's: the one offered, in this part's place. Its mesh alone: modifiers that act on it
        afterwards are those of this part's object."""
        obj, source = find_object(self.name), find_object(offer.name)
        composition.update_matrices()
        if offer.node is None:
            name, mesh = source.name, source.data.copy()
        else:
            name, mesh = f"{source.name} part", composition.create_part_mesh(source, _hierarchy_of(offer), offer.node, snap=self.snap)
        new = composition.create_bare_object(source, mesh, name, composition.target_collection(obj))
        for own, slot in zip(new.material_slots, source.material_slots):
            own.link, own.material = slot.link, slot.material
        self.put(new, offer, adjustment)
        return new

    def put(self, new, offer, adjustment):
        """Moves an object that stand_in() made."""
        own, known = self.shape.main, (offer.name, offer.node, adjustment.mirror)
        shape = self._shape_of(offer)
        if known not in self._fits:
            self._fits[known] = compatible.fit(self.shape, shape, adjustment.mirror).matrix
        depth = adjustment.depth + compatible.gap(self.shape, shape, self._fits[known])
        start = Matrix(self._fits[known]) @ find_object(offer.name).matrix_world
        new.matrix_world = placement.matrix(start, own, Vector(own.center), -Vector(own.normal), adjustment.scale,
                                            adjustment.angle, depth)

    def _shape_of(self, offer):
        """As it is cut out. Parts are ranked by their own borders: to move those of all would take long."""
        if not self.snap or offer.node is None:
            return offer.shape
        known = offer.name, offer.node
        if known not in self._cut:
            self._cut[known] = _shape(find_object(offer.name), _hierarchy_of(offer), offer.node, snap=True) or offer.shape
        return self._cut[known]

    @all_or_nothing()
    def swap(self, offer, adjustment=Adjustment(), blend=0.0):
        """Takes the part out of the object's mesh and unites what is left with the one offered; blend: as for
        union.unite(). Raises an Error before anything has changed."""
        rest, new = self.rest(), self.stand_in(offer, adjustment)
        solver = union.unite(find_object(self.name), [new], blend, rest)
        bpy.data.meshes.remove(rest)
        dispose(new)
        return solver


def _hierarchy_of(offer):
    """Of the object that the offer's node is of. Raises Refused."""
    hierarchy = registry.hierarchy(find_object(offer.name))
    if not hierarchy or offer.node >= len(hierarchy.parent):
        raise Refused("{name} was changed and has other parts now. Start again.", name=offer.name)
    return hierarchy


def sources(context, obj):
    """The mesh objects that parts may come from: those selected beside the object, or else all others in the scene that
    can be seen."""
    others = [each for each in context.view_layer.objects if each != obj and each.type == "MESH" and each.visible_get()]
    return [each for each in others if each.select_get()] or others


def _same(hierarchy, one, other):
    """Whether two nodes are so nearly one part that it is enough to offer one. None: the object as it is."""
    return None not in (one, other) and compatible.node_overlap(hierarchy, one, other) >= compatible.MIN_OVERLAP


def _parts(obj):
    """(hierarchy or None, [(node or None, Shape), ...]) of an object, or None if it has no parts and is none."""
    hierarchy, whole = registry.hierarchy(obj), _whole(obj)
    if not hierarchy and not whole:
        return None
    parts = [(None, whole)] if whole else []
    return hierarchy, parts + (_shapes(obj, hierarchy, compatible.candidate_nodes(hierarchy)) if hierarchy else [])


def _shapes(obj, hierarchy, nodes, snap=False):
    """[(node, Shape), ...] in the world, of the mesh as it is now. A node of which nothing can be cut out is left out.
    snap: with their borders in creases."""
    positions = np.array(hierarchy.vertices)
    known = hierarchy.source >= 0
    positions[known] = arrays.read(arrays.up_to_date(obj).vertices, "co", np.float32, 3)[hierarchy.source[known]]
    matrix = np.array(obj.matrix_world)
    size = _size(positions, matrix)
    shapes = [(node, compatible.part_shape(hierarchy, node, positions, matrix, size,
                                      composition.snapped_faces(obj, hierarchy, node, snap))) for node in nodes]
    return [(node, shape) for node, shape in shapes if shape]


def _shape(obj, hierarchy, node, snap=False):
    """The Shape of one node, or None if it can't be compared."""
    return next((shape for _, shape in _shapes(obj, hierarchy, [node], snap) if shape.is_usable), None)


def _whole(obj):
    """The Shape of an object that is a part, closed by caps; None for any other."""
    mesh = obj.data
    caps = placement.caps(mesh)
    if obj.mode == "EDIT" or caps is None or not caps.any() or union.problem(mesh):
        return None
    triangles, polygons = arrays.triangles(mesh)
    positions, matrix = arrays.read(mesh.vertices, "co", np.float32, 3).astype(float), np.array(obj.matrix_world)
    shape = compatible.PartShape(positions, triangles, caps[polygons], matrix, _size(positions, matrix))
    return shape if shape.is_usable else None


def _size(positions, matrix):
    """Half the diagonal of the bounding box of positions (n,3), in the world."""
    places = positions @ matrix[:3, :3].T
    return float(np.linalg.norm(places.max(axis=0) - places.min(axis=0)) / 2)
