"""Runs in `blender -b`: installs the add-on from the zip as a user would, and sets the preferences that tests need.

    blender -b --python-exit-code 9 --python install.py -- ZIP
"""
import sys

import bpy

zip_path = sys.argv[sys.argv.index("--") + 1]
if bpy.app.version >= (4, 2):
    bpy.ops.extensions.package_install_files(filepath=zip_path, repo="user_default", enable_on_install=True)
else:
    bpy.ops.preferences.addon_install(filepath=zip_path)
    bpy.ops.preferences.addon_enable(module="partwheel_addon")

preferences = bpy.context.preferences
if not any(addon.module.split(".")[-1].startswith("partwheel") for addon in preferences.addons):
    sys.exit("The add-on is not enabled after its installation.")
preferences.view.show_splash = False  # it would eat the first events
preferences.view.smooth_view = 0  # the view moves at once, so a test need not wait for an animation
preferences.system.viewport_aa = "OFF"  # or every change of the view would be drawn eight times over
bpy.ops.wm.save_userpref()
