"""Blender's own autosave: put off while a part is being picked and not lost by it; it is recovered whole, without a
trace of ours in it, and parts are built anew."""
import bpy

from scenarios.recover import recovered

MINUTE = 60  # seconds, the shortest interval that Blender offers


def play(stage):
    yield from stage.open("hand")
    aside = stage.file("aside")
    aside.mkdir()
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        stage.object.data.vertices[0].co.z += 1000
        bpy.ops.ed.undo_push(message="moved")
        bpy.ops.object.mode_set(mode="EDIT")
    height = stage.object.data.vertices[0].co.z
    stage.check(stage.registry.get_hierarchy(stage.object) is not None, "the parts are there before")
    filepaths = bpy.context.preferences.filepaths
    filepaths.temporary_directory = str(aside)
    filepaths.auto_save_time = 1
    filepaths.use_auto_save_temporary_files = True
    # Blender looks at all its timers at once, so when this one has run the other has.
    later = bpy.data.window_managers[0].event_timer_add(MINUTE + 1, window=stage.window)

    def saved():
        return list(aside.glob("*autosave.blend"))

    _, stops, start = yield from stage.pick(0.5, 0.9, above=2)
    yield from stage.until("it is time to save", lambda: later.time_duration > 0)
    bpy.data.window_managers[0].event_timer_remove(later)
    yield from stage.settle()
    stage.check(not saved(), "Blender saves nothing while a part is being picked")
    yield from stage.selected(stops[start], "still being picked")
    stage.mouse.key("RET")
    yield from stage.until("then it does at once", saved)
    stage.check(not stage.object.data.keys(), "no bytes of ours are left on the mesh")
    stage.check(stage.registry.get_state(stage.object.data)[0] != stage.registry.State.NONE, "its parts are still there")
    filepaths.temporary_directory = ""
    filepaths.auto_save_time = 2

    with stage.override():
        bpy.ops.wm.recover_auto_save(filepath=str(saved()[0]))
    yield from recovered(stage, height)
