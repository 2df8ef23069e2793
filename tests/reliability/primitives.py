# SPDX-License-Identifier: GPL-3.0-or-later
"""Run by Blender: writes its primitive meshes, as quads and as triangles, as .npz files of arrays.

    blender -b --factory-startup --python tests/reliability/primitives.py -- DIRECTORY
"""

import sys
from pathlib import Path

import bmesh
import bpy
import numpy as np

PRIMITIVES = ("plane", "cube", "circle", "uv_sphere", "ico_sphere", "cylinder", "cone", "torus", "grid", "monkey")


def arrays(mesh):
    mesh.calc_loop_triangles()
    return {
        "vertices": np.array([tuple(vertex.co) for vertex in mesh.vertices], np.float64),
        "triangles": np.array([tuple(triangle.vertices) for triangle in mesh.loop_triangles], np.int32).reshape(-1, 3),
        "faces": np.array([triangle.polygon_index for triangle in mesh.loop_triangles], np.int32),
        "face_count": len(mesh.polygons),
    }


def main(directory):
    for name in PRIMITIVES:
        # A circle of faces, not the empty ring that Blender creates by default.
        options = {"fill_type": "NGON"} if name == "circle" else {}
        getattr(bpy.ops.mesh, f"primitive_{name}_add")(**options)
        mesh = bpy.context.object.data
        np.savez(directory / f"{name}.npz", **arrays(mesh))
        triangulated = bmesh.new()
        triangulated.from_mesh(mesh)
        bmesh.ops.triangulate(triangulated, faces=triangulated.faces)
        triangulated.to_mesh(mesh)
        triangulated.free()
        np.savez(directory / f"{name}_triangles.npz", **arrays(mesh))


if __name__ == "__main__":
    main(Path(sys.argv[sys.argv.index("--") + 1]))
