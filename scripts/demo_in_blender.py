# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes two example models apart, as scripts/demo describes.

Run as: blender -b --python demo_in_blender.py -- FOLDER
with the add-on installed and enabled. It writes MODEL.blend, MODEL-parts.blend and MODEL.obj to FOLDER.
"""

import sys
from pathlib import Path

import bpy
from partwheel.examples import EXAMPLES
from partwheel_addon.ui.tour import create_object

CLICKS = {"figure": [(-0.84, -0.124, 0.987), (0.193, -0.196, 0.066)],  # the hand, a foot
          "truck": [(0.52, -0.8, 0.24), (0.37, 0.45, 0.85)]}  # a wheel, the crate
NOTCHES = range(-2, 3)
EXPLODE = 0.4  # how far parts move apart, times the distance of their centers


def take_apart(name, folder):
    bpy.data.batch_remove(bpy.data.objects)
    example = EXAMPLES[name]()
    example.save(folder / f"{name}.obj", up="z")
    obj = create_object(example, name)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.context.tool_settings.mesh_select_mode = (False, False, True)
    bpy.ops.mesh.partwheel_build()
    for point in CLICKS[name]:
        face = obj.closest_point_on_mesh(point)[3]
        bpy.ops.object.mode_set(mode="EDIT")
        counts = []
        for notch in NOTCHES:
            bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", face_index=face, level=notch)
            obj.update_from_editmode()
            counts.append(obj.data.count_selected_items()[2])
        print(f"{name}: the wheel around a click selects {', '.join(map(str, counts))} of {len(obj.data.polygons)} faces")
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{name}.blend"))
    bpy.ops.mesh.partwheel_parts(to={"OBJECTS"}, explode=EXPLODE)
    print(f"{name}: made {len(bpy.context.selected_objects)} objects")
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / f"{name}-parts.blend"))


for model in CLICKS:
    take_apart(model, Path(sys.argv[-1]))
