# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh objects of a .blend file as one mesh, as they are seen there, by a Blender in the background."""

import functools
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from ..contents import KINDS
from ..meshes import Mesh, MeshFileError
from ..worker.exit_status import describe_exit

# What Blender runs: this package has nothing of Blender. Each array is a file; the last one tells that all are whole.
SCRIPT = """
import bpy, sys, numpy
folder = sys.argv[-1]
points, corners, counts, start, polygons, dropped = [], [], [], 0, 0, set()
graph = bpy.context.evaluated_depsgraph_get()
for one in sorted(bpy.context.scene.objects, key=lambda one: one.name):
    if one.type != "MESH" or one.hide_render:
        continue
    evaluated = one.evaluated_get(graph)
    mesh = evaluated.to_mesh()
    mesh.calc_loop_triangles()
    here = numpy.empty(len(mesh.vertices) * 3)
    mesh.vertices.foreach_get("co", here)
    matrix = numpy.array(evaluated.matrix_world)
    triangles = numpy.empty(len(mesh.loop_triangles) * 3, numpy.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    faces = numpy.empty(len(mesh.loop_triangles), numpy.int32)
    mesh.loop_triangles.foreach_get("polygon_index", faces)
    triangles = triangles.reshape(-1, 3)
    if numpy.linalg.det(matrix[:3, :3]) < 0:
        triangles = triangles[:, ::-1]
    points.append(here.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
    corners.append(triangles + start)
    counts.append(faces + polygons)
    polygons += len(mesh.polygons)
    start += len(mesh.vertices)
    nodes = [node for used in mesh.materials if used and used.node_tree for node in used.node_tree.nodes]
    here = {"names": True, "texture coordinates": mesh.uv_layers, "materials": mesh.materials, "skeletons": one.find_armature(),
            "colors": mesh.color_attributes, "shape keys": one.data.shape_keys,
            "textures": any(node.type == "TEX_IMAGE" for node in nodes)}
    dropped |= {kind for kind, there in here.items() if there}
    evaluated.to_mesh_clear()
join = lambda arrays, shape: numpy.concatenate(arrays) if arrays else numpy.zeros(shape)
numpy.save(folder + "/dropped.npy", numpy.array(sorted(dropped), str))
numpy.save(folder + "/vertices.npy", join(points, (0, 3)))
numpy.save(folder + "/triangles.npy", join(corners, (0, 3)).astype(numpy.int32))
numpy.save(folder + "/faces.npy", join(counts, 0).astype(numpy.int32))
"""


def blender():
    """The path of the Blender that is on the PATH, or None."""
    return shutil.which("blender")


@functools.lru_cache(None)
def version():
    """What that Blender says it is, or "none"."""
    if not blender():
        return "none"
    result = subprocess.run([blender(), "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    return (result.stdout.splitlines() or ["none"])[0]


def read(path, folder):
    """The meshes.Mesh. Modifiers are applied, scripts in the file are not run. folder: where files may be made and taken
    away again. Raises MeshFileError."""
    program = blender()
    if not program:
        raise MeshFileError("Reading .blend files needs Blender, and there is no program blender on the PATH.")
    with tempfile.TemporaryDirectory(dir=folder) as folder:
        result = subprocess.run(
            [program, "--background", "-noaudio", "--factory-startup", "--disable-autoexec", str(Path(path).absolute()),
             "--python-exit-code", "9", "--python-expr", SCRIPT, "--", folder],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        try:
            vertices, triangles, faces, dropped = (np.load(f"{folder}/{name}.npy")
                                                   for name in ("vertices", "triangles", "faces", "dropped"))
        except (OSError, ValueError) as error:
            said = result.stdout.decode("utf-8", "replace").strip().splitlines()[-1:] or ["nothing"]
            how = describe_exit(result.returncode) if result.returncode else "wrote no mesh"
            raise MeshFileError(f"Blender can't read {Path(path).name}: it {how}; its last words: {said[0]}") from error
    if not len(triangles):
        raise MeshFileError(f"{Path(path).name} holds no mesh objects with faces.")
    return Mesh(vertices, triangles, faces, int(faces.max()) + 1, 0, tuple(kind for kind in KINDS if kind in dropped))
