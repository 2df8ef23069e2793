# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a cut as the bones of an armature that moves the object, by vertex groups of the same names, which
layers.vertex_groups() writes. Outside Edit Mode; undo is the caller's."""

import bpy

from ..mesh import arrays
from ..mesh.datablocks import all_or_nothing
from ..solid import composition
from partwheel.cut import bones, mirror_planes, part_tree

OURS = "partwheel_bones"  # a property of armatures that were made here


@all_or_nothing()
def made(obj, cut, names, weights):
    """The armature object, with a bone for each part; the one that was made before, if the object still has it: pose
    and constraints of bones that keep their names stay. The object hangs on it. weights: of each part, as
    layers.weights_of() gives them."""
    surface = arrays.surface(obj.data)
    labels = cut.labels[surface.faces]
    vertices, triangles = surface.vertices, surface.triangles
    found = bones(vertices, triangles, labels, part_tree(cut, vertices, triangles, labels), weights,
                  mirror_planes(vertices, triangles))
    modifier = _modifier(obj)
    if modifier and _usable(obj, modifier.object):
        _write(modifier.object, found, names)
        return modifier.object
    rig = _new(obj)
    _write(rig, found, names)
    _hang(obj, rig, modifier)
    return rig


def _modifier(obj):
    """The one by which an armature that was made here moves the object, or None."""
    return next((modifier for modifier in obj.modifiers if modifier.type == "ARMATURE" and modifier.object
                 and OURS in modifier.object.data), None)


def _usable(obj, rig):
    """Whether its bones may be made anew: it is here, and moves nothing else, as after the object was duplicated."""
    moved = [other for other in bpy.data.objects for modifier in other.modifiers
             if modifier.type == "ARMATURE" and modifier.object == rig]
    return moved == [obj] and not rig.library and not rig.data.library and rig.data.users == 1 and rig.visible_get()


def _new(obj):
    """In the object's place, also in the tree of objects."""
    composition.update_matrices()
    data = bpy.data.armatures.new(f"{obj.name} bones")
    data[OURS] = True
    rig = bpy.data.objects.new(data.name, data)
    composition.target_collection(obj).objects.link(rig)
    rig.show_in_front = True
    rig.parent, rig.parent_type, rig.parent_bone = obj.parent, obj.parent_type, obj.parent_bone
    if obj.parent_type in {"VERTEX", "VERTEX_3"}:
        rig.parent_vertices = obj.parent_vertices
    rig.matrix_parent_inverse = obj.matrix_parent_inverse
    rig.matrix_world = obj.matrix_world
    return rig


def _hang(obj, rig, modifier):
    """The object stays where it is, and keeps its own transform: that may be animated."""
    obj.parent, obj.parent_type, obj.matrix_parent_inverse = rig, "OBJECT", obj.matrix_basis.inverted_safe()
    modifier = modifier or obj.modifiers.new("Bones", "ARMATURE")
    modifier.object, modifier.use_vertex_groups = rig, True
    modifier.use_deform_preserve_volume = True  # or a joint gets thinner the further it bends
    composition.update_matrices()


def _write(rig, found, names):
    """Bones are made in Edit Mode alone."""
    layer = bpy.context.view_layer
    active = layer.objects.active
    layer.objects.active = rig
    try:
        bpy.ops.object.mode_set(mode="EDIT")
        edited = rig.data.edit_bones
        for bone in list(edited):
            edited.remove(bone)
        new = [edited.new(name) for name in names]
        for bone, each in zip(new, found):
            bone.head, bone.tail = each.head, each.tail
            if each.parent >= 0:
                bone.parent, bone.use_connect = new[each.parent], each.is_connected
        bpy.ops.object.mode_set(mode="OBJECT")
    finally:
        layer.objects.active = active
