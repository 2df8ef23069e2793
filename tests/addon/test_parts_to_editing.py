# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts to... while it runs: wheel, clicks, Esc and Enter, fed by hand."""

import types

import bpy
from common import part
from test_modal import ToolTest


class Editing(ToolTest):
    """The modal tool, fed with events."""

    def begin(self):
        options = {"to": {"FACE_SETS"}, "count": 4, "clusters": "", "own_parts": "", "unwrap": False, "smooth": False,
                   "material": False, "closed": True, "origins": True, "explode": 0.0, "shell": 0.0, "hide": True,
                   "original_mode": "", "properties": types.SimpleNamespace(is_property_set=lambda _name: True)}
        self.start(operator="parts", **options)
        return self.tool.state.cut

    def test_the_wheel_changes_the_number_of_parts_and_escape_changes_nothing(self):
        before = self.begin()
        self.assertEqual(self.send("WHEELUPMOUSE"), {"RUNNING_MODAL"})
        self.assertEqual(len(self.tool.state.cut), len(before) + 1)
        self.assertEqual(self.send("WHEELDOWNMOUSE"), {"RUNNING_MODAL"})
        self.assertEqual(self.tool.state.cut.parts, before.parts)
        self.assertEqual(self.send("ESC"), {"CANCELLED"})
        self.assertEqual((self.obj.mode, self.context.status[-1], self.context.header[-1]), ("EDIT", None, None))
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertIsNone(part("api").load_cut(self.obj))

    def test_a_click_activates_the_part_under_the_mouse_and_another_deactivates_it(self):
        self.begin()
        for is_active in (True, False):
            for value in ("PRESS", "RELEASE"):
                self.assertEqual(self.send("LEFTMOUSE", value=value), {"RUNNING_MODAL"})
            self.assertEqual(self.tool.state.part is not None, is_active)
        self.send("ESC")  # a draw handler that is left lets bpy 4.2 crash as Python ends

    def test_enter_saves_the_cut(self):
        count = len(self.begin())
        self.assertEqual(self.send("RET"), {"FINISHED"})
        self.assertEqual(self.obj.mode, "EDIT")
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertEqual(len(part("api").load_cut(self.obj)[0]), count)
