"""Linked meshes, library overrides and instances in Object Mode: what can't be edited says so, an original is found."""
import bpy
from mathutils import Matrix


def menu(stage):
    """The last entry of Object Mode's Select menu."""
    with stage.override():
        bpy.ops.wm.call_menu(name="VIEW3D_MT_select_object")
    yield from stage.settle()
    stage.mouse.key("END")
    stage.mouse.key("RET")
    yield from stage.settle()


def play(stage):
    yield from stage.open("hand")
    model = stage.object
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    path = str(stage.file("library.blend"))
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.data.libraries.write(path, {model})
    bpy.data.objects.remove(model)
    with bpy.data.libraries.load(path, link=True) as (available, here):
        here.objects = available.objects
    linked = here.objects[0]
    scene = stage.window.scene
    scene.collection.objects.link(linked)

    def refused(what, sentence):
        """The operator ends at once with this sentence, and Object Mode goes on."""
        yield from stage.wait_for_redraw()
        stage.mouse.move(x, y)
        before = stage.reports().count(sentence)
        yield from menu(stage)
        yield from stage.until(f"a sentence says why ({what})", lambda: stage.reports().count(sentence) == before + 1)
        stage.check(not stage.drawn_things() and all(obj.mode == "OBJECT" for obj in bpy.data.objects),
                    f"nothing has begun ({what})")

    yield from refused("linked", "is linked from another file")
    yield from stage.screenshot("0-linked")
    override = linked.override_create(remap_local_usages=True)
    if override.name not in scene.collection.objects:
        scene.collection.objects.link(override)
    if linked.name_full in [obj.name_full for obj in scene.collection.objects if obj.library]:
        scene.collection.objects.unlink(linked)
    yield from refused("an override of the object", "is linked from another file")
    override.data.override_create(remap_local_usages=True)
    if override.data.library is None:
        yield from refused("an override of its mesh", "is a library override")
    bpy.data.objects.remove(override)

    # An instance of a collection that is not in the scene; and one of an object that is.
    yield from stage.open("hand")
    model = stage.object
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    group = bpy.data.collections.new("group")
    group.objects.link(model)
    scene = stage.window.scene
    scene.collection.objects.unlink(model)
    empty = bpy.data.objects.new("instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", group
    scene.collection.objects.link(empty)
    yield from refused("an instance of what is not in the view layer", "is an instance")
    yield from stage.screenshot("1-instance")
    scene.collection.objects.link(model)
    shift = Matrix.Translation((0.01, 0, 0))
    empty.matrix_world = shift
    yield from stage.wait_for_redraw()
    stage.mouse.move(x, y)
    yield from menu(stage)
    yield from stage.until("a part of it is shown", lambda: stage.drawn_things() == 1)
    stage.mouse.key("RET")
    yield from stage.until("the original is being edited", lambda: model.mode == "EDIT")
    yield from stage.until("something of it is selected", lambda: model.data.total_face_sel > 0)
    stage.window.view_layer.objects.active = model
    yield from stage.ended()

    # Two users of one mesh: the one under the mouse that is being edited is picked from.
    yield from stage.open("hand")
    model = stage.object
    twin = bpy.data.objects.new("twin", model.data)
    stage.window.scene.collection.objects.link(twin)
    twin.matrix_world = Matrix.Translation((5, 0, 0)) @ model.matrix_world
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        twin.select_set(True)
        bpy.ops.object.mode_set(mode="EDIT")
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    stage.shortcut("mesh.partwheel_select")
    yield from stage.selected(stops[start], "of two users of a mesh")
    stage.mouse.wheel(1)
    yield from stage.selected(stops[start + 1], "after a notch")
    stage.mouse.key("RET")
    yield from stage.ended()
