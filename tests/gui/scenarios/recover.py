"""What Blender itself puts aside, quit.blend, is recovered whole, without a trace of ours in it; parts are built anew."""
import os
import subprocess

import bpy

# Another Blender opens the file, looks at its parts, moves a vertex and quits.
OTHER = """
import bpy, sys
def play():
    registry = next(module for name, module in sys.modules.items() if name.endswith(".parts.registry"))
    snapshot = next(module for name, module in sys.modules.items() if name.endswith(".mesh.snapshot"))
    model = bpy.data.objects["hand"]
    assert registry.get_hierarchy(snapshot.MeshSnapshot(model)) is not None, "the parts came with the file"
    model.data.vertices[0].co.z += 1000
    bpy.ops.ed.undo_push(message="moved")
    print("parts seen")
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.wm.quit_blender()
bpy.app.timers.register(play, first_interval=0.5)
"""


def play(stage):
    yield from stage.open("hand")
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    height = stage.object.data.vertices[0].co.z
    path = stage.file("hand.blend")
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    aside = path.parent / "recover"
    aside.mkdir()

    log = path.parent / "other.log"
    with log.open("w") as output:
        other = subprocess.Popen([bpy.app.binary_path, "-noaudio", path, "--python-expr", OTHER], stdout=output,
                                 stderr=subprocess.STDOUT, env={**os.environ, "TMPDIR": str(aside)})
    yield from stage.until("the other Blender has quit", lambda: other.poll() is not None)
    stage.check("parts seen" in log.read_text(), "the other Blender has seen the parts of the file")
    stage.check((aside / "quit.blend").exists(), "it has put its state aside")

    bpy.context.preferences.filepaths.temporary_directory = str(aside)
    with stage.override():
        bpy.ops.wm.recover_last_session()
    bpy.context.preferences.filepaths.temporary_directory = ""
    yield from recovered(stage, height + 1000)


def recovered(stage, height):
    """The hand is as it was put aside, its first vertex at this height; parts are built anew."""
    yield from stage.wait_for_redraw()
    mesh = bpy.data.objects["hand"].data
    stage.check(abs(mesh.vertices[0].co.z - height) < 1, "the vertex is where it was moved before")
    stage.check(list(mesh.keys()) == [], "no bytes of ours are on the mesh")
    stage.check(stage.registry.get_state(mesh)[0] == stage.registry.State.NONE, "no parts are claimed that are not there")
    mesh.vertices[0].co.z -= 1000
    stage.window.view_layer.objects.active = bpy.data.objects["hand"]
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")
    stage.select(())
    face = 700
    stops, start = stage.wheels.stops(face)
    with stage.override():
        stage.check(bpy.ops.mesh.partwheel_select(face_index=face) == {"FINISHED"}, "parts are built anew")
    yield from stage.selected(stops[start], "after that")
