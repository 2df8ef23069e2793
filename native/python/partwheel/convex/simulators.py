# SPDX-License-Identifier: GPL-3.0-or-later
"""A body that collides as convex hulls, in the languages of robot simulators: URDF, MuJoCo's, USD."""

import re
from xml.etree import ElementTree

import numpy as np


def write_urdf(path, name, model, files):
    """model, files: of the surface and of the hulls, as seen from the path."""
    robot = ElementTree.Element("robot", name=name)
    link = ElementTree.SubElement(robot, "link", name=name)
    for role, file in [("visual", model), *(("collision", file) for file in files)]:
        shape = ElementTree.SubElement(link, role, name=file.rpartition("/")[2].removesuffix(".obj"))
        ElementTree.SubElement(ElementTree.SubElement(shape, "geometry"), "mesh", filename=file)
    _write_xml(path, robot)


def write_mjcf(path, name, files):
    """files: of the hulls, as seen from the path."""
    root = ElementTree.Element("mujoco", model=name)
    asset, world = ElementTree.SubElement(root, "asset"), ElementTree.SubElement(root, "worldbody")
    body = ElementTree.SubElement(world, "body", name=name)
    ElementTree.SubElement(body, "freejoint")
    for number, file in enumerate(files):
        ElementTree.SubElement(asset, "mesh", name=f"hull_{number:02}", file=file, inertia="convex")
        ElementTree.SubElement(body, "geom", type="mesh", mesh=f"hull_{number:02}")
    _write_xml(path, root)


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
USD_MESH = """    def Mesh "{name}"{schemas}
    {{
        float3[] extent = [{extent}]
        int[] faceVertexCounts = [{counts}]
        int[] faceVertexIndices = [{corners}]
        point3f[] points = [{points}]
        uniform token subdivisionScheme = "none"{more}
    }}"""
USD_COLLIDES = """ (
        prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"]
    )"""
USD_HULL = """
        uniform token purpose = "guide"
        uniform token physics:approximation = "convexHull\""""


def write_usd(path, name, model, hulls):
    """model: (its name, vertices, triangles); hulls: [the same, ...]."""
    shapes = [_usd_mesh("model", *model[1:]), *(_usd_mesh(*hull, USD_COLLIDES, USD_HULL) for hull in hulls)]
    name = re.sub(r"^(?=\d)|\W", "_", name, flags=re.ASCII)  # what USD takes for a name
    path.write_text(USD.format(name=name, shapes="\n\n".join(shapes)), encoding="utf-8")


def _usd_mesh(name, vertices, triangles, schemas="", more=""):
    def points(array):
        return ", ".join("({:.9g}, {:.9g}, {:.9g})".format(*point) for point in array.tolist())
    return USD_MESH.format(
        name=name, schemas=schemas, more=more, extent=points(np.array([vertices.min(axis=0), vertices.max(axis=0)])),
        counts=", ".join(["3"] * len(triangles)), corners=", ".join(map(str, triangles.ravel().tolist())),
        points=points(vertices))
