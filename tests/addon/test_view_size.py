# SPDX-License-Identifier: GPL-3.0-or-later
"""The size of the view, which chooses what a click selects: against points projected by Blender itself; and what box, hover
and clicks make of it."""

import bpy
from bpy_extras.object_utils import world_to_camera_view
from bpy_extras.view3d_utils import location_3d_to_region_2d
from common import MeshTest, part, read_off
from mathutils import Euler, Matrix, Vector
from test_modal import camera


class ViewSize(MeshTest):
    def setUp(self):
        super().setUp()
        part("preferences").preferences().use_view = True

    def test_the_view_size_matches_the_projection(self):
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

    def test_the_view_size_matches_in_camera_views(self):
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
