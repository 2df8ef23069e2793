# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls as objects for collisions in engines and Blender. In Object Mode; undo is up to the caller."""

import itertools
from typing import Any, NamedTuple

import bpy
from mathutils import Matrix

from ..mesh import MeshSnapshot, Refused, remove_object, rename, rollback_on_error
from ..mesh.datablocks import ID_NAME_SIZE
from ..solid import composition
from partwheel import ConvexPart, convex

# Engine -> {kind of shape: name pattern}: as its importer expects, or readable. The engine has no other kinds.
NAME_PATTERNS = {"UNREAL": {kind: start + "_{model}_{number:02}" for kind, start in convex.UNREAL_PREFIXES.items()},
                 "GODOT": {"hull": "{model}_{number:02}-convcolonly"},
                 "UNITY": {"hull": "{model}_collider_{number:02}", "box": "{model}_box_{number:02}",
                           "sphere": "{model}_sphere_{number:02}", "capsule": "{model}_capsule_{number:02}"},
                 "RIGID_BODY": {kind: "{model}_" + kind + "_{number:02}" for kind in ("hull", *convex.KINDS)}}
TOLERANCE_PROPERTY = "partwheel_hull_tolerance"  # largest distance of a hull from the model, if it was given

Slice = tuple[int, int]  # of a hierarchy's tetrahedra: first, last


class HullGroup(NamedTuple):
    """Hulls of a part of the model, a slice of its hierarchy. part None: of all that is in no other group."""

    parts: list[ConvexPart]
    part: Slice | None = None


def find_hulls(obj: bpy.types.Object) -> list[bpy.types.Object]:
    return [child for child in obj.children if child.type == "MESH" and composition.HULL_PROPERTY in child]


def volume_ratio(parts: list[ConvexPart]) -> float:
    """The volume of the hulls, divided by that of their parts. Where shells overlap, part.volume counts the overlap
    twice, and may be more than the hull's: then the hull's volume counts."""
    volumes = [part.hull_volume() for part in parts]
    return sum(volumes) / sum(min(volume, part.volume) for volume, part in zip(volumes, parts))


def find_other_parts(obj: bpy.types.Object, part: Slice) -> tuple[list[Slice], int]:
    """(the other parts that have hulls of their own, the number of hulls of what is neither in them nor in this part)."""
    slices = _read_parts(obj).values()
    other_parts = {other for other in slices if other and _is_apart(other, part)}
    return sorted(other_parts), sum(other not in other_parts and not (other and part[0] <= other[0] and other[1] <= part[1])
                             for other in slices)


def find_rest(slices: list[Slice], count: int) -> list[Slice]:
    """What is in none of these disjoint slices of count tetrahedra."""
    bounds = [0, *(bound for part in sorted(slices) for bound in part), count]
    return [(first, last) for first, last in zip(bounds[::2], bounds[1::2]) if first < last]


def _is_apart(one: Slice, other: Slice) -> bool:
    return one[1] <= other[0] or other[1] <= one[0]


def _read_parts(obj: bpy.types.Object) -> dict[bpy.types.Object, Slice | None]:
    """The object's hulls, with the part that each was made for, if the mesh is still the same."""
    values = {hull: hull[composition.HULL_PROPERTY] for hull in find_hulls(obj)}
    texts = {hull: value.split() for hull, value in values.items() if isinstance(value, str)}
    key = _get_mesh_key(obj) if texts else None
    return {hull: (int(texts[hull][0]), int(texts[hull][1])) if hull in texts and texts[hull][2] == key else None
            for hull in values}


def _get_mesh_key(obj: bpy.types.Object) -> str:
    return "".join(digest.hex() for digest in MeshSnapshot(obj).fingerprint)


@rollback_on_error()
def create_hulls(context: bpy.types.Context, obj: bpy.types.Object, groups: list[HullGroup], engine: str,
                 primitives: float, tolerance: float) -> list[bpy.types.Object]:
    """A child of the object for each partwheel.ConvexPart, named for the engine, a key of NAME_PATTERNS; drawn as
    wires, not rendered, in a new collection. Earlier hulls are replaced, except those of parts that share nothing with
    the groups, and their collection is reused. RIGID_BODY: the object becomes a rigid body whose compound shape they
    are. primitives: use a box, sphere, capsule or cylinder, if the engine has it, where it reaches no farther than this
    length beyond the hull; 0: hulls only. tolerance: of the hulls, for the checks before export; 0: any. Raises Refused
    before any change."""
    part, slices = groups[0].part, _read_parts(obj)
    earlier = [hull for hull, other in slices.items() if not (part and other and _is_apart(other, part))]
    others = {hull.name for hull in slices} - {hull.name for hull in earlier}
    kinds = tuple(kind for kind in convex.KINDS if kind in NAME_PATTERNS[engine])
    key = _get_mesh_key(obj) if any(group.part for group in groups) else None
    hulls = [(hull, f"{group.part[0]} {group.part[1]} {key}" if group.part else True)
             for group in groups for hull in group.parts]
    shapes = [(primitives > 0 and convex.fit_primitive(*hull[:2], primitives, kinds)) or hull for hull, _ in hulls]
    names, numbers = [], itertools.count()
    for shape in shapes:
        pattern = NAME_PATTERNS[engine][convex.kind_of(shape)]
        names.append(next(name for name in (pattern.format(model=obj.name, number=number) for number in numbers)
                          if name not in others))
    _check_names(obj, names, earlier, engine)
    collection = next((child.users_collection[0] for child in earlier if child.users_collection), None)
    collection = collection or composition.create_collection(obj, f"{obj.name} hulls")
    objects = [_create_child(obj, shape, name, collection) for shape, name in zip(shapes, names)]
    for child, (_, value) in zip(objects, hulls):
        child[composition.HULL_PROPERTY] = value
        if tolerance > 0:
            child[TOLERANCE_PROPERTY] = tolerance + primitives
    if engine == "RIGID_BODY":
        _add_rigid_bodies(context, obj, {child: convex.kind_of(shape) for child, shape in zip(objects, shapes)})
    for child in earlier:  # nothing can fail any more
        remove_object(child)
    for child, name in zip(objects, names):  # the earlier objects had the same names
        rename(child, name)
        rename(child.data, child.name)
    composition.update_matrices()
    return objects


def _check_names(obj: bpy.types.Object, names: list[str], earlier: list[bpy.types.Object], engine: str) -> None:
    """Raises Refused if the object can't be a rigid body, or a name is too long or in use."""
    if engine == "RIGID_BODY" and obj.library:
        raise Refused("{name} is linked from another file and can't be a rigid body: make it local first (Object > "
                      "Relations > Make Local).", name=obj.name)
    for name in names:
        if len(name.encode()) >= ID_NAME_SIZE:
            raise Refused("The name of {name} is too long for the names of its hulls: shorten it.",
                          name=obj.name)
        if bpy.data.objects.get(name) not in {None, *earlier}:
            raise Refused("Another object has the name {name}, which a hull needs: rename that object.", name=name)


def _create_child(obj: bpy.types.Object, shape: Any, name: str, collection: bpy.types.Collection) -> bpy.types.Object:
    """A primitive is aligned with its own axes, so that its bounding box defines it."""
    primitive = convex.kind_of(shape) != "hull"
    vertices, triangles = shape.mesh() if primitive else shape[:2]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    new = bpy.data.objects.new(name, mesh)
    collection.objects.link(new)
    new.parent, new.matrix_parent_inverse = obj, Matrix()
    if primitive:
        new.matrix_basis = Matrix(shape.matrix().tolist())
    new.display_type, new.hide_render = "WIRE", True
    return new


def _add_rigid_bodies(context: bpy.types.Context, obj: bpy.types.Object, kinds: dict[bpy.types.Object, str]) -> None:
    """Makes the object a rigid body with a compound shape, and each hull a part of it. kinds: {hull: its kind}."""
    scene = context.scene
    if not scene.rigidbody_world:
        bpy.ops.rigidbody.world_add()
    world = scene.rigidbody_world
    if not world.collection:
        world.collection = bpy.data.collections.new("RigidBodyWorld")  # Blender's own name for it
    for child in (obj, *kinds):
        if not child.rigid_body:
            world.collection.objects.link(child)
    obj.rigid_body.collision_shape = "COMPOUND"
    for child, kind in kinds.items():
        body = child.rigid_body
        # With Blender's default margin, 0.04, small objects float or sink in.
        body.use_margin, body.collision_margin = True, 0
        body.collision_shape = "CONVEX_HULL" if kind == "hull" else kind.upper()
