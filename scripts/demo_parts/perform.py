"""Runs the demo inside Blender for one model: opens it, builds its hierarchy, clicks and turns the wheel.

Run as: blender -b --python perform.py -- MODEL MESHES FOLDER [--docs]
with the add-on installed and enabled. It writes MODEL.blend and MODEL-parts.blend to FOLDER, and to layers/MODEL/ report.json
(events, sizes, times) and a .npz of layers for each image, which paint.py creates.
"""

import json
import math
import os
import sys
import time

import bmesh
import bpy
import numpy
from partwheel import Hierarchy, FillMethod, meshes as mesh_files
from partwheel.cut import Cut
from partwheel.examples import EXAMPLES
from partwheel_addon.mesh import arrays, selection
from partwheel_addon.mesh.snapshot import MeshSnapshot
from partwheel_addon.parts import registry
from partwheel_addon.ui.tour import create_object

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from models import EXAMPLE, MODELS  # noqa: E402
from studio import Studio  # noqa: E402

HEIGHT = 300  # of an image, in pixels
CLOSE_UP = 0.17  # a part whose size is a smaller fraction of the image's gets a close-up
SMALLEST = 0.001  # wheel stops with a smaller fraction of the model's area are not shown
EXPLODE = 0.4  # how far parts move apart, times the distance of their centers


def open_model(model, meshes):
    """Opens the model as the only, active object."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    if model.source == EXAMPLE:
        obj = create_object(EXAMPLES[model.name](), model.name)
    else:
        source = mesh_files.read(os.path.join(meshes, model.source))
        mesh = bpy.data.meshes.new(model.name)
        mesh.from_pydata(source.vertices.tolist(), [], source.triangles.tolist())
        mesh.update()
        obj = bpy.data.objects.new(model.name, mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    if model.voxel:
        remesh = obj.modifiers.new("Remesh", "REMESH")
        remesh.mode, remesh.voxel_size = "VOXEL", model.voxel
        bpy.ops.object.modifier_apply(modifier=remesh.name)
    bpy.context.tool_settings.mesh_select_mode = (False, False, True)
    mesh = obj.data
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(45)
    return obj


def corners(mesh):
    """(V, 3) coordinates."""
    return arrays.read(mesh.vertices, "co", numpy.float32, 3).astype(float)


def selected_faces():
    """(n,) sorted indices of the selected faces in Edit Mode."""
    faces = bmesh.from_edit_mesh(bpy.context.object.data).faces
    return numpy.array([face.index for face in faces if face.select], numpy.int64)


def open_studio(points, model):
    """(a Studio around the points, the View of all of them)"""
    studio = Studio(points, model.azimuth, model.elevation)
    box = studio.box(points)
    return studio, studio.view(points, round(HEIGHT * min(max(box.width / box.height, 0.55), 1.5)), HEIGHT)


def click(obj, studio, at):
    """(face, point) that a click at this position hits."""
    origin, direction = studio.ray(studio.box(corners(obj.data)), at)
    hit, point, _, face = obj.ray_cast(origin, direction)
    if not hit:
        raise RuntimeError(f"the click at {at} misses the model")
    return face, point


def turn_wheel(hierarchy, face):
    """Selects every wheel stop of a face by the operator; returns ([faces of a stop, ...], start).

    Raises RuntimeError if the operator's selection differs from the hierarchy's part."""
    nodes, start = hierarchy.wheel(face)
    stops = []
    for number, node in enumerate(nodes):
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", face_index=face, level=number - start)
        stops.append(selected_faces())
        if not numpy.array_equal(stops[-1], numpy.sort(hierarchy.faces(node))):
            raise RuntimeError(f"stop {number + 1} of face {face} selected {len(stops[-1])} faces, "
                               f"the hierarchy's node {node} has {len(hierarchy.faces(node))}")
    return stops, start


def closer_views(studio, whole, points, polygons, stops):
    """([View, ...] widest first, the index of the view for each stop): close-ups where parts are small."""
    views, view_of_stop = [whole], [0] * len(stops)
    for number in reversed(range(len(stops))):
        part = points[numpy.unique(numpy.concatenate([polygons[face] for face in stops[number]]))]
        tight = studio.view(part, whole.width, whole.height)
        if tight.span < CLOSE_UP * views[-1].span:
            views.append(tight._replace(span=tight.span * 2.6))
        view_of_stop[number] = len(views) - 1
    return views, view_of_stop


def hull_object(hierarchy, bounds):
    """(object of the convex hulls of a cut's parts, part of each of its polygons)"""
    hulls = [hierarchy.hull_of_slice(*pair) for pair in zip(bounds, bounds[1:])]
    counts = numpy.cumsum([0] + [len(vertices) for vertices, _ in hulls])
    mesh = bpy.data.meshes.new("Hulls")
    mesh.from_pydata(numpy.vstack([vertices for vertices, _ in hulls]).tolist(), [],
                     numpy.vstack([triangles + first for (_, triangles), first in zip(hulls, counts)]).tolist())
    mesh.update()
    return bpy.data.objects.new("Hulls", mesh), numpy.repeat(numpy.arange(len(hulls)), [len(triangles) for _, triangles in hulls])


NOTE = """Partwheel's demo saved this model in Edit Mode, in face select mode, with a part selected.

1. The add-on must be installed and enabled: scripts/demo --open MODEL does that; otherwise install the zip of
   build/package with Edit > Preferences > Add-ons > Install.
2. Put the mouse over the model and press Shift Ctrl W. The first time, this builds the hierarchy, which takes some seconds.
3. Turn the wheel: up for a larger part, down for a smaller one. Click to confirm, Esc to cancel.
"""


def show(studio):
    """Puts what the studio shows into the 3D views of the file."""
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                space = area.spaces.active
                space.shading.show_cavity = True
                space.shading.color_type = "TEXTURE"
                space.overlay.show_extra_edge_length = False
                space.clip_start, space.clip_end = studio.radius * 0.005, studio.radius * 100.0
                view = space.region_3d
                view.view_perspective = "PERSP"
                view.view_location = studio.center
                view.view_rotation = studio.axes.to_quaternion()
                view.view_distance = studio.radius * 2.6


def show_ready(obj, studio, stop):
    """Prepares the file for a user who opens it: Edit Mode, face select mode, a part selected, the model in view."""
    mesh = obj.data
    bpy.ops.object.mode_set(mode="OBJECT")
    selection.select_outside_edit_mode(mesh, stop)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.data.texts.new("Partwheel").write(NOTE)
    show(studio)


def build(obj, report):
    """Builds the hierarchy by the add-on's operator and fills in the report."""
    start_time = time.perf_counter()
    bpy.ops.mesh.partwheel_build()  # raises RuntimeError if it fails
    hierarchy = registry.get_hierarchy(MeshSnapshot(obj))
    report["seconds"] = {**hierarchy.seconds, "whole": time.perf_counter() - start_time}
    report["tetrahedra"] = len(hierarchy.tetrahedra)
    report["nodes"] = len(hierarchy.parent)
    report["shells"] = hierarchy.summary.shells
    report["fill_method"], report["notes"] = hierarchy.summary.fill_method, hierarchy.notes
    report["saved_bytes"] = len(hierarchy.save())
    return hierarchy


def play_click(spot, obj, studio, whole, hierarchy, folder, report):
    """Plays a click and every wheel stop after it; returns the faces of the start stop."""
    mesh = obj.data
    face, point = click(obj, studio, spot.at)
    bpy.ops.object.mode_set(mode="EDIT")
    start_time = time.perf_counter()
    stops, start = turn_wheel(hierarchy, face)
    seconds = (time.perf_counter() - start_time) / len(stops)
    bpy.ops.object.mode_set(mode="OBJECT")
    areas = hierarchy.area[hierarchy.wheel(face)[0]] / hierarchy.area[-1]
    hidden = min(int(numpy.searchsorted(areas, SMALLEST)), start)
    stops, areas, start = stops[hidden:], areas[hidden:], start - hidden

    if "partwheel_demo" not in obj:
        obj["partwheel_demo"] = point[:]  # open.py draws its hint at the first click
    polygons = [polygon.vertices for polygon in mesh.polygons]
    views, view_of_stop = closer_views(studio, whole, corners(mesh), polygons, stops)
    for number, view in enumerate(views[1:], 1):
        picture = studio.photograph(obj, range(len(polygons)), view)
        picture.save(os.path.join(folder, f"{spot.name}-{number}.npz"))
    entered = numpy.full(len(polygons), len(stops))  # the first stop that contains a face: stops are nested
    for number in reversed(range(len(stops))):
        entered[stops[number]] = number
    numpy.save(os.path.join(folder, f"{spot.name}.npy"), entered)

    report["clicks"].append({
        "name": spot.name, "face": face, "hidden": hidden, "start": start, "seconds_per_stop": seconds,
        "views": [{"closer": whole.span / view.span, "clicked": view.pixel(studio.project([point])[0])}
                  for view in views],
        "stops": [{"faces": len(stop), "area": area, "view": number}
                  for stop, area, number in zip(stops, areas, view_of_stop)]})
    return stops[start]


def polygon_colors(mesh):
    """(P, 3) linear color of each polygon: that of its material, or of the material's texture at its middle."""
    colors = numpy.empty((len(mesh.polygons), 3), numpy.float32)
    for index, material in enumerate(mesh.materials):
        image = next((node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE"), None)
        polygons = [polygon for polygon in mesh.polygons if polygon.material_index == index]
        if image is None:
            colors[[polygon.index for polygon in polygons]] = material.diffuse_color[:3]
            continue
        pixels = numpy.empty(len(image.pixels), numpy.float32)
        image.pixels.foreach_get(pixels)
        uvs = mesh.uv_layers.active.data
        for polygon in polygons:
            x, y = numpy.mean([uvs[corner].uv for corner in polygon.loop_indices], axis=0) * image.size % image.size
            colors[polygon.index] = pixels.reshape(image.size[1], image.size[0], 4)[int(y), int(x), :3]
        painted = [polygon.index for polygon in polygons]
        colors[painted] = ((colors[painted] + 0.055) / 1.055) ** 2.4  # of sRGB
    return colors


def play_parts(model, obj, hierarchy, folder, layers, report):
    """Takes the model apart by Parts to..., renders the objects, and saves them as MODEL-parts.blend. Removes them again."""
    numpy.save(os.path.join(layers, "labels.npy"), Cut.automatic(hierarchy).labels)
    numpy.save(os.path.join(layers, "colors.npy"), polygon_colors(obj.data))
    bpy.ops.mesh.partwheel_parts(to={"OBJECTS"}, explode=EXPLODE)
    bpy.context.view_layer.update()
    parts = bpy.context.selected_objects
    points = numpy.vstack([corners(part.data) @ numpy.array(part.matrix_world.to_3x3()).T + part.matrix_world.translation
                           for part in parts])
    polygons, count = [], 0
    for part in parts:
        polygons += [[count + vertex for vertex in polygon.vertices] for polygon in part.data.polygons]
        count += len(part.data.vertices)
    mesh = bpy.data.meshes.new("Apart")
    mesh.from_pydata(points.tolist(), [], polygons)
    apart = bpy.data.objects.new("Apart", mesh)
    studio, box = open_studio(points, model)
    studio.photograph(apart, range(len(polygons)), box).save(os.path.join(layers, "apart.npz"))
    numpy.save(os.path.join(layers, "apart-colors.npy"), numpy.concatenate([polygon_colors(part.data) for part in parts]))
    show(studio)
    studio.close()
    bpy.data.batch_remove([apart, mesh])
    report["parts"] = len(parts)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, f"{model.name}-parts.blend"), compress=True, copy=True)
    bpy.data.batch_remove([*parts, *(part.data for part in parts), *parts[0].users_collection])
    obj.hide_set(False)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)


def play_cut(count, studio, whole, hierarchy, folder, report):
    """Renders the convex hulls of the dendrogram cut into this number of parts."""
    count = min(count, len(hierarchy.tetrahedra))
    bounds = hierarchy.cut_parts(count)
    hulls, parts = hull_object(hierarchy, bounds)
    studio.photograph(hulls, parts, whole).save(os.path.join(folder, f"hulls-{count}.npz"))
    bpy.data.batch_remove([hulls, hulls.data])
    report["cuts"].append({"parts": count, "bounds": bounds.tolist(), "polygons": len(parts)})


def compare_fill_methods(count, obj, hierarchy, folder, report):
    """Saves the parts of each face, cut into this number, after three builds: exact, from points, and on a copy with a
    tenth of the triangles. Parts are numbered so that they match the first build's as well as possible."""
    surface = arrays.read_surface(obj.data)
    built = {"exact": hierarchy, "points": Hierarchy.build(*surface, fill_methods=FillMethod.POINTS),
             "coarse": Hierarchy.build(*surface, exact_triangles=4 * len(surface.triangles) // 10)}
    areas, first = numpy.array([polygon.area for polygon in obj.data.polygons]), None
    for name, variant in built.items():
        labels = variant.face_labels(variant.cut_parts(count))
        first = labels if first is None else first
        shared = numpy.bincount(labels * count + first, areas, count * count).reshape(count, count)
        number, free_numbers = numpy.full(count, -1), set(range(count))
        for part, first_part in zip(*numpy.unravel_index(numpy.argsort(-shared, axis=None), shared.shape)):
            if number[part] < 0 and first_part in free_numbers:
                number[part] = first_part
                free_numbers.remove(first_part)
        numpy.save(os.path.join(folder, f"filled-{name}.npy"), number[labels])
        report["fill_methods"].append({"name": name, "fill_method": variant.summary.fill_method, "tetrahedra": len(variant.tetrahedra),
                               "parts": count})


def perform(model, meshes, folder, docs):
    """Runs the whole demo with one model and returns the report. docs: also what only the docs show."""
    layers = os.path.join(folder, "layers", model.name)
    os.makedirs(layers, exist_ok=True)
    obj = open_model(model, meshes)
    report = {"model": model.name, "source": model.source, "faces": len(obj.data.polygons)}
    print(f"demo: {model.name}: {report['faces']} faces from {model.source}", flush=True)
    hierarchy = build(obj, report)
    print(f"demo: {model.name}: built; clicking, turning the wheel, taking pictures", flush=True)
    start_time = time.perf_counter()
    studio, whole = open_studio(corners(obj.data), model)
    studio.photograph(obj, range(report["faces"]), whole).save(os.path.join(layers, "whole.npz"))
    report["clicks"], report["cuts"], report["fill_methods"] = [], [], []
    for spot in model.clicks:
        part = play_click(spot, obj, studio, whole, hierarchy, layers, report)
    if docs:
        unmarked = Hierarchy.build(*arrays.read_surface(obj.data))  # approximated is the shape, not its colors
        for count in model.convex:
            play_cut(count, studio, whole, unmarked, layers, report)
        if model.compared_parts:
            compare_fill_methods(model.compared_parts, obj, hierarchy, layers, report)
    studio.close()
    if model.source == EXAMPLE:
        play_parts(model, obj, hierarchy, folder, layers, report)
    show_ready(obj, studio, part)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, f"{model.name}.blend"), compress=True)
    report["pictures_seconds"] = time.perf_counter() - start_time
    return report


def main():
    name, meshes, folder, *options = sys.argv[sys.argv.index("--") + 1:]
    model = next(model for model in MODELS if model.name == name)
    report = perform(model, meshes, folder, bool(options))
    with open(os.path.join(folder, "layers", name, "report.json"), "w", encoding="utf-8") as file:
        json.dump(report, file, indent=1, default=lambda number: number.item())


if __name__ == "__main__":
    main()
