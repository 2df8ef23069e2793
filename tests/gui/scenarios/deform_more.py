"""The handle's gizmo, a handle put elsewhere by a click, and X mirror: by the mouse, on a ball with two horns."""
import bpy
import numpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

from scenarios.deform import confirmed


def pixel(stage, point):
    """Of the window, for a point of the object's."""
    place = location_3d_to_region_2d(stage.view.region, stage.view_3d, stage.object.matrix_world @ Vector(point))
    return round(place.x + stage.view.region.x), round(place.y + stage.view.region.y)


def deforming(stage, before):
    """Picks a horn by a script, starts Deform, and waits for it: what may move."""
    obj = stage.object
    horn = max(obj.data.polygons, key=lambda face: face.center.x).index
    hierarchy = stage.registry.get_hierarchy(stage.snapshot(obj))
    stops, start = hierarchy.wheel(horn)

    def vertices(stop):
        return sorted({vertex for face in hierarchy.faces(int(stop)) for vertex in obj.data.polygons[face].vertices})

    level = max(level for level, stop in enumerate(stops) if (before[vertices(stop)][:, 0] > 0.5).all())
    with stage.override():
        bpy.ops.mesh.partwheel_select(face_index=horn, level=level - start)
        bpy.ops.mesh.partwheel_deform("INVOKE_DEFAULT")
    yield from stage.wait_for_redraw()
    stage.check(stage.part("parts.picks").get_pick(stage.snapshot(obj)).node == stops[level], "the largest part of one horn is picked")
    return vertices(stops[level])


def play(stage):
    yield from stage.open("hand", build=False)  # for the view; then a ball with two horns takes its place
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.objects.remove(stage.object)
        bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24)
        for vertex in stage.object.data.vertices:
            x, y, z = vertex.co
            if abs(x) > 0.9:
                vertex.co.x = numpy.copysign(0.9 + 14 * (abs(x) - 0.9), x)
        stage.object.data.use_mirror_x = True
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.partwheel_build()
        bpy.ops.ed.undo_push(message="A ball with horns")  # scripts make none
    stage.view_3d.view_rotation = (0.7071, 0.7071, 0, 0)
    stage.view_3d.view_location = (0, 0, 0)
    stage.view_3d.view_distance = 9
    yield from stage.wait_for_redraw()
    before = stage.coordinates()
    inside = yield from deforming(stage, before)
    free = numpy.array(inside)

    # A click elsewhere puts the handle there and moves nothing; the gizmo's blue arrow then moves it along Z alone.
    target = free[numpy.abs(before[free] - [1.6, -0.2, 0]).sum(axis=1).argmin()]
    stage.mouse.move(*pixel(stage, before[target]))
    stage.mouse.click()
    yield from stage.settle()
    stage.check((stage.coordinates() == before).all(), "a click moves nothing")
    yield from stage.screenshot("gizmo")
    x, y = pixel(stage, before[target])
    stage.mouse.move(x, y + 80)
    yield from stage.drag("LEFTMOUSE", 0, 60)
    yield from stage.until("the arrow moves it", lambda: (stage.coordinates() != before).any())
    yield from stage.screenshot("mirrored")
    yield from confirmed(stage)
    after = stage.coordinates()
    shift = after - before
    moved = numpy.flatnonzero((shift != 0).any(axis=1))
    farthest = shift[numpy.linalg.norm(shift, axis=1).argmax()]
    stage.check(farthest[2] > 0.2 and abs(farthest[1]) < 0.05, f"along Z ({farthest})")

    # What one side did the other did, mirrored.
    image = [numpy.abs(before - before[vertex] * [-1, 1, 1]).sum(axis=1).argmin() for vertex in moved]
    off = numpy.abs(shift[image] - shift[moved] * [-1, 1, 1]).max()
    stage.check(off < 1e-4, f"both sides moved alike ({off})")
    stage.check((before[moved][:, 0] > 0).sum() == (before[moved][:, 0] < 0).sum() > 5, "as many on either side")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one Ctrl Z takes all of it back", lambda: (stage.coordinates() == before).all())
