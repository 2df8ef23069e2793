# SPDX-License-Identifier: GPL-3.0-or-later
"""The size of the view, which chooses what a click selects: against points projected by Blender itself; and what box, hover
and clicks make of it."""

import bpy
import numpy as np
from bpy_extras.object_utils import world_to_camera_view
from bpy_extras.view3d_utils import location_3d_to_region_2d
from common import MeshTest, part, read_off, selected
from mathutils import Euler, Matrix, Vector
from test_modal import camera, view


class ViewSize(MeshTest):
    def setUp(self):
        super().setUp()
        part("preferences").preferences().use_view = True

    def test_as_projected(self):
        """Two points of the plane through the place that are apart by the size lie apart by the smaller side."""
        measure = part("view.picking").measure_view
        for perspective in (True, False):
            obj = self.add(*read_off("hand"))
            obj.matrix_world = (Matrix.Translation((3, -2, 1)) @ Euler((0.3, 0.4, 0.5)).to_matrix().to_4x4()
                                @ Matrix.Scale(2.5, 4))
            bpy.context.view_layer.update()
            region, region_view = camera(obj, perspective)
            axes = region_view.view_matrix.inverted().to_3x3()
            for index in range(0, len(obj.data.polygons), 300):
                place = obj.matrix_world @ obj.data.polygons[index].center
                size = measure(obj.matrix_world, region_view, place)
                half = 2.5 * size / 2 * axes.col[1]  # 800 x 600 pixels: the smaller side is the height
                low, high = (location_3d_to_region_2d(region, region_view, place + sign * half) for sign in (-1, 1))
                self.assertAlmostEqual((high - low).length / region.height, 1, 3)

    def test_in_the_camera_view(self):
        obj = self.add(*read_off("hand"))
        data = bpy.data.cameras.new("camera")
        eye = bpy.context.scene.camera = self.link(bpy.data.objects.new("camera", data))
        eye.matrix_world = Matrix.Translation((0, 0, 40))
        bpy.context.view_layer.update()
        render = bpy.context.scene.render
        projection = eye.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=render.resolution_x,
                                            y=render.resolution_y)
        class RegionView:
            window_matrix, perspective_matrix = projection, projection @ eye.matrix_world.inverted()
        for place in (Vector((0, 0, 0)), Vector((1, 2, 20))):
            size = part("view.picking").measure_view(obj.matrix_world, RegionView, place)
            low, high = (world_to_camera_view(bpy.context.scene, eye, place + Vector((0, sign * size / 2, 0)))
                         for sign in (-1, 1))
            self.assertAlmostEqual(high.y - low.y, 1, 4)
        bpy.context.scene.camera = None

    def test_scale_of_the_object_and_preference(self):
        measure, region_view = part("view.picking").measure_view, view()[3]
        sizes = [measure(Matrix.Scale(scale, 4), region_view, region_view.view_location) for scale in (1, 2, -2, 0)]
        self.assertAlmostEqual(sizes[0] / sizes[1], 2, 5)
        self.assertAlmostEqual(sizes[1], sizes[2], 5)
        self.assertEqual(sizes[3], 0)
        part("preferences").preferences().use_view = False
        self.assertEqual(measure(Matrix(), region_view, region_view.view_location), 0)

    def test_the_redo_panel_keeps_the_node(self):
        """face_index and level lead to the picked node from any view."""
        obj = self.add(*read_off("homer"))
        h = self.hierarchy(obj)
        self.edit(obj)
        states = part("pick.states")
        differs = 0
        for face in range(0, len(h.order), 97):
            for size in np.geomspace(0.02, 5, 6) * np.ptp(h.vertices, axis=0).max():
                picked = states.pick_face(h, face, view=float(size))
                stops, start = h.wheel(face, float(size))
                self.assertEqual(picked.node, stops[start])
                differs += picked.level != 0
                self.assertEqual(states.pick_face(h, face, picked.level).node, picked.node)
        self.assertGreater(differs, 20)
        picked = states.pick_face(h, 97, view=float(0.05 * np.ptp(h.vertices, axis=0).max()))
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", face_index=97, level=picked.level)
        self.assertEqual(selected(obj), set(h.faces(picked.node).tolist()))

    def test_box_takes_the_level_of_the_pick_in_this_view(self):
        """A pick without notches has level 0 in its view, and so has a box there."""
        obj = self.add(*read_off("homer"))
        h = self.hierarchy(obj)
        self.edit(obj)
        states, notches = part("pick.states"), part("related.gather")._notches_from_start
        size = float(0.1 * np.ptp(h.vertices, axis=0).max())
        picked = states.pick_face(h, 700, view=size)
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", face_index=700, level=picked.level)
        pick = part("parts.picks").get_pick(obj)
        self.assertEqual(notches(pick, size), 0)
        self.assertEqual(notches(pick, 0.0), picked.level)
