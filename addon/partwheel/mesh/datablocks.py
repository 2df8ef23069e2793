# SPDX-License-Identifier: GPL-3.0-or-later
"""Data-blocks: created all or none; their settings and animation copied."""

from collections.abc import Collection, Iterator
from contextlib import contextmanager
import json

import bpy

# Everything that the add-on creates is in one of these collections.
KINDS = ("objects", "collections", "shape_keys", "meshes", "armatures", "materials", "actions", "scenes")
ID_NAME_SIZE = bpy.types.ID.bl_rna.properties["name"].length_max  # bytes, with the terminating zero
# Properties of animation data that hold actions, or that are copied in another way.
_NOT_SETTINGS = {"action", "action_slot", "action_slot_handle", "last_slot_identifier",
                 "action_tweak_storage", "use_tweak_mode"}


@contextmanager
def rollback_on_error() -> Iterator[None]:
    """If the block raises, remove each data-block created in it and restore selection, active object and mode. Existing
    data-blocks must not be changed until nothing can fail any more."""
    before = {block.as_pointer() for block in _iter_blocks()}  # addresses of existing blocks don't change
    layer = bpy.context.view_layer
    active, mode = layer.objects.active, bpy.context.mode
    object_mode = active.mode if active else "OBJECT"
    selected = [obj for obj in layer.objects if obj.select_get()]
    try:
        yield
    except BaseException:  # also Ctrl C in a script
        if active and layer.objects.active and layer.objects.active.mode != "OBJECT" and bpy.context.mode != mode:
            bpy.ops.object.mode_set(mode="OBJECT")
        used_data = {obj.data for obj in bpy.data.objects if obj.as_pointer() in before}  # data of objects that stay
        used_data |= {mesh.shape_keys for mesh in used_data if isinstance(mesh, bpy.types.Mesh)}
        bpy.data.batch_remove([block for block in _iter_blocks() if block.as_pointer() not in before and block not in used_data])
        layer.update()
        for obj in layer.objects:
            obj.select_set(obj in selected)
        layer.objects.active = active
        if active and active.mode != object_mode:
            bpy.ops.object.mode_set(mode=object_mode)
        raise


def _iter_blocks() -> Iterator[bpy.types.ID]:
    return (block for kind in KINDS for block in getattr(bpy.data, kind))


def parse_json(text: object) -> object:
    """Return what a custom property holds as JSON; None if it holds anything else, as others may have written it."""
    try:
        return json.loads(text) if isinstance(text, str) else None
    except (ValueError, RecursionError):
        return None


def rename(block: bpy.types.Object | bpy.types.Mesh, name: str) -> None:
    """Give a data-block the name, or the next free one, instead of renaming another as Blender before 4.0 would."""
    if bpy.app.version < (4, 0, 0):
        blocks = bpy.data.objects if isinstance(block, bpy.types.Object) else bpy.data.meshes
        base, number = name.encode()[:ID_NAME_SIZE - len(".000") - 1].decode(errors="ignore"), 0
        while blocks.get(name) not in (None, block):
            number += 1
            name = f"{base}.{number:03}"
    block.name = name


def local_copy(block: bpy.types.Object | bpy.types.Mesh) -> bpy.types.Object | bpy.types.Mesh:
    """Return a local copy, also of a library override, which Blender would copy as another override."""
    if block.override_library and bpy.app.version < (4, 0, 0):  # which can't make an override local
        new = block.override_library.reference.copy()
        if isinstance(block, bpy.types.Object):
            copy_settings(block, new, {"name", "data", "dimensions", "matrix_world", "matrix_local", "matrix_basis"})
        return new
    new = block.copy()
    return new.make_local(clear_liboverride=True) if new.override_library else new


def find_users(mesh: bpy.types.Mesh) -> list[bpy.types.Object]:
    """Return the objects that share the mesh."""
    return [obj for obj in bpy.data.objects if obj.data == mesh]


def remove_object(obj: bpy.types.Object) -> None:
    """Remove an object, and its mesh and shape keys if nothing else uses them."""
    mesh = obj.data
    bpy.data.objects.remove(obj)
    if not mesh.users:
        bpy.data.batch_remove([mesh, *filter(None, [mesh.shape_keys])])  # or keys of a copied mesh would stay


def copy_settings(source: bpy.types.bpy_struct, target: bpy.types.bpy_struct, exclude: Collection[str]) -> None:
    """Copy all writable properties of source, except some, to target of the same type."""
    for prop in source.bl_rna.properties:
        name = prop.identifier
        if prop.is_readonly or name in exclude or target.is_property_readonly(name):
            continue
        value = getattr(source, name)
        if getattr(target, name) != value:
            setattr(target, name, value)


def has_strips_without_action(block: bpy.types.ID) -> bool:
    """Return whether the data-block has NLA strips (meta, transition) that Python can't create."""
    tracks = block.animation_data.nla_tracks if block.animation_data else ()
    return any(not strip.action for track in tracks for strip in track.strips)


def copy_animation(source: bpy.types.ID, target: bpy.types.ID) -> None:
    """Copy the source's action, drivers and NLA strips, if each plays an action, to a target without animation data."""
    old = source.animation_data
    if not old:
        return
    new = target.animation_data_create()
    for driver in old.drivers:
        new.drivers.from_existing(src_driver=driver)
    _assign_action(old, new)
    copy_settings(old, new, _NOT_SETTINGS)
    for track in old.nla_tracks:
        new_track = new.nla_tracks.new()
        for strip in track.strips:
            new_strip = new_track.strips.new(strip.name, int(strip.frame_start), strip.action)
            _assign_action(strip, new_strip)
            copy_settings(strip, new_strip, _NOT_SETTINGS)
        copy_settings(track, new_track, {"is_solo"})


def _assign_action(old: bpy.types.bpy_struct, new: bpy.types.bpy_struct) -> None:
    new.action = old.action
    if getattr(old, "action_slot", None):  # from Blender 4.4 on
        new.action_slot = old.action_slot


def copy_actions(block: bpy.types.ID) -> None:
    """Give a copied data-block its own actions if the preferences duplicate actions, as Blender's Separate does."""
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
    """Make drivers of a copied data-block refer to copies instead of originals. images: {original: copy}."""
    for curve in block.animation_data.drivers if block.animation_data else ():
        for variable in curve.driver.variables:
            for target in variable.targets:
                if target.id in images:
                    target.id = images[target.id]
