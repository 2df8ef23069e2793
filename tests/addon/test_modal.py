# SPDX-License-Identifier: GPL-3.0-or-later
"""Picking by a ray, and the modal tool fed with events by hand: its answers, the selection, what it leaves behind.

Blender without windows has a 3D view with sizes and matrices, but runs no modal operator; so the operator's own methods
are called. The GUI tier does the same with real events.
"""

import types

import bmesh
import bpy
import common
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from common import (BOX, MeshTest, alive, flags, only_in, package, part, read_off, selected,
                    until)
from gate import Gate
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


class ToolTest(MeshTest):
    """Starts the tool and feeds it."""

    def start(self, name="hand", point=None, build=True, **properties):
        self.obj = self.add(*(read_off(name) if isinstance(name, str) else name))
        self.h = self.hierarchy(self.obj)
        if build:
            self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        show(self.obj)
        self.edit(self.obj)
        self.context, self.tool = FakeContext(), Tool(**properties)
        return self.tool.invoke(self.context, event("W", point or (1, 1), ctrl=True))

    def send(self, *arguments, **modifiers):
        return self.tool.modal(self.context, event(*arguments, **modifiers))

    def center_of_part(self, obj=None, levels=3):
        """A pixel with a face of the object under it, with so many stops above the start: (point, face index)."""
        obj = obj or self.obj
        _, _, region, region_view = view()
        tree = part("view.picking").FaceRayCaster(obj)
        bm = bmesh.from_edit_mesh(obj.data)
        for face in bm.faces:
            if obj == self.obj:
                stops, start = self.h.wheel(face.index)
                if start + levels >= len(stops):
                    continue
            point = location_3d_to_region_2d(region, region_view, obj.matrix_world @ face.calc_center_median())
            hit = tree.cast(obj.matrix_world, region, region_view, [int(value) for value in point])
            if hit and hit[0] == face.index:
                return [int(value) for value in point], face.index
        self.fail("no face of the object is in view")

    def expect(self, face, level):
        stops, start = self.h.wheel(face)
        self.assertEqual(selected(self.obj), set(self.h.faces(stops[start + level]).tolist()))

    def is_over(self):
        self.assertEqual((self.context.status[-1], self.context.header[-1]), (None, None))


class Modal(ToolTest):
    """With a hierarchy built before."""

    def test_each_step_sees_what_happened_before_it(self):
        """Even an edit that Blender was not notified of."""
        self.assertEqual(self.start(), {"RUNNING_MODAL"})
        point, _ = self.center_of_part()
        bm = bmesh.from_edit_mesh(self.obj.data)
        edge = next(edge for edge in bm.edges if edge.calc_face_angle() < 0.1)
        self.assertTrue(bmesh.ops.rotate_edges(bm, edges=[edge])["edges"])
        self.send("LEFTMOUSE", point)
        self.assertTrue(part("parts.builds").has_builds())
        self.send("ESC")

    def test_another_object_of_edit_mode_is_picked_from(self):
        other = self.add(*BOX, "other")
        other_hierarchy = self.hierarchy(other)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        self.start()
        self.send("ESC")
        bpy.ops.object.mode_set(mode="OBJECT")
        self.obj.matrix_world = Matrix.Translation((0, 0, -1000))
        other.select_set(True)
        show(other)
        bpy.ops.object.mode_set(mode="EDIT")
        self.assertEqual(bpy.context.edit_object, self.obj)
        bm = bmesh.from_edit_mesh(self.obj.data)
        bm.faces.ensure_lookup_table()
        bm.faces[3].select_set(True)
        before = flags(self.obj), flags(other)
        point, face = self.center_of_part(other)
        stops, start = other_hierarchy.wheel(face)
        for end, answer in (("ESC", {"CANCELLED"}), ("RET", {"FINISHED"})):
            self.tool, self.context = Tool(), FakeContext()
            self.assertEqual(self.tool.invoke(self.context, event("W", point, ctrl=True)), {"RUNNING_MODAL"})
            self.assertEqual(selected(other), set(other_hierarchy.faces(stops[start]).tolist()))
            self.assertEqual(selected(self.obj), set())
            self.assertEqual(self.send(end), answer)
            self.is_over()
            if end == "ESC":
                self.assertEqual((flags(self.obj), flags(other)), before)
        self.assertEqual(bpy.context.edit_object, other)
        self.assertEqual(selected(self.obj), set())
        self.assertEqual(part("parts.picks").get_pick(other).node, stops[start])

    def test_leaving_edit_mode_or_changing_the_mesh_ends_it(self):
        for change in (lambda: bpy.ops.object.mode_set(mode="OBJECT"), lambda: bpy.ops.mesh.delete(type="FACE"),
                       lambda: bpy.ops.mesh.select_mode(type="VERT")):
            self.start()
            point, _ = self.center_of_part()
            self.send("LEFTMOUSE", point)
            change()
            self.assertEqual(self.send("WHEELUPMOUSE", point), {"CANCELLED"})
            self.assertEqual(self.tool.reports[-1][0], {"WARNING"})
            self.is_over()
            self.setUp()

    def test_extend_adds(self):
        self.start()
        point, face = self.center_of_part()
        self.send("ESC")
        bm = bmesh.from_edit_mesh(self.obj.data)
        bm.faces.ensure_lookup_table()
        stops, start = self.h.wheel(face)
        outside = next(index for index in range(2390) if index not in self.h.faces(stops[start + 1]))
        bm.faces[outside].select_set(True)
        self.tool, self.context = Tool(extend=True), FakeContext()
        self.tool.invoke(self.context, event("W", point, ctrl=True))
        self.send("WHEELUPMOUSE", point)
        self.assertEqual(selected(self.obj), {outside, *self.h.faces(stops[start + 1]).tolist()})
        self.send("WHEELDOWNMOUSE", point)
        self.assertEqual(selected(self.obj), {outside, *self.h.faces(stops[start]).tolist()})


class HeldWorkers(ToolTest):
    """No worker gets on before the gate is opened."""

    def setUp(self):
        super().setUp()
        self.gate = Gate(package("worker.job"))
        self.addCleanup(self.gate.remove)
        self.addCleanup(part("parts.files").on_load)


class WhileBuilding(HeldWorkers):
    """The first use: a worker process builds, Blender's own work goes on, then the face that was clicked is picked."""

    def begin(self, name="hand", over=True):
        """Starts the tool over a face of a mesh without a hierarchy, or beside the mesh."""
        self.start(name, build=False)
        self.send("ESC")
        part("parts.files").on_load()
        self.tool, self.context = Tool(), FakeContext()
        point, self.face = self.center_of_part() if over else ((1, 1), None)
        self.before = flags(self.obj)
        self.assertEqual(self.tool.invoke(self.context, event("W", point, ctrl=True)), {"RUNNING_MODAL"})
        self.assertTrue(part("parts.builds").has_builds())
        self.assertEqual((len(self.context.handlers), len(self.context.timers)), (1, 1))
        self.assertIn("Esc", self.context.status[-1])
        self.job = self.tool.building.build.job

    def build_on(self):
        """The tool's answer to the first timer event after the build is over."""
        self.gate.open()
        until(lambda: self.job.poll() is None)
        return self.send("TIMER")

    def nothing_runs(self):
        self.assertFalse(part("parts.builds").has_builds())
        self.assertEqual(self.context.timers, [])
        self.assertIsNone(self.context.status[-1])
        self.assertFalse(alive(self.job.process_id))

    def test_moved_meanwhile(self):
        self.begin()
        bm = bmesh.from_edit_mesh(self.obj.data)
        bm.verts.ensure_lookup_table()
        bm.verts[0].co.x += 0.01
        self.assertEqual(self.build_on(), {"RUNNING_MODAL"})
        self.expect(self.face, 0)
        self.assertEqual(part("parts.registry").get_state(self.obj.data)[0], part("parts.registry").State.MOVED)

    def test_an_operator_that_makes_the_mesh_anew_wants_no_build_of_the_former(self):
        self.begin()
        part("parts.builds").cancel_outdated()
        self.assertTrue(part("parts.builds").has_builds())
        bm = bmesh.from_edit_mesh(self.obj.data)
        bm.verts.ensure_lookup_table()
        bm.verts[0].co.x += 0.01  # as a union with a wider blend has the same polygons, elsewhere
        part("parts.builds").cancel_outdated()
        self.assertEqual(self.build_on(), {"CANCELLED"})
        self.nothing_runs()

    def test_undone_meanwhile(self):
        for message, undo, expected in (("moved", 1, {"RUNNING_MODAL"}), ("subdivided", 1, {"CANCELLED"})):
            ToolTest.setUp(self)
            self.obj = self.add(*read_off("hand"))
            name = self.obj.name
            self.edit(self.obj)
            bpy.ops.ed.undo_push(message="before")
            if message == "moved":
                bpy.ops.transform.translate(value=(1, 0, 0))
            else:
                bpy.ops.mesh.select_all(action="SELECT")
                bpy.ops.mesh.subdivide()
            bpy.ops.ed.undo_push(message=message)
            self.tool, self.context = Tool(), FakeContext()
            self.assertEqual(self.tool.invoke(self.context, event("W", (1, 1))), {"RUNNING_MODAL"})
            self.job = self.tool.building.build.job
            bpy.ops.ed.undo()
            self.obj = bpy.data.objects[name]
            self.assertEqual(self.build_on(), expected)
            self.assertEqual(self.tool.modal(self.context, event("ESC")), {"CANCELLED"}) if expected == {
                "RUNNING_MODAL"} else self.nothing_runs()

    def test_deleted_meanwhile(self):
        self.begin()
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.meshes.remove(self.obj.data)
        self.assertEqual(self.build_on(), {"CANCELLED"})
        self.nothing_runs()
        self.assertIn("deleted", self.tool.reports[-1][1])
        self.assertFalse(part("parts.registry").list_entries())

    def test_blender_ends_the_tool(self):
        """Also a worker that would go on as soon as it is waited for ends with it."""
        self.begin()
        wait, self.job.wait = self.job.wait, lambda seconds: self.gate.open() or wait(seconds)
        self.tool.cancel(self.context)
        self.nothing_runs()
        self.assertIn("Canceled", self.tool.reports[-1][1])
        self.assertIsNone(part("parts.registry").get_hierarchy(self.obj))

    def test_disabling_the_add_on_kills_the_worker(self):
        self.begin()
        bpy.ops.preferences.addon_disable(module=common.MODULE)
        try:
            until(lambda: not alive(self.job.process_id))
        finally:
            bpy.ops.preferences.addon_enable(module=common.MODULE)

    def test_opening_a_file_kills_the_worker(self):
        self.begin()
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.wm.read_homefile(app_template="", use_empty=False)
        until(lambda: not alive(self.job.process_id))
        self.assertFalse(part("parts.builds").has_builds())


@only_in("newest")
class ManyMeshes(HeldWorkers):
    """More clicks than one while parts are being found, on the same mesh and on others."""

    def show_two(self, built=()):
        """Two meshes side by side, both in Edit Mode; those named have parts already."""
        self.hierarchies, self.objects = {}, []
        for side, name in ((-1, "hand"), (1, "homer")):
            obj = self.add(*read_off(name), name)
            show(obj)
            _, _, _, region_view = view()
            obj.matrix_world = (Matrix.Translation(region_view.view_rotation @ Vector((side, 0, 0))
                                                   * region_view.view_distance / 6) @ obj.matrix_world)
            self.hierarchies[obj] = self.hierarchy(obj)
            if name in built:
                self.gate.open()
                part("api").build(obj)
                self.gate.close()
            self.objects.append(obj)
        for obj in self.objects:
            obj.select_set(True)
        self.edit(self.objects[1])
        return self.objects

    def click(self, obj, nth=0, **properties):
        """A click of the toolbar's tool: (Tool with its context and the part that is meant, its answer)"""
        self.assertTrue(bpy.ops.mesh.partwheel_select.poll())  # else the click would be Blender's own
        self.obj, self.h = obj, self.hierarchies[obj]
        point, face = self.center_of_part(obj, levels=1 + nth)
        tool, context = Tool(tool=True, **properties), FakeContext()
        answer = tool.invoke(context, event("LEFTMOUSE", point))
        vars(tool).update(context=context, face=face)
        stops, start = self.h.wheel(face)
        tool.meant = set(self.h.faces(stops[start]).tolist())
        return tool, answer

    def tick(self, tool, kind="TIMER"):
        return tool.modal(tool.context, event(kind))

    def until_built(self, tool):
        """Opens the gate and waits for the answer; the tool has not received it yet."""
        self.gate.open()
        until(lambda: tool.building.build.job.poll() is None)

    def test_builds_queue(self):
        hand, homer = self.show_two()
        first, _ = self.click(hand)
        second, answer = self.click(homer)
        self.assertEqual(answer, {"RUNNING_MODAL"})
        self.assertTrue(first.building.build.job)
        self.assertIsNone(second.building.build.job)  # one worker at a time
        self.assertEqual(self.tick(second), {"PASS_THROUGH"})
        self.assertIn("those of hand", second.context.status[-1])
        self.gate.open()
        until(lambda: first.building.build.job.poll() is None)
        self.assertEqual(self.tick(second), {"PASS_THROUGH"})
        self.assertTrue(second.building.build.job)
        until(lambda: second.building.build.poll() is None)
        self.assertEqual((self.tick(first), self.tick(second)), ({"CANCELLED"}, {"RUNNING_MODAL"}))
        self.assertEqual((selected(hand), selected(homer)), (set(), second.meant))
        for obj in (hand, homer):
            self.assertEqual(part("parts.registry").get_hierarchy(obj).save(), self.hierarchies[obj].save())
        self.assertFalse(part("parts.builds").has_builds())

    def test_escape_takes_the_one_that_waits_out_of_the_queue(self):
        hand, homer = self.show_two()
        first, _ = self.click(hand)
        second, _ = self.click(homer)
        self.assertEqual(self.tick(second, "ESC"), {"CANCELLED"})
        self.assertIsNone(second.building.build.job)
        self.assertEqual(self.tick(first), {"PASS_THROUGH"})
        self.until_built(first)
        self.tick(first)
        self.assertIsNotNone(part("parts.registry").get_hierarchy(hand))
        self.assertIsNone(part("parts.registry").get_hierarchy(homer))
        self.assertFalse(part("parts.builds").has_builds())

    def test_escape_lets_the_next_one_begin(self):
        hand, homer = self.show_two()
        first, _ = self.click(hand)
        second, _ = self.click(homer)
        self.assertEqual(self.tick(first, "ESC"), {"CANCELLED"})
        self.assertEqual(self.tick(second), {"PASS_THROUGH"})
        self.assertTrue(second.building.build.job)

    def test_a_second_click_on_the_same_mesh_joins(self):
        hand, _ = self.show_two()
        first, _ = self.click(hand)
        second, answer = self.click(hand, 1)
        self.assertEqual(answer, {"RUNNING_MODAL"})
        self.assertIs(second.building.build, first.building.build)
        self.assertNotEqual(second.face, first.face)
        self.assertEqual(self.tick(second), {"PASS_THROUGH"})
        self.assertEqual((self.tick(first), first.reports), ({"CANCELLED"}, []))  # the second goes on alone
        self.assertEqual(first.context.timers, [])
        self.until_built(second)
        self.assertEqual(self.tick(second), {"RUNNING_MODAL"})
        self.assertEqual(selected(hand), second.meant)

    def test_an_edited_mesh_is_no_longer_the_same(self):
        hand, _ = self.show_two()
        first, _ = self.click(hand)
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.subdivide()
        second = part("parts.builds").request_build(hand)
        self.assertIsNot(second, first.building.build)
        self.assertEqual(self.tick(first), {"CANCELLED"})
        self.assertTrue(second.job)

    def test_parts_found_anew_while_one_of_the_old_is_held(self):
        _, homer = self.show_two(built=["homer"])
        tool, _ = self.click(homer)
        self.gate.open()
        part("api").build(homer, quality=1.4)
        self.assertEqual(self.tick(tool, "WHEELUPMOUSE"), {"CANCELLED"})
        self.assertEqual(tool.reports[-1][0], {"WARNING"})

    def test_a_click_while_parts_are_found_anew_waits_for_them(self):
        _, homer = self.show_two(built=["homer"])
        old = part("parts.registry").get_hierarchy(homer)
        part("parts.builds").request_build(homer, quality=1.4)
        tool, answer = self.click(homer)
        self.assertEqual((answer, selected(homer)), ({"RUNNING_MODAL"}, set()))
        self.until_built(tool)
        self.assertEqual(self.tick(tool), {"RUNNING_MODAL"})
        self.assertIsNot(tool.hierarchy, old)
        self.assertGreater(len(tool.hierarchy.tetrahedra), len(old.tetrahedra))
        self.assertTrue(selected(homer))

    def test_scripts_wait_for_their_turn(self):
        hand, homer = self.show_two()
        tool, _ = self.click(hand)
        self.gate.open()
        self.assertEqual(part("api").build(homer).save(), self.hierarchies[homer].save())
        until(lambda: tool.building.build.poll() is None)
        self.assertEqual((self.tick(tool), selected(hand)), ({"RUNNING_MODAL"}, tool.meant))

    def test_a_script_that_wants_other_parts_of_the_same_mesh_has_its_way(self):
        hand, _ = self.show_two()
        tool, _ = self.click(hand)
        self.gate.open()
        finer = part("api").build(hand, quality=1.4)
        self.assertEqual(self.tick(tool), {"CANCELLED"})
        self.assertIs(part("parts.registry").get_hierarchy(hand), finer)
        self.assertGreater(len(finer.tetrahedra), len(self.hierarchies[hand].tetrahedra))
        self.assertFalse(part("parts.builds").has_builds())

    # ---- Esc, and the answer in the same moment

    def test_escape_while_a_script_has_had_the_answer(self):
        hand, _ = self.show_two()
        tool, _ = self.click(hand)
        self.gate.open()
        self.assertIsNotNone(part("api").hierarchy(hand))  # waits for the tool's build
        self.assertEqual(self.tick(tool, "ESC"), {"CANCELLED"})
        self.assertEqual(selected(hand), set())


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
                    tree, shown, hits = part("view.picking").FaceRayCaster(obj), self.triangles(obj, hidden), 0
                    for x in range(1, 6):
                        for y in range(1, 6):
                            point = region.width * x // 6, region.height * y // 6
                            hit = tree.cast(obj.matrix_world, region, region_view, point)
                            ray = (region_2d_to_origin_3d(region, region_view, point),
                                   region_2d_to_vector_3d(region, region_view, point))
                            expected, close = (self.nearest(*shown, *ray, margin) for margin in (1e-4, -1e-4))
                            if expected != close:
                                continue  # on a side of a triangle, to the rounding of single precision
                            if expected is None:
                                self.assertIsNone(hit)
                                continue
                            hits += 1
                            self.assertEqual(hit[0], expected[1])
                            self.assertAlmostEqual(hit[1] / expected[0], 1, 3)
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
