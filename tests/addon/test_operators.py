# SPDX-License-Identifier: GPL-3.0-or-later
"""All operators of the add-on, by what Blender knows of them: labels, descriptions, undo, poll messages, properties, menus."""

import collections

import bpy
from common import MeshTest, part, read_off

# What changes none of Blender's data, so that there is nothing to undo: parts are kept beside it.
CHANGES_NOTHING = {"MESH_OT_partwheel_build", "MESH_OT_partwheel_find", "MESH_OT_partwheel_imported",
                   "MESH_OT_partwheel_path"}
# Steps of others, which make the undo step: of macros, the pick in Edit Mode that follows entering it, Blender's own Move.
STEPS = {"MESH_OT_partwheel_gather_begin", "MESH_OT_partwheel_gather", "OBJECT_OT_partwheel_select",
         "MESH_OT_partwheel_move"}


def classes(kind):
    """{name: class} of the add-on."""
    classes_found = {}
    for name in dir(bpy.types):
        cls = getattr(bpy.types, name)
        if "partwheel" in name.lower() and isinstance(cls, type) and issubclass(cls, kind):
            classes_found[name] = cls
    return classes_found


def operator(name):
    space, _, rest = name.partition("_OT_")
    return getattr(getattr(bpy.ops, space.lower()), rest)


class Layout:
    """A layout that writes down what is drawn in it."""

    def __init__(self, drawn):
        self.drawn = drawn

    def operator(self, name, text=None, **_):
        entry = collections.defaultdict(lambda: None)
        options = type("Options", (), {"__setattr__": lambda _, key, value: entry.__setitem__(key, value)})()
        self.drawn.append((name, entry))
        return options

    def menu(self, name, **_):
        self.drawn.append((name, {}))

    def menu_pie(self):
        return self

    def __getattr__(self, _name):
        return lambda *_, **__: self


class Operators(MeshTest):
    def operators(self):
        classes_found = {**classes(bpy.types.Operator), **classes(bpy.types.Macro)}
        self.assertGreater(len(classes_found), 25)
        return classes_found

    def test_labels_and_descriptions(self):
        for name in self.operators():
            with self.subTest(name):
                rna = operator(name).get_rna_type()
                self.assertTrue(rna.name.strip())
                self.assertGreater(len(rna.description), 10)

    def test_what_changes_data_can_be_undone_and_adjusted(self):
        for name, cls in self.operators().items():
            with self.subTest(name):
                options = set(cls.bl_options)
                if name in CHANGES_NOTHING | STEPS:
                    self.assertNotIn("UNDO", options)
                else:
                    self.assertLessEqual({"REGISTER", "UNDO"}, options)

    def test_no_two_properties_have_one_name(self):
        """Of those that a panel shows. All have a name and a description."""
        for name in self.operators():
            with self.subTest(name):
                shown = [prop for prop in operator(name).get_rna_type().properties
                         if not prop.is_hidden and prop.identifier != "rna_type"]
                counts = collections.Counter(prop.name for prop in shown)
                self.assertEqual([name for name, count in counts.items() if count > 1], [])
                for prop in shown:
                    if prop.type != "POINTER":
                        self.assertTrue(prop.name and prop.description, prop.identifier)

    def test_a_disabled_operator_says_why(self):
        """Without an object, with one that is no mesh, and with a mesh in each mode, with parts and without."""
        def confirmation(where):
            for name in self.operators():
                call = operator(name)
                if not call.poll():
                    refused[name].add(where)
                    with self.subTest(name, where=where), self.assertRaises(RuntimeError) as raised:
                        call()
                    message = str(raised.exception).partition("poll()")[2].strip()
                    self.assertGreater(len(message.split()), 3, str(raised.exception))
                    self.assertNotIn("context is incorrect", message)

        refused = collections.defaultdict(set)
        confirmation("nothing")
        lamp = self.link(bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT")))
        confirmation("a lamp")
        bpy.data.objects.remove(lamp)
        obj = self.add(*read_off("cross_quad"))
        for parts in ("without", "with"):
            if parts == "with":
                self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
            for mode in ("EDIT", "SCULPT", "VERTEX_PAINT", "WEIGHT_PAINT", "TEXTURE_PAINT", "OBJECT"):
                bpy.ops.object.mode_set(mode=mode)
                confirmation(f"{mode}, {parts}")
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(bpy.context.active_object, obj)
        never = set(self.operators()) - set(refused)
        self.assertEqual(never, set())

    def test_each_menu_has_an_entry_once(self):
        """Also those of its submenus, and of our own menus by themselves."""
        menus = dict(part("ui.menu").ENTRIES)
        ours = {name: cls.draw for name, cls in classes(bpy.types.Menu).items()}
        drawn = {}

        def entries(name):
            entries_found = []
            for draw in ([menus[name]] if name in menus else []) + ([part("ui.part_menus")._draw_submenu] if (
                    name in part("ui.part_menus").MENUS) else []) + ([ours[name]] if name in ours else []):
                layout = Layout([])
                draw(type("Menu", (), {"layout": layout})(), bpy.context)
                entries_found += [(entry_name, tuple(sorted(options.items()))) for entry_name, options in layout.drawn if entry_name]
            submenus = [submenu for submenu, _ in entries_found if "_MT_" in submenu]
            if name == "VIEW3D_MT_select_edit_mesh":
                submenus.append("VIEW3D_MT_edit_mesh_select_similar")
            return entries_found + [entry for submenu in submenus for entry in entries(submenu)]

        for name in {*menus, *part("ui.part_menus").MENUS, *ours}:
            with self.subTest(name):
                drawn[name] = entries(name)
                counts = collections.Counter(drawn[name])
                self.assertTrue(counts)
                self.assertEqual([entry for entry, count in counts.items() if count > 1], [])
        self.assertLessEqual(len(part("ui.menu").ENTRIES), len(menus))
