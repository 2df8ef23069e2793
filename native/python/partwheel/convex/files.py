# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes convex hulls to files, by the conventions of engines and simulators.

Formats, where NAME is the model's name and 00 a hull's number:

obj     NAME_hulls.obj, one object per hull, UCX_NAME_00 and so on
glb     NAME_hulls.glb, the same
unreal  NAME_unreal.glb, the model NAME with the hulls UCX_NAME_00, which Unreal imports as its collision
godot   NAME_godot.glb, the model with the hulls NAME_00-convcolonly, which Godot imports as a body with shapes
urdf    NAME.urdf, a link whose visual is the model and whose collision are the hulls; meshes in NAME_hulls/
mjcf    NAME.xml, a free MuJoCo body with a geom for the model, if it has at most 200,000 faces, and one for each hull;
        meshes in NAME_hulls/
usd     NAME.usda, a UsdPhysics body with the model and the hulls, which are guides

The model has its materials, textures and colors; in usd it has none. Coordinates are the model's; simulators take
them as meters, with z up. In glb files each node of a hull has the extras "collider" ("hull" or the kind of the
primitive), "of" (the model's name) and, for primitives, "size" along the node's axes.
"""

import re
from functools import cache
from pathlib import Path
from typing import Any, Callable, Collection, Dict, Iterable, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from .. import wavefront
from ..appearance import Appearance, Image, to_png
from ..gltf import Node, write_glb
from ..meshes import Mesh
from ..output import whole_file
from ..separation import separate
from . import simulators
from .mass import MassProperties
from .primitives import KINDS, fit_primitive, kind_of

FORMATS = "obj", "glb", "unreal", "godot", "urdf", "mjcf", "usd"
# Kind of a collision shape -> the prefix by which Unreal recognizes it.
UNREAL_PREFIXES = {"hull": "UCX", "box": "UBX", "sphere": "USP", "capsule": "UCP"}


def write(folder: Path, name: str, mesh: Mesh, hulls: Sequence[Sequence[Any]], formats: Collection[str] = ("obj",),
          primitives: Optional[float] = None, mass: Optional[MassProperties] = None) -> List[Path]:
    """Writes hulls [(vertices (n, 3), triangles (m, 3), ...), ...] of a model into a folder, which is created, in some of
    FORMATS; returns the files' paths.

    name : of the model; characters other than letters, digits, ".", "-" and "_" become "_"
    primitives : the max_excess of fit_primitive(), for formats that have primitives: mjcf and usd; urdf, except for capsules;
        glb and unreal, except for cylinders, with the names UBX_NAME_00, USP_NAME_00, UCP_NAME_00. None: hulls only
    mass : of the body, for urdf, mjcf and usd, see mass_properties(); None: simulators derive it from the shapes

    Raises OSError, or RequirementError if the package for images is missing, which converts textures that a format doesn't
    take."""
    name = re.sub(r"[^\w.-]", "_", name)
    folder.mkdir(parents=True, exist_ok=True)
    model = Node(name, -1, mesh.vertices, mesh.triangles,
                 mesh.appearance or Appearance({}, np.full(len(mesh.triangles), -1)))
    hulls = [separate(*hull[:2])[:2] for hull in hulls]
    paths = []

    @cache
    def shapes(*kinds: str) -> List[Any]:
        """The collision shapes for a format that has these kinds of primitive."""
        fits = [primitives is not None and fit_primitive(hull[0], hull[1], primitives, kinds) for hull in hulls]
        return [primitive or hull for primitive, hull in zip(fits, hulls)]

    def write_file(file_name: str, writer: Callable[..., Any], *arguments: Any) -> None:
        path = folder / file_name
        path.parent.mkdir(exist_ok=True)
        with whole_file(path):
            writer(path, *arguments)
        paths.append(path)

    named_hulls = {f"{number:02}": hull for number, hull in enumerate(hulls)}
    _write_for_engines(write_file, model, named_hulls, formats, shapes)
    _write_for_simulators(write_file, model, named_hulls, formats, shapes, mass)
    return list(dict.fromkeys(paths))  # materials may share an image


def _write_for_engines(write_file: Callable[..., None], model: Node, hulls: Dict[str, Any], formats: Collection[str],
                       shapes: Callable[..., List[Any]]) -> None:
    name = model.name
    if "obj" in formats:
        write_file(f"{name}_hulls.obj", write_obj, [(f"UCX_{name}_{number}", *hull) for number, hull in hulls.items()])
    if {"glb", "unreal"} & set(formats):
        named_shapes = [(f"{UNREAL_PREFIXES[kind_of(shape)]}_{name}_{number}", shape)
                        for number, shape in zip(hulls, shapes("sphere", "capsule", "box"))]
        if "glb" in formats:
            write_file(f"{name}_hulls.glb", _write_glb, name, [], named_shapes)
        if "unreal" in formats:
            write_file(f"{name}_unreal.glb", _write_glb, name, [model], named_shapes)
    if "godot" in formats:
        named_hulls = [(f"{name}_{number}-convcolonly", hull) for number, hull in hulls.items()]
        write_file(f"{name}_godot.glb", _write_glb, name, [model], named_hulls)


def _write_for_simulators(write_file: Callable[..., None], model: Node, hulls: Dict[str, Any], formats: Collection[str],
                          shapes: Callable[..., List[Any]], mass: Optional[MassProperties]) -> None:
    name, folder = model.name, f"{model.name}_hulls"
    if {"urdf", "mjcf"} & set(formats):
        for number, hull in hulls.items():
            write_file(f"{folder}/{number}.obj", write_obj, [(number, *hull)])
    files = [f"{folder}/{number}.obj" for number in hulls]
    if "urdf" in formats:
        for file_name, data in wavefront.write_obj("model", [model]).items():
            write_file(f"{folder}/{file_name}", Path.write_bytes, data)
        write_file(f"{name}.urdf", simulators.write_urdf, name, f"{folder}/model.obj", files,
                   shapes("box", "sphere", "cylinder"), mass)
    if "mjcf" in formats:
        visuals = []
        if len(model.triangles) <= simulators.MAX_MUJOCO_FACES:
            for k, (surface, color, image) in enumerate(_divide_by_material(model)):
                visuals.append(simulators.Visual(f"{folder}/visual_{k:02}.obj", color,
                                                 f"{folder}/{image.name}" if image else None))
                write_file(visuals[-1].mesh, Path.write_bytes, wavefront.write_obj("", [surface])[".obj"])
                if image:
                    write_file(f"{folder}/{image.name}", Path.write_bytes, image.data)
        write_file(f"{name}.xml", simulators.write_mjcf, name, visuals, files, shapes(*KINDS), mass)
    if "usd" in formats:
        write_file(f"{name}.usda", simulators.write_usd, name, (model.vertices, model.triangles), shapes(*KINDS), mass)


def _divide_by_material(model: Node) -> Iterator[Tuple[Node, Optional[np.ndarray], Optional[Image]]]:
    """The triangles of each material as surfaces with texture coordinates; their linear base color, None without a material, and
    their texture as PNG. Raises RequirementError if it isn't PNG and the package for images is missing."""
    look = model.appearance
    for number in np.unique(look.face_materials).tolist():
        is_of_material = look.face_materials == number
        coordinates = look.base_coordinates(number, np.flatnonzero(is_of_material))
        attributes = {} if coordinates is None else {"TEXCOORD_0": coordinates}
        surface = model._replace(triangles=model.triangles[is_of_material],
                                 appearance=Appearance(attributes, np.full(is_of_material.sum(), -1)))
        index = look.base_image(number) if attributes else None
        image = None if index is None else look.images[index]
        yield surface, look.base_color(number), image and (image if image.mime_type == "image/png" else to_png(image))


def write_obj(path: Path, objects: Iterable[Tuple[Any, ...]]) -> None:
    """Writes a Wavefront OBJ file; objects: (name, vertices (n, 3), triangles (m, 3)) each. Raises OSError."""
    nodes = [Node(name, -1, vertices, triangles, Appearance({}, np.full(len(triangles), -1)))
             for name, vertices, triangles in objects]
    path.write_bytes(wavefront.write_obj("", nodes)[".obj"])


def _write_glb(path: Path, name: str, models: Sequence[Node], named_shapes: Iterable[Tuple[str, Any]]) -> None:
    """Writes a glb file of shapes with their names, which belong to the model with this name, and of its surface if it is
    among models."""
    nodes = list(models)
    look = models[0].appearance if models else Appearance({}, np.empty(0, int))
    for shape_name, shape in named_shapes:
        is_hull, extras = kind_of(shape) == "hull", {"collider": kind_of(shape), "of": name}
        vertices, triangles = shape if is_hull else shape.mesh()
        appearance = look._replace(attributes={}, face_materials=np.full(len(triangles), -1))
        nodes.append(Node(shape_name, -1, vertices, triangles, appearance, None if is_hull else shape.matrix(),
                          extras if is_hull else {**extras, "size": (2 * shape.half_extents).tolist()}))
    path.write_bytes(write_glb(nodes))
