# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls as files, by the conventions of engines and simulators."""

import re

from ..meshes import needed_trimesh
from . import simulators

FORMATS = "obj", "glb", "unreal", "godot", "urdf", "mjcf", "usd"


def write(folder, name, mesh, hulls, formats=("obj",)):
    """Writes hulls into a folder, made if it is not there; [path, ...] what was written.

    obj: NAME_hulls.obj, an object for each, UCX_NAME_00 and so on. glb: NAME_hulls.glb, the same. unreal: NAME_unreal.glb,
    the model NAME with the hulls UCX_NAME_00 and so on, which Unreal takes as its collision. godot: NAME_godot.glb, the model
    with the hulls NAME_00-convcolonly and so on, of which Godot makes a body with shapes. urdf: NAME.urdf, a link that looks
    as the model and collides as the hulls. mjcf: NAME.xml, a body of MuJoCo's, falling freely, with a mesh and a geom for
    each hull. These two name files in NAME_hulls/. usd: NAME.usda, a body of UsdPhysics that looks as the model and collides
    as the hulls, which are guides. All in the unit of the model, which simulators take for metres, and z for up.

    hulls: [(vertices, triangles, ...), ...]. mesh: a meshes.Mesh. Raises MeshFileError without trimesh, where glb is
    written; OSError."""
    name = re.sub(r"[^\w.-]", "_", name)  # as all readers take it
    folder.mkdir(parents=True, exist_ok=True)
    numbers = [f"{number:02}" for number in range(len(hulls))]
    unreal = [f"UCX_{name}_{number}" for number in numbers]
    model = name, mesh.vertices, mesh.triangles
    written = []

    def named(names):
        return [(each, *hull[:2]) for each, hull in zip(names, hulls)]

    def put(file_name, write_it, *arguments):
        path = folder / file_name
        path.parent.mkdir(exist_ok=True)
        write_it(path, *arguments)
        written.append(path)

    if "obj" in formats:
        put(f"{name}_hulls.obj", write_obj, named(unreal))
    if "glb" in formats:
        put(f"{name}_hulls.glb", _write_glb, named(unreal))
    if "unreal" in formats:
        put(f"{name}_unreal.glb", _write_glb, [model, *named(unreal)])
    if "godot" in formats:
        put(f"{name}_godot.glb", _write_glb, [model, *named(f"{name}_{number}-convcolonly" for number in numbers)])
    if {"urdf", "mjcf"} & set(formats):
        for each in named(numbers):
            put(f"{name}_hulls/{each[0]}.obj", write_obj, [each])
    files = [f"{name}_hulls/{number}.obj" for number in numbers]
    if "urdf" in formats:
        put(f"{name}_hulls/model.obj", write_obj, [model])
        put(f"{name}.urdf", simulators.write_urdf, name, f"{name}_hulls/model.obj", files)
    if "mjcf" in formats:
        put(f"{name}.xml", simulators.write_mjcf, name, files)
    if "usd" in formats:
        put(f"{name}.usda", simulators.write_usd, name, model, named(f"hull_{number}" for number in numbers))
    return written


def write_obj(path, named):
    """named: [(name, vertices, triangles), ...], an object each."""
    first = 1
    with open(path, "w", encoding="utf-8") as file:
        for name, vertices, triangles in named:
            file.write(f"o {name}\n")
            file.writelines("v {!r} {!r} {!r}\n".format(*point) for point in vertices.tolist())
            file.writelines("f {} {} {}\n".format(*corners) for corners in (triangles + first).tolist())
            first += len(vertices)


def _write_glb(path, named):
    trimesh = needed_trimesh("Writing glb files")
    scene = trimesh.Scene()
    for name, vertices, triangles in named:
        scene.add_geometry(trimesh.Trimesh(vertices, triangles, process=False), node_name=name, geom_name=name)
    path.write_bytes(scene.export(file_type="glb"))
