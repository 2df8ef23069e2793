"""What the scenarios share that do an operation again from the panel of the last operation."""
import bmesh
import bpy
import numpy

from compose import activate, module

FACE, THUMB = 700, 100
TURN = (1, 0, 0, 0.02, 0, 1, 0, 0.03, 0, 0, 1, 0.02, 0, 0, 0, 1)


def again(stage, model, mode, name, first, second):
    yield from begin(stage, model, mode, name)
    before = scene()
    yield from run(stage, name, first)
    yield from stage.adjusted(**second)
    adjusted = scene()
    stage.check(adjusted != before, f"{name} does something")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.settle()
    if stage.object.mode != mode:  # what makes objects leaves Edit Mode, as a step of its own
        stage.mouse.key("Z", ctrl=True)
        yield from stage.settle()
    differing = differences(scene(), before)
    stage.check(not differing, lambda: f"undo brings all back after {name} {second}: {differing}")
    yield from run(stage, name, {**first, **second})
    differing = differences(adjusted, scene())
    stage.check(not differing, lambda: f"{name} again, with {second}, as at once: {differing}")


def begin(stage, model, mode, name):
    yield from stage.open(model)
    hand = stage.object
    face = max(hand.data.polygons, key=lambda polygon: polygon.center.x).index if model == "homer" else FACE
    with stage.override():
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", True, face_index=THUMB)
        bpy.ops.mesh.partwheel_remember("EXEC_DEFAULT", True, part="second")
        bpy.ops.mesh.partwheel_select("EXEC_DEFAULT", True, face_index=face)
        bpy.ops.mesh.partwheel_remember("EXEC_DEFAULT", True, part="first")
    if name.endswith("swap"):
        with stage.override():
            bpy.ops.object.mode_set(mode="OBJECT")
        other = bpy.data.objects.new("other", hand.data.copy())
        other.location.x = 10
        stage.window.scene.collection.objects.link(other)
        activate(stage, hand)
        with stage.override():
            bpy.ops.object.mode_set(mode="EDIT")
    elif mode == "OBJECT":
        with stage.override():
            bpy.ops.object.mode_set(mode="OBJECT")
        if not name.endswith("pick"):
            module("api").copy_part(hand, module("parts.picks").get_pick(stage.snapshot(hand)).node)
            part, = (obj for obj in bpy.data.objects if obj != hand)
            part.name = "part"
            part.location.x += 0.01
            activate(stage, *((hand, part) if name.endswith("unite") else (part,)))
    with stage.override():
        bpy.ops.ed.undo_push(message="Begin")
    yield from stage.settle()


def run(stage, name, options):
    if "handles" in options:
        hand = stage.object
        faces = module("parts.registry").get_hierarchy(stage.snapshot(hand)).faces(module("parts.picks").get_pick(stage.snapshot(hand)).node)
        vertices = {vertex for face in faces.tolist() for vertex in hand.data.polygons[face].vertices}
        tip = max(vertices, key=lambda vertex: hand.data.vertices[vertex].co.length)
        options = {**options, "handles": [{"name": "", "vertex": tip, "radius": 0.05, "turn": 0, "matrix": TURN}]}
    space, _, operator = name.partition(".")
    with stage.override():
        stage.check(getattr(getattr(bpy.ops, space), operator)("EXEC_DEFAULT", True, **options) == {"FINISHED"}, f"{name} is done")
    yield from stage.settle()


def scene():
    """All that the operators could change."""
    bpy.context.view_layer.update()
    registry, named_parts = module("parts.registry"), module("related.named_parts")
    result = {}
    for obj in bpy.data.objects:
        mesh = obj.data
        if obj.mode == "EDIT":
            bm = bmesh.from_edit_mesh(mesh)
            places, faces = [vert.co[:] for vert in bm.verts], [face.select for face in bm.faces]
        else:
            places, faces = [vertex.co[:] for vertex in mesh.vertices], [face.select for face in mesh.polygons]
        result |= {f"{obj.name} places": numpy.round(places, 5).tobytes(), f"{obj.name} selected": faces, f"{obj.name} mode": obj.mode,
                   f"{obj.name} state": str(registry.get_state(mesh)[0]), f"{obj.name} matrix": numpy.round(obj.matrix_world, 5).tolist(),
                   f"{obj.name} is selected": obj.select_get(), f"{obj.name} names": sorted(named_parts.part_names(mesh))}
    return result | {"active": bpy.context.view_layer.objects.active.name, "meshes": sum(mesh.users > 0 for mesh in bpy.data.meshes)}


def differences(state, other):
    return sorted(name for name in {*state, *other} if state.get(name) != other.get(name))
