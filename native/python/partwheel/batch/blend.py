# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the mesh objects of a .blend file as one mesh, with modifiers and transforms applied, by Blender in the
background."""

import functools
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Union

import numpy as np

from ..contents import KINDS
from ..meshes import Mesh, MeshFileError
from ..worker.exit_status import describe_exit

# The script that Blender runs. It writes each array to a file in the folder.
SCRIPT = """
import bpy, sys, numpy
folder = sys.argv[-1]
vertices, triangles, faces, vertex_count, polygon_count, dropped = [], [], [], 0, 0, set()
graph = bpy.context.evaluated_depsgraph_get()
for obj in sorted(bpy.context.scene.objects, key=lambda obj: obj.name):
    if obj.type != "MESH" or obj.hide_render:
        continue
    evaluated = obj.evaluated_get(graph)
    mesh = evaluated.to_mesh()
    mesh.calc_loop_triangles()
    coordinates = numpy.empty(len(mesh.vertices) * 3)
    mesh.vertices.foreach_get("co", coordinates)
    matrix = numpy.array(evaluated.matrix_world)
    corners = numpy.empty(len(mesh.loop_triangles) * 3, numpy.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    polygons = numpy.empty(len(mesh.loop_triangles), numpy.int32)
    mesh.loop_triangles.foreach_get("polygon_index", polygons)
    corners = corners.reshape(-1, 3)
    if numpy.linalg.det(matrix[:3, :3]) < 0:
        corners = corners[:, ::-1]
    vertices.append(coordinates.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
    triangles.append(corners + vertex_count)
    faces.append(polygons + polygon_count)
    polygon_count += len(mesh.polygons)
    vertex_count += len(mesh.vertices)
    nodes = [node for material in mesh.materials if material and material.node_tree for node in material.node_tree.nodes]
    contents = {"names": True, "texture coordinates": mesh.uv_layers, "materials": mesh.materials,
                "skeletons": obj.find_armature(), "colors": mesh.color_attributes, "shape keys": obj.data.shape_keys,
                "textures": any(node.type == "TEX_IMAGE" for node in nodes)}
    dropped |= {kind for kind, content in contents.items() if content}
    evaluated.to_mesh_clear()
join = lambda arrays, shape: numpy.concatenate(arrays) if arrays else numpy.zeros(shape)
numpy.save(folder + "/dropped.npy", numpy.array(sorted(dropped), str))
numpy.save(folder + "/vertices.npy", join(vertices, (0, 3)))
numpy.save(folder + "/triangles.npy", join(triangles, (0, 3)).astype(numpy.int32))
numpy.save(folder + "/faces.npy", join(faces, 0).astype(numpy.int32))
"""


@functools.cache
def version() -> str:
    """The first line of Blender's --version; "none" without Blender."""
    program = shutil.which("blender")
    if not program:
        return "none"
    result = subprocess.run([program, "--version"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    return (result.stdout.splitlines() or ["none"])[0]


def read(path: Union[str, Path], folder: Path) -> Mesh:
    """Reads a .blend file with modifiers applied; scripts in the file are not run. folder : where to create a temporary one.
    Raises MeshFileError."""
    program = shutil.which("blender")
    if not program:
        raise MeshFileError("Reading .blend files needs Blender, and there is no program blender on the PATH.")
    with tempfile.TemporaryDirectory(dir=folder) as arrays:
        result = subprocess.run(
            [program, "--background", "-noaudio", "--factory-startup", "--disable-autoexec", str(Path(path).absolute()),
             "--python-exit-code", "9", "--python-expr", SCRIPT, "--", arrays],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        try:
            vertices, triangles, faces, dropped = (np.load(f"{arrays}/{name}.npy")
                                                   for name in ("vertices", "triangles", "faces", "dropped"))
        except (OSError, ValueError) as error:
            last_line = (result.stdout.decode("utf-8", "replace").strip().splitlines()[-1:] or ["nothing"])[0]
            ending = describe_exit(result.returncode) if result.returncode else "wrote no mesh"
            raise MeshFileError(f"Blender can't read {Path(path).name}: it {ending}; its last output: {last_line}") from error
    if not len(triangles):
        raise MeshFileError(f"{Path(path).name} has no mesh objects with faces.")
    return Mesh(vertices, triangles, faces, int(faces.max()) + 1, 0, tuple(kind for kind in KINDS if kind in dropped))
