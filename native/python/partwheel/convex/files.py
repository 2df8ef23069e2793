# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls as files, by the conventions of engines and simulators."""

import re
from functools import cache

from ..requirements import load_module
from . import simulators
from .primitives import KINDS, around, kind_of

FORMATS = "obj", "glb", "unreal", "godot", "urdf", "mjcf", "usd"
# How the names of what collides begin.
UNREAL = {"hull": "UCX", "box": "UBX", "sphere": "USP", "capsule": "UCP"}


def write(folder, name, mesh, hulls, formats=("obj",), primitives=None):
    """Writes hulls into a folder, made if it is not there; [path, ...] what was written.

    obj: NAME_hulls.obj, an object for each, UCX_NAME_00 and so on. glb: NAME_hulls.glb, the same. unreal: NAME_unreal.glb,
    the model NAME with the hulls UCX_NAME_00 and so on, which Unreal takes as its collision. godot: NAME_godot.glb, the model
    with the hulls NAME_00-convcolonly and so on, of which Godot makes a body with shapes. urdf: NAME.urdf, a link that looks
    as the model and collides as the hulls. mjcf: NAME.xml, a body of MuJoCo's, falling freely, with a mesh and a geom for
    each hull. These two name files in NAME_hulls/. usd: NAME.usda, a body of UsdPhysics that looks as the model and collides
    as the hulls, which are guides. All in the unit of the model, which simulators take for metres, and z for up.

    primitives: None for hulls alone, or the length that a box, sphere, capsule or cylinder may reach beyond a hull to be
    taken in its place, see around(): in mjcf and usd; in urdf, which has no capsules; in glb and unreal, which have no
    cylinders, named UBX_NAME_00, USP_..., UCP_... and turned by their nodes.

    In all glb files a node of a hull has the extras "collider", "hull" or the kind of a primitive; "of", the model's name;
    and "size" of a primitive, along the node's own axes.

    hulls: [(vertices, triangles, ...), ...]. mesh: a meshes.Mesh. Raises RequirementError without trimesh, where
    glb is written; OSError."""
    name = re.sub(r"[^\w.-]", "_", name)  # as all readers take it
    folder.mkdir(parents=True, exist_ok=True)
    numbers = [f"{number:02}" for number in range(len(hulls))]
    surface = mesh.vertices, mesh.triangles
    hulls = [hull[:2] for hull in hulls]
    written = []

    @cache
    def shapes(*kinds):
        """What collides where there are these kinds: hulls, and Primitives."""
        taken = [primitives is not None and around(*hull, primitives, kinds) for hull in hulls]
        return [primitive or hull for primitive, hull in zip(taken, hulls)]

    def put(file_name, write_it, *arguments):
        path = folder / file_name
        path.parent.mkdir(exist_ok=True)
        write_it(path, *arguments)
        written.append(path)

    unreal = [f"UCX_{name}_{number}" for number in numbers]
    if "obj" in formats:
        put(f"{name}_hulls.obj", write_obj, [(each, *hull) for each, hull in zip(unreal, hulls)])
    if {"glb", "unreal"} & set(formats):
        found = shapes("sphere", "capsule", "box")
        found = [(f"{UNREAL[kind_of(each)]}_{name}_{number}", each) for number, each in zip(numbers, found)]
        if "glb" in formats:
            put(f"{name}_hulls.glb", _write_glb, name, None, found)
        if "unreal" in formats:
            put(f"{name}_unreal.glb", _write_glb, name, surface, found)
    if "godot" in formats:
        named = [(f"{name}_{number}-convcolonly", hull) for number, hull in zip(numbers, hulls)]
        put(f"{name}_godot.glb", _write_glb, name, surface, named)
    if {"urdf", "mjcf"} & set(formats):
        for number, hull in zip(numbers, hulls):
            put(f"{name}_hulls/{number}.obj", write_obj, [(number, *hull)])
    files = [f"{name}_hulls/{number}.obj" for number in numbers]
    if "urdf" in formats:
        put(f"{name}_hulls/model.obj", write_obj, [(name, *surface)])
        put(f"{name}.urdf", simulators.write_urdf, name, f"{name}_hulls/model.obj", files, shapes("box", "sphere", "cylinder"))
    if "mjcf" in formats:
        put(f"{name}.xml", simulators.write_mjcf, name, files, shapes(*KINDS))
    if "usd" in formats:
        put(f"{name}.usda", simulators.write_usd, name, surface, shapes(*KINDS))
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


def _write_glb(path, model, surface, named):
    """model: its name; surface: (vertices, triangles), or None. named: [(name, hull or Primitive), ...]."""
    trimesh = load_module("trimesh", "Writing glb files")
    scene = trimesh.Scene()

    def add(name, mesh, **more):
        scene.add_geometry(trimesh.Trimesh(*mesh, process=False), node_name=name, geom_name=name, **more)

    if surface:
        add(model, surface)
    for name, shape in named:
        extras = {"collider": kind_of(shape), "of": model}
        if extras["collider"] == "hull":
            add(name, shape, metadata=extras)
        else:
            add(name, shape.mesh(), transform=shape.matrix(), metadata={**extras, "size": (2 * shape.half).tolist()})
    path.write_bytes(scene.export(file_type="glb"))
