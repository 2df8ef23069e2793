# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures a mouse move inside Blender while a part is deformed: everything that the add-on does for it, in Edit Mode.

    blender -b --factory-startup --python deform_in_blender.py -- MESH.npz MOVES RESULT.json

The steps are the operator's: the region follows its handle, its positions are read and written to Blender's mesh, and
the normals are computed. MESH.npz: vertices, triangles, and part, the vertices of the part, of which the first tenth is
the handle. RESULT.json, in seconds: begin, done once while Blender waits; prepare, done once in the background; and the
medians over the moves of follow, write, whole and blender_update, Blender's own update of the scene.
"""
import importlib.util
import json
import statistics
import sys
import time
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "native" / "python"))
# The add-on of this source tree, under its installed name.
spec = importlib.util.spec_from_file_location("partwheel_addon", ROOT / "addon" / "partwheel" / "__init__.py")
sys.modules[spec.name] = importlib.util.module_from_spec(spec)
methods, vertex_writers, regions = (importlib.import_module(f"partwheel_addon.deform.{name}")
                          for name in ("methods", "vertex_writer", "region"))


def create_edited_object(vertices, triangles):
    """Creates an object with this mesh and enters Edit Mode."""
    mesh = bpy.data.meshes.new("part")
    mesh.from_pydata(vertices, [], triangles.tolist())
    obj = bpy.data.objects.new("part", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    return obj


def rotation(angle, center):
    """(4, 4) rotation about the z axis through center; angle in radians."""
    matrix = np.eye(4)
    matrix[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    matrix[:3, 3] = center - matrix[:3, :3] @ center
    return matrix


def main():
    mesh_file, moves, result = sys.argv[sys.argv.index("--") + 1:]
    arrays, moves = np.load(mesh_file), int(moves)
    vertices, triangles, part = arrays["vertices"], arrays["triangles"], arrays["part"]
    obj = create_edited_object(vertices, triangles)
    inside = np.zeros(len(vertices), bool)
    inside[part] = True
    start = time.perf_counter()
    region = regions.Region(obj, np.flatnonzero(inside[triangles].any(axis=1)))
    handle = np.intersect1d(region.vertices, part[:len(part) // 10], return_indices=True)[1]
    shape = methods.AsRigidAsPossible(region, [handle])
    writer = vertex_writers.VertexWriter(obj, region)
    begin = time.perf_counter() - start
    shape.solve([np.eye(4)])
    prepare = time.perf_counter() - start - begin
    steps = []
    for move in range(1, moves + 1):
        times = [time.perf_counter()]
        shape.follow([rotation(0.5 * move / moves, region.rest[handle].mean(axis=0))])
        times.append(time.perf_counter())
        writer.write_draft(obj, shape.points())
        times.append(time.perf_counter())
        bpy.context.view_layer.update()
        times.append(time.perf_counter())
        steps.append(np.diff(times))
    follow, write, update = (statistics.median(column) for column in zip(*steps))
    whole = statistics.median(step[0] + step[1] for step in steps)
    report = {"blender": bpy.app.version_string.split()[0], "vertices": len(vertices), "moving": len(region.moving),
              "begin": begin, "prepare": prepare, "follow": follow, "write": write, "whole": whole,
              "blender_update": update}
    Path(result).write_text(json.dumps(report))


main()
