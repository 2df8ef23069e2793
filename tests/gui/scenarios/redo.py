"""The panel of the last operation does it again with other options, and afterwards the mode, the active object and the objects
that are selected are as the first time; after Parts to... as the options have it."""
import bpy

FACE = 700
# Operator, what it is started with, what is changed in the panel, whether as many objects are made then; in Edit Mode with
# a part that is picked.
OPERATORS = (
    ("mesh.partwheel_select", {"face_index": FACE}, {"level": 1}, True),
    ("mesh.partwheel_remember", {"part": "finger"}, {"part": "thumb"}, True),
    ("mesh.partwheel_remove", {}, {"smooth": True}, True),
    ("mesh.partwheel_copy", {}, {"smooth": True}, True),
    ("mesh.partwheel_split", {"parts": 3}, {"parts": 4}, False),
    ("mesh.partwheel_convex", {"hulls": 3}, {"hulls": 4}, False),
)


def play(stage):
    yield from parts_to(stage, "EDIT", {"VERTEX_GROUPS"})
    yield from parts_to(stage, "SCULPT", {"FACE_SETS"})
    for operator in OPERATORS:
        yield from again(stage, *operator)


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
    """The mode, the active object, how many objects there are, those that are selected."""
    obj, layer = stage.object, stage.window.view_layer
    return obj.mode, obj.name, len(bpy.data.objects), sorted(obj_in_layer.name for obj_in_layer in layer.objects if obj_in_layer.select_get())


def again(stage, name, first, second, as_many):
    yield from begin(stage, "EDIT")
    yield from run(stage, name, first)
    before = state(stage)
    yield from stage.adjusted(**second)
    current = state(stage)
    stage.check(current == before if as_many else current[:2] == before[:2], lambda: f"{name} again: {current}, not {before}")


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
