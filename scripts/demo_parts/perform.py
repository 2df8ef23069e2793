"""Runs the demo inside Blender for one model: opens it, builds its hierarchy, clicks and turns the wheel.

Run as: blender -b --python perform.py -- MODEL MESHES FOLDER [--docs]
with the add-on installed and enabled. It writes to FOLDER: MODEL.blend and MODEL-parts.blend; events, sizes and times to
MODEL.json; and to MODEL.npz the arrays of which paint.py makes pictures.
"""

import json
import math
import os
import sys
import time

import bmesh
import bpy
import numpy
from mathutils import Vector
from partwheel import Hierarchy, FillMethod, meshes as mesh_files
from partwheel.appearance import to_srgb
from partwheel.cut import Cut
from partwheel.examples import EXAMPLES
from partwheel_addon.mesh import arrays, selection
from partwheel_addon.mesh.snapshot import MeshSnapshot
from partwheel_addon.parts import registry
from partwheel_addon.ui.tour import create_object

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from models import EXAMPLE, MODELS  # noqa: E402

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


def selected_faces():
    """(n,) sorted indices of the selected faces in Edit Mode."""
    faces = bmesh.from_edit_mesh(bpy.context.object.data).faces
    return numpy.array([face.index for face in faces if face.select], numpy.int64)


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


NOTE = """Partwheel's demo saved this model in Edit Mode, in face select mode, with a part selected.

1. The add-on must be installed and enabled: scripts/demo --open MODEL does that; otherwise install the zip of
   build/package with Edit > Preferences > Add-ons > Install.
2. Put the mouse over the model and press Shift Ctrl W. The first time, this builds the hierarchy, which takes some seconds.
3. Turn the wheel: up for a larger part, down for a smaller one. Click to confirm, Esc to cancel.
"""


def show(vertices, direction):
    """Puts the vertices (n, 3) into the 3D views of the file, seen from a direction."""
    center = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    radius = numpy.linalg.norm(vertices - center, axis=1).max()
    for area in (area for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D"):
        space = area.spaces.active
        space.shading.show_cavity = True
        space.shading.color_type = "TEXTURE"
        space.overlay.show_extra_edge_length = False
        space.clip_start, space.clip_end = radius * 0.005, radius * 100.0
        view = space.region_3d
        view.view_perspective = "PERSP"
        view.view_location = center
        view.view_rotation = Vector(direction).to_track_quat("Z", "Y")
        view.view_distance = radius * 2.6


def show_ready(obj, model, stop):
    """Prepares the file for a user who opens it: Edit Mode, face select mode, a part selected, the model in view."""
    selection.select_outside_edit_mode(obj.data, stop)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.data.texts.new("Partwheel").write(NOTE)
    show(arrays.read(obj.data.vertices, "co", numpy.float32, 3), model.view)


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


def play_click(name, point, obj, hierarchy, saved, report):
    """Plays a click and every wheel stop after it; returns the faces of the start stop."""
    _, point, _, face = obj.closest_point_on_mesh(point)
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
    entered = numpy.full(len(obj.data.polygons), len(stops))  # the first stop that contains a face: stops are nested
    for number in reversed(range(len(stops))):
        entered[stops[number]] = number
    saved[name] = entered
    report["clicks"].append({"name": name, "point": point[:], "hidden": hidden, "start": start, "seconds_per_stop": seconds,
                             "stops": [{"faces": len(stop), "area": area} for stop, area in zip(stops, areas)]})
    return stops[start]


def polygon_colors(mesh):
    """(P, 3) color of each polygon, as on the screen: that of its material, or of the material's texture at its middle."""
    colors = numpy.empty((len(mesh.polygons), 3), numpy.float32)
    for index, material in enumerate(mesh.materials):
        image = next((node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE"), None)
        polygons = [polygon for polygon in mesh.polygons if polygon.material_index == index]
        if image is None:
            colors[[polygon.index for polygon in polygons]] = to_srgb(numpy.array(material.diffuse_color[:3]))
            continue
        pixels = numpy.empty(len(image.pixels), numpy.float32)
        image.pixels.foreach_get(pixels)
        uvs = mesh.uv_layers.active.data
        for polygon in polygons:
            x, y = numpy.mean([uvs[corner].uv for corner in polygon.loop_indices], axis=0) * image.size % image.size
            colors[polygon.index] = pixels.reshape(image.size[1], image.size[0], 4)[int(y), int(x), :3]
    return colors


def play_parts(model, obj, hierarchy, folder, saved, report):
    """Takes the model apart by Parts to..., and saves the objects as MODEL-parts.blend. Removes them again."""
    saved["labels"], saved["colors"] = Cut.automatic(hierarchy).labels, polygon_colors(obj.data)
    bpy.ops.mesh.partwheel_parts(to={"OBJECTS"}, explode=EXPLODE)
    bpy.context.view_layer.update()
    parts = bpy.context.selected_objects
    surfaces = [arrays.read_surface(part.data) for part in parts]
    save_bodies(saved, "apart", [(surface.vertices @ numpy.array(part.matrix_world.to_3x3()).T + part.matrix_world.translation,
                                  surface.triangles) for surface, part in zip(surfaces, parts)])
    saved["apart_colors"] = numpy.concatenate([polygon_colors(part.data)[surface.faces]
                                               for surface, part in zip(surfaces, parts)])
    show(saved["apart_vertices"], model.view)
    report["parts"] = len(parts)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, f"{model.name}-parts.blend"), compress=True, copy=True)
    bpy.data.batch_remove([*parts, *(part.data for part in parts), *parts[0].users_collection])
    obj.hide_set(False)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)


def save_bodies(saved, name, bodies):
    """Saves surfaces [(vertices, triangles), ...] as one, and which of them each triangle is of."""
    firsts = numpy.cumsum([0] + [len(vertices) for vertices, _ in bodies])
    saved[f"{name}_vertices"] = numpy.vstack([vertices for vertices, _ in bodies])
    saved[f"{name}_triangles"] = numpy.vstack([triangles + first for (_, triangles), first in zip(bodies, firsts)])
    saved[f"{name}_bodies"] = numpy.repeat(numpy.arange(len(bodies)), [len(triangles) for _, triangles in bodies])


def play_cut(count, hierarchy, saved, report):
    """Saves the convex hulls of the dendrogram cut into this number of parts."""
    bounds = hierarchy.cut_parts(min(count, len(hierarchy.tetrahedra)))
    save_bodies(saved, f"hulls{count}", [hierarchy.hull_of_slice(*pair) for pair in zip(bounds, bounds[1:])])
    report["cuts"].append({"parts": count, "bounds": bounds.tolist()})


def compare_fill_methods(count, obj, hierarchy, saved, report):
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
        saved[f"filled_{name}"] = number[labels]
        report["fill_methods"].append({"name": name, "tetrahedra": len(variant.tetrahedra), "parts": count})


def perform(model, meshes, folder, docs):
    """Runs the whole demo with one model; returns (the report, the arrays to save). docs: also what only the docs show."""
    obj = open_model(model, meshes)
    report = {"model": model.name, "source": model.source, "faces": len(obj.data.polygons), "clicks": [], "cuts": [],
              "fill_methods": []}
    print(f"demo: {model.name}: {report['faces']} faces from {model.source}", flush=True)
    hierarchy = build(obj, report)
    print(f"demo: {model.name}: built; clicking, turning the wheel", flush=True)
    surface = arrays.read_surface(obj.data)
    saved = {"vertices": surface.vertices, "triangles": surface.triangles, "faces": surface.faces}
    for name, point in model.clicks.items():
        part = play_click(name, point, obj, hierarchy, saved, report)
    if docs:
        unmarked = Hierarchy.build(*surface)  # approximated is the shape, not its colors
        for count in model.convex:
            play_cut(count, unmarked, saved, report)
        if model.compared_parts:
            compare_fill_methods(model.compared_parts, obj, hierarchy, saved, report)
    if model.source == EXAMPLE:
        play_parts(model, obj, hierarchy, folder, saved, report)
    show_ready(obj, model, part)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, f"{model.name}.blend"), compress=True)
    return report, saved


def main():
    name, meshes, folder, *options = sys.argv[sys.argv.index("--") + 1:]
    report, saved = perform(MODELS[name], meshes, folder, bool(options))
    numpy.savez(os.path.join(folder, f"{name}.npz"), **saved)
    with open(os.path.join(folder, f"{name}.json"), "w", encoding="utf-8") as file:
        json.dump(report, file, indent=1, default=lambda number: number.item())


if __name__ == "__main__":
    main()
