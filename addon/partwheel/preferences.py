# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences."""

import bpy


class PartwheelPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    save_with_file: bpy.props.BoolProperty(
        name="Save Parts in .blend Files",
        description="Parts that were built are there again when the file is opened. It grows by about 65 bytes a face",
        default=True,
    )
    memory_share: bpy.props.IntProperty(
        name="Memory", description="How much of the available memory a build may use (kept on Linux)",
        default=80, min=10, max=100, subtype="PERCENTAGE",
    )
    time_limit: bpy.props.IntProperty(
        name="Time Limit", description="Minutes after which a build is stopped; 0: two, and two more for each 60,000 "
                                       "triangles, far more than builds take",
        default=0, min=0, soft_max=60,
    )

    def draw(self, _context):
        column = self.layout.column()
        column.use_property_split = True
        for name in ("save_with_file", "memory_share", "time_limit"):
            column.prop(self, name)


def preferences():
    """The user's preferences, or the defaults when the add-on runs without being enabled."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else Defaults


class Defaults:
    save_with_file, memory_share, time_limit = True, 80, 0


def register():
    bpy.utils.register_class(PartwheelPreferences)


def unregister():
    bpy.utils.unregister_class(PartwheelPreferences)
