# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a part goes: its border onto a point of a surface, turned to the surface's normal, or onto another border."""

from typing import NamedTuple

import numpy as np
from mathutils import Matrix, Quaternion, Vector

from ..mesh import arrays
from ..mesh.datablocks import all_or_nothing
from ..solid.composition import create_object_like, update_matrices
from partwheel import compatible
from ..mesh.errors import Refused
from ..solid.solids import CAP_ATTRIBUTE

_CHANNELS = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale")
SINK = 0.05  # of its border's radius that a part is sunk in: solids that only touch don't unite


def caps(mesh):
    """(F,) bool: the faces that close a mesh where it was cut; None if nothing is marked so."""
    layer = arrays.attribute(mesh, CAP_ATTRIBUTE, "BOOLEAN", "FACE")
    return arrays.read(layer.data, "value", bool) if layer else None


def border(obj, near=None):
    """Where a part was cut off, or where one was removed, in the world: the compatible.CapLoop that is the largest group
    of the object's caps that touch, or the nearest to a point; None if its mesh has no caps."""
    marks = caps(obj.data)
    if marks is None or not marks.any():
        return None
    triangles, polygons = arrays.triangles(obj.data)
    places = arrays.read(obj.data.vertices, "co", np.float32, 3).astype(float)
    found = compatible.cap_loops(places, triangles[marks[polygons]], np.array(obj.matrix_world))
    if not found:
        return None
    return found[0] if near is None else min(found, key=lambda each: (Vector(each.center) - near).length)


def anchor(obj):
    """The Border that is placed: the object's own, or for one without caps its underside."""
    found = border(obj)
    if found:
        return found
    corners = [obj.matrix_world @ Vector(corner) for corner in obj.bound_box]
    down = -obj.matrix_world.to_3x3().col[2].normalized()
    lowest = max(corner.dot(down) for corner in corners)
    middle = sum(corners, Vector()) / 8
    radius = max((corner - middle).length for corner in corners) / 2
    return compatible.CapLoop(middle + down * (lowest - middle.dot(down)), down, radius)


def matrix(start, own, location, normal, scale=1.0, angle=0.0, depth=0.0):
    """The matrix_world that brings an object from the matrix start, at which its Border was own, onto a surface: the
    border's middle to location, its normal against the surface's. scale: times the size it had. angle: about the
    normal, in radians. depth: how far it is sunk in, times the border's radius, beyond what unites well."""
    normal = normal.normalized()
    turn = Quaternion(normal, angle) @ Vector(own.normal).rotation_difference(-normal)
    sunk = location - normal * ((SINK + depth) * own.radius * scale)
    return (Matrix.Translation(sunk) @ turn.to_matrix().to_4x4() @ Matrix.Scale(scale, 4)
            @ Matrix.Translation(-Vector(own.center)) @ start)


class Pose(NamedTuple):
    """Where a part goes, as matrix() takes it; fit: onto the target's border nearest to location, and of its size."""

    location: Vector
    normal: Vector
    scale: float = 1.0
    angle: float = 0.0
    depth: float = 0.0
    fit: bool = False


def put(part, start, own, target, pose):
    """Moves the part, at whose matrix start its Border was own. Raises Refused where there is no border to fit."""
    location, normal, scale = pose.location, pose.normal, pose.scale
    if pose.fit:
        found = border(target, location)
        if not found:
            raise Refused("{name} has no border to fit: no part was removed from it.", name=target.name)
        location, normal = Vector(found.center), Vector(found.normal)
        scale *= found.radius / own.radius
    part.matrix_world = matrix(start, own, location, normal, scale, pose.angle, pose.depth)


def own_transform(obj):
    """Its own location, rotation and scale, for put_back()."""
    return {channel: tuple(getattr(obj, channel)) for channel in _CHANNELS}


def put_back(obj, transform):
    """Puts the object back exactly: a matrix keeps neither full turns nor which axes are mirrored, nor the last bit."""
    for channel, values in transform.items():
        setattr(obj, channel, values)


def place(part, target, pose, mirror=False):
    """Moves the part. The mirror image, if that is wanted, else None."""
    update_matrices()
    put(part, part.matrix_world.copy(), anchor(part), target, pose)
    update_matrices()
    return mirrored(part, target) if mirror else None


@all_or_nothing()
def mirrored(part, target):
    """A new object: the part's mirror image across the target's own YZ plane. Its mesh is mirrored, not its matrix."""
    mesh = part.data.copy()
    flip = Matrix.Scale(-1, 4, (1, 0, 0))
    new = create_object_like(part, mesh, part.name)
    across = target.matrix_world @ flip @ target.matrix_world.inverted()
    # A mirror image of a mirror image is a turn: the matrix stays free of reflection.
    mesh.transform(flip, shape_keys=True)
    mesh.flip_normals()
    new.matrix_world = across @ part.matrix_world @ flip
    return new
