"""Similar parts of other objects: a copy of the model, whose parts are known with it, and a cube, whose parts aren't, are in
Edit Mode with it. Shift Ctrl L selects in the copy too, the wheel as well, Esc takes all back; it says that the cube was not
searched."""
import bmesh
import bpy
from mathutils import Vector


def play(stage):
    yield from stage.open("homer")
    stage.use_tool()
    spot = stage.spot(0.05, 0.5, above=1)
    obj, copy, cube = beside_others(stage)
    yield from stage.settle()
    yield from stage.take(spot, "among three", notches=0)
    part = stage.selection()
    stage.shortcut("mesh.partwheel_similar")
    yield from stage.until("those of the copy are selected", lambda: selected(copy))

    pick = stage.part("parts.picks").get_pick(stage.snapshot(obj))
    similar = stage.part("related.similar_parts").find_similar(stage.snapshot(obj), pick.hierarchy, pick.node,
                                                                      [stage.snapshot(copy)])
    threshold = stage.package("likeness").THRESHOLD

    def wanted(item, count):
        """The faces of an object that are selected with so many parts that are alike."""
        nodes = [pick.node] * (item == obj) + [other.node for other in similar[:count] if other.name == item.name_full]
        return frozenset(face for node in nodes for face in pick.hierarchy.faces(node).tolist())

    count = sum(other.likeness >= threshold for other in similar)
    stage.check({other.name for other in similar[:count]} == {obj.name_full, copy.name_full}, "both have some")
    for notches in (0, -1, 1):
        if notches:
            stage.mouse.wheel(notches)
            count += notches
            yield from stage.settle()
        for target in (obj, copy):
            stage.check(selected(target) == wanted(target, count), f"{target.name} after {notches} notches: as they are alike")
    stage.check(not selected(cube), "nothing of the cube")
    with stage.override():
        bpy.ops.view3d.view_all()
    yield from stage.screenshot("alike")
    stage.mouse.key("ESC")
    yield from stage.selected(part, "after Esc")
    stage.check(not selected(copy), "nothing of the copy after Esc")
    stage.check("Not searched, since they have no parts yet: Cube" in stage.reports(), "it says where no parts are known")


def beside_others(stage):
    """(the model, its copy, a cube), all in Edit Mode."""
    obj = stage.object
    aside = obj.matrix_world.to_3x3() @ Vector((1, 0, 0)) * obj.dimensions.x / obj.scale.x * 1.2
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.mesh.primitive_cube_add(size=0.3, location=obj.location + 2 * aside)
    cube, copy = stage.object, obj.copy()
    copy.data = obj.data.copy()
    copy.location = obj.location + aside
    stage.window.scene.collection.objects.link(copy)
    stage.window.view_layer.objects.active = obj
    for target in (obj, copy, cube):
        target.select_set(True)
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="DESELECT")
    return obj, copy, cube


def selected(obj):
    return frozenset(face.index for face in bmesh.from_edit_mesh(obj.data).faces if face.select)
