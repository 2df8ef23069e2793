# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh's cut as it is kept in the .blend file: the number of its part on each face, an attribute that Blender carries
through edits, and the parts' names. So it can be gone on with, also where the hierarchy was found anew."""

import json

import bmesh
import numpy as np

from ..mesh import arrays
from partwheel.cut import Cut, name_parts

ATTRIBUTE = "partwheel_part"  # of faces, whole numbers
NAMES = "partwheel_parts"  # a property of the mesh: JSON, {number: name}
WORD = "Part"
LONGEST, DIGITS = 63, 10  # bytes of a name in Blender; digits of a part's number


def keep(mesh, labels, names):
    """labels (F,) the part of each face; names: one for each part."""
    arrays.needed_attribute(mesh, ATTRIBUTE, "INT", "FACE").data.foreach_set("value", labels)
    mesh[NAMES] = json.dumps(dict(enumerate(names)))


def found(obj, hierarchy):
    """(the Cut that is kept in the object's mesh, {its clusters: name}), or None. The hierarchy is that of the mesh as
    it is now."""
    mesh = obj.data
    labels = _labels(mesh)
    if labels is None:
        return None
    known = _known_names(mesh.get(NAMES))
    cut, names = Cut.from_labels(hierarchy, labels), {}
    for part, clusters in enumerate(cut.parts):
        values, counts = np.unique(labels[cut.labels == part], return_counts=True)
        if (name := known.get(int(values[counts.argmax()]))) and name not in names.values():
            names[clusters] = name
    return cut, names


def _known_names(kept):
    """{number: name} of what is kept as NAMES, whatever that is: others may have written it. Names that Blender takes."""
    try:
        known = json.loads(kept) if isinstance(kept, str) else None
    except (ValueError, RecursionError):
        known = None
    if not isinstance(known, dict):
        return {}
    return {int(number): name for number, name in known.items()
            if isinstance(name, str) and name and name.isprintable() and len(name.encode()) <= LONGEST
            and number.isdecimal() and len(number) <= DIGITS}


def _labels(mesh):
    """(F,) or None."""
    if mesh.is_editmode:  # Blender shows no attribute's values then
        faces = bmesh.from_edit_mesh(mesh).faces
        layer = faces.layers.int.get(ATTRIBUTE)
        return None if layer is None else np.array([face[layer] for face in faces], np.int32)
    number = arrays.attribute(mesh, ATTRIBUTE, "INT", "FACE")
    return arrays.read(number.data, "value", np.int32) if number else None


def names_of(obj, cut, known):
    """[name, ...] of a cut's parts: those that are known, {clusters: name}, and for the others such as say what is
    alike and what is left and right."""
    names = [known.get(clusters) for clusters in cut.parts]
    if None not in names:
        return names
    surface = arrays.surface(obj.data)
    fresh = name_parts(cut, surface.vertices, surface.triangles, surface.faces, WORD)
    taken = set(filter(None, names))
    for part, name in enumerate(names):
        if name is None:
            number, name = 0, fresh[part]
            while name in taken:
                number += 1
                name = f"{fresh[part]} ({number})"
            names[part] = name
            taken.add(name)
    return names
