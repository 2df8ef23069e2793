# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene for temporary objects, so that the user's scenes never contain them: other add-ons, playback and renders
use what is in those."""

from collections.abc import Iterator
import contextlib

import bpy

from .mesh_state import ignore_reports


@contextlib.contextmanager
def create_temporary_scene(*objects: bpy.types.Object) -> Iterator[bpy.types.ViewLayer]:
    """Yield the view layer of a new scene with these objects only. The scene has the frame and the settings by which
    the user's scene evaluates modifiers. The objects belong to the caller. Must not be called while Blender draws."""
    user = bpy.context.scene
    with ignore_reports():
        scene = bpy.data.scenes.new("Partwheel")
        try:
            scene.frame_current, scene.frame_subframe = user.frame_current, user.frame_subframe
            for name in user.render.bl_rna.properties.keys():
                if name in {"fps", "fps_base", "use_simplify"} or name.startswith("simplify_"):
                    setattr(scene.render, name, getattr(user.render, name))
            for obj in objects:
                scene.collection.objects.link(obj)
            yield scene.view_layers[0]
        finally:
            bpy.data.scenes.remove(scene)


@contextlib.contextmanager
def edit_in_temporary_scene(mesh: bpy.types.Mesh) -> Iterator[None]:
    """A context for Blender's operators: Edit Mode of the mesh, by an object in a scene of its own."""
    obj = bpy.data.objects.new(mesh.name, mesh)
    try:
        with create_temporary_scene(obj) as layer:
            layer.objects.active = obj
            context = {"scene": layer.id_data, "view_layer": layer, "object": obj, "active_object": obj}
            with bpy.context.temp_override(**context, edit_object=None, mode="OBJECT"):
                bpy.ops.object.mode_set(mode="EDIT")
            with bpy.context.temp_override(**context, edit_object=obj):
                yield
                bpy.ops.object.mode_set(mode="OBJECT")
    finally:
        bpy.data.objects.remove(obj)


def update_depsgraph(layer: bpy.types.ViewLayer) -> bpy.types.Depsgraph:
    layer.update()
    return layer.depsgraph
