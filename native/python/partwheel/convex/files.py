# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes convex hulls to files, by the conventions of engines and simulators."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Collection, Iterable, List, Optional, Sequence, Tuple

import numpy as np

from ..output import whole_file
from ..requirements import load_module
from ..separation import separate
from . import simulators
from .mass import MassProperties
from .primitives import KINDS, fit_primitive, kind_of

if TYPE_CHECKING:
    from ..meshes import Mesh

FORMATS = "obj", "glb", "unreal", "godot", "urdf", "mjcf", "usd"
# Kind of a collision shape -> the prefix by which Unreal recognizes it.
UNREAL_PREFIXES = {"hull": "UCX", "box": "UBX", "sphere": "USP", "capsule": "UCP"}

Hull = Tuple[np.ndarray, np.ndarray]  # vertices (n, 3), triangles (m, 3)


def write(folder: Path, name: str, mesh: Mesh, hulls: Sequence[Sequence[Any]], formats: Collection[str] = ("obj",),
          primitives: Optional[float] = None, mass: Optional[MassProperties] = None) -> List[Path]:
    """Writes hulls into a folder.

    Formats, where NAME is the model's name and 00 a hull's number:

    obj     NAME_hulls.obj, one object per hull, UCX_NAME_00 and so on
    glb     NAME_hulls.glb, the same
    unreal  NAME_unreal.glb, the model NAME with the hulls UCX_NAME_00, which Unreal imports as its collision
    godot   NAME_godot.glb, the model with the hulls NAME_00-convcolonly, which Godot imports as a body with shapes
    urdf    NAME.urdf, a link whose visual is the model and whose collision are the hulls; meshes in NAME_hulls/
    mjcf    NAME.xml, a free MuJoCo body with a geom for the model, if it has at most 200,000 faces, and one for each hull;
            meshes in NAME_hulls/
    usd     NAME.usda, a UsdPhysics body with the model and the hulls, which are guides

    Coordinates are the model's; simulators take them as meters, with z up. In glb files each node of a hull has the
    extras "collider" ("hull" or the kind of the primitive), "of" (the model's name) and, for primitives, "size" along
    the node's axes.

    Parameters
    ----------
    folder : created if it does not exist
    name : of the model; characters other than letters, digits, ".", "-" and "_" become "_"
    mesh : the model
    hulls : [(vertices (n, 3), triangles (m, 3), ...), ...]
    formats : from FORMATS
    primitives : the max_excess of fit_primitive(), for formats that have primitives: mjcf and usd; urdf, except for
        capsules; glb and unreal, except for cylinders, with the names UBX_NAME_00, USP_NAME_00, UCP_NAME_00. None:
        hulls only
    mass : of the body, for urdf, mjcf and usd, see mass_properties(); None: simulators derive it from the shapes

    Returns
    -------
    the paths of the files

    Raises
    ------
    RequirementError : trimesh, which writes glb, is not installed
    OSError : a file can't be written
    """
    name = re.sub(r"[^\w.-]", "_", name)
    folder.mkdir(parents=True, exist_ok=True)
    numbers = [f"{number:02}" for number in range(len(hulls))]
    surface = mesh.vertices, mesh.triangles
    hulls = [separate(*hull[:2])[:2] for hull in hulls]
    paths = []

    @cache
    def shapes(*kinds: str) -> List[Any]:
        """The collision shapes for a format that has these kinds of primitive."""
        fits = [primitives is not None and fit_primitive(hull[0], hull[1], primitives, kinds) for hull in hulls]
        return [primitive or hull for primitive, hull in zip(fits, hulls)]

    def write_file(file_name: str, writer: Callable[..., None], *arguments: Any) -> None:
        path = folder / file_name
        path.parent.mkdir(exist_ok=True)
        with whole_file(path):
            writer(path, *arguments)
        paths.append(path)

    if "obj" in formats:
        write_file(f"{name}_hulls.obj", write_obj, [(f"UCX_{name}_{number}", *hull) for number, hull in zip(numbers, hulls)])
    if {"glb", "unreal"} & set(formats):
        named_shapes = [(f"{UNREAL_PREFIXES[kind_of(shape)]}_{name}_{number}", shape)
                        for number, shape in zip(numbers, shapes("sphere", "capsule", "box"))]
        if "glb" in formats:
            write_file(f"{name}_hulls.glb", _write_glb, name, None, named_shapes)
        if "unreal" in formats:
            write_file(f"{name}_unreal.glb", _write_glb, name, surface, named_shapes)
    if "godot" in formats:
        named_hulls = [(f"{name}_{number}-convcolonly", hull) for number, hull in zip(numbers, hulls)]
        write_file(f"{name}_godot.glb", _write_glb, name, surface, named_hulls)
    if {"urdf", "mjcf"} & set(formats):
        for number, hull in zip(numbers, hulls):
            write_file(f"{name}_hulls/{number}.obj", write_obj, [(number, *hull)])
    files = [f"{name}_hulls/{number}.obj" for number in numbers]
    model = f"{name}_hulls/model.obj"
    fits_mujoco = len(mesh.triangles) <= simulators.MAX_MUJOCO_FACES
    if "urdf" in formats or ("mjcf" in formats and fits_mujoco):
        write_file(model, write_obj, [(name, *surface)])
    if "urdf" in formats:
        write_file(f"{name}.urdf", simulators.write_urdf, name, model, files, shapes("box", "sphere", "cylinder"), mass)
    if "mjcf" in formats:
        write_file(f"{name}.xml", simulators.write_mjcf, name, model if fits_mujoco else None, files, shapes(*KINDS), mass)
    if "usd" in formats:
        write_file(f"{name}.usda", simulators.write_usd, name, surface, shapes(*KINDS), mass)
    return paths


def write_obj(path: Path, objects: Iterable[Tuple[Any, ...]]) -> None:
    """Writes a Wavefront OBJ file; objects: (name, vertices (n, 3), triangles (m, 3)) each. Raises OSError."""
    first = 1
    with open(path, "w", encoding="utf-8") as file:
        for name, vertices, triangles in objects:
            file.write(f"o {name}\n")
            file.writelines("v {!r} {!r} {!r}\n".format(*point) for point in vertices.tolist())
            file.writelines("f {} {} {}\n".format(*corners) for corners in (triangles + first).tolist())
            first += len(vertices)


def _write_glb(path: Path, model: str, surface: Optional[Hull], named_shapes: Iterable[Tuple[str, Any]]) -> None:
    """Writes a glb file of shapes with their names, and of the model's surface unless it is None."""
    trimesh = load_module("trimesh", "Writing glb files")
    scene = trimesh.Scene()

    def add(name: str, mesh: Hull, **options: Any) -> None:
        scene.add_geometry(trimesh.Trimesh(*mesh, process=False), node_name=name, geom_name=name, **options)

    if surface:
        add(model, surface)
    for name, shape in named_shapes:
        extras = {"collider": kind_of(shape), "of": model}
        if extras["collider"] == "hull":
            add(name, shape, metadata=extras)
        else:
            add(name, shape.mesh(), transform=shape.matrix(), metadata={**extras, "size": (2 * shape.half_extents).tolist()})
    path.write_bytes(scene.export(file_type="glb"))
