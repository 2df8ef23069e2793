# SPDX-License-Identifier: GPL-3.0-or-later
"""Convex hulls as objects that engines, and Blender's own rigid bodies, take as a model's collision. In Object Mode;
undo is the caller's."""

import bpy
from mathutils import Matrix

from ..mesh.datablocks import all_or_nothing, dispose
from ..mesh.errors import Refused
from ..solid import composition
from partwheel import convex

# What is called how, by its kind: as the engine's importer knows it, or so that people do. Engines take no other kinds.
NAMES = {"UNREAL": {kind: start + "_{model}_{number:02}" for kind, start in convex.UNREAL_PREFIXES.items()},
         "GODOT": {"hull": "{model}_{number:02}-convcolonly"},
         "UNITY": {"hull": "{model}_collider_{number:02}", "box": "{model}_box_{number:02}",
                   "sphere": "{model}_sphere_{number:02}", "capsule": "{model}_capsule_{number:02}"},
         "RIGID_BODY": {kind: "{model}_" + kind + "_{number:02}" for kind in ("hull", *convex.KINDS)}}
LONGEST = bpy.types.ID.bl_rna.properties["name"].length_max  # of a name, in bytes


@all_or_nothing()
def made(context, obj, hulls, engine="UNREAL", primitives=0.0):
    """[object, ...]: a child of the object for each partwheel.ConvexPart, named as the engine has it, one of NAMES; seen
    as wires and not rendered, in a new collection, or in that of the earlier ones, which are removed. RIGID_BODY: the
    object is a body whose shape they are together. primitives: the length that a box, sphere, capsule or cylinder may
    reach beyond a hull to be taken instead, as far as the engine has these; 0: hulls alone. Refused: nothing has changed."""
    earlier = [child for child in obj.children if child.type == "MESH" and composition.HULL_PROPERTY in child]
    kinds = tuple(kind for kind in convex.KINDS if kind in NAMES[engine])
    shapes = [(primitives > 0 and convex.fit_primitive(*hull[:2], primitives, kinds)) or hull for hull in hulls]
    names = [NAMES[engine][convex.kind_of(shape)].format(model=obj.name, number=number)
             for number, shape in enumerate(shapes)]
    _check(obj, names, earlier, engine)
    home = next((each.users_collection[0] for each in earlier if each.users_collection), None)
    home = home or composition.create_collection(obj, f"{obj.name} hulls")
    found = [_child(obj, shape, name, home) for shape, name in zip(shapes, names)]
    if engine == "RIGID_BODY":
        _simulated(context, obj, {child: convex.kind_of(shape) for child, shape in zip(found, shapes)})
    for each in earlier:  # now that nothing can fail any more
        dispose(each)
    for each, name in zip(found, names):  # which an earlier one had
        each.name = each.data.name = name
    composition.update_matrices()
    return found


def _check(obj, names, earlier, engine):
    if engine == "RIGID_BODY" and obj.library:
        raise Refused("{name} is linked from another file and can't be a rigid body: make it local first (Object > "
                      "Relations > Make Local).", name=obj.name)
    for name in names:
        if len(name.encode()) >= LONGEST:
            raise Refused("The name of {name} is too long for its hulls to be named after it: shorten it.", name=obj.name)
        if bpy.data.objects.get(name) not in {None, *earlier}:
            raise Refused("There is another object called {name}, as a hull would be: rename it.", name=name)


def _child(obj, shape, name, collection):
    """A primitive lies in its own axes, so that its bounding box tells all about it."""
    primitive = convex.kind_of(shape) != "hull"
    vertices, triangles = shape.mesh() if primitive else shape[:2]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices.tolist(), [], triangles.tolist())
    new = bpy.data.objects.new(name, mesh)
    new[composition.HULL_PROPERTY] = True
    collection.objects.link(new)
    new.parent, new.matrix_parent_inverse = obj, Matrix()
    if primitive:
        new.matrix_basis = Matrix(shape.matrix().tolist())
    new.display_type, new.hide_render = "WIRE", True
    return new


def _simulated(context, obj, kinds):
    """The object is a rigid body from now on, unless it was one; of its hulls, whichever shape it had. kinds: {hull: its
    kind}."""
    scene = context.scene
    if not scene.rigidbody_world:
        bpy.ops.rigidbody.world_add()
    world = scene.rigidbody_world
    if not world.collection:
        world.collection = bpy.data.collections.new("RigidBodyWorld")  # as Blender calls it
    for each in (obj, *kinds):
        if not each.rigid_body:
            world.collection.objects.link(each)
    obj.rigid_body.collision_shape = "COMPOUND"
    for each, kind in kinds.items():
        body = each.rigid_body
        # Blender's own margin, 0.04, makes all that is small float or sink in.
        body.use_margin, body.collision_margin = True, 0
        body.collision_shape = "CONVEX_HULL" if kind == "hull" else kind.upper()
