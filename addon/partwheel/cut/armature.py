# SPDX-License-Identifier: GPL-3.0-or-later
"""Creates an armature with a bone for each part of a cut. It moves the object through vertex groups of the same names, which
layers.write_vertex_groups() writes. Works outside Edit Mode; undo is up to the caller."""

from collections.abc import Sequence, Set

import bpy

from ..mesh import Refused, arrays, rollback_on_error
from ..solid import composition
from . import existing_names
from partwheel import Context
from partwheel.cut import Bone, Cut, VertexWeights, bones, mirror_planes, part_tree

ARMATURE_PROPERTY = "partwheel_bones"  # marks armatures that this module created


def compute_bones(surface: arrays.MeshSurface, cut: Cut, weights: list[VertexWeights],
                  context: Context) -> list[Bone]:
    """Return the bone of each part. weights: of each part, from skin_weights()."""
    vertices, triangles = surface.vertices, surface.triangles
    labels = cut.labels[surface.faces]
    links = part_tree(cut, vertices, triangles, labels)
    context.start_step(0.3)
    planes = mirror_planes(vertices, triangles)
    context.start_step(0.4)
    return bones(vertices, triangles, labels, links, weights, planes)


@rollback_on_error()
def create_armature(obj: bpy.types.Object, names: list[str], part_bones: list[Bone],
                    copies: Sequence[bpy.types.Object]) -> bpy.types.Object:
    """Create an armature object with a bone for each part, make the object and its copies its children, and return it.
    An armature that this function created for the object earlier is reused, so bones that keep their names keep their
    pose and constraints."""
    modifier = _armature_modifier(obj)
    if modifier and _is_reusable({obj, *copies}, modifier.object):
        _write_bones(modifier.object, part_bones, names)
        return modifier.object
    armature = _create_armature_object(obj)
    _write_bones(armature, part_bones, names)
    for deformed in (obj, *copies):
        _attach(deformed, armature)
    return armature


def is_own_armature(obj: bpy.types.Object | None) -> bool:
    """Return whether it is an armature object that this module created."""
    return obj is not None and obj.type == "ARMATURE" and ARMATURE_PROPERTY in obj.data


def check_no_rig(obj: bpy.types.Object) -> None:
    """Raise Refused if an armature that this module did not create already moves the object by its vertex groups."""
    for rig in existing_names.find_rigs(obj):
        if not is_own_armature(rig) and any(bone.use_deform and bone.name in obj.vertex_groups
                                                     for bone in rig.data.bones):
            raise Refused("{name} already moves with the armature {armature}: bones of the parts would move it a second "
                          "time. Divide a copy of it without this armature.", name=obj.name, armature=rig.name)


def _armature_modifier(obj: bpy.types.Object) -> bpy.types.Modifier | None:
    """Return the object's modifier with an armature that this module created, or None."""
    return next((modifier for modifier in obj.modifiers if modifier.type == "ARMATURE"
                 and is_own_armature(modifier.object)), None)


def _is_reusable(objects: Set[bpy.types.Object], armature: bpy.types.Object) -> bool:
    """Return whether the armature's bones may be replaced: it is local and visible, and deforms only these objects."""
    deformed = {other for other in bpy.data.objects for modifier in other.modifiers
                if modifier.type == "ARMATURE" and modifier.object == armature}
    is_local = not armature.library and not armature.data.library
    return deformed == objects and is_local and armature.data.users == 1 and armature.visible_get()


def _create_armature_object(obj: bpy.types.Object) -> bpy.types.Object:
    """Return a new armature object without bones, with the object's transform, parent and collection."""
    composition.update_matrices()
    data = bpy.data.armatures.new(f"{obj.name} bones")
    data[ARMATURE_PROPERTY] = True
    armature = bpy.data.objects.new(data.name, data)
    composition.target_collections(obj)[0].objects.link(armature)
    armature.show_in_front = True
    armature.parent, armature.parent_type, armature.parent_bone = obj.parent, obj.parent_type, obj.parent_bone
    if obj.parent_type in {"VERTEX", "VERTEX_3"}:
        armature.parent_vertices = obj.parent_vertices
    armature.matrix_parent_inverse = obj.matrix_parent_inverse
    armature.matrix_world = obj.matrix_world
    return armature


def _attach(obj: bpy.types.Object, armature: bpy.types.Object) -> None:
    """Parent the object to the armature by a modifier. It stays in place and keeps its transform, maybe animated."""
    obj.parent, obj.parent_type, obj.matrix_parent_inverse = armature, "OBJECT", obj.matrix_basis.inverted_safe()
    modifier = _armature_modifier(obj) or obj.modifiers.new("Bones", "ARMATURE")
    modifier.object, modifier.use_vertex_groups = armature, True
    modifier.use_deform_preserve_volume = True  # otherwise joints get thinner as they bend
    composition.update_matrices()


def _write_bones(armature: bpy.types.Object, part_bones: list[Bone], names: list[str]) -> None:
    """Replace the armature's bones. Blender allows this in Edit Mode only."""
    view_layer = bpy.context.view_layer
    active = view_layer.objects.active
    view_layer.objects.active = armature
    try:
        bpy.ops.object.mode_set(mode="EDIT")
        edit_bones = armature.data.edit_bones
        for bone in list(edit_bones):
            edit_bones.remove(bone)
        new_bones = [edit_bones.new(name) for name in names]
        for bone, part_bone in zip(new_bones, part_bones):
            bone.head, bone.tail = part_bone.head, part_bone.tail
            if part_bone.parent >= 0:
                bone.parent, bone.use_connect = new_bones[part_bone.parent], part_bone.is_connected
        bpy.ops.object.mode_set(mode="OBJECT")
    finally:
        view_layer.objects.active = active
