# SPDX-License-Identifier: GPL-3.0-or-later
"""The union of two meshes that may be open: both are cut where they intersect, and the pieces inside the other are deleted.
Blender's Boolean also loses pieces outside, because it can't tell the two sides of an open surface apart."""

import bmesh
import bpy
from mathutils import Vector
import numpy as np

from ..mesh import arrays, assembly, temporary_scene
from partwheel.components import components
from partwheel.triangles import winding_number

OPERAND_LAYER = "partwheel_operand"  # temporary: 1 for the operand's faces
N_SAMPLED_FACES = 32  # of a piece
MAX_OUTSIDE_FRACTION = 0.05  # of these, if the piece counts as inside
MIN_INSIDE = 0.6  # winding number: on the surface of the other, and on a lid over its opening, it is about one half


class OpenInterior:
    """The inside of a mesh that may be open or inside out: where its winding number, the solid angle that it takes up
    divided by that of a sphere, is closer to 1 or -1 than to 0. Rays would not tell where it is close to one half."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        vertices = arrays.read_positions(mesh).astype(np.float64)
        self._corners = vertices[arrays.read_triangles(mesh)[0]].transpose(1, 0, 2)

    def contains(self, position: Vector, least: float = 0.5) -> bool:
        return self._winding(position) >= least

    def covers(self, vertex: Vector) -> bool:
        """Whether one of its own vertices is inside another of its shells."""
        return self._winding(vertex) >= 1

    def _winding(self, position: Vector) -> float:
        return abs(winding_number(self._corners - np.array(position)))


def unite_open(base: bpy.types.Mesh, operand: bpy.types.Mesh, slots: list) -> bpy.types.Mesh:
    """A new mesh, with these materials. What overlaps without a distance stays once."""
    united = _join(base, operand)
    for material in slots:
        united.materials.append(material)
    with temporary_scene.edit_in_temporary_scene(united):  # the operand's faces are selected
        bpy.ops.mesh.intersect(mode="SELECT_UNSELECT", separate_mode="NONE", solver="EXACT")
        bpy.ops.mesh.select_all(action="DESELECT")
    interiors = OpenInterior(operand), OpenInterior(base)  # of the other mesh, by the layer's value
    with assembly.edit_as_bmesh(united, into=united) as bm:
        layer = bm.faces.layers.int[OPERAND_LAYER]
        inside = [face for piece in _find_pieces(bm, layer) if _is_inside(piece, interiors[piece[0][layer]]) for face in piece]
        bmesh.ops.delete(bm, geom=inside, context="FACES")
        bm.faces.layers.int.remove(bm.faces.layers.int[OPERAND_LAYER])
    return united


def _join(base: bpy.types.Mesh, operand: bpy.types.Mesh) -> bpy.types.Mesh:
    """A new mesh of both, with the operand's faces selected and marked in a layer."""
    united = base.copy()
    with assembly.edit_as_bmesh(base, into=united) as bm:
        bm.faces.layers.int.new(OPERAND_LAYER)
        n_faces = len(bm.faces)
        bm.from_mesh(operand)
        layer = bm.faces.layers.int[OPERAND_LAYER]
        for element in (*bm.verts, *bm.edges, *bm.faces):
            element.hide_set(False)
            element.select_set(False)
        for number, face in enumerate(bm.faces):
            face[layer] = number >= n_faces
            face.select_set(number >= n_faces)
    return united


def _find_pieces(bm: bmesh.types.BMesh, layer: bmesh.types.BMLayerItem) -> list[list[bmesh.types.BMFace]]:
    """The faces of each mesh that are connected without crossing the other mesh."""
    bm.faces.index_update()
    pairs = []
    for edge in bm.edges:
        first, *others = edge.link_faces or [None]
        if all(face[layer] == first[layer] for face in others):
            pairs += [(first.index, face.index) for face in others]
    labels = components(len(bm.faces), np.array(pairs, int).reshape(-1, 2))
    pieces = [[] for _ in range(labels.max(initial=-1) + 1)]
    for face, label in zip(bm.faces, labels.tolist()):
        pieces[label].append(face)
    return pieces


def _is_inside(piece: list[bmesh.types.BMFace], interior: OpenInterior) -> bool:
    """Whether a piece is inside the other mesh, at points near the corners of faces spread over its area. A piece that leaves
    through an opening of the other mesh, as an eye through its socket, is not."""
    ends = np.cumsum([face.calc_area() for face in piece])
    samples = np.searchsorted(ends, (np.arange(N_SAMPLED_FACES) + 0.5) / N_SAMPLED_FACES * ends[-1])
    allowed = MAX_OUTSIDE_FRACTION * N_SAMPLED_FACES
    for index, count in zip(*np.unique(samples, return_counts=True)):
        face = piece[index]
        center = face.calc_center_median()
        for vert in face.verts:
            if not interior.contains(vert.co.lerp(center, 0.1), MIN_INSIDE):
                allowed -= count / len(face.verts)
                if allowed < 0:
                    return False
    return True
