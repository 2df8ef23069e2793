# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigid bodies with collision shapes for robot simulators: URDF, MuJoCo's MJCF, USD.

A shape is (vertices (n, 3), triangles (m, 3)) of a hull, or a Primitive. Without MassProperties a simulator derives the mass
from the shapes, and counts it twice where two of them overlap."""

import re
from pathlib import Path
from typing import Any, Dict, Iterable, List, NamedTuple, Optional, Sequence, Tuple
from xml.etree import ElementTree

import numpy as np

from ..appearance import to_srgb
from .mass import MassProperties
from .primitives import Primitive, kind_of

MAX_MUJOCO_FACES = 200_000  # of a mesh


def write_urdf(path: Path, name: str, model: str, files: Sequence[str], shapes: Sequence[Any],
               mass: Optional[MassProperties] = None) -> None:
    """Writes a robot of one link. model : the mesh file of the surface, files : those of the hulls, relative to the path;
    shapes : one for each hull; mass : None: no inertial element. Raises OSError."""
    robot = ElementTree.Element("robot", name=name)
    link = ElementTree.SubElement(robot, "link", name=name)
    if mass:
        set_inertial(link, mass)

    def add(role: str, name: str) -> ElementTree.Element:
        return ElementTree.SubElement(link, role, name=name)

    def add_mesh(element: ElementTree.Element, file: str) -> None:
        ElementTree.SubElement(ElementTree.SubElement(element, "geometry"), "mesh", filename=file)

    add_mesh(add("visual", "model"), model)
    for number, (file, shape) in enumerate(zip(files, shapes)):
        element = add("collision", f"{number:02}")
        if kind_of(shape) == "hull":
            add_mesh(element, file)
            continue
        ElementTree.SubElement(element, "origin", xyz=_text(shape.center), rpy=_text(_roll_pitch_yaw(shape.axes)))
        radius, length = _text(shape.half_extents[:1]), _text(2 * shape.half_extents[2:])
        sizes = {"box": {"size": _text(2 * shape.half_extents)}, "sphere": {"radius": radius},
                 "cylinder": {"radius": radius, "length": length}}
        ElementTree.SubElement(ElementTree.SubElement(element, "geometry"), shape.kind, sizes[shape.kind])
    write_xml(path, robot)


def set_inertial(link: ElementTree.Element, mass: MassProperties) -> None:
    """Replaces the inertial element of a URDF link."""
    for old in link.findall("inertial"):
        link.remove(old)
    inertial = ElementTree.SubElement(link, "inertial")
    ElementTree.SubElement(inertial, "origin", xyz=_text(mass.center), rpy="0 0 0")
    ElementTree.SubElement(inertial, "mass", value=_text([mass.mass]))
    ElementTree.SubElement(inertial, "inertia", {f"i{'xyz'[i]}{'xyz'[j]}": _text([mass.inertia[i, j]])
                                                 for i in range(3) for j in range(i, 3)})


class Visual(NamedTuple):
    """What a simulator shows."""

    mesh: str  # the mesh file, relative to the simulator's file
    color: Optional[np.ndarray]  # (4,) linear RGBA; None: the simulator's own
    texture: Optional[str]  # a PNG file, or None


def write_mjcf(path: Path, name: str, visuals: Sequence[Visual], files: Sequence[str], shapes: Sequence[Any],
               mass: Optional[MassProperties] = None) -> None:
    """Writes a free body. As in MuJoCo Menagerie, its geoms are of the class visual, in group 2, or collision, in group 3.

    visuals : the surface, in one piece for each material, since MuJoCo's meshes have one; none: only the collision geoms
    files, shapes : see write_urdf()
    mass : None: MuJoCo adds up the geoms

    Raises OSError."""
    root = ElementTree.Element("mujoco", model=name)
    defaults = ElementTree.SubElement(root, "default")
    for kind, attributes in (("visual", {"group": "2", "contype": "0", "conaffinity": "0", "mass": "0"}),
                             ("collision", {"group": "3"})):
        ElementTree.SubElement(ElementTree.SubElement(defaults, "default", {"class": kind}), "geom", attributes)
    asset, world = ElementTree.SubElement(root, "asset"), ElementTree.SubElement(root, "worldbody")
    body = ElementTree.SubElement(world, "body", name=name)
    ElementTree.SubElement(body, "freejoint")
    if mass:
        tensor = [mass.inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
        ElementTree.SubElement(body, "inertial", pos=_text(mass.center), mass=_text([mass.mass]), fullinertia=_text(tensor))
    for number, visual in enumerate(visuals):
        title = f"visual_{number:02}"
        material: Dict[str, str] = {}
        ElementTree.SubElement(asset, "mesh", name=title, file=visual.mesh, inertia="shell")  # the surface may be open
        if visual.texture:
            ElementTree.SubElement(asset, "texture", name=title, type="2d", file=visual.texture)
            material["texture"] = title
        if visual.color is not None:
            material["rgba"] = _text([*to_srgb(visual.color[:3]), visual.color[3]])
            ElementTree.SubElement(asset, "material", {"name": title, **material})
        ElementTree.SubElement(body, "geom", {"class": "visual", "type": "mesh", "mesh": title,
                                              **({"material": title} if material else {})})
    for number, (file, shape) in enumerate(zip(files, shapes)):
        if kind_of(shape) == "hull":
            ElementTree.SubElement(asset, "mesh", name=f"hull_{number:02}", file=file, inertia="convex")
            ElementTree.SubElement(body, "geom", {"class": "collision", "type": "mesh", "mesh": f"hull_{number:02}"})
            continue
        radius, _, half = shape.half_extents
        sizes = {"box": shape.half_extents, "sphere": [radius], "capsule": [radius, half - radius],
                 "cylinder": [radius, half]}
        ElementTree.SubElement(body, "geom", {"class": "collision", "type": shape.kind, "size": _text(sizes[shape.kind]),
                                              "pos": _text(shape.center), "xyaxes": _text(shape.axes[:, :2].T.ravel())})
    write_xml(path, root)


def _text(numbers: Iterable[float]) -> str:
    return " ".join(f"{number:.9g}" for number in numbers)


def _roll_pitch_yaw(axes: np.ndarray) -> Tuple[float, float, float]:
    """Angles in radians about the fixed x, y and z axes, in this order, of a rotation matrix (3, 3)."""
    cos_pitch = np.hypot(axes[0, 0], axes[1, 0])
    if cos_pitch < 1e-9:  # gimbal lock: roll and yaw turn about the same axis
        return np.arctan2(-axes[1, 2], axes[1, 1]), np.arctan2(-axes[2, 0], cos_pitch), 0
    return np.arctan2(axes[2, 1], axes[2, 2]), np.arctan2(-axes[2, 0], cos_pitch), np.arctan2(axes[1, 0], axes[0, 0])


def rotation_matrix(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """(3, 3), of angles as in _roll_pitch_yaw()."""
    (a, b, c), (d, e, f) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array([[b * c, d * e * c - a * f, a * e * c + d * f], [b * f, d * e * f + a * c, a * e * f - d * c],
                     [-e, d * b, a * b]])


def write_xml(path: Path, root: ElementTree.Element) -> None:
    """Writes an indented XML file. Raises OSError."""
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


USD = """#usda 1.0
(
    defaultPrim = "{name}"
    kilogramsPerUnit = 1
    metersPerUnit = 1
    upAxis = "Z"
)

def Xform "{name}" (
    prepend apiSchemas = [{schemas}]
)
{{
{mass}{shapes}
}}
"""
USD_SHAPE = """    def {kind} "{name}"{schemas}
    {{
        {lines}
    }}"""


def write_usd(path: Path, name: str, surface: Tuple[np.ndarray, np.ndarray], shapes: Sequence[Any],
              mass: Optional[MassProperties] = None) -> None:
    """Writes a body with a visible mesh, vertices (n, 3) and triangles (m, 3), and collision shapes as guides. Raises
    OSError."""
    prims = [_usd_prim("Mesh", "model", [], _usd_mesh(*surface))]
    for number, shape in enumerate(shapes):
        kind = kind_of(shape)
        title, lines = f"{kind}_{number:02}", ['uniform token purpose = "guide"']
        if kind == "hull":
            lines += ['uniform token physics:approximation = "convexHull"', *_usd_mesh(*shape)]
            prims.append(_usd_prim("Mesh", title, ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"], lines))
        else:
            lines += _usd_primitive(shape)
            prims.append(_usd_prim({"box": "Cube"}.get(kind, kind.title()), title, ["PhysicsCollisionAPI"], lines))
    name = re.sub(r"^(?=\d)|\W", "_", name, flags=re.ASCII)  # a valid USD identifier
    schemas = ["PhysicsRigidBodyAPI"] + ["PhysicsMassAPI"] * bool(mass)
    path.write_text(USD.format(name=name, schemas=", ".join(f'"{schema}"' for schema in schemas),
                               mass=_usd_mass(mass) if mass else "", shapes="\n\n".join(prims)), encoding="utf-8")


def _usd_mass(mass: MassProperties) -> str:
    """The attributes of PhysicsMassAPI, one per line."""
    diagonal, axes = np.linalg.eigh(mass.inertia)
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    lines = [f"float physics:mass = {mass.mass:.9g}", f"point3f physics:centerOfMass = {_points([mass.center])}",
             f"float3 physics:diagonalInertia = {_points([diagonal])}",
             "quatf physics:principalAxes = ({})".format(", ".join(f"{value:.9g}" for value in _quaternion(axes)))]
    return "".join(f"    {line}\n" for line in lines) + "\n"


def _quaternion(rotation: np.ndarray) -> np.ndarray:
    """(4,) w, x, y, z of a rotation matrix (3, 3): the eigenvector of the largest eigenvalue of a symmetric matrix (Bar-Itzhack
    2000)."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    matrix = np.array([[a + e + i, h - f, c - g, d - b], [h - f, a - e - i, b + d, c + g],
                       [c - g, b + d, e - a - i, f + h], [d - b, c + g, f + h, i - a - e]])
    return np.linalg.eigh(matrix)[1][:, 3]


def _usd_prim(kind: str, name: str, schemas: Sequence[str], lines: Sequence[str]) -> str:
    quoted = ", ".join(f'"{schema}"' for schema in schemas)
    applied = f" (\n        prepend apiSchemas = [{quoted}]\n    )" if schemas else ""
    return USD_SHAPE.format(kind=kind, name=name, schemas=applied, lines="\n        ".join(lines))


def _usd_mesh(vertices: np.ndarray, triangles: np.ndarray) -> List[str]:
    """The attributes of a mesh, one per line."""
    return [f"float3[] extent = [{_points([vertices.min(axis=0), vertices.max(axis=0)])}]",
            "int[] faceVertexCounts = [{}]".format(", ".join(["3"] * len(triangles))),
            "int[] faceVertexIndices = [{}]".format(", ".join(map(str, triangles.ravel().tolist()))),
            f"point3f[] points = [{_points(vertices)}]", 'uniform token subdivisionScheme = "none"']


def _usd_primitive(shape: Primitive) -> List[str]:
    """The attributes of a primitive, one per line. A box is a cube of size 2, scaled by its matrix."""
    radius, _, half = shape.half_extents
    matrix = shape.matrix()
    along_z = ['uniform token axis = "Z"', f"double radius = {radius:.9g}"]
    if shape.kind == "box":
        matrix[:3, :3] *= shape.half_extents
        lines = ["double size = 2", f"float3[] extent = [{_points([-np.ones(3), np.ones(3)])}]"]
    else:
        lines = {"sphere": along_z[1:], "capsule": [*along_z, f"double height = {2 * (half - radius):.9g}"],
                 "cylinder": [*along_z, f"double height = {2 * half:.9g}"]}[shape.kind]
        lines.append(f"float3[] extent = [{_points([-shape.half_extents, shape.half_extents])}]")
    rows = ", ".join("({})".format(", ".join(f"{value:.9g}" for value in row)) for row in matrix.T)
    return [*lines, f"matrix4d xformOp:transform = ( {rows} )", 'uniform token[] xformOpOrder = ["xformOp:transform"]']


def _points(points: Iterable[np.ndarray]) -> str:
    return ", ".join("({:.9g}, {:.9g}, {:.9g})".format(*point) for point in points)
