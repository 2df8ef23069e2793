"""Copy, Remove and Split find the parts first where there are none: beside Blender's own work, with the progress and Esc,
and go on then with the part that is selected. Workers are held until what comes between has happened."""
import bmesh
import bpy
import numpy


def play(stage):
    gate = stage.hold_workers()
    yield from stage.open("homer", build=False)
    _, _, face = stage.spot(0.5, 0.9)
    stops, start = stage.wheels.stops(face)
    part = stops[start]
    stage.select(sorted(part))
    before = places(stage.object.data, part)
    stage.mouse.move(*stage.empty_spot())
    stage.check(stage.registry.find_hierarchy(stage.object.data) is None, "there are no parts")

    stage.shortcut("mesh.partwheel_copy")
    yield from stage.until("a build has begun", stage.has_builds)
    yield from stage.screenshot("0-building")
    status = stage.part("view.status").StatusLine.stack[-1]._content
    stage.check("finds the parts of homer" in status and "Esc" in status, f"the status bar says so ({status})")
    stage.mouse.key("ESC")
    yield from stage.until("Esc ends it", lambda: not stage.has_builds())
    yield from stage.selected(part, "after Esc")
    stage.check(len(bpy.data.objects) == 1 and stage.object.mode == "EDIT", "and all is as it was")

    stage.shortcut("mesh.partwheel_copy")
    yield from stage.until("a build has begun again", stage.has_builds)
    view = stage.view_state()
    stage.mouse.key("NUMPAD_3")
    yield from stage.until("the view turns meanwhile", lambda: stage.view_state() != view)
    stage.check(len(bpy.data.objects) == 1, "nothing is copied yet")
    gate.open()
    yield from stage.until("there is a copy", lambda: len(bpy.data.objects) == 2)
    copy = stage.object
    stage.check(closed(copy.data), "which is closed")
    stage.check(len(before & places(copy.data)) > 0.8 * len(part), "and has the faces that were selected")
    yield from stage.screenshot("1-copied")
    bpy.data.objects.remove(copy)

    gate.close()
    yield from again(stage, part)
    stage.shortcut("mesh.partwheel_remove")
    yield from stage.until("a build has begun for Remove", stage.has_builds)
    stage.check(stage.object.data.total_face_sel == len(part), "nothing is removed yet")
    gate.open()
    left = len(stage.wheels.triangles) - len(part)
    yield from stage.until("the part is gone", lambda: stage.object.mode == "EDIT" and not stage.has_builds()
                           and len(bmesh.from_edit_mesh(stage.object.data).faces) < left + 0.5 * len(part))
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    stage.check(closed(stage.object.data), "and the hole is closed")
    yield from stage.screenshot("2-removed")

    gate.close()
    yield from again(stage, ())
    with stage.override():
        bpy.ops.mesh.partwheel_split("INVOKE_DEFAULT", True, parts=4)
    yield from stage.until("a build has begun for Split", stage.has_builds)
    stage.check(len(bpy.data.objects) == 1, "nothing is split yet")
    gate.open()
    yield from stage.until("there are four parts", lambda: len(bpy.data.objects) == 5)
    stage.check(all(closed(obj.data) for obj in bpy.data.objects if obj.visible_get()), "all closed")
    yield from stage.screenshot("3-split")


def again(stage, part):
    """The model anew, without parts, with these faces selected."""
    yield from stage.open("homer", build=False)
    stage.select(sorted(part))
    stage.mouse.move(*stage.empty_spot())


def places(mesh, faces=None):
    """{the middle of each face}; of a mesh in Object Mode, or of these faces."""
    polygons = mesh.polygons if faces is None else [mesh.polygons[face] for face in faces]
    return {tuple(numpy.round(polygon.center, 4)) for polygon in polygons}


def closed(mesh):
    """Whether each edge has two faces."""
    bm = bmesh.new()
    bm.from_mesh(mesh)
    is_closed = all(len(edge.link_faces) == 2 for edge in bm.edges)
    bm.free()
    return is_closed
