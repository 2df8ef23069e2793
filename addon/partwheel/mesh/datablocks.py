# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's data-blocks: made all or none; settings and animation of one given to another."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager

import bpy

# Whatever the add-on makes is in one of these.
KINDS = ("objects", "collections", "shape_keys", "meshes", "armatures", "materials", "actions", "scenes")
# Of animation data: actions, and what is copied in another way.
_NOT_SETTINGS = {"action", "action_slot", "action_slot_handle", "last_slot_identifier", "action_tweak_storage", "use_tweak_mode"}


@contextmanager
def rollback_on_error() -> Iterator[None]:
    """If an error leaves the block, each data-block that was made in it is removed again, and what was selected, active and
    in which mode is so again. What was there before must not change until nothing can fail any more."""
    before = {block.as_pointer() for block in _iter_blocks()}  # what is there stays at its place
    layer = bpy.context.view_layer
    active, mode = layer.objects.active, bpy.context.mode
    object_mode = active.mode if active else "OBJECT"
    selected = [obj for obj in layer.objects if obj.select_get()]
    try:
        yield
    except BaseException:  # also Ctrl C in a script
        if active and layer.objects.active and layer.objects.active.mode != "OBJECT" and bpy.context.mode != mode:
            bpy.ops.object.mode_set(mode="OBJECT")
        used = {obj.data for obj in bpy.data.objects if obj.as_pointer() in before}  # by what stays
        used |= {mesh.shape_keys for mesh in used if isinstance(mesh, bpy.types.Mesh)}
        bpy.data.batch_remove([block for block in _iter_blocks() if block.as_pointer() not in before and block not in used])
        layer.update()
        for obj in layer.objects:
            obj.select_set(obj in selected)
        layer.objects.active = active
        if active and active.mode != object_mode:
            bpy.ops.object.mode_set(mode=object_mode)
        raise


def _iter_blocks() -> Iterator[bpy.types.ID]:
    return (block for kind in KINDS for block in getattr(bpy.data, kind))


def remove_object(obj: bpy.types.Object) -> None:
    """Removes an object, and its mesh with its shape keys if nothing else has it."""
    mesh = obj.data
    bpy.data.objects.remove(obj)
    if not mesh.users:
        bpy.data.batch_remove([mesh, *filter(None, [mesh.shape_keys])])  # Blender alone leaves keys of a copied mesh behind


def copy_settings(source: bpy.types.bpy_struct, target: bpy.types.bpy_struct, but: Collection[str] = ()) -> None:
    """Gives target all that can be set of source, both of one type, but for these properties."""
    for each in source.bl_rna.properties:
        name = each.identifier
        if each.is_readonly or name in but or target.is_property_readonly(name):
            continue
        value = getattr(source, name)
        if getattr(target, name) != value:
            setattr(target, name, value)


def copy_animation(source: bpy.types.ID, target: bpy.types.ID) -> None:
    """Gives target, a data-block without any, the animation of source: action, drivers and NLA strips that play actions."""
    old = source.animation_data
    if not old:
        return
    new = target.animation_data_create()
    for driver in old.drivers:
        new.drivers.from_existing(src_driver=driver)
    _assign_action(old, new)
    copy_settings(old, new, _NOT_SETTINGS)
    for track in old.nla_tracks:
        other = new.nla_tracks.new()
        for strip in track.strips:
            if strip.action:
                made = other.strips.new(strip.name, int(strip.frame_start), strip.action)
                _assign_action(strip, made)
                copy_settings(strip, made, _NOT_SETTINGS)
        copy_settings(track, other, {"is_solo"})


def _assign_action(old: bpy.types.bpy_struct, new: bpy.types.bpy_struct) -> None:
    """Both an AnimData or an NlaStrip."""
    new.action = old.action
    if getattr(old, "action_slot", None):  # from Blender 4.4 on
        new.action_slot = old.action_slot


def copy_actions(block: bpy.types.ID) -> None:
    """Gives a copied data-block actions of its own, if the preferences say so of duplicates, as Blender's Separate does."""
    data = block.animation_data
    if not data or data.use_tweak_mode or not bpy.context.preferences.edit.use_duplicate_action:
        return
    for user in (data, *(strip for track in data.nla_tracks for strip in track.strips)):
        if user.action and not user.action.library:
            slot = getattr(user, "action_slot", None)
            user.action = user.action.copy()
            if slot:
                user.action_slot = user.action.slots[slot.identifier]


def redirect_drivers(block: bpy.types.ID, images: dict[bpy.types.ID, bpy.types.ID]) -> None:
    """Drivers of a copied data-block that ask one of the originals ask its copy from now on. images: {original: copy}."""
    for curve in block.animation_data.drivers if block.animation_data else ():
        for variable in curve.driver.variables:
            for target in variable.targets:
                if target.id in images:
                    target.id = images[target.id]
