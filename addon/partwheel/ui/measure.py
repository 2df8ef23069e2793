# SPDX-License-Identifier: GPL-3.0-or-later
"""How large a part is, in the scene's units."""

import weakref

import bpy
import numpy as np

_boxes = weakref.WeakKeyDictionary()  # hierarchy -> {node: extent (3,)}, since panels are drawn often


def sides(context, obj, hierarchy, node):
    """The sides of the box about a part, along the object's own axes, as texts; the longest first."""
    known = _boxes.setdefault(hierarchy, {})
    if node not in known:
        corners = hierarchy.vertices[hierarchy.tetrahedra[hierarchy.tet_first[node]:hierarchy.tet_last[node]].ravel()]
        known[node] = np.ptp(corners, axis=0) if len(corners) else np.zeros(3)
    units = context.scene.unit_settings
    lengths = known[node] * np.abs(obj.matrix_world.to_scale()) * units.scale_length
    return [bpy.utils.units.to_string(units.system, "LENGTH", float(length), precision=3).strip()
            for length in sorted(lengths, reverse=True)]
