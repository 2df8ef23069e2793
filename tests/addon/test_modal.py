# SPDX-License-Identifier: GPL-3.0-or-later
"""Picking by a ray, and the modal tool fed with events by hand: its answers, the selection, what it leaves behind.

Blender without windows has a 3D view with sizes and matrices, but runs no modal operator; so the operator's own methods
are called. The GUI tier does the same with real events.
"""

import types

import bmesh
import bpy
import numpy as np
from common import MeshTest, part, read_off
from mathutils import Euler, Matrix, Vector


def view():
    """(window, area, region, RegionView3D) of the 3D view."""
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return window, area, region, area.spaces.active.region_3d


def show(obj):
    """Puts the object where the view looks, so that it fills a good part of it. (A view can't be turned here: without
    windows Blender crashes when it is updated.)"""
    _, _, _, region_view = view()
    corners = [Vector(corner) for corner in obj.bound_box]
    size = max((a - b).length for a in corners for b in corners)
    obj.matrix_world = (Matrix.Translation(region_view.view_location) @ Euler((0.4, 0.2, 0.5)).to_matrix().to_4x4()
                        @ Matrix.Scale(region_view.view_distance / 4 / size, 4)
                        @ Matrix.Translation(-sum(corners, Vector()) / 8))
    bpy.context.view_layer.update()


def camera(obj, perspective):
    """(region, view) of 800 x 600 pixels that look at the object, as far as picking needs them."""
    corners = [obj.matrix_world @ Vector(corner) for corner in obj.bound_box]
    size = max((a - b).length for a in corners for b in corners)
    pose = (Matrix.Translation(sum(corners, Vector()) / 8) @ Euler((1.1, 0, 0.5)).to_matrix().to_4x4()
            @ Matrix.Translation((0, 0, 1.5 * size)))
    near, far, across = 0.01 * size, 10 * size, 0.75
    if perspective:
        projection = Matrix(((2 / across, 0, 0, 0), (0, 8 / 3 / across, 0, 0),
                             (0, 0, (near + far) / (near - far), 2 * near * far / (near - far)), (0, 0, -1, 0)))
    else:
        projection = Matrix(((2 / size, 0, 0, 0), (0, 8 / 3 / size, 0, 0), (0, 0, -1 / far, 0), (0, 0, 0, 1)))
    return types.SimpleNamespace(width=800, height=600), types.SimpleNamespace(
        view_matrix=pose.inverted(), window_matrix=projection, perspective_matrix=projection @ pose.inverted(),
        is_perspective=perspective, use_clip_planes=False, view_perspective="PERSP" if perspective else "ORTHO")


class FakeContext:
    """bpy.context for a 3D view, but what the tool says to the user is kept, and no handler is added."""

    def __init__(self):
        self.window, self.area, self.region, _ = view()
        self.handlers, self.status, self.header, self.timers = [], [], [], []
        self.window_manager = types.SimpleNamespace(
            modal_handler_add=self.handlers.append, event_timer_remove=self.timers.remove,
            event_timer_add=lambda seconds, window: self.timers.append(seconds) or seconds)
        self.workspace = types.SimpleNamespace(status_text_set=self.status.append, tools=bpy.context.workspace.tools)
        real = self.area
        self.area = types.SimpleNamespace(type="VIEW_3D", header_text_set=self.header.append, regions=real.regions)
        self.space = real.spaces.active

    @property
    def selectable_objects(self):
        """As in a window: those that this view shows, too."""
        return [obj for obj in bpy.context.selectable_objects if obj.visible_get(viewport=self.space)]

    def __getattr__(self, name):
        return getattr(bpy.context, name)


def event(kind, point=None, value="PRESS", **modifiers):
    """point: in pixels of the 3D view; its middle by default."""
    _, _, region, _ = view()
    point = point or (region.width // 2, region.height // 2)
    modifiers_down = {name: modifiers.get(name, False) for name in ("ctrl", "alt", "shift", "oskey")}
    return types.SimpleNamespace(type=kind, value=value, mouse_x=int(point[0] + region.x),
                                 mouse_y=int(point[1] + region.y), is_tablet=False, **modifiers_down)


class Tool:
    """An instance of an operator's methods without an operator."""

    def __init__(self, operator="select", kinds=("MESH", "OBJECT"), **properties):
        self.reports = []
        self.operator, self.kinds = operator, kinds
        self.face_index, self.level, self.extend, self.deselect, self.tool, self.snap = 0, 0, False, False, False, False
        self.quality, self.full_resolution = 0.0, False
        vars(self).update(properties)

    def __getattr__(self, name):
        kinds = (getattr(bpy.types, f"{kind}_OT_partwheel_{self.operator}", None) for kind in self.kinds)
        cls = next(filter(None, kinds))
        definitions = [vars(base)[name] for base in cls.__mro__ if name in vars(base)]
        if not definitions:
            raise AttributeError(name)
        value = definitions[0]
        return value.__get__(self) if isinstance(value, types.FunctionType) else value

    def invoke(self, context, event):
        """And waits, as long as it makes what it needs slice by slice."""
        return prepared(self, context, Tool.__getattr__(self, "invoke")(context, event))

    def report(self, kind, message):
        self.reports.append((kind, message))


def prepared(tool, context, answer):
    """The answer of a tool that answered so, once it has made what it needs slice by slice."""
    while answer == {"RUNNING_MODAL"} and isinstance(getattr(tool, "state", None), part("pick.states").Preparing):
        answer = tool.modal(context, event("TIMER"))
    return answer


class Pick(MeshTest):
    def triangles(self, obj, skip):
        """(T, 3, 3) corners in the world, (T,) their faces: of all faces but those to skip."""
        loops = [corners for corners in bmesh.from_edit_mesh(obj.data).calc_loop_triangles()
                 if corners[0].face.index not in skip]
        to_world = np.array(obj.matrix_world)
        points = np.array([[corner.vert.co for corner in corners] for corners in loops]) @ to_world[:3, :3].T
        return points + to_world[:3, 3], np.array([corners[0].face.index for corners in loops])

    def nearest(self, points, faces, origin, direction, margin):
        """By brute force: (distance, face) of the triangle that the ray meets first. margin: how far, in barycentric
        coordinates, from its sides; negative takes in what lies just beside it."""
        a, ab, ac = points[:, 0], points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
        normal, to_origin = np.cross(ab, ac), np.array(origin) - a
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = -(normal @ np.array(direction))
            distance = (to_origin * normal).sum(1) / slope
            turned = np.cross(np.array(direction), to_origin)
            v, w = -(ac * turned).sum(1) / slope, (ab * turned).sum(1) / slope
            hit = (distance > 0) & (v >= margin) & (w >= margin) & (v + w <= 1 - margin)
        if not hit.any():
            return None
        index = np.flatnonzero(hit)[distance[hit].argmin()]
        return distance[index], faces[index]

    def test_the_nearest_visible_face_under_the_mouse(self):
        from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d

        for perspective in (True, False):
            for scale in ((1, 1, 1), (-1, 1, 1), (2, -0.5, 3), (-1, -1, -1), (100, 100, 100)):
                self.setUp()
                obj = self.add(*read_off("hand"))
                obj.matrix_world = Matrix.Translation((3, -2, 1)) @ Euler((0.3, 0.4, 0.5)).to_matrix().to_4x4() @ \
                    Matrix.Diagonal((*scale, 1))
                bpy.context.view_layer.update()
                region, region_view = camera(obj, perspective)
                bm = self.edit(obj)
                bm.faces.ensure_lookup_table()
                hidden = set()
                for _ in range(2):
                    part("mesh.arrays").update_mesh(obj)
                    surface = part("view.visible_surface").compute_visible_surface(obj)
                    tree, shown, hits = part("view.picking").FaceRayCaster(surface), self.triangles(obj, hidden), 0
                    for x in range(1, 6):
                        for y in range(1, 6):
                            point = region.width * x // 6, region.height * y // 6
                            hit = tree.cast(obj, obj.matrix_world, region, region_view, point)
                            ray = (region_2d_to_origin_3d(region, region_view, point),
                                   region_2d_to_vector_3d(region, region_view, point))
                            expected, close = (self.nearest(*shown, *ray, margin) for margin in (1e-4, -1e-4))
                            if expected != close:
                                continue  # on a side of a triangle, to the rounding of single precision
                            if expected is None:
                                self.assertIsNone(hit)
                                continue
                            hits += 1
                            self.assertEqual(hit.face, expected[1])
                            self.assertAlmostEqual(hit.distance / expected[0], 1, 3)
                    self.assertGreater(hits, 2)
                    hidden = set(range(0, 2390, 3))
                    for index in hidden:
                        bm.faces[index].hide_set(True)
                bpy.ops.mesh.reveal(select=False)

    def test_what_lies_over_the_view_is_not_the_view(self):
        window, area, region, _ = view()
        find = part("view.picking").find_view_at
        inside = region.x + region.width // 2, region.y + region.height // 2
        self.assertEqual(find(window, *inside)[1].type, "WINDOW")
        header = next(region for region in area.regions if region.type == "HEADER")
        self.assertIsNone(find(window, header.x + 5, header.y + header.height // 2))
        self.assertIsNone(find(window, -5, -5))
