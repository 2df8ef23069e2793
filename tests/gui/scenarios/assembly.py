"""A knight of fifteen objects with an armature, imported from a file: a click on the head, and the wheel goes on to what
touches it and to the whole knight, and back. Enter selects those objects, one undo step; Esc selects nothing; Shift adds.
In Edit Mode of all of them, the wheel selects all faces of the same objects."""
import pathlib
import types

import bmesh
import bpy
import numpy
from mathutils import Matrix, Quaternion
from scenarios.modes import hover
from view import View

KNIGHT = pathlib.Path(__file__).resolve().parents[4] / "shared" / "assets" / "files" / "Knight.glb"
HEAD, OTHER = "Knight_Head", "Other"


def play(stage):
    if not KNIGHT.exists():
        stage.skipped = f"{KNIGHT} is not there"
        return
    yield from import_knight(stage)
    yield from in_object_mode(stage)
    yield from in_edit_mode(stage)


def import_knight(stage):
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    vars(numpy).setdefault("bool", bool)  # for Debian's importer, which is older than its numpy
    with stage.override():
        bpy.ops.import_scene.gltf(filepath=str(KNIGHT))
        bpy.ops.mesh.primitive_cube_add(size=0.5, location=(5, 0, 0))
        stage.object.name = OTHER
        stage.window.scene.collection.objects.link(stage.object)
        bpy.data.collections["Collection"].objects.unlink(stage.object)
    select(stage, {OTHER}, OTHER)
    stage.view_3d.view_rotation = Quaternion((0.7071, 0.7071, 0, 0))
    stage.view_3d.view_location, stage.view_3d.view_distance = (0, 0, 1.2), 6
    yield from stage.wait_for_redraw()


def knight():
    return frozenset(each.name for each in bpy.data.objects["Rig"].children_recursive if each.type == "MESH")


def select(stage, names, active):
    with stage.override():
        for each in stage.window.view_layer.objects:
            each.select_set(each.name in names)
        stage.window.view_layer.objects.active = bpy.data.objects[active]
        bpy.ops.ed.undo_push(message="Test selection")


def selected():
    return frozenset(each.name for each in bpy.context.view_layer.objects if each.select_get())


def spot_on(stage, name):
    """(x, y) of a pixel that shows the object, which others cover in part."""
    corners, owners = [], []
    depsgraph = stage.window.view_layer.depsgraph
    for each in (each for each in bpy.data.objects if each.type == "MESH" and each.visible_get()):
        mesh = each.evaluated_get(depsgraph).to_mesh()
        mesh.calc_loop_triangles()
        places = numpy.array([each.matrix_world @ vertex.co for vertex in mesh.vertices])
        corners += [places[list(triangle.vertices)] for triangle in mesh.loop_triangles]
        owners += [each.name] * len(mesh.loop_triangles)
    view = View(stage.area, types.SimpleNamespace(matrix_world=Matrix()), numpy.concatenate(corners),
                numpy.arange(3 * len(corners)).reshape(-1, 3))
    centers = view.centers()[[owner == name for owner in owners]]
    return view.spot(*centers.mean(axis=0), lambda face: owners[face] == name)[:2]


def in_object_mode(stage):
    x, y = spot_on(stage, HEAD)
    display, hovering = stage.part("pick.display").pick_display, stage.part("pick.hover").hover

    def shown():
        """The names of the objects that are highlighted, and of those that the next notch adds too."""
        picked, name = display._picked, display._target[0]
        return picked.group | {name}, picked.group | picked.next_group | {name}

    def click(**held):
        yield from hover(stage, x, y)
        yield from stage.until("hover shows a part of the head", lambda: hovering.target and hovering.target[0] == HEAD)
        stage.mouse.click(**held)
        yield from stage.until("a part of the head is picked", lambda: display.is_shown and display._target[0] == HEAD)
        stage.check(shown()[0] == {HEAD}, "first the head alone")

    def turn_to_whole():
        """The sets that the notches show; the last is the knight."""
        seen = [shown()]
        while seen[-1][0] != knight():
            stage.mouse.wheel(1)
            yield from stage.settle()
            seen.append(shown())
            stage.check(len(seen) < 60, "the wheel ends at the knight")
            stage.check(seen[-2][0] <= seen[-1][0] and seen[-2][1] <= seen[-1][1], "each notch adds")
            stage.check(seen[-1][0] in ({HEAD}, seen[-2][1]), "what the notch before had announced")
        return seen

    with stage.override():
        stage.window.view_layer.objects.active = bpy.data.objects[HEAD]
        bpy.ops.mesh.partwheel_build()
    select(stage, {OTHER}, OTHER)
    stage.use_tool()
    yield from click()
    seen = yield from turn_to_whole()
    yield from stage.screenshot("0-knight")
    groups = sorted({names for names, _ in seen}, key=len)
    stage.check(len(knight()) == 15 and len(groups) >= 3 and groups[0] == {HEAD}, f"head, groups, knight ({groups})")
    stage.check({"Knight_Body", "Knight_Helmet"} < groups[1] < knight() - {"Knight_LegLeft", "Knight_LegRight"},
                f"first what touches the head ({groups[1]})")
    stage.mouse.wheel(1)
    yield from stage.settle()
    stage.check(shown() == (knight(), knight()), "one notch more changes nothing")
    yield from follows_the_pose(stage, display)
    for names, larger in seen[-2::-1]:
        stage.mouse.wheel(-1)
        yield from stage.settle()
        stage.check(shown() == (names, larger), f"back to {len(names)} objects")
        if names == groups[1]:
            yield from stage.screenshot("1-touching")
    stage.check(selected() == {OTHER} and stage.object.name == OTHER, "nothing is selected meanwhile")
    yield from turn_to_whole()
    stage.mouse.key("ESC")
    yield from stage.until("Esc ends it", lambda: not display.is_shown)
    stage.check(selected() == {OTHER} and stage.object.name == OTHER, "Esc selects nothing")

    yield from click()
    yield from turn_to_whole()
    stage.mouse.key("RET")
    yield from stage.until("Enter selects the knight", lambda: selected() == knight())
    stage.check(stage.object.name == HEAD, "with the head active")
    yield from stage.screenshot("2-selected")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one Ctrl Z restores", lambda: selected() == {OTHER})
    stage.check(stage.object.name == OTHER, "and the active object")
    yield from click(shift=True)
    yield from turn_to_whole()
    stage.mouse.wheel(-1)
    yield from stage.settle()
    group = shown()[0]
    stage.mouse.key("RET")
    yield from stage.until("Shift adds", lambda: selected() == group | {OTHER})
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("which is one step, too", lambda: selected() == {OTHER})


def follows_the_pose(stage, display):
    """The highlight of an object stays on its surface when its armature moves."""
    arm = bpy.data.objects["Knight_ArmRight"]
    bone = bpy.data.objects["Rig"].pose.bones[arm.vertex_groups[0].name]

    def displayed():
        mesh = arm.evaluated_get(stage.window.view_layer.depsgraph).data
        return numpy.array([vertex.co for vertex in mesh.vertices])

    def highlighted():
        return display._triangles[arm.name].positions

    initial, at_rest = displayed(), bone.matrix_basis.copy()
    for pose, moved in ((Matrix.Rotation(1, 4, "X") @ at_rest, True), (at_rest, False)):
        bone.matrix_basis = pose
        yield from stage.wait_for_redraw()
        stage.mouse.move(stage.mouse.x, stage.mouse.y + (1 if moved else -1))
        yield from stage.until("the highlight follows the pose", lambda: numpy.allclose(highlighted(), displayed()))
        stage.check(moved != numpy.allclose(displayed(), initial, atol=1e-5), "the arm has moved, or is back")


def in_edit_mode(stage):
    entered = knight() - {"Knight_Cape"}
    select(stage, entered | {OTHER}, HEAD)
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")
        stage.window.scene.tool_settings.mesh_select_mode = (False, False, True)
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.ed.undo_push(message="Edit Mode")
    stage.use_tool()
    x, y = spot_on(stage, HEAD)

    def chosen():
        """name -> number of selected faces, where there are any."""
        counts = {name: sum(face.select for face in bmesh.from_edit_mesh(bpy.data.objects[name].data).faces)
                  for name in entered | {OTHER}}
        return {name: count for name, count in counts.items() if count}

    def all_of(names):
        return {name: len(bpy.data.objects[name].data.polygons) for name in names}

    def click_and_turn():
        yield from hover(stage, x, y)
        yield from stage.settle()
        stage.mouse.click()
        yield from stage.until("a part of the head is selected", lambda: chosen().keys() == {HEAD})
        seen = [chosen()]
        while seen[-1] != all_of(entered):
            stage.mouse.wheel(1)
            yield from stage.settle()
            seen.append(chosen())
            stage.check(len(seen) < 60, "the wheel ends at the knight")
            stage.check(seen[-1].keys() == {HEAD} or seen[-1] == all_of(seen[-1]), "only whole objects")
            stage.check(all(seen[-1][name] >= count for name, count in seen[-2].items()) and seen[-1] != seen[-2],
                        "each notch adds")
        return seen

    seen = yield from click_and_turn()
    yield from stage.screenshot("3-edit-mode")
    stage.check({"Knight_Body", "Knight_Helmet"} < next(each for each in seen if len(each) > 1).keys(),
                "first what touches the head")
    for before in seen[-2::-1]:
        stage.mouse.wheel(-1)
        yield from stage.settle()
        stage.check(chosen() == before, f"back to {len(before)} objects")
    stage.mouse.key("ESC")
    yield from stage.until("Esc restores", lambda: chosen() == {})
    yield from click_and_turn()
    stage.mouse.key("RET")
    yield from stage.settle()
    stage.check(chosen() == all_of(entered) and stage.object.name == HEAD, "Enter keeps it")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one Ctrl Z", lambda: chosen() == {})
