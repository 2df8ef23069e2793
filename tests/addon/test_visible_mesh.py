# SPDX-License-Identifier: GPL-3.0-or-later
"""Picking what is seen: meshes under modifiers, poses, sculpted levels; what a 3D view does not show is not picked."""

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from common import MeshTest, part, read_off, snapshot
from mathutils import Vector
from test_modal import FakeContext, Tool, camera, event, show


def positions(mesh):
    values = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


class VisibleMesh(MeshTest):
    def sphere(self):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=12, calc_uvs=False)
        return bpy.context.active_object

    def modified(self, kind, **settings):
        """A sphere with this modifier."""
        obj = self.sphere()
        modifier = obj.modifiers.new(kind, kind)
        for name, value in settings.items():
            setattr(modifier, name, value)
        bpy.context.view_layer.update()
        return obj

    def tagged(self, obj):
        """Writes each face's number into the UV map, which modifiers carry along in a way of their own."""
        layer = obj.data.uv_layers.new(name="number")
        numbers = np.repeat(np.arange(len(obj.data.polygons)), [face.loop_total for face in obj.data.polygons])
        layer.data.foreach_set("uv", np.column_stack([numbers, numbers]).astype(np.float32).ravel())
        obj.data.update()
        bpy.context.view_layer.update()

    def numbers(self, obj):
        """(positions, triangles, the tag of each triangle) of what is evaluated; -1: of none, or of several."""
        mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
        mesh.calc_loop_triangles()
        tags = np.array([value.uv[0] for value in mesh.uv_layers["number"].data])
        corners = np.array([triangle.loops[:] for triangle in mesh.loop_triangles])
        same = (tags[corners] == tags[corners[:, :1]]).all(axis=1)
        return (positions(mesh).copy(), np.array([triangle.vertices[:] for triangle in mesh.loop_triangles]),
                np.where(same, tags[corners[:, 0]], -1).astype(int))

    def test_visible_triangles_map_to_source_faces(self):
        """Under modifiers of all sorts, by tags that are not ours."""
        for kind, settings in (("DISPLACE", {"strength": 100, "direction": "Z"}), ("SUBSURF", {"levels": 2}),
                               ("MIRROR", {"use_axis": (False, False, True)}), ("ARRAY", {}),
                               ("BUILD", {"frame_start": 0, "frame_duration": 2, "use_random_order": True}),
                               ("EDGE_SPLIT", {"split_angle": 0.1}),
                               ("SOLIDIFY", {"thickness": 0.1}), ("TRIANGULATE", {})):
            with self.subTest(kind):
                MeshTest.setUp(self)
                obj = self.modified(kind, **settings)
                self.tagged(obj)
                if kind == "SUBSURF":
                    obj.modifiers[0].uv_smooth = "NONE"
                    bpy.context.view_layer.update()
                places, triangles, tags = self.numbers(obj)
                result = part("view.visible_surface").compute_visible_surface(obj)
                np.testing.assert_array_equal(result.positions, places)
                np.testing.assert_array_equal(result.triangles, triangles)
                self.assertGreater((tags >= 0).mean(), 0.85)
                np.testing.assert_array_equal(result.faces[tags >= 0], tags[tags >= 0])

    def replaced(self):
        """A sphere whose modifier shows a cube of size 6 instead."""
        obj = self.sphere()
        nodes = bpy.data.node_groups.new("cube", "GeometryNodeTree")
        if hasattr(nodes, "interface"):
            nodes.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        else:
            nodes.outputs.new("NodeSocketGeometry", "Geometry")
        cube = nodes.nodes.new("GeometryNodeMeshCube")
        cube.inputs["Size"].default_value = 6, 6, 6
        nodes.links.new(cube.outputs[0], nodes.nodes.new("NodeGroupOutput").inputs[0])
        obj.modifiers.new("nodes", "NODES").node_group = nodes
        bpy.context.view_layer.update()
        return obj

    def test_a_click_on_a_generated_face_is_reported(self):
        obj = self.replaced()
        self.assertEqual(set(part("view.visible_surface").compute_visible_surface(obj).faces), {part("view.visible_surface").NO_FACE})
        bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
        show(obj)
        tool = Tool("paint", write="AUTO")
        self.assertIsNone(tool._find_face(FakeContext(), event("LEFTMOUSE")))
        self.assertIn("belongs to no face", tool.reports[-1][1])
        bpy.ops.object.mode_set(mode="OBJECT")
        obj.modifiers.clear()
        bpy.context.view_layer.update()
        bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
        self.assertEqual(tool._find_face(FakeContext(), event("LEFTMOUSE")).obj, obj)

    def test_computing_the_visible_surface_changes_no_data(self):
        obj = self.modified("SUBSURF", levels=2)
        for name in ("Basis", "smile"):
            obj.shape_key_add(name=name)
        settings = bpy.context.scene.tool_settings.sculpt
        self.addCleanup(setattr, settings, "use_deform_only", settings.use_deform_only)
        self.addCleanup(bpy.ops.object.mode_set, mode="OBJECT")
        settings.use_deform_only = False  # or Sculpt Mode would not subdivide it
        for mode in ("WEIGHT_PAINT", "SCULPT", "OBJECT"):
            bpy.ops.object.mode_set(mode=mode)
            before = self.everything(obj)
            self.assertGreater(len(part("view.visible_surface").compute_visible_surface(obj).faces), 1000)
            self.assertEqual(self.everything(obj), before)
            self.looked_at_once(obj)

    def looked_at_once(self, obj):
        """To look is no change, upon which it would be looked at again, and so on for ever."""
        prepared = part("pick.view_cache").get_view_cache
        prepared_cache = prepared(snapshot(obj))
        bpy.context.view_layer.update()
        self.assertIs(prepared(snapshot(obj)), prepared_cache)

    def everything(self, obj):
        collections = {name: [block.name_full for block in getattr(bpy.data, name)]
                       for name in ("objects", "meshes", "collections", "scenes", "shape_keys", "actions")}
        return (collections, obj.mode, bpy.context.view_layer.objects.active, bpy.context.selected_objects[:],
                [attribute.name for attribute in obj.data.attributes], bpy.data.is_dirty, obj.data.users,
                [(modifier.name, modifier.show_viewport) for modifier in obj.modifiers], bpy.context.scene.objects[:])

    def test_multires_as_it_is_sculpted(self):
        obj = self.modified("MULTIRES")
        for _ in range(2):
            bpy.ops.object.multires_subdivide(modifier="MULTIRES")
        multires = obj.modifiers[0]
        after = obj.modifiers.new("away", "DISPLACE")  # not shown in Sculpt Mode, as it comes after
        after.show_viewport = False
        expected = {}
        self.tagged(obj)
        for multires.levels in (1, 2):
            bpy.context.view_layer.update()
            expected[multires.levels] = self.numbers(obj)
        after.show_viewport, multires.levels = True, 0
        for multires.sculpt_levels in (1, 2):
            bpy.ops.object.mode_set(mode="SCULPT")
            bpy.context.view_layer.update()
            result = part("view.visible_surface").compute_visible_surface(obj)
            places, triangles, tags = expected[multires.sculpt_levels]
            np.testing.assert_allclose(result.positions, places, atol=1e-6)
            np.testing.assert_array_equal(result.triangles, triangles)
            np.testing.assert_array_equal(result.faces[tags >= 0], tags[tags >= 0])
            self.looked_at_once(obj)
            bpy.ops.object.mode_set(mode="OBJECT")

    # ---- Picking and drawing

    def posed(self):
        """The hand, its upper half bent by a bone; in Weight Paint."""
        obj = self.add(*read_off("hand"))
        h = self.hierarchy(obj)
        self.assertEqual(bpy.ops.mesh.partwheel_build(), {"FINISHED"})
        low, high = positions(obj.data).min(axis=0), positions(obj.data).max(axis=0)
        armature = bpy.data.armatures.new("bones")
        self.addCleanup(lambda: bpy.data.armatures.remove(armature))
        bones = self.link(bpy.data.objects.new("bones", armature))
        bpy.ops.object.mode_set(mode="EDIT")
        bone = armature.edit_bones.new("upper")
        bone.head, bone.tail = Vector((low + high) / 2), Vector((low + high) / 2) + Vector((0, 0, 1))
        bpy.ops.object.mode_set(mode="OBJECT")
        group = obj.vertex_groups.new(name="upper")
        middle = (low + high)[1] / 2
        group.add([vertex.index for vertex in obj.data.vertices if vertex.co.y > middle], 1, "REPLACE")
        obj.modifiers.new("armature", "ARMATURE").object = bones
        bones.pose.bones["upper"].location = (0, 0, 2 * (high - low).max())
        bpy.context.view_layer.objects.active = obj
        bpy.context.view_layer.update()
        bpy.ops.object.mode_set(mode="WEIGHT_PAINT")
        return obj, h, bones

    def test_a_posed_hand_is_picked_and_drawn_where_it_is(self):
        obj, h, bones = self.posed()
        prepared = part("pick.view_cache").get_view_cache
        evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
        places = positions(evaluated.to_mesh()).copy()
        self.assertGreater(np.abs(places - positions(obj.data)).max(), 1)
        for perspective in (True, False):
            region, region_view = camera(evaluated, perspective)
            moved = [face.index for face in obj.data.polygons
                     if np.abs(places - positions(obj.data))[list(face.vertices)].min(axis=0).max() > 1][::7]
            right = sum(face == self.face_at(obj, places, face, region, region_view) for face in moved)
            self.assertGreater(right, len(moved) / 4)  # those that are turned to the camera and not behind others
        node = h.wheel(700)[0][3]
        parts = prepared(snapshot(obj)).get_part_triangles(snapshot(obj))
        np.testing.assert_array_equal(parts.positions, places)
        begin, end = parts.slice(node)
        drawn = {tuple(sorted(triangle)) for triangle in parts.triangles[begin:end].tolist()}
        own = {tuple(sorted(obj.data.polygons[face].vertices)) for face in h.faces(node)}
        self.assertEqual(drawn, own)
        # Kept as long as nothing has moved.
        prepared_cache = prepared(snapshot(obj))
        bpy.context.view_layer.update()
        self.assertIs(prepared(snapshot(obj)), prepared_cache)
        bones.pose.bones["upper"].location = (0, 0, 0)
        bpy.context.view_layer.update()
        self.assertIsNot(prepared(snapshot(obj)), prepared_cache)
        np.testing.assert_allclose(prepared(snapshot(obj)).get_part_triangles(snapshot(obj)).positions, positions(obj.data), atol=1e-4)

    def face_at(self, obj, places, face, region, region_view):
        """The face picked at the pixel of a face's middle."""
        middle = obj.matrix_world @ Vector(places[list(obj.data.polygons[face].vertices)].mean(axis=0))
        point = location_3d_to_region_2d(region, region_view, middle)
        result = part("pick.view_cache").get_view_cache(snapshot(obj)).get_ray_caster().cast(obj, obj.matrix_world, region, region_view, point)
        return result and result.face
