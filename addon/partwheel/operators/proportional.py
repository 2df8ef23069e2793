# SPDX-License-Identifier: GPL-3.0-or-later
"""A picked part moved, turned or scaled proportionally: by Blender's own tools, or within the part alone by ours.

Blender's tools are told to be proportional by the call, so the user's own settings stay. The reach is the user's: given
by the call, Blender would keep it as the new setting.
"""

import bpy

TRANSFORMS = {"G": ("translate", "Move"), "R": ("rotate", "Rotate"), "S": ("resize", "Scale")}


def around(key):
    """start(context) of Blender's own proportional tool: the part moves as one, its surroundings follow."""
    def start(_context):
        getattr(bpy.ops.transform, TRANSFORMS[key][0])("INVOKE_DEFAULT", use_proportional_edit=True,
                                                       use_proportional_connected=True)
    return start


def within(key):
    """start(context) of ours: the part follows less and less towards its border, and nothing beyond it moves."""
    def start(_context):
        bpy.ops.mesh.partwheel_deform("INVOKE_DEFAULT", True, method="PROPORTIONAL", start=key)
    return start
