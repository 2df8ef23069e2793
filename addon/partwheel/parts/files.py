# SPDX-License-Identifier: GPL-3.0-or-later
"""Saves hierarchies in .blend files and reads them back."""

import bpy
from bpy.app.handlers import persistent

from ..mesh import get_mesh_state
from ..preferences import preferences
from . import builds, registry, stored


@persistent
def _on_save(*_: object) -> None:
    if not preferences().save_with_file:
        return
    for mesh in bpy.data.meshes:
        if mesh.library:
            continue
        state, entry = registry.get_state(mesh)
        if state in registry.USABLE and not entry.packed:
            entry.packed = stored.pack(entry.built_for, entry.hierarchy)
        packed = get_mesh_state(mesh).stored if state == registry.State.UNOPENED else entry and entry.packed
        if packed:
            stored.take_property(mesh)  # Blender 4.2 to 5.0 truncate bytes at a 0 if they replace others
            mesh[stored.PROPERTY] = packed


@persistent
def _on_saved(*_: object) -> None:
    for mesh in bpy.data.meshes:
        if stored.PROPERTY in mesh:
            stored.take_property(mesh)


@persistent
def on_load(*_: object) -> None:
    """Another file was opened. Forget all meshes and take the stored hierarchies of the new ones."""
    unregister()
    for mesh in bpy.data.meshes:
        if stored.PROPERTY in mesh and not mesh.library:
            get_mesh_state(mesh).stored = stored.take_property(mesh)


HANDLERS = {"load_post": on_load, "save_pre": _on_save, "save_post": _on_saved,
            "save_post_fail": _on_saved}  # from Blender 4.0


def unregister() -> None:
    """Cancel all builds and forget all hierarchies."""
    builds.cancel_all()
    registry.forget_all()
