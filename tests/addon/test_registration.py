# SPDX-License-Identifier: GPL-3.0-or-later
"""Enabling and disabling the add-on leaves nothing behind, as often as one likes."""

import importlib.util
import inspect
import os
import sys
import tempfile
import time
import unittest
import zipfile

import bpy
import common
from run import installed


def keymap_items():
    configurations = bpy.context.window_manager.keyconfigs
    return sorted((configuration.name, keymap.name, item.idname, item.type, item.ctrl, item.shift, item.alt)
                  for configuration in (configurations.addon, configurations.user) if configuration
                  for keymap in configuration.keymaps for item in keymap.keymap_items)


def handlers():
    return {name: list(functions) for name, functions in inspect.getmembers(bpy.app.handlers)
            if isinstance(functions, list)}


def menu_entries():
    found = {}
    for name in dir(bpy.types):
        draw = getattr(getattr(bpy.types, name, None), "draw", None)
        functions = getattr(draw, "_draw_funcs", None)
        if functions:
            found[name] = [function for function in functions if function.__module__.startswith(common.MODULE)]
    return {name: functions for name, functions in found.items() if functions}


def timers():
    return [function for name, module in list(sys.modules.items()) if name.startswith(common.MODULE)
            for function in vars(module).values() if inspect.isfunction(function)
            and bpy.app.timers.is_registered(function)]


def properties():
    return {owner: sorted(getattr(bpy.types, owner).bl_rna.properties.keys())
            for owner in ("Scene", "Object", "Mesh", "WindowManager", "Screen")}


def tools():
    import bl_ui.space_toolsystem_toolbar as toolbar

    return {mode: [tool.idname for tool in toolbar.VIEW3D_PT_tools_active._tools_flatten(tools) if tool]
            for mode, tools in toolbar.VIEW3D_PT_tools_active._tools.items() if mode}


def everything():
    operators = [name for name in dir(bpy.ops.mesh) if name.startswith("partwheel")]
    return dir(bpy.types), operators, keymap_items(), handlers(), menu_entries(), timers(), properties(), tools()


class Registration(unittest.TestCase):
    def tearDown(self):
        bpy.ops.preferences.addon_enable(module=common.MODULE)

    def test_three_times_by_blender(self):
        bpy.ops.preferences.addon_disable(module=common.MODULE)
        off = everything()
        self.assertEqual((off[1], off[4], off[5]), ([], {}, []))
        for _ in range(3):
            bpy.ops.preferences.addon_enable(module=common.MODULE)
            on = everything()
            self.assertLessEqual({"partwheel_build", "partwheel_clear", "partwheel_copy", "partwheel_deform",
                                  "partwheel_remove", "partwheel_select", "partwheel_split"}, set(on[1]))
            self.assertLessEqual({"VIEW3D_MT_edit_mesh", "VIEW3D_MT_object"}, set(on[4]))
            self.assertLessEqual({"VIEW3D_MT_select_edit_mesh", "VIEW3D_MT_select_object", "VIEW3D_MT_face_sets",
                                  "VIEW3D_MT_mask", "VIEW3D_MT_paint_weight", "VIEW3D_MT_paint_vertex"}, set(on[4]))
            self.assertEqual(on[7]["EDIT_MESH"].count("partwheel.select"), 1)
            self.assertEqual(len(on[3]["load_post"]), len(off[3]["load_post"]) + 3)
            bpy.ops.preferences.addon_disable(module=common.MODULE)
            self.assertEqual(everything(), off)

    def test_three_times_by_hand(self):
        package = sys.modules[common.MODULE]
        package.unregister()
        off = everything()
        for _ in range(3):
            package.register()
            self.assertNotEqual(everything(), off)
            package.unregister()
            self.assertEqual(everything(), off)
        package.register()

    def test_an_update_is_used_at_once(self):
        """Installed over the enabled add-on: all its files are the new ones, also deep ones, without a restart; and the
        library in use is not written over, or the next call into it would end Blender."""
        files = ("partwheel/session.py", "partwheel/core/hierarchy.py", "partwheel/operators/build.py")
        names = [name[:-len(".py")].replace("/", ".").replace("partwheel", common.MODULE, 1) for name in files]
        before = everything()
        with tempfile.TemporaryDirectory() as directory:
            update = os.path.join(directory, os.path.basename(common.ZIP))
            with zipfile.ZipFile(common.ZIP) as old, zipfile.ZipFile(update, "w") as new:
                for name in old.namelist():
                    new.writestr(name, old.read(name) + (b"\nUPDATED = True\n" if name in files else b""))
            for path, updated in ((update, True), (common.ZIP, False)):
                first = sys.modules[common.MODULE].__file__
                installed_at = os.path.getmtime(first)
                common.until(lambda: time.time() > installed_at + 0.1)  # or Blender takes the file for the same
                with open(os.path.join(os.path.dirname(first), "core", "libpartwheel.so"), "rb") as in_use:
                    installed(path)
                    self.assertEqual(os.fstat(in_use.fileno()).st_nlink, 0, "removed, not written over")
                for name in names:
                    module = importlib.import_module(name)
                    self.assertEqual(hasattr(module, "UPDATED"), updated, name)
                self.assertEqual(hasattr(sys.modules[common.MODULE].session, "UPDATED"), updated)
                self.assertIs(bpy.types.MESH_OT_partwheel_build, getattr(
                    importlib.import_module(names[2]), "MESH_OT_partwheel_build"))
                after = everything()
                self.assertEqual((after[0], after[1], after[2], after[7]), (before[0], before[1], before[2], before[7]))
                self.assertEqual({name: len(functions) for name, functions in after[3].items()},
                                 {name: len(functions) for name, functions in before[3].items()})
                self.assertEqual({name: len(functions) for name, functions in after[4].items()},
                                 {name: len(functions) for name, functions in before[4].items()})

    def test_the_shortcut_is_there_and_was_free(self):
        ours = [item for item in keymap_items() if item[2] == "mesh.partwheel_select"]
        self.assertIn(("Blender addon", "Mesh", "mesh.partwheel_select", "W", 1, 0, 0),
                      [tuple(value if isinstance(value, str) else int(value) for value in item) for item in ours])
        path = next(path for path in (os.path.join(root, "presets", "keyconfig", "keymap_data", "blender_default.py")
                                      for root in bpy.utils.script_paths()) if os.path.exists(path))
        spec = importlib.util.spec_from_file_location("blender_default_keys", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        keymaps = [keymap for mouse in ("LEFT", "RIGHT") for keymap in module.generate_keymaps(
            module.Params(select_mouse=mouse))]
        names = {"Mesh", "3D View", "3D View Generic", "Window", "Screen", "Screen Editing", "Object Non-modal",
                 "User Interface", "Frames"}
        self.assertTrue(names <= {name for name, _, _ in keymaps})
        taken = [name for name, _, content in keymaps if name in names or name.startswith("3D View Tool")
                 for item in content["items"]
                 if item[1]["type"] == "W" and item[1].get("ctrl") and not item[1].get("shift") and not
                 item[1].get("alt")]
        self.assertEqual(taken, [])

    def test_operators_undo_and_panel(self):
        self.assertEqual(bpy.types.MESH_OT_partwheel_select.bl_options, {"REGISTER", "UNDO"})
        self.assertEqual(bpy.types.VIEW3D_PT_partwheel.bl_category, "Partwheel")

    def test_texts_follow_blenders_conventions(self):
        """As Blender's extractor of UI messages wants them: no period at the end, no spaces around, a capital first."""
        texts = {}
        for name in dir(bpy.types):
            cls = getattr(bpy.types, name)
            if "partwheel" not in name.lower() or not hasattr(cls, "bl_rna"):
                continue
            texts[name] = cls.bl_rna.name
            if issubclass(cls, (bpy.types.Operator, bpy.types.AddonPreferences)):
                if issubclass(cls, bpy.types.Operator):
                    space, _, operator = name.lower().partition("_ot_")
                    texts[f"{name} tooltip"] = getattr(getattr(bpy.ops, space), operator).get_rna_type().description
                for prop in cls.bl_rna.properties:
                    if prop.identifier in getattr(cls, "__annotations__", {}) or (
                            prop.identifier in {"face_index", "level", "extend", "deselect", "tool"}):
                        texts[f"{name}.{prop.identifier}"], texts[f"{name}.{prop.identifier} tooltip"] = (
                            prop.name, prop.description)
        self.assertGreater(len(texts), 20)
        for where, text in texts.items():
            with self.subTest(where):
                self.assertTrue(text, "there is none")
                self.assertEqual(text, text.strip())
                self.assertFalse(text.endswith("."), text)
                self.assertFalse(text[0].islower(), text)
                self.assertNotIn("  ", text)
