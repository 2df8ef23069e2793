# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences."""

from types import SimpleNamespace

import bpy

from . import library_error

MARK_ITEMS = [
    ("MATERIALS", "Materials", "Borders of materials"),
    ("COLORS", "Colors", "Borders in the base color images of the materials and in the active color attribute"),
    ("FACE_SETS", "Face Sets", "Borders of face sets, from Sculpt Mode"),
    ("SEAMS", "Seams", "UV seams"),
    ("SHARP", "Sharp Edges", "Edges that are marked as sharp"),
    ("CREASES", "Creases", "Creases for subdivision"),
    ("DRAWN", "Drawn Borders", "Borders drawn with the tool, with Shift Ctrl and the left mouse button")]


class PartwheelPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    save_with_file: bpy.props.BoolProperty(
        name="Save Parts in .blend Files",
        description="Save the parts of meshes with the file, so that they need not be found again. The file "
                    "grows by about 40 bytes per face",
        default=True)
    parts: bpy.props.EnumProperty(
        name="Parts", description="How the next builds merge small parts into larger ones",
        items=[("LEARNED", "As People See Them", "Learned from the parts that people chose on some hundred models: a "
                "click alone finds the intended part more often. Borders follow "
                "creases, and symmetric models get symmetric parts"),
               ("PAPER", "Nearly Convex", "By convexity alone, the most regular and fastest method: a click selects "
                "the smallest part, and each notch of the wheel takes one step")],
        default="LEARNED")
    use_marks: bpy.props.EnumProperty(
        name="Use", description="What you have marked on the mesh that the next builds divide it by. Marks that machines make, "
        "such as an atlas with thousands of islands, are ignored",
        items=MARK_ITEMS, options={"ENUM_FLAG"}, default={"MATERIALS", "COLORS", "DRAWN"})
    hard_marks: bpy.props.EnumProperty(
        name="No Part Crosses", description="Which of the marks in use divide the mesh whatever its shape. The others are hints",
        items=MARK_ITEMS, options={"ENUM_FLAG"}, default={"DRAWN"})
    full_resolution: bpy.props.BoolProperty(
        name="Large Meshes at Full Resolution",
        description="Find the parts of meshes with more than 200,000 triangles at full resolution, not on a coarser "
        "copy. Takes about ten times the time and memory, for mostly the same parts",
        default=False)
    on_import: bpy.props.BoolProperty(
        name="Find on Import", description="Find the parts of imported and appended meshes at once, while you keep "
        "working", default=False)
    memory_share: bpy.props.IntProperty(
        name="Memory", description="Share of the available memory that a build may use (enforced on Linux)", default=80,
        min=10, max=100, subtype="PERCENTAGE")
    cpu_limit: bpy.props.IntProperty(
        name="Time Limit", description="Minutes of processor time after which a build is stopped. 0: two, plus two for "
        "each 60,000 triangles, far more than builds need", default=0, min=0, soft_max=60)
    python: bpy.props.StringProperty(
        name="Python", description="The Python 3 program that runs builds in a separate process. Empty: the one in "
        "Blender, or else an installed one", default="", subtype="FILE_PATH")
    wheel: bpy.props.EnumProperty(
        name="Wheel", description="When the wheel resizes the part, after a click with the tool",
        items=[("NEAR", "At the Click", "While the mouse stays at the click; elsewhere the wheel zooms as usual"),
               ("HELD", "Until Enter", "Wherever the mouse is, until Enter or another key ends it")],
        default="NEAR")
    use_view: bpy.props.BoolProperty(
        name="Zoom Chooses Size", description="The closer you look, the smaller the part that a click selects",
        default=True)
    show_part: bpy.props.BoolProperty(name="Part", description="Tint the picked part", default=True)
    show_next: bpy.props.BoolProperty(
        name="Next Part", description="Tint faintly what the next notch of the wheel adds", default=True)
    show_hull: bpy.props.BoolProperty(
        name="Convex Hull", description="Show the convex hull of the picked part as glass", default=False)
    show_cut: bpy.props.BoolProperty(
        name="All Parts", description="Show all parts of the mesh at the size of the picked part, each in its own "
        "color", default=False)
    show_steps: bpy.props.BoolProperty(
        name="Buttons", description="Show two buttons beside the click, larger and smaller. With a pen they are always "
        "shown", default=False)

    def draw(self, context: bpy.types.Context) -> None:
        library_error.draw_library_error(context, self.layout)
        column = self.layout.column()
        column.use_property_split = True
        draw_build_options(column)
        for name in ("on_import", "save_with_file", "memory_share", "cpu_limit", "python",
                     "wheel", "use_view"):
            column.prop(self, name)
        draw_overlays(column)
        for key in find_keymap_items("wm.call_menu_pie", {"name": PIE})[:1]:  # the pie menu has no key by default
            column.prop(key, "type", text="Pie Menu", full_event=True)


def draw_build_options(column: bpy.types.UILayout) -> None:
    for name in ("parts", "full_resolution"):
        column.prop(preferences(), name)
    column.label(text="Use")
    marks = column.column(align=True)
    marks.use_property_split = False
    for kind, _, _ in MARK_ITEMS:
        row = marks.row(align=True)
        row.prop_enum(preferences(), "use_marks", kind)
        lock = row.row(align=True)
        lock.enabled = kind in preferences().use_marks
        icon = "LOCKED" if kind in preferences().hard_marks else "UNLOCKED"
        lock.prop_enum(preferences(), "hard_marks", kind, text="", icon=icon)


PIE = "VIEW3D_MT_PIE_partwheel"


def find_keymap_items(operator: str, options: dict) -> list[bpy.types.KeyMapItem]:
    """Return the user's KeyMapItems of Edit Mode that start an operator with these options; without a window none."""
    configuration = bpy.context.window_manager.keyconfigs.user
    keymap = configuration and configuration.keymaps.get("Mesh")
    return [item for item in (keymap.keymap_items if keymap else ()) if item.idname == operator
            and all(getattr(item.properties, name) == value for name, value in options.items())]


def draw_overlays(layout: bpy.types.UILayout) -> None:
    column = layout.column(heading="Overlay")
    for name in ("show_part", "show_next", "show_hull", "show_cut", "show_steps"):
        column.prop(preferences(), name)


def preferences() -> PartwheelPreferences | SimpleNamespace:
    """Return the user's preferences, or the defaults if the add-on is not enabled."""
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else Defaults


Defaults = SimpleNamespace(**{name: prop.keywords["default"]
                              for name, prop in PartwheelPreferences.__annotations__.items()})
