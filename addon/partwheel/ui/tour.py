# SPDX-License-Identifier: GPL-3.0-or-later
"""The two-minute tour: three models in a scene of their own, and a panel that says what to do with each."""

import bpy
from mathutils import Euler, Vector
import numpy

from .. import library_error
from ..mesh import check_poll
from ..translations.lookup import iface_
from .panel import SidebarPanel
from partwheel.examples import Example, chair, figure, truck

SCENE = "Partwheel Tour"
# Properties of the scene: the scene before it, and how that was viewed.
BACK, BACK_VIEW = "partwheel_tour_back", "partwheel_tour_view"
VIEW_PROPERTIES = "view_perspective", "view_rotation", "view_location", "view_distance"
# Name of a model -> the function that makes it, its location, the view (x and z of Euler angles), its steps.
MODELS = {
    "Figure": (figure, (0, 0, 0), (1.36, 0.15), (
        "Point at a hand: the arm lights up, because a click selects it. Click.",
        "Turn the wheel down for the hand and a finger, up for the whole body. Shift click adds a part, Esc ends it.",
        "Press Parts to... below, then Enter: closed, textured objects.",
        "Open Parts to... at the bottom left and set Explode to 0.5: they move apart.")),
    "Truck": (truck, (2.2, 0, 0), (1.1, 0.5), (
        "Its 24 shells are one mesh. Click a wheel of the truck to select all of it.",
        "Turn the mouse wheel to add what belongs to it. Esc ends it.",
        "Press Parts to... and click the cargo. Turn the wheel down to split it, up to join it. Enter makes objects.")),
    "Chair": (chair, (3.9, 0, 0), (1.36, 0.15), (
        "Press Convex Parts below: hulls for a physics engine.",
        "Open Convex Parts at the bottom left and set For to your engine. With Rigid Body, Space lets it fall.")),
}


class WM_OT_partwheel_tour(bpy.types.Operator):
    """Open a new scene with three models to try Partwheel on. Your scenes stay as they are"""

    bl_idname = "wm.partwheel_tour"
    bl_label = "Two-Minute Tour"
    bl_options = {"REGISTER", "UNDO"}

    model: bpy.props.EnumProperty(name="Model", items=[(name, name, "") for name in MODELS], options={"SKIP_SAVE"})

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return check_poll(cls, context.mode == "OBJECT" and context.window, "Go to Object Mode first.")

    def execute(self, context: bpy.types.Context) -> set[str]:
        scene = bpy.data.scenes.get(SCENE)
        if scene is None:
            scene = bpy.data.scenes.new(SCENE)
            for name, (make, place, _, _) in MODELS.items():
                obj = create_object(make(), iface_(name))
                obj.location = place
                obj["partwheel_tour"] = name
                scene.collection.objects.link(obj)
        is_view = context.area and context.area.type == "VIEW_3D"
        if context.scene != scene:
            scene[BACK] = context.scene.name
            if is_view:
                scene[BACK_VIEW] = _read_view(context.space_data)
        context.window.scene = scene
        objects = [obj for obj in context.view_layer.objects if obj.get("partwheel_tour") == self.model]
        for obj in context.view_layer.objects:
            obj.select_set(obj in objects)
        if objects:
            context.view_layer.objects.active = objects[0]
        if is_view:
            _show(context, *MODELS[self.model][1:3])
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Runs execute() and finds the model's parts in the background, so that hover shows them."""
        result = self.execute(context)
        if bpy.ops.mesh.partwheel_imported.poll():
            bpy.ops.mesh.partwheel_imported("INVOKE_DEFAULT")
        return result


class WM_OT_partwheel_tour_back(bpy.types.Operator):
    """Return to your scene. The scene of the tour stays in the file until you delete it"""

    bl_idname = "wm.partwheel_tour_back"
    bl_label = "Back to My Scene"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return check_poll(cls, context.mode == "OBJECT" and _get_scene_before(context), "Go to Object Mode first.")

    def execute(self, context: bpy.types.Context) -> set[str]:
        view = context.scene.get(BACK_VIEW)
        context.window.scene = _get_scene_before(context)
        if view and context.area and context.area.type == "VIEW_3D":
            context.space_data.shading.color_type = view["color_type"]
            for name in VIEW_PROPERTIES:
                setattr(context.space_data.region_3d, name, view[name])
        return {"FINISHED"}


def _get_scene_before(context: bpy.types.Context) -> bpy.types.Scene | None:
    """The scene before the tour; if that is gone, any other; None if there is no other."""
    named = bpy.data.scenes.get(context.scene.get(BACK, ""))
    return named or next((scene for scene in bpy.data.scenes if scene != context.scene), None)


def _read_view(space: bpy.types.SpaceView3D) -> dict[str, object]:
    values = ((name, getattr(space.region_3d, name)) for name in VIEW_PROPERTIES)
    return {"color_type": space.shading.color_type,
            **{name: value if isinstance(value, (str, float)) else tuple(value) for name, value in values}}


def _show(context: bpy.types.Context, place: tuple[float, float, float], angles: tuple[float, float]) -> None:
    """Shows the model at the place and textures in the 3D view, and activates the tool."""
    space = context.space_data
    space.shading.color_type = "TEXTURE"
    view = space.region_3d
    view.view_perspective = "PERSP"
    view.view_rotation = Euler((angles[0], 0, angles[1])).to_quaternion()
    to_the_right = view.view_rotation @ Vector((0.6, 0, 0))  # the sidebar covers what is there
    view.view_location, view.view_distance = Vector((place[0], place[1], 0.8)) + to_the_right, 4.2
    bpy.ops.wm.tool_set_by_id(name="partwheel.select")


def create_object(example: Example, name: str) -> bpy.types.Object:
    """Return a new object, in no collection, with the example's UV map, texture and materials."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(example.vertices.tolist(), [], example.polygons)
    for material_name, color in example.materials.items():
        material = bpy.data.materials.new(iface_(material_name))
        material.diffuse_color = (*color, 1)
        material.use_nodes = True
        _get_shader(material).inputs["Base Color"].default_value = (*color, 1)
        mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", example.material_of_polygon)
    if example.texture is not None:
        mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", example.uvs.ravel())
        mesh.materials.append(_create_textured_material(name, example.texture))
    if not example.materials:
        mesh.polygons.foreach_set("use_smooth", numpy.ones(len(mesh.polygons), bool))
    mesh.update()
    return bpy.data.objects.new(name, mesh)


def _create_textured_material(name: str, texture: numpy.ndarray) -> bpy.types.Material:
    height, width, _ = texture.shape
    image = bpy.data.images.new(name, width, height)
    image.pixels.foreach_set(numpy.dstack([texture, numpy.ones((height, width), numpy.float32)]).ravel())
    image.update()
    image.pack()
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.links.new(node.outputs["Color"], _get_shader(material).inputs["Base Color"])
    material.node_tree.nodes.active = node  # the one that the 3D view shows
    return material


def _get_shader(material: bpy.types.Material) -> bpy.types.Node:
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")


class VIEW3D_PT_partwheel_tour(SidebarPanel, bpy.types.Panel):
    bl_label = "Tour"
    bl_order = 100  # below the commands

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene.name != SCENE and not library_error.find_library_error()

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.operator("wm.partwheel_tour", icon="PLAY")


class VIEW3D_PT_partwheel_tour_steps(SidebarPanel, bpy.types.Panel):
    bl_label = "Tour"
    bl_order = 0  # above the commands, so that all steps are visible in a small window

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.scene.name == SCENE and not library_error.find_library_error()

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        active = context.active_object.get("partwheel_tour") if context.active_object else None
        row = layout.row(align=True)
        for name in MODELS:
            row.operator("wm.partwheel_tour", text=name, depress=name == active).model = name
        for number, step in enumerate(MODELS[active][3] if active in MODELS else (), 1):
            library_error.draw_wrapped_text(context, layout.column(align=True), f"{number}. {iface_(step)}")
        layout.operator("wm.partwheel_tour_back", icon="LOOP_BACK")
