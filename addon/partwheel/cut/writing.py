# SPDX-License-Identifier: GPL-3.0-or-later
"""A cut is kept in its mesh and written to whatever is wanted."""

from typing import NamedTuple

from ..mesh import arrays
from ..mesh.datablocks import all_or_nothing
from . import armature, layers, objects, stored, unwrapping

LAYERS = {"FACE_SETS": layers.face_sets, "COLORS": layers.own_materials, "MATERIALS": layers.kept_materials}
TO = "FACE_SETS", "VERTEX_GROUPS", "COLORS", "MATERIALS", "SEAMS", "OBJECTS", "BONES"


class Written(NamedTuple):
    """names: of the parts, in order; objects: those that were made; armature: the object with the bones, or None."""

    names: list
    objects: list
    armature: object


def known_names(obj, cut):
    """{clusters: name} of the parts that are kept in the mesh."""
    kept = stored.found(obj, cut.hierarchy)
    return kept[1] if kept else {}


@all_or_nothing()
def write(obj, cut, to=(), known=None, options=objects.Options(), unwrap=False):
    """Keeps the cut in the object's mesh and writes it: to, some of TO. known: {clusters: name} of parts that have one;
    None: those that are kept in the mesh. options: of objects. unwrap: also by the seams. Nothing has changed where it
    raises an Error. Outside Edit Mode."""
    arrays.up_to_date(obj)
    to = {*to, "VERTEX_GROUPS"} if "BONES" in to else to
    if known is None:
        known = known_names(obj, cut)
    names = stored.names_of(obj, cut, known)
    if "VERTEX_GROUPS" in to:
        layers.check_locks(obj, names)
        weights = layers.weights_of(obj, cut)
    take_back = unwrapping.mark(obj, cut, unwrap) if "SEAMS" in to else lambda: None
    try:
        made = objects.made(obj, cut, names, options) if "OBJECTS" in to else []  # with the new UVs
        rig = armature.made(obj, cut, names, weights) if "BONES" in to else None
    except Exception:
        take_back()
        raise
    stored.keep(obj.data, cut.labels, names)
    if "VERTEX_GROUPS" in to:
        layers.vertex_groups(obj, names, weights)
    for layer, write_layer in LAYERS.items():
        if layer in to:
            write_layer(obj, cut, names)
    obj.data.update()
    return Written(names, made, rig)
