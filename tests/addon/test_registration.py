# SPDX-License-Identifier: GPL-3.0-or-later
"""Enabling and disabling the add-on leaves nothing behind, as often as one likes."""

import gc
import importlib.util
import inspect
import io
import os
import subprocess
import sys
import tempfile
import time
import types
import unittest
import zipfile

import bpy
import common
from common import MeshTest, package, part, read_off
from run import installed


def keymap_items():
    configurations = bpy.context.window_manager.keyconfigs
    return sorted((configuration.name, keymap.name, item.idname, item.type, item.ctrl, item.shift, item.alt)
                  for configuration in (configurations.addon, configurations.user) if configuration
                  for keymap in configuration.keymaps for item in keymap.keymap_items)


def keymap_data(name):
    """The module that one of Blender's own keymaps is made by."""
    path = next(path for path in (os.path.join(root, "presets", "keyconfig", "keymap_data", f"{name}.py")
                                  for root in bpy.utils.script_paths()) if os.path.exists(path))
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def handlers():
    return {name: list(functions) for name, functions in inspect.getmembers(bpy.app.handlers)
            if isinstance(functions, list)}


def menu_entries():
    entries = {}
    for name in dir(bpy.types):
        draw = getattr(getattr(bpy.types, name, None), "draw", None)
        functions = getattr(draw, "_draw_funcs", None)
        if functions:
            entries[name] = [function for function in functions if function.__module__.startswith(common.MODULE)]
    return {name: functions for name, functions in entries.items() if functions}


def timers():
    """Wherever they were made: also those that only Blender holds. (isinstance() would ask an operator of a class that is
    unregistered by now for its own, which raises an error.)"""
    return [obj for obj in gc.get_objects() if type(obj) is types.FunctionType
            and (obj.__module__ or "").startswith(common.MODULE) and bpy.app.timers.is_registered(obj)]


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


def add_updated(old, new):
    """Writes the files of a zip, or of the wheel in it, into another: some say so, and a wheel has another version."""
    for name in old.namelist():
        data = old.read(name)
        if name.endswith(".whl"):
            wheel = io.BytesIO()
            with zipfile.ZipFile(io.BytesIO(data)) as old_wheel, zipfile.ZipFile(wheel, "w") as new_wheel:
                add_updated(old_wheel, new_wheel)
            data = wheel.getvalue()
        elif name.endswith(("parts/registry.py", "partwheel/hierarchy.py", "pick/build.py")):
            data += b"\nUPDATED = True\n"
        elif ".dist-info/" in name:
            data = data.replace(b"0.1.0", b"0.1.1")
        data = data.replace(b"partwheel-0.1.0-py3", b"partwheel-0.1.1-py3") if name.endswith(".toml") else data
        new.writestr(name.replace("partwheel-0.1.0", "partwheel-0.1.1"), data)


class Registration(unittest.TestCase):
    def tearDown(self):
        bpy.ops.preferences.addon_enable(module=common.MODULE)

    def test_the_addon_registers_three_times(self):
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

    def test_an_update_is_used_at_once(self):
        """Installed over the enabled add-on: all its files are the new ones, also deep ones, without a restart; and the
        library in use is not written over, or the next call into it would end Blender."""
        names = [f"{common.MODULE}.parts.registry", "partwheel.hierarchy", f"{common.MODULE}.pick.build"]
        before = everything()
        with tempfile.TemporaryDirectory() as directory:
            update = os.path.join(directory, os.path.basename(common.ZIP))
            with zipfile.ZipFile(common.ZIP) as old, zipfile.ZipFile(update, "w") as new:
                add_updated(old, new)
            for path, updated in ((update, True), (common.ZIP, False)):
                first = sys.modules[common.MODULE].__file__
                installed_at = os.path.getmtime(first)
                common.until(lambda: time.time() > installed_at + 0.1)  # or Blender takes the file for the same
                with open(package("library").LIBRARY, "rb") as in_use:
                    installed(path)
                    self.assertEqual(os.fstat(in_use.fileno()).st_nlink, 0, "removed, not written over")
                for name in names:
                    module = importlib.import_module(name)
                    self.assertEqual(hasattr(module, "UPDATED"), updated, name)
                self.assertEqual(hasattr(sys.modules[f"{common.MODULE}.parts.registry"], "UPDATED"), updated)
                self.assertIs(bpy.types.MESH_OT_partwheel_build, getattr(
                    importlib.import_module(names[2]), "MESH_OT_partwheel_build"))
                after = everything()
                self.assertEqual((after[0], after[1], after[2], after[7]), (before[0], before[1], before[2], before[7]))
                self.assertEqual({name: len(functions) for name, functions in after[3].items()},
                                 {name: len(functions) for name, functions in before[3].items()})
                self.assertEqual({name: len(functions) for name, functions in after[4].items()},
                                 {name: len(functions) for name, functions in before[4].items()})

    def test_the_shortcuts_are_there_and_were_free(self):
        """In all keymaps that come with Blender: the default, for either mouse button; that of Blender 2.7; and the
        industry compatible one. Also the key that snaps the border of the part that is held."""
        ours = {item[3:] for item in keymap_items() if item[:2] == ("Blender addon", "Mesh")}
        self.assertEqual({item for item in ours if item[0] == "NONE"}, {("NONE", False, False, False)})  # the pie's
        ours = {item for item in ours if item[0] != "NONE"}
        self.assertEqual({key for key, *_ in ours}, {"W", *(command.key for command in part("view.keys").COMMANDS)})
        snaps, = part("view.keys").SNAP_BORDER.events
        ours = [(key, [*map(bool, modifiers), False]) for key, *modifiers in (*ours, (snaps, True, True, False))]
        default, industry = map(keymap_data, ("blender_default", "industry_compatible_data"))
        keymaps = {f"default, {mouse}, legacy {legacy}": default.generate_keymaps(
                       default.Params(select_mouse=mouse, legacy=legacy))
                   for mouse in ("LEFT", "RIGHT") for legacy in (False, True)}
        keymaps["industry compatible"] = industry.generate_keymaps(industry.Params())
        names = {"Mesh", "3D View", "3D View Generic", "Window", "Screen", "Screen Editing", "Object Non-modal",
                 "User Interface", "Frames"}
        for title, content in keymaps.items():
            with self.subTest(title):
                self.assertTrue(names - {"Object Non-modal"} <= {name for name, _, _ in content})
                taken = [(name, item[0]) for name, _, values in content
                         if name in names or name.startswith("3D View Tool") for item in values["items"]
                         for key, pressed in ours
                         if item[1]["type"] == key and (item[1].get("any") or pressed == [
                             bool(item[1].get(modifier)) for modifier in ("ctrl", "shift", "alt", "oskey")])]
                # Over a button of the interface, where no part is held, C copies the data path.
                self.assertEqual(set(taken) - {("User Interface", "ui.copy_data_path_button")}, set())

    def test_blender_starts_without_a_window(self):
        """With the add-on enabled: there are no keymaps yet then. bpy as a Python module has no start of its own."""
        if not bpy.app.binary_path:
            return
        bpy.ops.wm.save_userpref()
        run = subprocess.run([bpy.app.binary_path, "-b", "--python-expr",
                              "import bpy; print('there:', hasattr(bpy.types, 'VIEW3D_PT_partwheel'))"],
                             capture_output=True, text=True, check=True)
        self.assertIn("there: True", run.stdout)
        self.assertNotIn("Traceback", run.stdout + run.stderr)


class Timers(MeshTest):
    def tearDown(self):
        bpy.ops.preferences.addon_enable(module=common.MODULE)

    def test_disabling_the_addon_stops_its_timer(self):
        """What waits for the end of Blender's proportional tool, to put the user's reach back, waits once, and does so
        at once where the add-on is disabled meanwhile."""
        obj = self.add(*read_off("hand"))
        self.edit(obj)
        bpy.ops.mesh.partwheel_select(face_index=700)
        settings = bpy.context.tool_settings
        settings.proportional_size = users = 0.625
        for _ in range(2):
            part("deform.proportional").MESH_OT_partwheel_move.invoke(None, bpy.context, None)
            self.assertEqual(len(timers()), 1)
            settings.proportional_size = 3  # as Blender's tool does in a window when it ends
        bpy.ops.preferences.addon_disable(module=common.MODULE)
        self.assertEqual(timers(), [])
        self.assertEqual(settings.proportional_size, users)
