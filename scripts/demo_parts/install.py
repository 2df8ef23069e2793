"""Installs the add-on's zip into this Blender's configuration and enables it there.

Run as: blender -b --python install.py -- ZIP
"""

import sys

import bpy

bpy.ops.preferences.addon_install(filepath=sys.argv[sys.argv.index("--") + 1], overwrite=True)
bpy.ops.preferences.addon_enable(module="partwheel_addon")
if "partwheel_addon" not in bpy.context.preferences.addons:
    sys.exit("demo: the add-on was installed but can't be enabled; the log has the reason")
bpy.context.preferences.view.show_splash = False
bpy.ops.wm.save_userpref()
