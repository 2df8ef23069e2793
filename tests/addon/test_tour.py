# SPDX-License-Identifier: GPL-3.0-or-later
"""The two-minute tour opens its models in a scene of their own and leaves the user's scene as it is."""

import bpy
import numpy
from common import BOX, MeshTest, part


class Tour(MeshTest):
    def tearDown(self):
        own = next(scene for scene in bpy.data.scenes if not scene.name.startswith("Partwheel Tour"))
        if bpy.context.window:
            bpy.context.window.scene = own
        for scene in [scene for scene in bpy.data.scenes if scene != own]:
            bpy.data.scenes.remove(scene)
        super().tearDown()

    def test_the_own_scene_stays_and_each_model_has_what_it_needs(self):
        obj = self.add(*BOX, "own")
        own = bpy.context.scene.name
        bpy.ops.wm.partwheel_tour()
        scene = bpy.data.scenes["Partwheel Tour"]
        self.assertEqual(bpy.context.window.scene, scene)
        self.assertEqual([other.name for other in bpy.data.scenes[own].objects], ["own"])
        self.assertTrue(obj.select_get(view_layer=bpy.data.scenes[own].view_layers[0]))
        models = {other["partwheel_tour"]: other for other in scene.objects}
        self.assertEqual(set(models), {"Figure", "Truck", "Chair"})
        mesh = models["Figure"].data
        image, = (node.image for node in mesh.materials[0].node_tree.nodes if node.type == "TEX_IMAGE")
        self.assertTrue(image.packed_file and mesh.uv_layers)
        indices = numpy.empty(len(models["Truck"].data.polygons), numpy.int32)
        models["Truck"].data.polygons.foreach_get("material_index", indices)
        self.assertEqual(len(set(indices)), len(models["Truck"].data.materials))
        for model in models.values():
            self.assertFalse(model.data.validate())
        bpy.ops.wm.partwheel_tour(model="Truck")
        self.assertEqual((len(bpy.data.scenes), bpy.context.view_layer.objects.active), (2, models["Truck"]))
        self.assertEqual([other.name for other in bpy.context.view_layer.objects if other.select_get()], ["Truck"])
        bpy.ops.wm.partwheel_tour_back()
        self.assertEqual(bpy.context.window.scene.name, own)

    def test_each_step_names_what_is_there(self):
        """Menu entries and options in the texts exist."""
        steps = " ".join(step for _, _, steps in part("ui.tour").MODELS.values() for step in steps)
        for operator, name in ((bpy.ops.mesh.partwheel_parts, "Parts to..."), (bpy.ops.mesh.partwheel_convex, "Convex Parts")):
            self.assertIn(operator.get_rna_type().name, steps)
            self.assertIn(name, steps)
        self.assertIn(bpy.ops.mesh.partwheel_parts.get_rna_type().properties["explode"].name, steps)
