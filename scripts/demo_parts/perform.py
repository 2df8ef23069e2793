"""Runs the demo inside Blender for one model: opens it, builds its hierarchy, clicks and turns the wheel.

Run as: blender -b --python perform.py -- MODEL MESHES FOLDER [--all]
with the add-on installed and enabled. It writes MODEL.blend to FOLDER, and to layers/MODEL/ report.json (events, sizes,
times) and a .npz of layers for each image, which paint.py creates. If the build fails, report.json has the error and
there are no layers.
"""

import json
import math
import os
import sys
import time

import bmesh
import bpy
import numpy
from mathutils import Matrix
from partwheel import Hierarchy, FillMethod, meshes as mesh_files
from partwheel_addon.mesh import arrays
from partwheel_addon.mesh.snapshot import MeshSnapshot
from partwheel_addon.parts import registry

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from models import MODELS, MONKEY  # noqa: E402
from studio import Studio  # noqa: E402

HEIGHT = 300  # of an image, in pixels
CLOSE_UP = 0.17  # a part whose size is a smaller fraction of the image's gets a close-up


def open_model(model, meshes):
    """Opens the model as the only, active object, with z up."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    if model.source == MONKEY:
        bpy.ops.mesh.primitive_monkey_add()
        obj = bpy.context.object
    else:
        source = mesh_files.read(os.path.join(meshes, model.source))
        mesh = bpy.data.meshes.new(model.name)
        mesh.from_pydata(source.vertices.tolist(), [], source.triangles.tolist())
        if model.up == "Y":
            mesh.transform(Matrix.Rotation(math.pi / 2, 4, "X"))
        mesh.update()
        obj = bpy.data.objects.new(model.name, mesh)
        bpy.context.collection.objects.link(obj)
    obj.name = obj.data.name = model.name
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
    points = numpy.empty(len(mesh.vertices) * 3)
    mesh.vertices.foreach_get("co", points)
    return points.reshape(-1, 3)


def selected_faces():
    """(n,) sorted indices of the selected faces in Edit Mode."""
    faces = bmesh.from_edit_mesh(bpy.context.object.data).faces
    return numpy.array([face.index for face in faces if face.select], numpy.int64)


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
    vertices, triangles, parts, count = [], [], [], 0
    for part in range(len(bounds) - 1):
        hull_vertices, hull_triangles = hierarchy.hull_of_slice(bounds[part], bounds[part + 1])
        vertices.append(hull_vertices)
        triangles.append(hull_triangles + count)
        parts.append(numpy.full(len(hull_triangles), part))
        count += len(hull_vertices)
    mesh = bpy.data.meshes.new("Hulls")
    mesh.from_pydata(numpy.vstack(vertices).tolist(), [], numpy.vstack(triangles).tolist())
    mesh.update()
    return bpy.data.objects.new("Hulls", mesh), numpy.concatenate(parts)


NOTE = """Partwheel's demo saved this model in Edit Mode, in face select mode, with a part selected.

1. The add-on must be installed and enabled: scripts/demo --open MODEL does that; otherwise install the zip of
   build/package with Edit > Preferences > Add-ons > Install.
2. Put the mouse over the model and press Shift Ctrl W. The first time, this builds the hierarchy, which takes some seconds.
3. Turn the wheel: up for a larger part, down for a smaller one. Click to confirm, Esc to cancel.
"""


def show_ready(obj, studio, stop):
    """Prepares the file for a user who opens it: Edit Mode, face select mode, a part selected, the model in view."""
    mesh = obj.data
    bpy.ops.object.mode_set(mode="OBJECT")
    for elements in (mesh.vertices, mesh.edges, mesh.polygons):
        elements.foreach_set("select", [False] * len(elements))
    is_selected = numpy.zeros(len(mesh.polygons), bool)
    is_selected[stop] = True
    mesh.polygons.foreach_set("select", is_selected)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.data.texts.new("Partwheel").write(NOTE)
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                space = area.spaces.active
                space.shading.show_cavity = True
                space.overlay.show_extra_edge_length = False
                space.clip_start, space.clip_end = studio.radius * 0.005, studio.radius * 100.0
                view = space.region_3d
                view.view_perspective = "PERSP"
                view.view_location = studio.center
                view.view_rotation = studio.axes.to_quaternion()
                view.view_distance = studio.radius * 2.6


def build(obj, report):
    """Builds the hierarchy by the add-on's operator and fills in the report; None if the build fails."""
    start_time = time.perf_counter()
    bpy.ops.mesh.partwheel_build()  # raises RuntimeError if it fails
    hierarchy = registry.get_hierarchy(MeshSnapshot(obj))
    report["seconds"] = {**hierarchy.seconds, "whole": time.perf_counter() - start_time}
    report["tetrahedra"] = len(hierarchy.tetrahedra)
    report["nodes"] = len(hierarchy.parent)
    report["components"] = hierarchy.summary.components
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

    nodes, _ = hierarchy.wheel(face)
    report["clicks"].append({
        "name": spot.name, "face": face, "start": start, "seconds_per_stop": seconds,
        "views": [{"closer": whole.span / view.span, "clicked": view.pixel(studio.project([point])[0])}
                  for view in views],
        "stops": [{"faces": len(stop), "area": hierarchy.area[node] / hierarchy.area[-1], "view": number}
                  for stop, node, number in zip(stops, nodes, view_of_stop)]})
    return stops[start]


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


def perform(model, meshes, folder, compare):
    """Runs the whole demo with one model and returns the report. compare: also build with other fill methods."""
    layers = os.path.join(folder, "layers", model.name)
    os.makedirs(layers, exist_ok=True)
    obj = open_model(model, meshes)
    report = {"model": model.name, "source": model.source, "faces": len(obj.data.polygons)}
    print(f"demo: {model.name}: {report['faces']} faces from {model.source}", flush=True)
    hierarchy = build(obj, report)
    print(f"demo: {model.name}: built; clicking, turning the wheel, taking pictures", flush=True)
    start_time = time.perf_counter()
    points = corners(obj.data)
    studio = Studio(points, model.azimuth, model.elevation)
    box = studio.box(points)
    whole = studio.view(points, round(HEIGHT * min(max(box.width / box.height, 0.55), 1.5)), HEIGHT)
    studio.photograph(obj, range(report["faces"]), whole).save(os.path.join(layers, "whole.npz"))
    report["clicks"], report["cuts"], report["fill_methods"] = [], [], []
    for spot in model.clicks:
        part = play_click(spot, obj, studio, whole, hierarchy, layers, report)
    for count in model.parts:
        play_cut(count, studio, whole, hierarchy, layers, report)
    if compare and model.compared_parts:
        compare_fill_methods(model.compared_parts, obj, hierarchy, layers, report)
    show_ready(obj, studio, part)
    studio.close()
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
