# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen is that of the current frame: Blender evaluates meshes anew without depsgraph_update_post."""

import tempfile

import bpy
import numpy as np
from common import MeshTest, part, read_off, snapshot
from mathutils import Vector


def evaluated(obj):
    """(V,3) where Blender shows the object's vertices."""
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return np.array([vertex.co[:] for vertex in mesh.vertices], np.float32)


class Frames(MeshTest):
    """Each way of moving the mesh takes it up to 8 of its sizes along X by frame 9."""

    def setUp(self):
        super().setUp()
        bpy.context.scene.frame_set(1)
        self.obj = self.add(*read_off("cross_quad"))
        self.far = 8 * float(np.ptp(evaluated(self.obj), axis=0).max())

    def tearDown(self):
        bpy.context.scene.frame_set(1)
        for data in (bpy.data.armatures, bpy.data.actions, bpy.data.node_groups):
            for block in list(data):
                data.remove(block)
        super().tearDown()

    def animate(self, owner, path, first, last, index=-1):
        for frame, value in ((1, first), (9, last)):
            owner_id, name = owner, path
            setattr(owner_id, name, value) if index < 0 else getattr(owner_id, name).__setitem__(index, value)
            owner.keyframe_insert(path, index=index, frame=frame)

    # ---- What moves it

    def by_armature(self):
        armature = bpy.data.armatures.new("bones")
        bones = self.link(bpy.data.objects.new("bones", armature))
        bpy.ops.object.mode_set(mode="EDIT")
        armature.edit_bones.new("all").tail = Vector((0, 0, 1))
        bpy.ops.object.mode_set(mode="OBJECT")
        group = self.obj.vertex_groups.new(name="all")
        group.add(range(len(self.obj.data.vertices)), 1, "REPLACE")
        self.obj.modifiers.new("bones", "ARMATURE").object = bones
        bones.pose.bones["all"].bone.use_local_location = False
        self.animate(bones.pose.bones["all"], "location", 0.0, self.far, 0)
        bpy.context.view_layer.objects.active = self.obj

    def by_shape_key(self):
        self.obj.shape_key_add(name="Basis")
        away = self.obj.shape_key_add(name="away")
        for point in away.data:
            point.co.x += self.far
        self.animate(away, "value", 0.0, 1.0)

    def by_modifier(self):
        modifier = self.obj.modifiers.new("away", "DISPLACE")
        modifier.direction, modifier.mid_level = "X", 0
        for frame, value in ((1, 0.0), (9, self.far)):
            modifier.strength = value
            modifier.keyframe_insert("strength", frame=frame)

    def by_driver(self):
        modifier = self.obj.modifiers.new("away", "DISPLACE")
        modifier.direction, modifier.mid_level = "X", 0
        modifier.driver_add("strength").driver.expression = f"(frame - 1) / 8 * {self.far}"

    def by_driver_of_a_modifier_in_object_mode_only(self):
        self.by_driver()
        self.obj.modifiers.new("more", "SUBSURF").levels = 1

    WAYS = by_armature, by_shape_key, by_modifier, by_driver, by_driver_of_a_modifier_in_object_mode_only

    def check(self, what):
        """What hovering, picking and the overlay use is what Blender shows, and a ray meets it there and not elsewhere."""
        shown = evaluated(self.obj)
        prepared = part("pick.view_cache").get_view_cache(snapshot(self.obj))
        np.testing.assert_allclose(prepared._surface.positions, shown, atol=1e-5, err_msg=what)
        target, middle = prepared.get_ray_caster()._target, (shown.min(axis=0) + shown.max(axis=0)) / 2
        self.assertIsNotNone(target.first_hit(middle + [0, 0, 10 * self.far], [0, 0, -1]), what)
        self.assertIsNone(target.first_hit(middle + [self.far, 0, 10 * self.far], [0, 0, -1]), what)
        if part("parts.registry").get_hierarchy(snapshot(self.obj)):
            self.assertTrue(part("pick.view_cache").is_current(self.obj, prepared.get_part_triangles(snapshot(self.obj))))

    def test_the_visible_surface_follows_every_kind_of_animation(self):
        for way in self.WAYS:
            for mode in ("OBJECT", "WEIGHT_PAINT"):
                with self.subTest(way.__name__, mode=mode):
                    self.tearDown()
                    self.setUp()
                    way(self)
                    bpy.ops.object.mode_set(mode=mode)
                    bpy.context.scene.frame_set(1)
                    self.check("frame 1")
                    first = evaluated(self.obj)
                    for frame in (9, 5, 1):
                        bpy.context.scene.frame_set(frame)
                        self.check(f"frame {frame}")
                        moved = evaluated(self.obj)[0, 0] - first[0, 0]
                        self.assertAlmostEqual(moved, (frame - 1) / 8 * self.far, delta=0.2 * self.far)
                    bpy.context.scene.frame_set(5, subframe=0.5)
                    self.check("between two frames")

    def test_changes_without_a_new_frame_update_the_visible_surface(self):
        """Each of them without a new frame; the armature's own mode shows its rest position."""
        self.by_armature()
        bones = self.obj.modifiers[0].object
        bpy.context.scene.frame_set(9)
        self.check("before")

        def armature_edited():
            bpy.context.view_layer.objects.active = bones
            bpy.ops.object.mode_set(mode="EDIT")

        def and_back():
            bpy.ops.object.mode_set(mode="OBJECT")
            bpy.context.view_layer.objects.active = self.obj

        def frame_without_set():
            bpy.context.scene.frame_current = 3

        def rest():
            bones.data.pose_position = "REST"

        def muted():
            self.obj.modifiers[0].show_viewport = False

        def while_hidden():
            self.obj.hide_viewport = True
            bpy.context.view_layer.update()
            bpy.context.scene.frame_set(7)
            self.obj.hide_viewport = False

        for change in (while_hidden, armature_edited, and_back, frame_without_set, rest, muted):
            change()
            bpy.context.view_layer.update()
            self.check(change.__name__)

    def test_frames_of_a_render_are_no_change(self):
        """A render evaluates its frames apart: meanwhile a 3D view shows the same as before."""
        self.by_modifier()
        scene, state = bpy.context.scene, part("mesh.mesh_state").get_mesh_state(self.obj.data)
        scene.camera = self.link(bpy.data.objects.new("camera", bpy.data.cameras.new("camera")))
        scene.render.engine, scene.cycles.samples = "CYCLES", 1
        scene.cycles.use_denoising = False  # Debian builds Blender without it
        scene.render.resolution_x = scene.render.resolution_y = 4
        scene.frame_start, scene.frame_end = 1, 2
        before, rendered = state.revision, []

        def record(_scene, depsgraph):
            if depsgraph.mode == "RENDER":
                rendered.append(state.revision)

        bpy.app.handlers.frame_change_post.append(record)  # behind the add-on's
        try:
            with tempfile.TemporaryDirectory() as folder:
                scene.render.filepath = f"{folder}/"
                bpy.ops.render.render(animation=True)
        finally:
            bpy.app.handlers.frame_change_post.remove(record)
        self.assertEqual(rendered, [before] * 2)
        self.check("after the render")
