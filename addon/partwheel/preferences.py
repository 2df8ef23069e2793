# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences."""

from types import SimpleNamespace

import bpy

from . import library_error


class PartwheelPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    save_with_file: bpy.props.BoolProperty(
        name="Save Parts in .blend Files",
        description="Parts that were built are there again when the file is opened. It grows by about 40 bytes a face",
        default=True)
    parts: bpy.props.EnumProperty(
        name="Parts", description="How small parts are joined to larger ones in builds from now on",
        items=[("REGROUPED", "As People See Them", "By what people took for parts on some hundred models: a click alone "
                "finds the part that was meant more often. Borders lie in creases, and the two sides of a model that is "
                "its own mirror image are alike"),
               ("PAPER", "Nearly Convex", "By convexity alone, the most regular and the quickest: a click takes the "
                "smallest piece there is, and each notch of the wheel takes one more step")],
        default="REGROUPED",
    )
    exactly: bpy.props.BoolProperty(
        name="Large Meshes Exactly", description="Find the parts of meshes of more than 200,000 triangles on all of "
        "these, not on a coarser copy: some ten times the time and memory for parts that are mostly the same",
        default=False)
    on_import: bpy.props.BoolProperty(
        name="Find on Import", description="The parts of what is imported or appended are found at once, beside your own "
        "work", default=False)
    memory_share: bpy.props.IntProperty(
        name="Memory", description="How much of the available memory a build may use (kept on Linux)", default=80,
        min=10, max=100, subtype="PERCENTAGE")
    cpu_limit: bpy.props.IntProperty(
        name="Time Limit", description="Minutes of processor time after which a build is stopped; 0: two, and two more "
        "for each 60,000 triangles, far more than builds take", default=0, min=0, soft_max=60)
    python: bpy.props.StringProperty(
        name="Python", description="The program that parts are found with, a Python 3, in a process of its own; empty: "
        "the one that Blender brings, or else one that is installed", default="", subtype="FILE_PATH")
    wheel: bpy.props.EnumProperty(
        name="Wheel", description="When the wheel makes the part larger and smaller, after a click with the tool",
        items=[("NEAR", "At the Click", "While the mouse is where it clicked; anywhere else it zooms as ever"),
               ("HELD", "Until Enter", "Wherever the mouse is, until Enter or another key ends it")],
        default="NEAR")
    show_part: bpy.props.BoolProperty(name="Part", description="Tint the part that is held", default=True)
    show_next: bpy.props.BoolProperty(
        name="Next Part", description="Tint faintly what the next notch of the wheel adds", default=True)
    show_hull: bpy.props.BoolProperty(
        name="Convex Hull", description="Show the convex hull of the part that is held as glass", default=False)
    show_cut: bpy.props.BoolProperty(
        name="All Parts", description="Show the parts of the whole mesh at the size of the part that is held, each in "
        "a colour of its own", default=False)
    show_steps: bpy.props.BoolProperty(
        name="Buttons", description="Show two buttons beside the click, larger and smaller. With a pen they are always "
        "there", default=False)

    def draw(self, context: bpy.types.Context) -> None:
        library_error.draw_library_error(context, self.layout)
        column = self.layout.column()
        column.use_property_split = True
        for name in ("parts", "exactly", "on_import", "save_with_file", "memory_share", "cpu_limit", "python", "wheel"):
            column.prop(self, name)
        draw_overlays(column)
        key = find_pie_key()
        if key:
            column.prop(key, "type", text="Pie Menu", full_event=True)


PIE = "VIEW3D_MT_PIE_partwheel"


def find_pie_key() -> bpy.types.KeyMapItem | None:
    """Return the user's KeyMapItem for the pie menu, which has no key by default; None without a window."""
    configuration = bpy.context.window_manager.keyconfigs.user
    keymap = configuration and configuration.keymaps.get("Mesh")
    return next((item for item in (keymap.keymap_items if keymap else ()) if item.idname == "wm.call_menu_pie"
                 and item.properties.name == PIE), None)


OVERLAY_SETTINGS = ("show_part", "show_next", "show_hull", "show_cut", "show_steps")


def draw_overlays(layout: bpy.types.UILayout) -> None:
    """Draw the settings of the overlay."""
    column = layout.column(heading="Overlay")
    for name in OVERLAY_SETTINGS:
        column.prop(preferences(), name)


def preferences() -> PartwheelPreferences | SimpleNamespace:
    """Return the user's preferences, or the defaults if the add-on is not enabled."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else Defaults


Defaults = SimpleNamespace(**{name: prop.keywords["default"]
                              for name, prop in PartwheelPreferences.__annotations__.items()})


CLASSES = (PartwheelPreferences,)
