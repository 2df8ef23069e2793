# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh's cut as saved in the .blend file: the number of its part on each face, as an attribute that Blender
preserves through edits, the parts' names, and whether somebody chose their borders. It can be loaded even after the
hierarchy was rebuilt."""

import json

import bpy

from ..mesh import Labels, arrays, parse_json
from . import existing_names, labeled_cut, layers
from partwheel import Hierarchy
from partwheel.cut import Cut, name_parts

ATTRIBUTE = "partwheel_part"  # face attribute: number of the part
NAMES_PROPERTY = "partwheel_parts"  # mesh property: JSON, {number: name}
KEEPS_BORDERS_PROPERTY = "partwheel_keeps_borders"  # mesh property: 1, if Cut.keeps_borders
NAME_PREFIX = "Part"
MAX_GROUP_NAME_BYTES = 63  # of vertex groups and bones in Blender
MAX_DIGITS = 10  # of a part's number


def save_cut(mesh: bpy.types.Mesh, cut: Cut, names: list[str]) -> None:
    """Saves a cut of the mesh, and the parts' names."""
    arrays.ensure_attribute(mesh, ATTRIBUTE, "INT", "FACE").data.foreach_set("value", cut.labels)
    mesh[NAMES_PROPERTY] = json.dumps(dict(enumerate(names)))
    mesh[KEEPS_BORDERS_PROPERTY] = int(cut.keeps_borders)


def load_cut(obj: bpy.types.Object, hierarchy: Hierarchy) -> tuple[Cut, dict] | None:
    """(the Cut saved in the object's mesh, {clusters: name}), or None. hierarchy: of the current mesh."""
    labels = _read_labels(obj.data)
    return labels and labeled_cut.find_cut(hierarchy, labels, _keeps_borders(obj.data))


def read_chosen_labels(mesh: bpy.types.Mesh) -> Labels | None:
    """The saved parts, if somebody chose their borders: a hierarchy must have them. None: any hierarchy will do."""
    return _read_labels(mesh) if _keeps_borders(mesh) else None


def _read_labels(mesh: bpy.types.Mesh) -> Labels | None:
    labels = arrays.read_face_integers(mesh, ATTRIBUTE)
    return None if labels is None else Labels(labels, _parse_names(mesh.get(NAMES_PROPERTY)))


def _keeps_borders(mesh: bpy.types.Mesh) -> bool:
    """Anything but what save_cut() wrote, by others or an earlier version, counts as False."""
    return mesh.get(KEEPS_BORDERS_PROPERTY) == 1


def _parse_names(text: object) -> dict[int, str]:
    """{number: name} of the saved property, if Blender accepts the name; others may have written anything."""
    parsed = parse_json(text)
    if not isinstance(parsed, dict):
        return {}
    return {int(number): name for number, name in parsed.items()
            if isinstance(name, str) and name and name.isprintable() and len(name.encode()) <= MAX_GROUP_NAME_BYTES
            and number.isdecimal() and len(number) <= MAX_DIGITS}


def complete_names(obj: bpy.types.Object, cut: Cut, known: dict, for_groups: bool = False) -> list[str]:
    """The names of a cut's parts: the known ones, {clusters: name}, and for the others those of the bone, material or
    vertex group that they have, or generated ones; they show which parts are alike, left or right. for_groups: no
    name may be that of a vertex group of the user's."""
    taken = {group.name for group in obj.vertex_groups} - layers.own_groups(obj) if for_groups else set()
    names = [known.get(clusters) for clusters in cut.parts]
    names = [None if name in taken else name for name in names]
    if None not in names:
        return names
    surface = arrays.read_surface(obj.data)
    generated = name_parts(cut, surface.vertices, surface.triangles, surface.faces, NAME_PREFIX,
                           existing_names.find_names(obj, cut))
    used_names = {*filter(None, names), *taken}
    for part, name in enumerate(names):
        if name is None:
            number, name = 0, generated[part]
            while name in used_names:
                number += 1
                name = f"{generated[part]} ({number})"
            names[part] = name
            used_names.add(name)
    return names
