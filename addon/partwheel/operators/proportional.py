# SPDX-License-Identifier: GPL-3.0-or-later
"""A picked part moved, turned or scaled proportionally: by Blender's own tools, or within the part alone by ours.

Blender's tools get all they need as arguments of the call, so the user's own settings of proportional editing stay.
"""

import bpy
import numpy as np

from .. import session
from ..deforming import coordinates

TRANSFORMS = {"G": ("translate", "Move"), "R": ("rotate", "Rotate"), "S": ("resize", "Scale")}


def reach(obj):
    """How far around the picked part its surroundings follow: half the side of a square of the part's area, in the
    world's unit."""
    picked = session.picked(obj)
    points = coordinates(obj) @ np.array(obj.matrix_world.to_3x3(), np.float32).T
    total = 0.0
    for face in picked.hierarchy.faces(picked.node).tolist():
        corners = points[list(obj.data.polygons[face].vertices)]
        total += np.linalg.norm(np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)) / 2
    return total ** 0.5 / 2


def around(key):
    """start(context) of Blender's own proportional tool: the part moves as one, its surroundings follow."""
    def start(context):
        size = reach(context.edit_object)
        getattr(bpy.ops.transform, TRANSFORMS[key][0])(
            "INVOKE_DEFAULT", use_proportional_edit=True, use_proportional_connected=True,
            **({"proportional_size": size} if size > 0 else {}))
    return start


def within(key):
    """start(context) of ours: the part follows less and less towards its border, and nothing beyond it moves."""
    def start(_context):
        bpy.ops.mesh.partwheel_deform("INVOKE_DEFAULT", True, method="PROPORTIONAL", start=key)
    return start
