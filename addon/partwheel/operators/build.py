# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh.partwheel_build: builds the hierarchy of the active mesh."""

import time

import bpy

from .. import session
from ..core import LibraryError, PartwheelError


class Progress:
    """Shows a build's progress at the mouse cursor, or in the terminal when Blender runs without windows."""

    def __init__(self, context):
        self.manager = context.window_manager
        self.percent = -1

    def __enter__(self):
        if not bpy.app.background:
            self.manager.progress_begin(0, 100)
        return self

    def __exit__(self, *_):
        if not bpy.app.background:
            self.manager.progress_end()

    def __call__(self, fraction, stage):
        percent = int(fraction * 100)
        if bpy.app.background and percent >= self.percent + 10:
            print(f"Partwheel: {percent:3d} % {stage}", flush=True)
            self.percent = percent
        elif not bpy.app.background:
            self.manager.progress_update(percent)


def build_reporting(operator, context, quality=0.0):
    """Builds for the active object and reports through the operator what came of it: the hierarchy, or None."""
    obj = context.active_object
    begin = time.perf_counter()
    try:
        with Progress(context) as progress:
            hierarchy = session.build(obj, quality, progress)
    except (PartwheelError, LibraryError) as error:
        name = getattr(error, "name", "library")
        operator.report({"ERROR"}, f"No parts for {obj.data.name} ({name}): {error}")
        return None
    seconds = time.perf_counter() - begin
    operator.report({"INFO"}, f"{obj.data.name}: {len(hierarchy.order)} faces, {len(hierarchy.tetrahedra)} tets, "
                              f"{seconds:.1f} s")
    return hierarchy


class MESH_OT_partwheel_build(bpy.types.Operator):
    """Find the parts of the active mesh at all sizes, so that the wheel can step through them"""

    bl_idname = "mesh.partwheel_build"
    bl_label = "Build Part Hierarchy"
    bl_options = {"REGISTER"}

    quality: bpy.props.FloatProperty(
        name="Quality",
        description="0 adds no points inside the mesh; from 1.1 on, bounds how stretched the tetrahedra may be "
                    "(1.4 is usual, smaller is slower)",
        default=0.0, min=0.0, soft_max=3.0,
    )

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return obj is not None and obj.type == "MESH" and obj.mode in {"OBJECT", "EDIT"}

    def execute(self, context):
        return {"FINISHED"} if build_reporting(self, context, self.quality) else {"CANCELLED"}
