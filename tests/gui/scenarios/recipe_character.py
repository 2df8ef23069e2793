"""The steps of docs/recipes/character.md, with real events: the tour's figure becomes objects and an armature that moves them, then a
file for an engine."""
import json
import struct

import bpy
import numpy

from compose import closed, pixel
from scenarios.bones import posed
from scenarios.first_tour import TOUR_BUTTON
from scenarios.three_clicks import BUTTON

BESIDE = (-1.0, 0, 1.9)  # a place beside the figure
BELLY = (0, -0.15, 0.9)
BELOW_STEPS = 429  # pixels from the sidebar's top to the middle of the button "Parts to..." below the tour's steps


def play(stage):
    states, end_recording = stage.record_cuts()
    yield from opened_tour(stage)
    model, count = stage.object, len(bpy.data.objects)
    material, = model.data.materials

    # Steps 2 and 3
    yield from parts_shown(stage, states, BELOW_STEPS)
    automatic = states[-1].cut
    yield from stage.screenshot("1-parts")
    stage.mouse.move(*pixel(stage, BELLY))
    stage.mouse.wheel(1)
    yield from stage.until("the wheel makes more parts", lambda: len(states[-1].cut) == len(automatic) + 1)
    stage.mouse.wheel(-1)
    yield from stage.until("and fewer", lambda: states[-1].cut == automatic)
    stage.mouse.click()
    yield from stage.until("a click takes a part", lambda: states[-1].part is not None)
    stage.mouse.wheel(-1)
    yield from stage.until("the wheel splits it", lambda: len(states[-1].cut) > len(automatic))
    stage.mouse.wheel(1)
    yield from stage.until("and joins it", lambda: states[-1].cut == automatic)
    stage.mouse.move(*pixel(stage, BESIDE))
    stage.mouse.click()
    yield from stage.until("a click beside the model ends that", lambda: states[-1].part is None)

    # Step 4
    for key in ("B", "RET"):
        stage.mouse.key(key)
    yield from stage.until("there are objects and an armature", lambda: len(bpy.data.objects) == count + len(automatic) + 1)
    yield from stage.settle()
    rig = model.find_armature()
    parts = [obj for obj in stage.window.scene.objects if obj.select_get() and obj.type == "MESH"]
    stage.check(model.hide_get() and {obj.name for obj in parts} == {bone.name for bone in rig.data.bones},
                "in the model's place, named like the bones")
    for obj in parts:
        stage.check(closed(obj), f"{obj.name} is closed")
        stage.check([slot.material for slot in obj.material_slots] == [material], f"{obj.name} has the texture")
        stage.check(obj.find_armature() == rig, f"{obj.name} has the armature")
    yield from stage.screenshot("2-objects")

    # Step 5
    before = {obj.name: posed(obj) for obj in parts}
    bone = next(bone for bone in rig.data.bones if bone.parent and not bone.children)
    stage.check(stage.object == rig, "the armature is active")
    stage.mouse.move(*pixel(stage, BELLY))
    yield from stage.settle()
    stage.mouse.key("TAB", ctrl=True)
    yield from stage.until("Pose Mode", lambda: rig.mode == "POSE")
    for other in rig.data.bones:
        other.select = other == bone
    rig.data.bones.active = bone
    x, y = pixel(stage, rig.matrix_world @ bone.tail_local)
    stage.mouse.move(x, y)
    yield from stage.settle()
    stage.mouse.key("R")
    yield from stage.settle()
    for step in range(1, 5):
        stage.mouse.move(x + 10 * step, y + 20 * step)
        yield from stage.settle()
    stage.mouse.click()
    yield from stage.until("the bone is turned", lambda: rig.pose.bones[bone.name].matrix_basis.to_quaternion().angle > 0.3)
    yield from stage.wait_for_redraw()
    moved = {name: abs(posed(bpy.data.objects[name]) - places).max() for name, places in before.items()}
    size = max(model.dimensions)
    stage.check(moved[bone.name] > 0.02 * size and min(moved.values()) < 1e-4 * size, f"it moves its part, and not all ({moved})")
    yield from stage.screenshot("3-posed")
    stage.mouse.key("TAB", ctrl=True)
    yield from stage.until("Object Mode", lambda: rig.mode == "OBJECT")

    # Steps 6 and 7
    stage.check(sum(name.endswith(".L") for name in before) == sum(name.endswith(".R") for name in before) > 1, "mirror images")
    vars(numpy).setdefault("bool", bool)  # for Debian's exporter, which is older than its numpy
    path = stage.file("character.glb")
    with stage.override():
        bpy.ops.export_scene.gltf(filepath=str(path), use_selection=True)
    data = path.read_bytes()
    names = {node["name"] for node in json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])["nodes"]}
    stage.check({*before, rig.name} <= names and model.name not in names, "the file has the parts by name, and not the original")
    end_recording()


def opened_tour(stage):
    """Press Two-Minute Tour in the sidebar."""
    with stage.override():
        stage.window.view_layer.objects.active = None
    yield from stage.sidebar()
    yield from stage.settle()
    yield from pressed(stage, TOUR_BUTTON)
    yield from stage.until("the tour is open", lambda: stage.object and stage.object.name == "Figure")
    yield from stage.wait_for_redraw()
    yield from stage.until("its parts are found", lambda: stage.registry.find_hierarchy(stage.object.data))


def pressed(stage, button):
    """Press the button of the sidebar that is so many pixels below its top."""
    sidebar = next(region for region in stage.area.regions if region.type == "UI")
    stage.mouse.move(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - button)
    yield from stage.settle()
    stage.mouse.click()
    yield from stage.settle()


def parts_shown(stage, states, button=BUTTON):
    """Press Parts to... in the sidebar."""
    yield from stage.wait_for_redraw()
    states.clear()
    yield from pressed(stage, button)
    yield from stage.until("the parts are shown", lambda: states)
    yield from stage.wait_for_redraw()
