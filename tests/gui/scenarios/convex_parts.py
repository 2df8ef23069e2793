"""Convex parts from the Object menu: hulls around the model; their number changed afterwards; made a rigid body; one undo
step takes all away."""
import bpy

from compose import activate, choose

ABOVE_LAST = 3  # Swap, Place and Unite stand below it


def play(stage):
    yield from stage.open("homer")
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    name = stage.object.name
    activate(stage, stage.object)
    before = {collection.name for collection in bpy.data.collections}

    def children():
        return sorted(child.name for child in bpy.data.objects[name].children)

    yield from choose(stage, "VIEW3D_MT_object", ABOVE_LAST)
    yield from stage.until("16 hulls", lambda: len(children()) == 16)
    stage.check(children() == [f"UCX_{name}_{number:02}" for number in range(16)], "named as Unreal has them")
    stage.check(stage.object.name == name and stage.object.select_get(), "the model stays selected")
    yield from stage.screenshot("1-sixteen")
    yield from stage.adjusted(hulls=5)
    stage.check(children() == [f"UCX_{name}_{number:02}" for number in range(5)], "five, when that is changed")
    yield from stage.screenshot("2-five")
    yield from stage.adjusted(engine="RIGID_BODY", hulls=9)
    stage.check(children() == [f"{name}_hull_{number:02}" for number in range(9)], "nine for a rigid body")
    stage.check(bpy.data.objects[name].rigid_body.collision_shape == "COMPOUND", "which has them as its shape")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("undone", lambda: len(bpy.data.objects[name].children) == 0)
    stage.check(bpy.data.objects[name].rigid_body is None and stage.window.scene.rigidbody_world is None, "and no body is left")
    stage.check({collection.name for collection in bpy.data.collections} == before, "nor a collection")
