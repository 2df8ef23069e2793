# SPDX-License-Identifier: GPL-3.0-or-later
"""Computes where a part goes: its border onto a point of a surface, turned to the normal, or onto another border."""

from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix, Quaternion, Vector

from ..mesh import Refused, arrays, local_copy, rollback_on_error
from ..solid.composition import create_object_like, differ_by_rounding, update_matrices, world_to_local
from partwheel import compatible
from ..solid.solids import CAP_ATTRIBUTE

_CHANNELS = ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale")
# Radii of the border by which a part sinks into the surface: solids that only touch can't be united.
SINK_FRACTION = 0.05


def cap_faces(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """(F,) bool: the faces that close cuts of a mesh; None without the cap attribute."""
    return arrays.read_attribute(mesh, CAP_ATTRIBUTE, "BOOLEAN", "FACE")


def find_cap_loop(obj: bpy.types.Object, near: Vector | None = None) -> compatible.CapLoop | None:
    """The compatible.CapLoop of the object, in the world, where it was cut or a part was removed: of the largest
    connected group of caps, or the one nearest to a point; None without caps."""
    is_cap = cap_faces(obj.data)
    if is_cap is None or not is_cap.any():
        return None
    triangles, polygons = arrays.read_triangles(obj.data)
    positions = arrays.read_positions(obj.data).astype(float)
    loops = compatible.cap_loops(positions, triangles[is_cap[polygons]], np.array(obj.matrix_world))
    if not loops:
        return None
    return loops[0] if near is None else min(loops, key=lambda loop: (Vector(loop.center) - near).length)


def anchor_loop(obj: bpy.types.Object) -> compatible.CapLoop:
    """The CapLoop by which an object is placed: its own, or one at the underside of an object without caps."""
    loop = find_cap_loop(obj)
    if loop:
        return loop
    corners = [obj.matrix_world @ Vector(corner) for corner in obj.bound_box]
    down = -obj.matrix_world.to_3x3().col[2].normalized()
    lowest = max(corner.dot(down) for corner in corners)
    center = sum(corners, Vector()) / 8
    radius = max((corner - center).length for corner in corners) / 2
    return compatible.CapLoop(center + down * (lowest - center.dot(down)), down, radius)


def placement_matrix(start: Matrix, part_loop: compatible.CapLoop, location: Vector, normal: Vector, scale: float,
                     angle: float, depth: float) -> Matrix:
    """The matrix_world that brings an object onto a surface: the center of its loop to location, the loop's normal
    against the surface normal. start: the object's matrix for which part_loop holds. scale: factor of the size.
    angle: around the normal, in radians. depth: radii of the border, beyond SINK_FRACTION."""
    normal = normal.normalized()
    rotation = Quaternion(normal, angle) @ Vector(part_loop.normal).rotation_difference(-normal)
    target = location - normal * ((SINK_FRACTION + depth) * part_loop.radius * scale)
    return (Matrix.Translation(target) @ rotation.to_matrix().to_4x4() @ Matrix.Scale(scale, 4)
            @ Matrix.Translation(-Vector(part_loop.center)) @ start)


class Pose(NamedTuple):
    """Where a part goes, see placement_matrix(). fit: onto the target's border nearest to location, in its size."""

    location: Vector
    normal: Vector
    scale: float = 1.0
    angle: float = 0.0
    depth: float = 0.0
    fit: bool = False


def move_to_pose(part: bpy.types.Object, start: Matrix, part_loop: compatible.CapLoop, target: bpy.types.Object | None,
                 pose: Pose) -> None:
    """Moves the part, whose loop was part_loop at the matrix start. Raises Refused if there is no border to fit."""
    location, normal, scale = pose.location, pose.normal, pose.scale
    if pose.fit:
        target_loop = find_cap_loop(target, location)
        if not target_loop:
            raise Refused("{name} has no border to fit: no part was removed from it.", name=target.name)
        location, normal = Vector(target_loop.center), Vector(target_loop.normal)
        scale *= target_loop.radius / part_loop.radius
    _set_world_matrix(part, placement_matrix(start, part_loop, location, normal, scale, pose.angle, pose.depth))


def _set_world_matrix(obj: bpy.types.Object, matrix: Matrix) -> None:
    """What the object's own transform can't hold, because a stretched parent would shear it, goes to the parent inverse."""
    obj.matrix_world = matrix
    if obj.parent and obj.parent_type == "OBJECT":
        in_parent = obj.parent.matrix_world.inverted_safe() @ matrix
        if not differ_by_rounding(obj.matrix_parent_inverse @ obj.matrix_basis, in_parent):
            obj.matrix_parent_inverse = in_parent @ obj.matrix_basis.inverted_safe()


def local_transform(obj: bpy.types.Object) -> dict[str, tuple[float, ...] | Matrix]:
    """The object's location, rotation and scale, and its parent inverse, for restore_transform()."""
    return {"matrix_parent_inverse": obj.matrix_parent_inverse.copy(),
            **{channel: tuple(getattr(obj, channel)) for channel in _CHANNELS}}


def restore_transform(obj: bpy.types.Object, transform: dict[str, tuple[float, ...] | Matrix]) -> None:
    """Restores the object's transform exactly. A matrix would lose full turns, mirrored axes and the last bit."""
    for channel, values in transform.items():
        setattr(obj, channel, values)


def place(part: bpy.types.Object, target: bpy.types.Object | None, pose: Pose,
          mirror: bool = False) -> bpy.types.Object | None:
    """Moves the part. Returns its mirror copy, or None without mirror."""
    update_matrices()
    transform = local_transform(part)
    try:
        move_to_pose(part, part.matrix_world.copy(), anchor_loop(part), target, pose)
        update_matrices()
        return create_mirror_copy(part, target) if mirror else None
    except BaseException:  # also Ctrl C in a script
        restore_transform(part, transform)
        raise


@rollback_on_error()
def create_mirror_copy(part: bpy.types.Object, target: bpy.types.Object) -> bpy.types.Object:
    """A new object: the part mirrored across the target's YZ plane. The mesh is mirrored, not the matrix."""
    mesh = local_copy(part.data)
    flip = Matrix.Scale(-1, 4, (1, 0, 0))
    new = create_object_like(part, mesh, part.name)
    reflection = target.matrix_world @ flip @ world_to_local(target)
    # Two reflections make a rotation: the matrix contains no reflection.
    mesh.transform(flip, shape_keys=True)
    mesh.flip_normals()
    _set_world_matrix(new, reflection @ part.matrix_world @ flip)
    return new
