"""The whole model in parts, as bones, with real events: B in the preview, Enter, and the model follows its armature in Pose
Mode. One undo step takes all of it away; in Edit Mode too, where it stays in that mode."""
import math

import bpy
import numpy

from scenarios.parts_to import mode, undone


def play(stage):
    yield from stage.open("homer")
    head = stage.spot(0.5, 0.95)
    yield from mode(stage, "OBJECT")
    start = everything(model())

    yield from bones(stage, head, "SIX", other="O")
    rig = model().find_armature()
    stage.check(len(rig.data.bones) == 6 and rig.mode == "OBJECT", "six bones")
    active = bpy.context.view_layer.objects.active
    stage.check(active == rig and rig.select_get() and not model().select_get(), "the armature is next")
    stage.check(not model().hide_get() and model().parent == rig, "the model hangs on it")
    yield from stage.screenshot("1-bones")
    yield from undone(stage)
    yield from stage.until("one undo step takes all away", lambda: len(bpy.data.objects) == 1)
    stage.check(everything(model()) == start and model().parent is None, "as it was")

    yield from bones(stage, head, "SIX", other="O")
    rest = posed(model())
    yield from mode(stage, "POSE")
    rig = model().find_armature()
    for bone in rig.pose.bones:
        if bone.parent:
            bone.rotation_mode = "XYZ"
            bone.rotation_euler.x = math.radians(30)
    yield from stage.wait_for_redraw()
    yield from stage.screenshot("2-posed")
    moved = abs(posed(model()) - rest).max(axis=1)
    stage.check(moved.max() > 0.05 * max(model().dimensions), "the model follows")
    yield from mode(stage, "OBJECT")

    bpy.context.view_layer.objects.active = model()
    yield from mode(stage, "EDIT")
    yield from bones(stage, head, "FOUR", other="G")
    stage.check(model().mode == "EDIT" and bpy.context.view_layer.objects.active == model(), "in Edit Mode")
    stage.check(len(model().find_armature().data.bones) == 4, "the same armature, with other bones")


def model():
    """Which is not the active object all the time."""
    return bpy.data.objects["homer"]


def bones(stage, place, digit, other):
    """Parts to..., so many, bones instead of what is usual."""
    before = model().find_armature()
    count = len(before.data.bones) if before else 0
    yield from stage.parts_to(*place[:2], digit, other, "B", "RET")
    yield from stage.until("there are bones", lambda: (rig := model().find_armature()) and (
        len(rig.data.bones) != count))
    yield from stage.settle()
    yield from stage.wait_for_redraw()


def posed(obj):
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return numpy.array([vertex.co[:] for vertex in mesh.vertices])


def everything(obj):
    return ([group.name for group in obj.vertex_groups], [modifier.name for modifier in obj.modifiers],
            sorted(obj.data.attributes.keys()), len(bpy.data.armatures))
