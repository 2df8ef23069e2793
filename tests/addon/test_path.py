# SPDX-License-Identifier: GPL-3.0-or-later
"""The way of the part picked last through the dendrogram, as the sidebar's panel and the popup show it: each row takes
the part that it describes."""

import types

import bpy
from common import MeshTest, part, read_off, selected


class Layout:
    """Notes what is drawn, row by row: [button, texts beside it]."""

    def __init__(self, rows=None):
        self.rows = [] if rows is None else rows

    def column(self, **_):
        return Layout(self.rows)

    row = split = column

    def operator(self, name, text, depress):
        self.rows.append([types.SimpleNamespace(name=name, text=text, depress=depress), []])
        return self.rows[-1][0]

    def label(self, text):
        self.rows[-1][1].append(text)


class Path(MeshTest):
    def setUp(self):
        super().setUp()
        self.obj = self.add(*read_off("hand"))
        self.h = self.hierarchy(self.obj)
        self.edit(self.obj)

    def draw_class(self, cls):
        layout = Layout()
        cls.draw(types.SimpleNamespace(layout=layout), bpy.context)
        return layout.rows

    def test_each_row_takes_the_part_that_it_shows(self):
        for cls in (bpy.types.VIEW3D_PT_partwheel_path, part("ui.path").MESH_OT_partwheel_path):
            for face, level in ((700, 1), (100, 0)):
                bpy.ops.mesh.partwheel_select(face_index=face, level=level)
                stops, start = self.h.wheel(face)
                for row, stop in enumerate(reversed(range(len(stops)))):  # the whole is on top
                    rows = self.draw_class(cls)
                    self.assertEqual(len(rows), len(stops))
                    active_stop = start + level if row == 0 else stop + 1
                    self.assertEqual([button.depress for button, _ in reversed(rows)],
                                     [index == active_stop for index in range(len(stops))])
                    button, texts = rows[row]
                    arguments = {name: getattr(button, name) for name in ("face_index", "level", "snap")}
                    self.assertEqual(button.name, "mesh.partwheel_select")
                    self.assertEqual(bpy.ops.mesh.partwheel_select(**arguments), {"FINISHED"})
                    faces = set(self.h.faces(stops[stop]).tolist())
                    self.assertEqual((selected(self.obj), button.text), (faces, f"{len(faces):,}"))
                    self.assertIn(f"{self.h.area[stops[stop]] / self.h.area[-1]:.1%}", texts)

    def test_there_must_be_a_part(self):
        panel, operator = bpy.types.VIEW3D_PT_partwheel_path, bpy.ops.mesh.partwheel_path
        self.assertFalse(panel.poll(bpy.context) or operator.poll())
        bpy.ops.mesh.partwheel_select(face_index=700)
        self.assertTrue(panel.poll(bpy.context) and operator.poll())
        bpy.ops.object.mode_set(mode="OBJECT")
        self.assertFalse(panel.poll(bpy.context) or operator.poll())
