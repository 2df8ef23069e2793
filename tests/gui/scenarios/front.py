"""The README's first picture, frame by frame: a knight as one mesh, one click on its sword, the wheel, Parts to..., and its
parts moving apart. scripts/tour puts the frames together. The knight (KayKit Adventurers by Kay Lousberg, CC0) is in the
folder that PARTWHEEL_ASSETS names."""
import json
import os
import pathlib

import bpy
import numpy
from compose import pixel
from mathutils import Euler, Vector

ASSETS = pathlib.Path(os.environ.get("PARTWHEEL_ASSETS", pathlib.Path(__file__).resolve().parents[4] / "shared" / "assets"))
UNUSED = ("2H_Sword", "1H_Sword_Offhand", "Badge_Shield", "Rectangle_Shield", "Spike_Shield")  # other equipment in the file
NOTCHES = 2
APART, STEPS = 0.4, 14  # how far in the end, in so many frames


def play(stage):
    blade = open_knight(stage)
    yield from stage.wait_for_redraw()
    frames = []

    def frame(milliseconds, caption):
        number = len(frames)
        yield from stage.screenshot(f"{number:02}")
        frames.append((milliseconds, caption, stage.mouse.x, stage.mouse.y))

    display, hovering = stage.part("pick.display").pick_display, stage.part("pick.hover").hover
    with stage.override():
        bpy.ops.mesh.partwheel_build()
    stage.use_tool()
    x, y = pixel(stage, blade)
    for step in range(4):
        stage.mouse.move(x + 150 - 50 * step, y + 90 - 30 * step)
        yield from stage.settle()
        yield from frame(120, "Point at the sword")
    yield from stage.until("hover shows its part", lambda: hovering.target)
    yield from frame(1000, "Point at the sword")
    stage.mouse.click()
    yield from stage.until("a click picks it", lambda: display.is_shown)
    yield from frame(1100, "Click: it is selected")
    for _ in range(NOTCHES):
        picked = stage.overlay_faces()
        stage.mouse.wheel(1)
        yield from stage.until("the wheel takes more", lambda: picked < stage.overlay_faces())
        yield from frame(800, "Turn the wheel: what belongs to it")
    stage.mouse.key("ESC")
    yield from stage.settle()
    shown, end_recording = stage.record_cuts()
    stage.mouse.move(x + 150, y + 200)  # beside him
    with stage.override():
        bpy.ops.mesh.partwheel_parts("INVOKE_DEFAULT")
    yield from stage.until("the parts are shown", lambda: shown)
    yield from frame(1500, "Parts to...: the whole model in parts")
    stage.mouse.key("RET")
    yield from stage.until("there are objects", lambda: len(bpy.data.objects) == 1 + len(shown[-1].cut))
    yield from stage.settle()
    end_recording()
    yield from stage.adjusted(explode=APART)
    parts = [obj for obj in bpy.data.objects if obj.name != "Knight"]
    with stage.override():
        bpy.ops.object.select_all(action="DESELECT")
    largest = next(obj for obj in parts if "explode" in obj)
    for step in [*range(STEPS + 1)]:
        largest["explode"] = APART * (1 - (1 - step / STEPS) ** 2)
        largest.update_tag()
        yield from frame(900 if step == 0 else 1700 if step == STEPS else 70, "Enter: closed, textured objects")
    stage.check(any(obj.delta_location.length > 0.1 for obj in parts), "they are apart")
    stage._pictures.with_name("front.json").write_text(json.dumps(frames))


def open_knight(stage):
    """Opens the knight as one mesh, as he stands, in Object Mode with his texture; returns a place on the blade of his sword."""
    vars(numpy).setdefault("bool", bool)  # for Debian's importer, which is older than its numpy
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    with stage.override():
        bpy.ops.import_scene.gltf(filepath=str(ASSETS / "files" / "Knight.glb"))
        meshes = [obj for obj in bpy.data.objects if obj.type == "MESH" and obj.name not in UNUSED and obj.parent]
        depsgraph = bpy.context.evaluated_depsgraph_get()
        copies = []
        for obj in meshes:
            mesh = bpy.data.meshes.new_from_object(obj.evaluated_get(depsgraph))
            mesh.transform(obj.matrix_world)
            copies.append(bpy.data.objects.new(obj.name, mesh))
        for obj in [obj for obj in bpy.data.objects if obj not in copies]:
            bpy.data.objects.remove(obj)
        sword = [vertex.co for vertex in next(copy for copy in copies if copy.name.startswith("1H_Sword")).data.vertices]
        tip = min(place.y for place in sword)
        ahead = [place for place in sword if place.y < tip + 0.6]
        blade = sum(ahead, Vector()) / len(ahead)
        for copy in copies:
            stage.window.scene.collection.objects.link(copy)
            copy.select_set(True)
        stage.window.view_layer.objects.active = copies[0]
        bpy.ops.object.join()
        stage.object.name = "Knight"
        bpy.ops.object.select_all(action="DESELECT")
        bpy.ops.ed.undo_push(message="The knight")
    space = stage.area.spaces.active
    space.shading.color_type = "TEXTURE"
    space.overlay.show_text = space.overlay.show_cursor = space.overlay.show_object_origins = False
    stage.view_3d.view_rotation = Euler((1.35, 0, -0.65)).to_quaternion()
    stage.view_3d.view_perspective = "PERSP"
    stage.view_3d.view_location, stage.view_3d.view_distance = (-0.1, -0.25, 1.15), 4.6
    return blade
