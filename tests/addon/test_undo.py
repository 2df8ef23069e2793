# SPDX-License-Identifier: GPL-3.0-or-later
"""Each command is one undo step: undo brings back all that there was before, also what others have changed in Edit Mode, where
Blender's own steps hold only the mesh; redo does all again; and the panel of the last operation works after it."""

import json

import bpy
from common import MeshTest, only_in, part, read_off

FACE = 700
COMMANDS = {  # what they are called with, in Edit Mode
    "remove": ("partwheel_remove", {"material": True}), "copy": ("partwheel_copy", {"material": True}),
    "convex": ("partwheel_convex", {"hulls": 3}), "swap": ("partwheel_swap", {"other": "other", "build": False}),
    "groups": ("partwheel_parts", {"count": 4, "to": {"VERTEX_GROUPS", "FACE_SETS", "COLORS"}}),
    "bones": ("partwheel_parts", {"count": 3, "to": {"BONES"}}),
    "objects": ("partwheel_parts", {"count": 3, "to": {"OBJECTS"}})}


def everything():
    """All that the commands, or the test, change."""
    bpy.context.view_layer.update()
    found = {"mode": bpy.context.mode, "active": bpy.context.view_layer.objects.active.name,
             "names": [sorted(block.name for block in blocks) for blocks in (
                 bpy.data.objects, bpy.data.collections, bpy.data.armatures, bpy.data.materials)]}
    for obj in bpy.data.objects:
        found[f"object {obj.name}"] = (obj.hide_get(), obj.parent and obj.parent.name, [modifier.name for modifier in obj.modifiers], sorted(obj.keys()))
        if obj.type == "MESH":
            mesh = obj.data
            found[f"mesh {obj.name}"] = (
                part("mesh.mesh_state").element_counts(mesh), [group.name for group in obj.vertex_groups], sorted(mesh.keys()),
                [material and material.name for material in mesh.materials], [name for name in (".sculpt_face_set", "partwheel_part")
                                                                 if name in mesh.attributes])
    return found


class Undo(MeshTest):
    def setUp(self):
        for blocks in (bpy.data.collections, bpy.data.armatures, bpy.data.materials):
            for block in list(blocks):
                blocks.remove(block)
        super().setUp()

    def prepare(self):
        """A pick in Edit Mode; since the last step outside of it there are a modifier, a property and a group."""
        self.add(*read_off("hand"), "other").location.x = 10
        obj = self.add(*read_off("hand"))
        bpy.ops.mesh.partwheel_build()
        bpy.ops.ed.undo_push(message="built")
        self.edit(obj)
        bpy.ops.ed.undo_push(message="Edit Mode")
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", True, face_index=FACE)
        bpy.ops.object.modifier_add("EXEC_DEFAULT", True, type="SUBSURF")
        bpy.ops.object.vertex_group_add("EXEC_DEFAULT", True)
        obj["own"] = 1
        bpy.ops.ed.undo_push(message="own")

    @only_in("oldest", "newest")
    def test_one_undo_in_edit_mode_brings_everything_back(self):
        for name, (operator, options) in COMMANDS.items():
            with self.subTest(name):
                self.setUp()
                self.prepare()
                before = everything()
                self.assertEqual(getattr(bpy.ops.mesh, operator)("EXEC_DEFAULT", True, **options), {"FINISHED"})
                after = everything()
                self.assertNotEqual(after, before)
                for _ in range(2):
                    bpy.ops.ed.undo()
                    self.assertEqual(everything(), before)
                    bpy.ops.ed.redo()
                    self.assertEqual(everything(), after)

    @only_in("newest")  # where background mode has windows
    def test_the_last_operation_is_adjusted_from_where_it_began(self):
        """Also in Object Mode, where bones leave their armature active."""
        window = bpy.context.window_manager.windows[0]
        override = {"window": window, "area": window.screen.areas[0], "region": window.screen.areas[0].regions[0]}
        for mode in ("EDIT", "OBJECT"):
            for name in ("groups", "bones", "objects"):
                with self.subTest(f"{name} {mode}"):
                    self.setUp()
                    self.prepare()
                    bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode=mode)
                    before = everything()
                    operator, options = COMMANDS[name]
                    getattr(bpy.ops.mesh, operator)("EXEC_DEFAULT", True, **options)
                    for count in (2, 5):
                        bpy.context.window_manager.operators[-1].properties.count = count
                        with bpy.context.temp_override(**override):
                            self.assertEqual(bpy.ops.ed.undo_redo("EXEC_DEFAULT", True), {"FINISHED"})
                        saved = bpy.data.meshes["model"][part("cut.saved_cut").NAMES_PROPERTY]
                        self.assertEqual(len(json.loads(saved)), count)
                    bpy.ops.ed.undo()
                    self.assertEqual(everything(), before)

    def test_an_armature_is_no_model(self):
        """Though the operator could be adjusted while one is active."""
        obj = self.add(*read_off("hand"))
        bpy.ops.mesh.partwheel_parts(count=3, to={"BONES"})
        self.assertEqual(bpy.context.view_layer.objects.active, obj.find_armature())
        self.assertTrue(bpy.ops.mesh.partwheel_parts.poll())
        with self.assertRaisesRegex(RuntimeError, "Select a mesh object"):
            bpy.ops.mesh.partwheel_parts(count=3, to={"BONES"})
        bpy.ops.object.mode_set(mode="POSE")
        self.assertFalse(bpy.ops.mesh.partwheel_parts.poll())
