"""A part merged by hand, with real events: the wheel stops there from then on; undo takes this back in the same step."""
import bpy
from scenarios.parts_to import mode


def play(stage):
    yield from stage.open("figure")
    states, end_recording = stage.record_cuts()
    arm, head = (stage.spot(*place) for place in ((0.95, 0.6), (0.5, 0.95)))
    yield from mode(stage, "OBJECT")
    stage.mouse.move(*arm[:2])
    with stage.override():
        bpy.ops.mesh.partwheel_parts("INVOKE_DEFAULT")
    yield from stage.until("the parts are shown", lambda: len(states) == 1)
    stage.mouse.key("SIX")
    yield from stage.until("six", lambda: len(states[-1].cut) == 6)
    six = states[-1].cut
    yield from stage.drag("LEFTMOUSE", head[0] - arm[0], head[1] - arm[1])
    merged = six.merge(int(six.labels[head[2]]), int(six.labels[arm[2]]))
    yield from stage.until("arm and head are one part", lambda: states[-1].cut == merged)
    faces = merged.faces(int(merged.labels[arm[2]])).tolist()
    stage.check(faces not in wheel_parts(stage, arm[2]), "the wheel doesn't stop there yet")
    stage.mouse.key("RET")
    yield from stage.until("there are objects", lambda: len(bpy.data.objects) == 1 + len(merged))
    yield from stage.settle()
    stage.check(faces in wheel_parts(stage, arm[2]) and faces in wheel_parts(stage, head[2]), "now it does")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("undone", lambda: len(bpy.data.objects) == 1)
    yield from stage.settle()
    stage.check(faces not in wheel_parts(stage, arm[2]), "and no more")
    end_recording()


def wheel_parts(stage, face):
    """The faces of each stop, ascending, after a click on a face."""
    tree = stage.registry.require_hierarchy(stage.snapshot(bpy.data.objects["figure"]))
    return [sorted(tree.faces(stop).tolist()) for stop in tree.wheel(face)[0]]
