# SPDX-License-Identifier: GPL-3.0-or-later
"""Saves a cut in its mesh and writes it to layers, objects and bones."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import bpy
import numpy as np

from ..mesh import Computation, Steps, arrays, rollback_on_error
from ..mesh.datablocks import redirect_drivers
from ..parts import own_parts as stored_parts, registry
from . import armature, layers, objects, saved_cut, unwrapping
from partwheel import Hierarchy, likeness
from partwheel.cut import Bone, Cut, VertexWeights, skin_weights

LAYER_WRITERS = {"FACE_SETS": layers.write_face_sets, "COLORS": layers.write_colored_materials,
                 "MATERIALS": layers.write_material_slots}
MAX_CLICKS = 64  # faces of a part at which the wheel is looked up
TARGETS = "FACE_SETS", "VERTEX_GROUPS", "COLORS", "MATERIALS", "SEAMS", "OBJECTS", "BONES"


class WriteResult(NamedTuple):
    """names: of the parts, in order. objects: the new objects. armature: the object with the bones, or None."""

    names: list[str]
    objects: list[bpy.types.Object]
    armature: bpy.types.Object | None


def load_names(obj: bpy.types.Object, cut: Cut) -> dict:
    """{clusters: name} of the parts saved in the mesh."""
    saved = saved_cut.load_cut(obj, cut.hierarchy)
    return saved[1] if saved else {}


class WritePlan(NamedTuple):
    """What plan_write() has computed; None for what is not written. to: some of TARGETS. weights: of each part."""

    to: set[str]
    names: list[str]
    weights: list[VertexWeights] | None
    bones: list[Bone] | None
    seams: unwrapping.SeamPlan | None
    own_parts: tuple[list[np.ndarray], Hierarchy] | None  # masks (F,), and the hierarchy with all of them


def plan_write(obj: bpy.types.Object, cut: Cut, to: Iterable[str], known: dict, unwrap: bool,
               own_parts: Sequence[int] = ()) -> Steps:
    """Steps that return the WritePlan. They change nothing. known: {clusters: name} of parts with a name. unwrap: along the
    seams. own_parts: parts made by hand, which become wheel stops, with their mirror images and similar parts. Raises an
    Error."""
    to = {*to, "VERTEX_GROUPS"} if "BONES" in to else {*to}
    surface = arrays.read_surface(arrays.update_mesh(obj))
    names = saved_cut.complete_names(obj, cut, known, "VERTEX_GROUPS" in to)
    weights = bones = seams = own = None
    if "BONES" in to:
        armature.check_no_rig(obj)
    if "VERTEX_GROUPS" in to:
        layers.check_locks(obj, names)
        weights = yield Computation(skin_weights, surface.vertices, surface.triangles, cut.labels[surface.faces],
                                    len(cut))
    if "BONES" in to:
        bones = yield Computation(armature.compute_bones, surface, cut, weights)
    if "SEAMS" in to:
        seams = yield from unwrapping.plan_seams(obj, cut, unwrap)
    if new_parts := [cut.labels == part for part in own_parts if not is_wheel_stop(cut, part)]:
        hierarchy = registry.find_entry(obj.data).built
        masks = yield Computation(likeness.extend_own_parts, hierarchy, *surface[:3], stored_parts.load(obj.data), new_parts)
        own = masks, (yield Computation(likeness.with_own_parts, hierarchy, masks))
    return WritePlan(to, names, weights, bones, seams, own)


def is_wheel_stop(cut: Cut, part: int) -> bool:
    """Whether the wheel stops at a part of a cut after a click on any of its faces; at most MAX_CLICKS are checked."""
    hierarchy, node, faces = cut.hierarchy, cut.node(part), cut.faces(part)
    clicked = faces[np.unique(hierarchy.leaf[faces], return_index=True)[1]]  # one face of each leaf: others have the same wheel
    clicked = clicked[::len(clicked) // MAX_CLICKS + 1]
    return node is not None and all(node in hierarchy.wheel(face)[0] for face in clicked)


@rollback_on_error()
def write(obj: bpy.types.Object, cut: Cut, plan: WritePlan,
          options: objects.ObjectOptions = objects.ObjectOptions()) -> WriteResult:
    """Saves the cut in the object's mesh and writes what was planned. options: of objects. Outside Edit Mode. If it
    raises an Error, nothing has changed."""
    arrays.update_mesh(obj)
    to, names = plan.to, plan.names
    part_objects = _create_objects(obj, cut, plan, options) if "OBJECTS" in to else []
    rig = armature.create_armature(obj, names, plan.bones, part_objects) if plan.bones else None
    saved_cut.save_cut(obj.data, cut, names)
    if plan.seams:
        unwrapping.write_seams(obj.data, plan.seams)
    if plan.own_parts is not None:
        registry.save_own_parts(obj.data, *plan.own_parts)
    if "VERTEX_GROUPS" in to:
        layers.write_vertex_groups(obj, names, plan.weights)
    for layer, write_layer in LAYER_WRITERS.items():
        if layer in to:
            write_layer(obj, cut, names)
    obj.data.update()
    return WriteResult(names, part_objects, rig)


def _create_objects(obj: bpy.types.Object, cut: Cut, plan: WritePlan, options: objects.ObjectOptions) -> list[bpy.types.Object]:
    """create_part_objects() with the seams, UVs and vertex groups of the plan; with bones as siblings that an armature can
    move. They are written to a copy of the mesh, so that nothing has changed if this fails."""
    if not (plan.seams or plan.bones):
        return objects.create_part_objects(obj, cut, plan.names, options)
    mesh = obj.data
    obj.data = mesh.copy()
    try:
        if plan.seams:
            unwrapping.write_seams(obj.data, plan.seams)
        if plan.bones:
            layers.write_vertex_groups(obj, plan.names, plan.weights)
        new_objects = objects.create_part_objects(obj, cut, plan.names, options._replace(tree=options.tree and not plan.bones))
        for new in new_objects:
            for block in filter(None, (new, new.data, new.data.shape_keys)):
                redirect_drivers(block, {mesh: new.data, mesh.shape_keys: new.data.shape_keys})
        return new_objects
    finally:
        copy, obj.data = obj.data, mesh
        bpy.data.batch_remove([copy, *filter(None, [copy.shape_keys])])
