# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene for temporary objects, so that the user's scenes never have them, not for a moment: other add-ons, playback and
renders go through what is in those."""

import contextlib

import bpy

active = False  # while there is one: what Blender tells of then are no changes of the user's


@contextlib.contextmanager
def scene_apart(*objects):
    """The view layer of a new scene with these objects alone, in the frame and with the settings by which the user's scene
    evaluates modifiers. The objects stay the caller's. Not to be called while Blender draws."""
    global active
    user, scene = bpy.context.scene, bpy.data.scenes.new("Partwheel")
    active, before = True, active
    try:
        scene.frame_current, scene.frame_subframe = user.frame_current, user.frame_subframe
        for name in ("fps", "fps_base", *filter(_simplifies, user.render.bl_rna.properties.keys())):
            setattr(scene.render, name, getattr(user.render, name))
        for obj in objects:
            scene.collection.objects.link(obj)
        yield scene.view_layers[0]
    finally:
        bpy.data.scenes.remove(scene)
        active = before


def _simplifies(name):
    return name == "use_simplify" or name.startswith("simplify_")


def depsgraph(layer):
    """Of a view layer, up to date."""
    layer.update()
    return layer.depsgraph
