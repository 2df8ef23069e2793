# SPDX-License-Identifier: GPL-3.0-or-later
"""All operators of the add-on, by what Blender knows of them: labels, descriptions, undo, poll messages, properties, menus."""

from types import SimpleNamespace

import bpy
from common import BOX, MeshTest, part

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

    def test_no_two_fields_of_a_redo_panel_have_the_same_label(self):
        for name, cls in self.operators().items():
            shown = [prop.name for prop in operator_of(cls).get_rna_type().properties if not prop.is_hidden]
            self.assertEqual(len(shown), len(set(shown)), f"{name}: {sorted(shown)}")

    def test_no_two_entries_of_a_menu_have_the_same_label(self):
        menus = {}  # name -> what the add-on draws into it
        for name, draw in part("ui.menu").ENTRIES:
            menus.setdefault(name, []).append(draw)
        for name in classes(bpy.types.Menu):
            menus[name] = []
        for name in menus:
            labels = drawn_labels(name, menus)
            self.assertGreater(len(labels), 0, name)
            self.assertEqual(len(labels), len(set(labels)), f"{name}: {sorted(labels)}")

    def test_a_refused_operator_says_why(self):
        """In each mode, of meshes and others, without any object."""
        refused = set()
        for prepare in (self.nothing, self.lamp, lambda: self.add(*BOX), lambda: self.edit(self.add(*BOX)),
                        lambda: (self.add(*BOX), bpy.ops.object.mode_set(mode="SCULPT")),
                        lambda: (self.add(*BOX), bpy.ops.object.mode_set(mode="TEXTURE_PAINT")),
                        lambda: self.linked(self.add(*BOX))):
            self.setUp()
            prepare()
            for cls in self.operators().values():
                operator = operator_of(cls)
                if operator.poll():
                    continue
                refused.add(cls)
                with self.assertRaisesRegex(RuntimeError, r"poll\(\) ") as raised:
                    operator()
                self.assertNotIn("context is incorrect", str(raised.exception))
        self.assertGreater(len(refused), 25)

    def test_linked_objects_are_not_placed(self):
        """A script could move them, but undo and the file would not have that. Local objects with a linked mesh move."""
        linked = self.linked(self.add(*BOX))
        self.assertFalse(bpy.ops.object.partwheel_place.poll())
        self.link(bpy.data.objects.new("local", linked.data))
        self.assertTrue(bpy.ops.object.partwheel_place.poll())

    def test_picking_without_an_object_says_why(self):
        for prepare in (self.nothing, self.lamp):
            prepare()
            for pick in (bpy.ops.object.partwheel_select, bpy.ops.object.partwheel_pick):
                with self.assertRaisesRegex(RuntimeError, "^Error: Select a mesh object"):
                    pick(face_index=0)

    def nothing(self):
        bpy.context.view_layer.objects.active = None

    def lamp(self):
        self.link(bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT")))


def drawn_labels(name, menus):
    """The labels of a menu's entries of the add-on, and of those in its submenus of the add-on. menus: name -> what draws."""
    labels = []

    def operator(idname, text=None, **_options):
        labels.append(text or getattr(bpy.types, operator_class(idname)).bl_label)
        return SimpleNamespace()

    def menu(submenu):
        labels.append(getattr(bpy.types, submenu).bl_label)
        labels.extend(drawn_labels(submenu, menus) if submenu in menus else ())

    layout = SimpleNamespace(operator=operator, menu=menu, separator=lambda **_: None)
    layout.menu_pie = lambda: layout
    for draw in menus[name] or [getattr(bpy.types, name).draw]:
        draw(SimpleNamespace(layout=layout), bpy.context)
    return labels


def operator_class(idname):
    space, name = idname.split(".")
    return f"{space.upper()}_OT_{name}"


def operator_of(cls):
    space, name = cls.bl_rna.identifier.lower().split("_ot_")
    return getattr(getattr(bpy.ops, space), name)
