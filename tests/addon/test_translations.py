# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on in the user's language: Blender finds its texts there, reports and reasons are put together in it, and sizes
are in the scene's units."""


import bpy
from common import MeshTest, part, read_off, snapshot

EXPECTED = {"de_DE": ("Teil per Mausrad auswählen", "Kein Teil ist gewählt"),
        "es": ("Seleccionar parte con la rueda", "No hay ninguna parte"),
        "ja_JP": ("ホイールでパーツを選択", "パーツが選ばれていません"), "zh_HANS": ("滚轮选择部件", "尚未选取部件")}


class Words(MeshTest):
    def setUp(self):
        super().setUp()
        self.view = bpy.context.preferences.view
        self.addCleanup(self.speak, self.view.language)

    def spoken(self):
        """The languages of EXPECTED that this Blender has: all, but for the Python module, which speaks none."""
        if bpy.app.build_options.international:
            return EXPECTED
        self.assertEqual(self.view.bl_rna.properties["language"].enum_items.keys(), ["DEFAULT"])
        return {}

    def speak(self, language):
        if language == "zh_HANS" and bpy.app.version < (4, 0):
            language = "zh_CN"
        self.view.language = language
        for name in ("interface", "tooltips", "reports", "new_dataname"):
            if hasattr(self.view, f"use_translate_{name}"):
                setattr(self.view, f"use_translate_{name}", True)

    def test_each_language(self):
        obj = self.add(*read_off("hand"))
        self.hierarchy(obj)
        self.edit(obj)
        for language, (label, reason) in self.spoken().items():
            with self.subTest(language):
                self.speak(language)
                lookup = part("translations.lookup")
                self.assertEqual(lookup.get_operator_label(bpy.types.MESH_OT_partwheel_select), label)
                self.assertEqual(lookup.iface_("Select Part by Wheel"), label)
                with self.assertRaisesRegex(RuntimeError, reason):
                    bpy.ops.mesh.partwheel_deform()
        self.speak("en_US" if self.spoken() else "DEFAULT")
        self.assertEqual(part("translations.lookup").iface_("Select Part by Wheel"), "Select Part by Wheel")

    def test_values_are_inserted_after_translation(self):
        obj = self.add(*read_off("hand"))
        obj.name = "{name}"  # no text of the user's is taken for one of ours
        if not self.spoken():
            return
        self.speak("de_DE")
        with self.assertRaises(part("mesh.errors").Refused) as refused:
            part("parts.registry").require_hierarchy(snapshot(obj))
        self.assertEqual(str(refused.exception), "{name} hat keine Teile für sein Mesh, wie es jetzt ist. Erst Teile finden.")
