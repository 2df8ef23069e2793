# SPDX-License-Identifier: GPL-3.0-or-later
"""A body that collides as convex hulls and primitives, in the languages of robot simulators: URDF, MuJoCo's, USD."""

import re
from xml.etree import ElementTree

import numpy as np

from .primitives import kind_of

# shapes: what collides, each (vertices, triangles) of a hull or a Primitive.


def write_urdf(path, name, model, files, shapes):
    """model, files: of the surface and of the hulls, as seen from the path."""
    robot = ElementTree.Element("robot", name=name)
    link = ElementTree.SubElement(robot, "link", name=name)

    def add(role, name):
        return ElementTree.SubElement(link, role, name=name)

    def mesh(shape, file):
        ElementTree.SubElement(ElementTree.SubElement(shape, "geometry"), "mesh", filename=file)

    mesh(add("visual", "model"), model)
    for number, (file, shape) in enumerate(zip(files, shapes)):
        element = add("collision", f"{number:02}")
        if kind_of(shape) == "hull":
            mesh(element, file)
            continue
        ElementTree.SubElement(element, "origin", xyz=_text(shape.center), rpy=_text(_roll_pitch_yaw(shape.axes)))
        radius, length = _text(shape.half[:1]), _text(2 * shape.half[2:])
        sizes = {"box": {"size": _text(2 * shape.half)}, "sphere": {"radius": radius},
                 "cylinder": {"radius": radius, "length": length}}
        ElementTree.SubElement(ElementTree.SubElement(element, "geometry"), shape.kind, sizes[shape.kind])
    _write_xml(path, robot)


def write_mjcf(path, name, files, shapes):
    """files: of the hulls, as seen from the path."""
    root = ElementTree.Element("mujoco", model=name)
    asset, world = ElementTree.SubElement(root, "asset"), ElementTree.SubElement(root, "worldbody")
    body = ElementTree.SubElement(world, "body", name=name)
    ElementTree.SubElement(body, "freejoint")
    for number, (file, shape) in enumerate(zip(files, shapes)):
        if kind_of(shape) == "hull":
            ElementTree.SubElement(asset, "mesh", name=f"hull_{number:02}", file=file, inertia="convex")
            ElementTree.SubElement(body, "geom", type="mesh", mesh=f"hull_{number:02}")
            continue
        radius, _, half = shape.half
        sizes = {"box": shape.half, "sphere": [radius], "capsule": [radius, half - radius], "cylinder": [radius, half]}
        ElementTree.SubElement(body, "geom", type=shape.kind, size=_text(sizes[shape.kind]), pos=_text(shape.center),
                               xyaxes=_text(shape.axes[:, :2].T.ravel()))
    _write_xml(path, root)


def _text(numbers):
    return " ".join(f"{number:.9g}" for number in numbers)


def _roll_pitch_yaw(axes):
    """Turns about the fixed x, y and z, one after the other."""
    level = np.hypot(axes[0, 0], axes[1, 0])
    if level < 1e-9:  # yaw and roll are the same turn
        return np.arctan2(-axes[1, 2], axes[1, 1]), np.arctan2(-axes[2, 0], level), 0
    return np.arctan2(axes[2, 1], axes[2, 2]), np.arctan2(-axes[2, 0], level), np.arctan2(axes[1, 0], axes[0, 0])


def _write_xml(path, root):
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
    prepend apiSchemas = ["PhysicsRigidBodyAPI"]
)
{{
{shapes}
}}
"""
USD_SHAPE = """    def {kind} "{name}"{schemas}
    {{
        {lines}
    }}"""


def write_usd(path, name, surface, shapes):
    """surface: (vertices, triangles) of the model."""
    found = [_usd_shape("Mesh", "model", [], _usd_mesh(*surface))]
    for number, shape in enumerate(shapes):
        kind = kind_of(shape)
        title, collides = f"{kind}_{number:02}", ['uniform token purpose = "guide"']
        if kind == "hull":
            collides += ['uniform token physics:approximation = "convexHull"', *_usd_mesh(*shape)]
            found.append(_usd_shape("Mesh", title, ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"], collides))
        else:
            collides += _usd_primitive(shape)
            found.append(_usd_shape({"box": "Cube"}.get(kind, kind.title()), title, ["PhysicsCollisionAPI"], collides))
    name = re.sub(r"^(?=\d)|\W", "_", name, flags=re.ASCII)  # what USD takes for a name
    path.write_text(USD.format(name=name, shapes="\n\n".join(found)), encoding="utf-8")


def _usd_shape(kind, name, schemas, lines):
    applied = ", ".join(f'"{each}"' for each in schemas)
    schemas = f" (\n        prepend apiSchemas = [{applied}]\n    )" if schemas else ""
    return USD_SHAPE.format(kind=kind, name=name, schemas=schemas, lines="\n        ".join(lines))


def _usd_mesh(vertices, triangles):
    """Lines."""
    return [f"float3[] extent = [{_points([vertices.min(axis=0), vertices.max(axis=0)])}]",
            "int[] faceVertexCounts = [{}]".format(", ".join(["3"] * len(triangles))),
            "int[] faceVertexIndices = [{}]".format(", ".join(map(str, triangles.ravel().tolist()))),
            f"point3f[] points = [{_points(vertices)}]", 'uniform token subdivisionScheme = "none"']


def _usd_primitive(shape):
    """Lines. Of a box the matrix has the size as well."""
    radius, _, half = shape.half
    matrix = shape.matrix()
    round_along_z = ['uniform token axis = "Z"', f"double radius = {radius:.9g}"]
    if shape.kind == "box":
        matrix[:3, :3] *= shape.half
        lines = ["double size = 2", f"float3[] extent = [{_points([-np.ones(3), np.ones(3)])}]"]
    else:
        lines = {"sphere": round_along_z[1:], "capsule": [*round_along_z, f"double height = {2 * (half - radius):.9g}"],
                 "cylinder": [*round_along_z, f"double height = {2 * half:.9g}"]}[shape.kind]
        lines.append(f"float3[] extent = [{_points([-shape.half, shape.half])}]")
    rows = ", ".join("({})".format(", ".join(f"{value:.9g}" for value in row)) for row in matrix.T)
    return [*lines, f"matrix4d xformOp:transform = ( {rows} )", 'uniform token[] xformOpOrder = ["xformOp:transform"]']


def _points(points):
    return ", ".join("({:.9g}, {:.9g}, {:.9g})".format(*point) for point in points)
