# SPDX-License-Identifier: GPL-3.0-or-later
"""What a mouse move costs inside Blender while a part is deformed: all that the add-on does for it, in Edit Mode.

    blender -b --factory-startup --python deform_in_blender.py -- MESH.npz MOVES RESULT.json

The same steps as the operator's: the region follows its handle, its places are read, written into Blender's mesh, and
normals found. MESH.npz: vertices, triangles, and part, the vertices of the part, ordered so that the first tenth is the
handle. RESULT.json, in seconds: begin, what is done once while Blender waits, and prepare, what is done once in the
background; for a move the medians of follow, write and whole, and of
what Blender itself then does to bring its scene up to date.
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
# The add-on from the checkout, under the name that it has where it is installed.
spec = importlib.util.spec_from_file_location("partwheel_addon", ROOT / "addon" / "partwheel" / "__init__.py")
sys.modules[spec.name] = importlib.util.module_from_spec(spec)
methods, pens, regions = (importlib.import_module(f"partwheel_addon.deform.{name}")
                          for name in ("methods", "pen", "region"))


def edited(vertices, triangles):
    """An object with this mesh, in Edit Mode."""
    mesh = bpy.data.meshes.new("part")
    mesh.from_pydata(vertices, [], triangles.tolist())
    obj = bpy.data.objects.new("part", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    return obj


def turned(angle, center):
    """(4,4): about the z axis through center."""
    matrix = np.eye(4)
    matrix[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    matrix[:3, 3] = center - matrix[:3, :3] @ center
    return matrix


def main():
    given, moves, result = sys.argv[sys.argv.index("--") + 1:]
    given, moves = np.load(given), int(moves)
    vertices, triangles, part = given["vertices"], given["triangles"], given["part"]
    obj = edited(vertices, triangles)
    inside = np.zeros(len(vertices), bool)
    inside[part] = True
    began = time.perf_counter()
    region = regions.Region(obj, np.flatnonzero(inside[triangles].any(axis=1)))
    handle = np.intersect1d(region.vertices, part[:len(part) // 10], return_indices=True)[1]
    shape = methods.AsRigidAsPossible(region, [handle])
    pen = pens.Pen(obj, region)
    begin = time.perf_counter() - began
    shape.jump([np.eye(4)])
    prepare = time.perf_counter() - began - begin
    steps = []
    for move in range(1, moves + 1):
        times = [time.perf_counter()]
        shape.follow([turned(0.5 * move / moves, region.rest[handle].mean(axis=0))])
        times.append(time.perf_counter())
        pen.draft(obj, shape.points())
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
