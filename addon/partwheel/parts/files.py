# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchies on their way into .blend files and out of them."""

import bpy
from bpy.app.handlers import persistent

from ..mesh.mesh_identity import mesh_key
from ..preferences import preferences
from . import builds, registry, stored
from .stored import carried, unopened


@persistent
def _before_saving(*_):
    if not preferences().save_with_file:
        return
    for mesh in bpy.data.meshes:
        if mesh.library:
            continue
        fits, entry = registry.state(mesh)
        if fits in registry.USABLE and not entry.packed:
            entry.packed = stored.pack(entry.built, entry.hierarchy)
        packed = unopened.get(mesh_key(mesh)) if fits == registry.State.UNOPENED else entry and entry.packed
        if packed:
            carried(mesh)  # Blender 4.2 to 5.0 cut bytes off at a 0 where they replace others
            mesh[stored.PROPERTY] = packed


@persistent
def _after_saving(*_):
    for mesh in bpy.data.meshes:
        if stored.PROPERTY in mesh:
            carried(mesh)


@persistent
def after_loading(*_):
    """Another file was opened: its meshes are others."""
    unregister()
    for mesh in bpy.data.meshes:
        if stored.PROPERTY in mesh and not mesh.library:
            unopened[mesh_key(mesh)] = carried(mesh)


HANDLERS = {"load_post": after_loading, "save_pre": _before_saving, "save_post": _after_saving,
            "save_post_fail": _after_saving}  # from Blender 4.0


def unregister():
    """Nothing goes on, and nothing is remembered."""
    builds.stop()
    registry.forget_all()
