# SPDX-License-Identifier: GPL-3.0-or-later
"""The size of a part, in the scene's units."""

from __future__ import annotations

import weakref

import bpy
import numpy as np

from partwheel import Hierarchy

_boxes = weakref.WeakKeyDictionary()  # hierarchy -> {node: extent (3,)}: panels are drawn often


def format_box_sides(context: bpy.types.Context, obj: bpy.types.Object, hierarchy: Hierarchy, node: int) -> list[str]:
    """The sides of the part's bounding box, along the object's own axes, as texts; the longest first."""
    boxes = _boxes.setdefault(hierarchy, {})
    if node not in boxes:
        corners = hierarchy.vertices[hierarchy.tetrahedra[slice(*hierarchy.tet_slice(node))].ravel()]
        boxes[node] = np.ptp(corners, axis=0) if len(corners) else np.zeros(3)
    units = context.scene.unit_settings
    lengths = boxes[node] * np.abs(obj.matrix_world.to_scale()) * units.scale_length
    return [bpy.utils.units.to_string(units.system, "LENGTH", float(length), precision=3).strip()
            for length in sorted(lengths, reverse=True)]
