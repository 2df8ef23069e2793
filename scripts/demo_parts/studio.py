"""The demo's photo studio: a backdrop, lights and a camera around one model; renders images as layers.

Runs inside Blender. An image has three layers, which paint.py combines: the light at each pixel, the gloss, and the id
of the face that each pixel shows. A model is rendered once per view and then colored for each wheel stop, which is many
times faster than a render per stop.
"""

import math
import os
import tempfile
from typing import NamedTuple

import bpy
import numpy
from mathutils import Matrix, Vector

from denoise import denoise
from layers import OVERSAMPLING, Layers

FIELD_OF_VIEW = math.radians(16.0)
SAMPLES = 4  # light paths per pixel of a layer; denoise() removes the noise


class View(NamedTuple):
    """An image's rectangle, centered at (x, y) on the plane at distance 1 in front of the camera, and the size of the
    final image in pixels."""

    x: float
    y: float
    span: float  # width of the rectangle
    width: int
    height: int

    def pixel(self, point):
        """A point of that plane -> (x from the left, y from the top) in the image, 0..1."""
        rise = self.span * self.height / self.width
        return (point[0] - self.x) / self.span + 0.5, 0.5 - (point[1] - self.y) / rise

    def point(self, pixel):
        """The inverse of pixel()."""
        rise = self.span * self.height / self.width
        return self.x + (pixel[0] - 0.5) * self.span, self.y + (0.5 - pixel[1]) * rise


class Studio:
    """A separate scene around the given points, (n, 3) in world space.

    azimuth, elevation: of the camera, in degrees; 0, 0 looks along +Y, as Blender's front view.
    """

    def __init__(self, points, azimuth, elevation):
        low, high = points.min(0), points.max(0)
        self.center = Vector((low + high) / 2)
        self.radius = float(numpy.linalg.norm(points - self.center, axis=1).max())
        self.azimuth = math.radians(azimuth)
        self.elevation = math.radians(elevation)
        self.scene = bpy.data.scenes.new("Studio")
        self._add_camera()
        self._set_render()
        self._add_backdrop(float(low[2]))
        self._add_lights()

    def close(self):
        """Removes the scene and everything in it."""
        objects = list(self.scene.collection.objects)
        bpy.data.batch_remove([self.scene, self.scene.world, *objects, *(obj.data for obj in objects)])
        bpy.data.batch_remove([material for material in bpy.data.materials if not material.users])

    def _link(self, name, data):
        obj = bpy.data.objects.new(name, data)
        self.scene.collection.objects.link(obj)
        return obj

    def _add_camera(self):
        to_camera = Vector((math.sin(self.azimuth) * math.cos(self.elevation),
                      -math.cos(self.azimuth) * math.cos(self.elevation), math.sin(self.elevation)))
        right = Vector((math.cos(self.azimuth), math.sin(self.azimuth), 0.0))
        self.axes = Matrix((right, to_camera.cross(right), to_camera)).transposed()  # columns: right, up, towards the camera
        self.camera_position = self.center + to_camera * self.radius / math.sin(FIELD_OF_VIEW / 2)
        self.camera = self._link("Camera", bpy.data.cameras.new("Camera"))
        self.camera.matrix_world = Matrix.Translation(self.camera_position) @ self.axes.to_4x4()
        self.camera.data.sensor_fit = "HORIZONTAL"
        self.camera.data.clip_start = self.radius * 0.01
        self.camera.data.clip_end = self.radius * 100.0
        self.scene.camera = self.camera

    def _set_render(self):
        scene = self.scene
        scene.use_nodes = True
        scene.render.engine = "CYCLES"
        scene.render.resolution_percentage = 100
        scene.render.use_persistent_data = True
        scene.cycles.device = "CPU"
        scene.cycles.use_denoising = False
        scene.cycles.use_adaptive_sampling = False
        scene.cycles.max_bounces = 1
        scene.cycles.diffuse_bounces = 1
        scene.cycles.sample_clamp_indirect = 4.0
        scene.cycles.pixel_filter_type = "BOX"
        threads = int(os.environ.get("PARTWHEEL_DEMO_THREADS", 0))
        if threads:
            scene.render.threads_mode = "FIXED"
            scene.render.threads = threads

    def _add_backdrop(self, ground_z):
        """A ground plane that curves smoothly into a wall behind the model."""
        radius = self.radius
        start, bend = 1.6 * radius, 2.0 * radius
        profile = [(-30.0 * radius, 0.0)]
        profile += [(start + bend * math.sin(turn), bend - bend * math.cos(turn))
                    for turn in numpy.linspace(0.0, math.pi / 2, 24)]
        profile.append((start + bend, 40.0 * radius))
        corners = [(side * 60.0 * radius, y, z) for y, z in profile for side in (-1.0, 1.0)]
        polygons = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
        mesh = bpy.data.meshes.new("Backdrop")
        mesh.from_pydata(corners, [], polygons)
        mesh.polygons.foreach_set("use_smooth", [True] * len(polygons))
        mesh.materials.append(paper("Backdrop", 0.8))
        self.backdrop = self._link("Backdrop", mesh)
        self.backdrop.matrix_world = (Matrix.Translation((self.center.x, self.center.y, ground_z))
                                      @ Matrix.Rotation(self.azimuth, 4, "Z"))

    def _add_lights(self):
        world = self.scene.world = bpy.data.worlds.new("Studio")
        world.use_nodes = True
        sky = world.node_tree.nodes["Background"].inputs
        sky["Color"].default_value = (0.86, 0.93, 1.0, 1.0)
        self.sky = sky["Strength"]
        self.lamps = []
        # name, direction (right, up, towards the camera), size, strength, color
        for name, direction, size, strength, color in (
                ("Key", (-1.1, 1.6, 1.3), 1.6, 55.0, (1.0, 0.96, 0.9)),
                ("Rim", (1.8, 1.2, -1.2), 1.2, 34.0, (0.9, 0.95, 1.0))):
            lamp = bpy.data.lights.new(name, "AREA")
            lamp.size = size * self.radius
            lamp.energy = strength * self.radius ** 2
            lamp.color = color
            to_lamp = (self.axes @ Vector(direction)).normalized()
            obj = self._link(name, lamp)
            obj.matrix_world = (Matrix.Translation(self.center + to_lamp * 3.2 * self.radius)
                                  @ to_lamp.to_track_quat("Z", "Y").to_matrix().to_4x4())
            self.lamps.append(obj)

    def project(self, points):
        """(n, 3) points in world space -> (n, 2) on the plane at distance 1 in front of the camera."""
        local = (numpy.asarray(points) - numpy.array(self.camera_position)) @ numpy.array(self.axes)
        return local[:, :2] / -local[:, 2:]

    def view(self, points, width, height, margin=0.06):
        """The View of this size in pixels that fits all points; margin: on each side, as a fraction of the size,
        0..0.5."""
        flat = self.project(points)
        low, high = flat.min(0), flat.max(0)
        span = max(high[0] - low[0], (high[1] - low[1]) * width / height) / (1.0 - 2.0 * margin)
        return View(*((low + high) / 2), span, width, height)

    def box(self, points):
        """The View that the points fill exactly; its size in pixels has no meaning."""
        width, height = numpy.ptp(self.project(points), axis=0)
        return self.view(points, width, height, margin=0.0)

    def ray(self, view, pixel):
        """The ray through a pixel (0..1 from the left, the top): (origin, direction) in world space."""
        x, y = view.point(pixel)
        return self.camera_position, (self.axes @ Vector((x, y, -1.0))).normalized()

    def photograph(self, obj, numbers, view):
        """Renders the Layers of a mesh object. numbers: (polygons,) the id of each polygon, 0 or more."""
        data = self.camera.data
        data.angle = 2.0 * math.atan(view.span / 2.0)
        data.shift_x, data.shift_y = view.x / view.span, view.y / view.span
        self.scene.render.resolution_x = view.width * OVERSAMPLING
        self.scene.render.resolution_y = view.height * OVERSAMPLING
        mesh = obj.data.copy()
        model = self._link("Model", mesh)
        model.matrix_world = obj.matrix_world
        try:
            mesh.materials.clear()
            mesh.materials.append(clay("Clay", 0.6))
            light, gloss = self._light()
            mesh.attributes.new("shown", "FLOAT", "FACE").data.foreach_set(
                "value", numpy.asarray(numbers, numpy.float32) + 1.0)
            mesh.materials[0] = glow("Number", "shown")
            return Layers(light, gloss, self._numbers())
        finally:
            bpy.data.objects.remove(model)
            bpy.data.meshes.remove(mesh)

    def _light(self):
        self.scene.cycles.samples = SAMPLES
        self.sky.default_value = 0.8
        passes = self._render({
            "direct": ("use_pass_diffuse_direct", "DiffDir"), "indirect": ("use_pass_diffuse_indirect", "DiffInd"),
            "shine": ("use_pass_glossy_direct", "GlossDir"), "mirror": ("use_pass_glossy_indirect", "GlossInd"),
            "tint": ("use_pass_glossy_color", "GlossCol"),
            "normal": ("use_pass_normal", "Normal"), "depth": ("use_pass_z", "Depth")})
        light = passes["direct"] + passes["indirect"]
        gloss = (passes["shine"] + passes["mirror"]) * passes["tint"]
        smooth = denoise(numpy.dstack((light, gloss)), passes["normal"], passes["depth"][..., 0])
        return smooth[..., :3], smooth[..., 3:]

    def _numbers(self):
        """(h, w) ids: one ray per pixel, an emissive material with the face's id + 1, everything else black."""
        self.scene.cycles.samples = 1
        self.sky.default_value = 0.0
        for obj in (self.backdrop, *self.lamps):
            obj.hide_render = True
        try:
            passes = self._render({"number": ("use_pass_combined", "Image")})
        finally:
            for obj in (self.backdrop, *self.lamps):
                obj.hide_render = False
        return numpy.rint(passes["number"][..., 0]).astype(numpy.int32) - 1

    def _render(self, passes):
        """passes: name -> (switch of the view layer, socket of the compositor). Returns name -> (h, w, 3) float32."""
        layer, tree = self.scene.view_layers[0], self.scene.node_tree
        tree.nodes.clear()
        source = tree.nodes.new("CompositorNodeRLayers")
        source.scene = self.scene
        target = tree.nodes.new("CompositorNodeOutputFile")
        target.format.file_format, target.format.color_depth = "OPEN_EXR", "32"
        target.format.exr_codec = "NONE"
        target.file_slots.clear()
        for name, (switch, socket) in passes.items():
            setattr(layer, switch, True)
            target.file_slots.new(name)
            tree.links.new(source.outputs[socket], target.inputs[name])
        with tempfile.TemporaryDirectory() as folder:
            target.base_path = folder
            bpy.ops.render.render(scene=self.scene.name)
            return {name: _pixels(os.path.join(folder, f"{name}{self.scene.frame_current:04d}.exr"))
                    for name in passes}


def _pixels(path):
    image = bpy.data.images.load(path)
    try:
        width, height = image.size
        pixels = numpy.empty(width * height * 4, numpy.float32)
        image.pixels.foreach_get(pixels)
        return pixels.reshape(height, width, 4)[::-1, :, :3]
    finally:
        bpy.data.images.remove(image)


def clay(name, albedo):
    """A matte material with a little gloss. The albedo affects indirect light only."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"].inputs
    shader["Base Color"].default_value = (albedo, albedo, albedo, 1.0)
    shader["Roughness"].default_value = 0.5
    shader["Specular"].default_value = 0.35
    return material


def paper(name, albedo):
    """A matte material without gloss."""
    material, nodes, output = _bare(name)
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (albedo, albedo, albedo, 1.0)
    material.node_tree.links.new(shader.outputs["BSDF"], output)
    return material


def glow(name, attribute):
    """An emissive material whose strength is a face attribute."""
    material, nodes, output = _bare(name)
    value = nodes.new("ShaderNodeAttribute")
    value.attribute_name = attribute
    shader = nodes.new("ShaderNodeEmission")
    material.node_tree.links.new(value.outputs["Fac"], shader.inputs["Strength"])
    material.node_tree.links.new(shader.outputs["Emission"], output)
    return material


def _bare(name):
    """(material, its nodes, the socket of its surface), nothing connected."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    return material, nodes, nodes.new("ShaderNodeOutputMaterial").inputs["Surface"]
