"""A script in a window: the view is still drawn while the script waits for a build; Edit Mode shows what it selects."""
import bpy

from partwheel import api


def play(stage):
    yield from stage.open("hand")
    obj = stage.object
    api.clear(obj)
    stage.check(api.state(obj) == api.State.NONE, "no parts to begin with")
    draws, build, progress = stage.draws, api.start_build(obj), []

    def polled():
        progress.append(build.poll())
        stage.area.tag_redraw()
        return progress[-1] is None

    yield from stage.until("the build is over", polled)
    stage.check(progress[0] is not None and stage.draws > draws, "Blender went on meanwhile")
    hierarchy = build.result()
    stage.check(api.hierarchy(obj) is hierarchy and api.state(obj) == api.State.FITS, "its parts are kept")
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    with stage.override():
        api.select(obj, api.part(obj, face))
    yield from stage.selected(stops[start], "what a click takes")
    with stage.override():
        api.select(obj, api.part(obj, face, level=1))
    yield from stage.selected(stops[start + 1], "and a notch up")
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        api.select(obj, api.part(obj, face))
        bpy.ops.object.mode_set(mode="EDIT")
    yield from stage.selected(stops[start], "selected in Object Mode, seen in Edit Mode")
