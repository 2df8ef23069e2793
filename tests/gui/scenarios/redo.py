"""The panel of the last operation does it again with other options: each operator from each mode, and afterwards the mode,
the active object and what is selected are as the first time, or as with these options from the start."""
import bpy

FACE = 700
# Operator, what it is started with, what is changed in the panel, in Edit Mode with a part that is picked.
IN_EDIT_MODE = (
    ("mesh.partwheel_select", {"face_index": FACE}, {"level": 1}),
    ("mesh.partwheel_similar", {}, {"threshold": 0.99}),
    ("mesh.partwheel_remember", {"part": "finger"}, {"part": "thumb"}),
    ("mesh.partwheel_remove", {}, {"smooth": True}),
    ("mesh.partwheel_copy", {}, {"smooth": True}),
    ("mesh.partwheel_split", {"parts": 3}, {"parts": 4}),
    ("mesh.partwheel_convex", {"hulls": 3}, {"hulls": 4}),
)


def play(stage):
    yield from stage.open("hand")
    yield from parts_to(stage, "EDIT", {"VERTEX_GROUPS"})
    yield from stage.open("hand")
    yield from parts_to(stage, "SCULPT", {"FACE_SETS"})
    for name, first, second in IN_EDIT_MODE:
        for mode in ("EDIT", "OBJECT") if name in ("mesh.partwheel_copy", "mesh.partwheel_split") else ("EDIT",):
            yield from again(stage, mode, name, first, second)


def begin(stage, mode):
    yield from stage.open("hand")
    with stage.override():
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", True, face_index=FACE)
        if mode != "EDIT":
            bpy.ops.object.mode_set(mode=mode)
        bpy.ops.ed.undo_push(message=mode)
    yield from stage.settle()


def run(stage, name, options):
    space, _, operator = name.partition(".")
    with stage.override():
        stage.check(getattr(getattr(bpy.ops, space), operator)("EXEC_DEFAULT", True, **options) == {"FINISHED"}, f"{name} is done")
    yield from stage.settle()


def state(stage):
    """The mode, the active object, how many objects and faces are selected."""
    obj, layer = stage.object, stage.window.view_layer
    faces = len(stage.selection()) if obj.mode == "EDIT" else 0
    return obj.mode, obj.name, len(bpy.data.objects), sorted(each.name for each in layer.objects if each.select_get()), faces


def again(stage, mode, name, first, second):
    """Done with other options, and done with these from the start, is the same."""
    yield from begin(stage, mode)
    yield from run(stage, name, {**first, **second})
    wanted = state(stage)
    yield from begin(stage, mode)
    yield from run(stage, name, first)
    yield from stage.adjusted(**second)
    stage.check(state(stage) == wanted, lambda: f"{name} again, begun in {mode}: {state(stage)}, not {wanted}")


def parts_to(stage, mode, to):
    """Also where the first time has made objects, which leaves the mode."""
    yield from begin(stage, mode)
    before = state(stage)
    yield from run(stage, "mesh.partwheel_parts", {"to": to, "count": 4})
    stage.check(state(stage) == before, "writing into the mesh leaves the mode and the selection")
    for options in ({"count": 5}, {"to": {"OBJECTS"}}, {"to": to}):
        yield from stage.adjusted(**options)
        if "OBJECTS" in stage.last.properties.to:
            stage.check(stage.object.mode == "OBJECT" and len(bpy.data.objects) > 2, "the objects are there")
        else:
            stage.check(state(stage) == before, lambda: f"as before, with {options}: {state(stage)}, not {before}")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.settle()
