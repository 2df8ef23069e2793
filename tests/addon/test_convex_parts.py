# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator Convex Parts: hulls for engines, as children; and as the shape of a body that Blender lets fall."""

import math

import bmesh
import bpy
import numpy as np
from common import BOX, MeshTest, only_in, part, read_off
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree

# A gate, seen from the front: two posts and a beam across that is longer.
GATE = (0, 0), (1, 0), (1, 3), (3, 3), (3, 0), (4, 0), (4, 3), (5, 3), (5, 4), (-1, 4), (-1, 3), (0, 3)


def gate():
    """(vertices, polygons), a unit deep."""
    count = len(GATE)
    vertices = [(x, y, z) for y in (0, 1) for x, z in GATE]
    sides = [(i, (i + 1) % count, (i + 1) % count + count, i + count) for i in range(count)]
    return vertices, [tuple(range(count))[::-1], tuple(range(count, 2 * count)), *(side for side in sides)]


def places(obj):
    """(V,3) of its mesh, where Blender has the object at this frame."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([evaluated.matrix_world @ vertex.co for vertex in obj.data.vertices])


class ConvexParts(MeshTest):
    def setUp(self):
        super().setUp()
        self.collections = set(bpy.data.collections)

    def tearDown(self):
        if bpy.context.scene.rigidbody_world:
            bpy.ops.rigidbody.world_remove()
        bpy.context.scene.frame_set(1)
        for collection in set(bpy.data.collections) - self.collections:
            bpy.data.collections.remove(collection)
        super().tearDown()

    def everything(self):
        return sorted([block.name for kind in (bpy.data.objects, bpy.data.meshes, bpy.data.collections) for block in kind]
                      + [str(bool(bpy.context.scene.rigidbody_world))])

    @only_in("newest")
    def test_children_that_hold_the_mesh_by_each_engines_names(self):
        obj = self.add(*read_off("hand"), "Right Hand")
        obj.location, obj.scale = (1, 2, 3), (2, 2, 2)
        for engine, first in (("UNREAL", "UCX_Right Hand_00"), ("GODOT", "Right Hand_00-convcolonly"),
                              ("UNITY", "Right Hand_collider_00"), ("RIGID_BODY", "Right Hand_hull_00")):
            with self.subTest(engine):
                self.assertEqual(bpy.ops.mesh.partwheel_convex(hulls=7, vertices=32, engine=engine), {"FINISHED"})
                # Those of the other engine have gone, and all are where they were.
                self.assertEqual([child.name for child in obj.children],
                                 [first.replace("00", f"{number:02}") for number in range(7)])
                self.assertEqual([len(collection.objects) for collection in set(bpy.data.collections) - self.collections
                                  if "hulls" in collection.name], [7])
                self.assertEqual(len(bpy.data.meshes), 8)
                self.assertEqual((bpy.context.active_object, bpy.context.selected_objects), (obj, [obj]))
                bpy.context.view_layer.update()
                for child in obj.children:
                    self.assertEqual(child.matrix_world, obj.matrix_world)
                    self.assertLessEqual(len(child.data.vertices), 32)
                self.assertLess(self.farthest_outside(obj), 1e-5 * max(obj.dimensions) / 2)

    def farthest_outside(self, obj):
        """The largest distance of a vertex from the hulls."""
        trees = [BVHTree.FromObject(child, bpy.context.evaluated_depsgraph_get()) for child in obj.children]
        distances = []
        for vertex in obj.data.vertices:
            outside = []
            for tree in trees:
                near, normal, _, distance = tree.find_nearest(vertex.co)
                outside.append(distance if (vertex.co - near).dot(normal) > 0 else 0)
            distances.append(min(outside))
        return max(distances)

    @only_in("newest")
    def test_the_error_is_a_share_of_the_diagonal(self):
        obj = self.add(*read_off("hand"))
        diagonal = Vector(np.ptp([vertex.co[:] for vertex in obj.data.vertices], axis=0)).length
        counts = []
        for share in (10, 3):
            bpy.ops.mesh.partwheel_convex(by="ERROR", error=share)
            hull_points = [sorted(vertex.co[:] for vertex in child.data.vertices) for child in obj.children]
            again = part("api").convex(obj, error=share / 100 * diagonal, max_vertices=64)
            counts.append(len(again))
            for one, other in zip(hull_points, again):
                np.testing.assert_allclose(one, sorted(vertex.co[:] for vertex in other.data.vertices), rtol=1e-5)
        self.assertLess(counts[0], counts[1])

    @only_in("newest")
    def test_hulls_of_one_part_replace_only_its_own(self):
        obj = self.add(*read_off("hand"), "hand")
        hierarchy = part("api").build(obj)
        volume = hierarchy.volume
        node = max(np.flatnonzero(volume < 0.5 * volume.max()), key=lambda number: volume[number])
        bpy.ops.mesh.partwheel_convex(hulls=6)
        counts = []
        for error in (10, 1):
            bpy.ops.mesh.partwheel_convex_part(node=int(node), by="ERROR", error=error)
            own = [child for child in obj.children if isinstance(child["partwheel_hull"], str)]
            counts.append(len(own))
            self.assertLessEqual(len(obj.children) - len(own), 6)
            self.assertEqual(len({child.name for child in obj.children}), len(obj.children))
            self.assertLess(self.farthest_outside(obj), 1e-5 * max(obj.dimensions))
        self.assertLess(counts[0], counts[1])
        bpy.ops.mesh.partwheel_convex_part(node=int(node), hulls=1)
        self.assertEqual(sum(isinstance(child["partwheel_hull"], str) for child in obj.children), 1)
        self.assertEqual(sorted(child.name for child in obj.children),
                         [f"UCX_hand_{number:02}" for number in range(len(obj.children))])
        bpy.ops.mesh.partwheel_convex(hulls=6)
        self.assertEqual(len(obj.children), 6)
        selected = np.zeros(len(obj.data.polygons), bool)  # the part as selected faces
        selected[hierarchy.faces(int(node))] = True
        obj.data.polygons.foreach_set("select", selected)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.partwheel_convex_part(hulls=1)
        self.assertEqual(sum(isinstance(child["partwheel_hull"], str) for child in obj.children), 1)

    def test_checks_before_export(self):
        obj = self.add(*gate(), "gate")
        bpy.ops.mesh.partwheel_convex(hulls=3)
        check = part("cut.hull_checks").check_hulls

        def problems():
            bpy.context.view_layer.update()
            return check(obj)
        self.assertEqual(problems(), [])
        parent = self.add(*BOX, "parent")
        obj.parent = parent
        for scale, words in (((-1, 1, 1), "mirrored"), ((1, 2, 1), "differs between axes"), ((2, 2, 2), "not 1")):
            for scaled in (obj, parent):  # its own scale, and that of its parent
                scaled.scale = scale
                self.assertEqual([words in problem for problem in problems()], [True])
                scaled.scale = 1, 1, 1
        parent.scale, obj.rotation_euler.z = (2, 1, 2.5 ** 0.5), math.pi / 4  # sheared; all axes have the same length
        self.assertEqual(["differs between axes" in problem for problem in problems()], [True])
        parent.scale, obj.rotation_euler.z = (1, 1, 1), 0
        hull = obj.children[0]
        hull.data.flip_normals()
        self.assertIn("inward", problems()[0])
        hull.data.flip_normals()
        hull.data.vertices[0].co = np.mean([vertex.co for vertex in hull.data.vertices], axis=0)
        self.assertTrue(any("not convex" in problem for problem in problems()))
        for vertex in hull.data.vertices:
            vertex.co.z = 0
        self.assertTrue(any("flat" in problem for problem in problems()))
        ball = bmesh.new()
        bmesh.ops.create_uvsphere(ball, u_segments=20, v_segments=16, radius=1)
        ball.to_mesh(obj.children[1].data)
        ball.free()
        self.assertTrue(any("more than 255 vertices" in problem for problem in problems()))
        obj.name = "door"
        self.assertEqual(sum("is not that of a hull of door" in problem for problem in problems()), 3)

    def test_hulls_with_slivers_pass_the_checks(self):
        for name in ("hand", "bear"):
            obj = self.add(*read_off(name), name)
            bpy.ops.mesh.partwheel_convex(hulls=16)
            self.assertEqual(part("cut.hull_checks").check_hulls(obj), [])

    def test_hulls_that_leave_the_model_by_more_than_their_tolerance(self):
        obj = self.add(*gate(), "gate")
        check = part("cut.hull_checks").check_hulls
        part("api").convex(obj, error=0.1)
        self.assertEqual(check(obj), [])
        hull = obj.children[0]
        for vertex in hull.data.vertices:
            vertex.co.y += 0.5 * (vertex.co.y > 0.5)
        hull.data.update()
        bpy.context.view_layer.update()
        self.assertEqual(check(obj), [f"{hull.name} leaves gate by 0.5, more than 0.1. Create the hulls again."])
        part("api").convex(obj, 1)  # no tolerance
        self.assertEqual(check(obj), [])

    def test_hulls_for_each_material_face_set_or_loose_part(self):
        vertices, polygons = gate()
        box = [(x + 7, y, z) for x, y, z in BOX[0]]
        obj = self.add(vertices + box, polygons + [tuple(i + len(vertices) for i in polygon) for polygon in BOX[1]], "gate")
        count = len(polygons)
        for material in "stone", "wood":
            obj.data.materials.append(bpy.data.materials.new(material))
        indices = np.arange(len(obj.data.polygons)) >= count
        obj.data.polygons.foreach_set("material_index", indices.astype(np.int32))
        for each, expected in (("MATERIALS", 4), ("LOOSE", 4), ("MODEL", 3)):
            with self.subTest(each):
                self.assertEqual(bpy.ops.mesh.partwheel_convex(hulls=3, each=each), {"FINISHED"})
                self.assertEqual(len(obj.children), expected)
                self.assertLess(self.farthest_outside(obj), 1e-5)
        with self.assertRaisesRegex(RuntimeError, "no Face Sets"):
            bpy.ops.mesh.partwheel_convex(hulls=3, each="FACE_SETS")

    def test_where_shells_overlap_their_volume_counts_once(self):
        vertices, polygons = np.array(BOX[0]), BOX[1]
        inner = vertices.mean(axis=0) + 0.9 * (vertices - vertices.mean(axis=0))
        obj = self.add([*vertices, *inner], [*polygons, *([v + 8 for v in polygon] for polygon in polygons)], "boxes")
        parts = part("api").build(obj).convex_parts(1)
        self.assertAlmostEqual(part("cut.hulls").volume_ratio(parts), 1)

    @only_in("newest")
    def test_a_refusal_changes_nothing(self):
        obj = self.add(*read_off("hand"), "hand")
        bpy.ops.mesh.partwheel_convex(hulls=3)
        other = self.add(*BOX, "UCX_hand_04")
        bpy.context.view_layer.objects.active = obj
        before = self.everything()
        with self.assertRaisesRegex(RuntimeError, "UCX_hand_04"):
            bpy.ops.mesh.partwheel_convex(hulls=6)
        self.assertEqual(self.everything(), before)
        other.name = "a box"
        obj.name = "h" * (bpy.types.ID.bl_rna.properties["name"].length_max - 5)
        before = self.everything()
        with self.assertRaisesRegex(RuntimeError, "too long"):
            bpy.ops.mesh.partwheel_convex(hulls=6)
        self.assertEqual(self.everything(), before)
        line = self.add([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)], "line")
        before = self.everything()
        with self.assertRaisesRegex(RuntimeError, "no area"):
            bpy.ops.mesh.partwheel_convex()
        self.assertEqual((self.everything(), bpy.context.active_object), (before, line))
        for child in obj.children:
            bpy.data.objects.remove(child)
        obj.name = "hand"
        far = self.linked(obj)
        before = self.everything()
        with self.assertRaisesRegex(RuntimeError, "linked"):
            bpy.ops.mesh.partwheel_convex(engine="RIGID_BODY")
        self.assertEqual(self.everything(), before)
        bpy.ops.mesh.partwheel_convex(engine="UNREAL", hulls=3)
        self.assertEqual([child.name for child in far.children], [f"UCX_hand_{number:02}" for number in range(3)])

    # ---- Falling

    def fall(self, frames=400):
        """Each object's places at the end."""
        scene = bpy.context.scene
        floor = self.add([(100 * x, 100 * y, z) for x, y, z in np.array(BOX[0]) - 0.5], BOX[1], "floor")
        floor.location.z = -0.5
        self.passive(floor)
        scene.rigidbody_world.point_cache.frame_end = frames
        for frame in range(1, frames + 1):
            scene.frame_set(frame)

    def passive(self, obj):
        bpy.context.view_layer.update()
        bpy.context.scene.rigidbody_world.collection.objects.link(obj)
        obj.rigid_body.type, obj.rigid_body.collision_shape = "PASSIVE", "BOX"

    def test_a_gate_with_hulls_falls_over_a_post(self):
        self.gate_falls(["CONVEX_HULL"] * 3, 0)

    def gate_falls(self, shapes, primitives):
        obj = self.add(*gate(), "gate")
        obj.data.transform(Matrix.Translation((-2, -0.5, -2)))
        obj.location.z = 5
        bpy.ops.mesh.partwheel_convex(hulls=3, engine="RIGID_BODY", primitives=primitives)
        self.assertEqual([child.rigid_body.collision_shape for child in obj.children], shapes)
        self.assertEqual((obj.rigid_body.type, obj.rigid_body.collision_shape), ("ACTIVE", "COMPOUND"))
        post = self.add(np.array(BOX[0]) - 0.5, BOX[1], "post")
        post.location.z = 0.5
        self.passive(post)
        self.fall(150)
        now = places(obj)
        self.assertLess(abs(now[:, 2].min()), 0.01)  # it stands on the floor; its hull would on the post
        self.assertLess(abs(now[:, 2].max() - 4), 0.01)
        for child in obj.children:
            self.assertGreater(places(child)[:, 2].min(), -0.01)  # they have gone with it
