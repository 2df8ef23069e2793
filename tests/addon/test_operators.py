# SPDX-License-Identifier: GPL-3.0-or-later
"""All operators of the add-on, by what Blender knows of them: labels, descriptions, undo, poll messages, properties, menus."""


import bpy
from common import MeshTest

# What changes none of Blender's data, so that there is nothing to undo: parts are kept beside it.
CHANGES_NOTHING = {"MESH_OT_partwheel_build", "MESH_OT_partwheel_find", "MESH_OT_partwheel_imported",
                   "MESH_OT_partwheel_path"}
# Steps of others, which make the undo step: of macros, the pick in Edit Mode that follows entering it, Blender's own Move.
STEPS = {"MESH_OT_partwheel_gather_begin", "MESH_OT_partwheel_gather", "OBJECT_OT_partwheel_select",
         "MESH_OT_partwheel_move"}
# Strokes of the mouse, of which there is nothing to adjust.
STROKES = {"MESH_OT_partwheel_border"}


def classes(kind):
    """{name: class} of the add-on."""
    classes_found = {}
    for name in dir(bpy.types):
        cls = getattr(bpy.types, name)
        if "partwheel" in name.lower() and isinstance(cls, type) and issubclass(cls, kind):
            classes_found[name] = cls
    return classes_found


class Operators(MeshTest):
    def operators(self):
        classes_found = {**classes(bpy.types.Operator), **classes(bpy.types.Macro)}
        self.assertGreater(len(classes_found), 25)
        return classes_found

    def test_what_changes_data_can_be_undone_and_adjusted(self):
        for name, cls in self.operators().items():
            with self.subTest(name):
                options = set(cls.bl_options)
                if name in CHANGES_NOTHING | STEPS:
                    self.assertNotIn("UNDO", options)
                elif name in STROKES:
                    self.assertEqual({"UNDO"}, options)
                else:
                    self.assertLessEqual({"REGISTER", "UNDO"}, options)
