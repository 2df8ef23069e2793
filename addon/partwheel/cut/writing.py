# SPDX-License-Identifier: GPL-3.0-or-later
"""Saves a cut in its mesh and writes it to layers, objects and bones."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import bpy

from ..mesh import arrays
from ..mesh.datablocks import rollback_on_error
from . import armature, layers, objects, saved_cut, unwrapping
from partwheel.cut import Cut

LAYER_WRITERS = {"FACE_SETS": layers.write_face_sets, "COLORS": layers.write_colored_materials,
                 "MATERIALS": layers.write_material_slots}
TARGETS = "FACE_SETS", "VERTEX_GROUPS", "COLORS", "MATERIALS", "SEAMS", "OBJECTS", "BONES"


class WriteResult(NamedTuple):
    """names: of the parts, in order. objects: new ones. armature: the object with the bones, or None."""

    names: list[str]
    objects: list[bpy.types.Object]
    armature: bpy.types.Object | None


def load_names(obj: bpy.types.Object, cut: Cut) -> dict:
    """{clusters: name} of the parts saved in the mesh."""
    saved = saved_cut.load_cut(obj, cut.hierarchy)
    return saved[1] if saved else {}


@rollback_on_error()
def write(obj: bpy.types.Object, cut: Cut, to: Iterable[str] = (), known: dict | None = None,
          options: objects.ObjectOptions = objects.ObjectOptions(), unwrap: bool = False) -> WriteResult:
    """Saves the cut in the object's mesh and writes it to some of TARGETS. known: {clusters: name} of parts with a
    name; None: those saved in the mesh. options: of objects. unwrap: along the seams. Outside Edit Mode. If it raises
    an Error, nothing has changed."""
    arrays.update_mesh(obj)
    to = {*to, "VERTEX_GROUPS"} if "BONES" in to else to
    if known is None:
        known = load_names(obj, cut)
    names = saved_cut.complete_names(obj, cut, known, "VERTEX_GROUPS" in to)
    if "BONES" in to:
        armature.check_no_rig(obj)
    if "VERTEX_GROUPS" in to:
        layers.check_locks(obj, names)
        weights = layers.compute_weights(obj, cut)
    restore = unwrapping.mark_seams(obj, cut, unwrap) if "SEAMS" in to else lambda: None
    try:
        # After the seams: objects get the new UVs.
        part_objects = objects.create_part_objects(obj, cut, names, options) if "OBJECTS" in to else []
        rig = armature.create_armature(obj, cut, names, weights) if "BONES" in to else None
    except Exception:
        restore()
        raise
    saved_cut.save_cut(obj.data, cut.labels, names)
    if "VERTEX_GROUPS" in to:
        layers.write_vertex_groups(obj, names, weights)
    for layer, write_layer in LAYER_WRITERS.items():
        if layer in to:
            write_layer(obj, cut, names)
    obj.data.update()
    return WriteResult(names, part_objects, rig)
