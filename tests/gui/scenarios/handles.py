"""Handles have the size that is meant: drawn by the shaders that have one on every graphics system."""
import bpy
import gpu
import numpy
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_location_3d
from mathutils import Matrix, Vector
from view import picture


def play(stage):
    yield from stage.open("hand")
    gizmo = stage.part("deform.gizmo")
    region, view = stage.view.region, stage.view_3d
    middle = region.width // 2, region.height // 2
    place = region_2d_to_location_3d(region, view, middle, view.view_location)
    plain = picture((yield from stage.screenshot("0-plain")))
    names, builtin = [], gpu.shader.from_builtin

    def noted(name, *more, **options):
        shader = builtin(name, *more, **options)  # or it raises
        names.append(name)
        return shader

    gpu.shader.from_builtin = noted
    try:
        handle = numpy.array([place])
        changed = yield from drawn(stage, plain, "1-point", lambda: gizmo.draw_points(Matrix(), [handle]))
        rows, columns = numpy.nonzero(changed)
        for extent in (numpy.ptp(rows), numpy.ptp(columns)):
            stage.check(abs(extent + 1 - gizmo.POINT_SIZE) <= 1.5, f"a point of {gizmo.POINT_SIZE} is {extent + 1} pixels wide")
        center = Vector((columns.mean() - region.x, rows.mean() - region.y))
        stage.check((center - Vector(middle)).length < 2, f"it is where it is meant: {center}, not {middle}")
        shader_name = "POINT_UNIFORM_COLOR" if bpy.app.version >= (4, 5) else "UNIFORM_COLOR"
        stage.check(set(names) == {shader_name}, f"points are drawn by {names}")

        names.clear()
        changed = yield from drawn(stage, plain, "2-gizmo", lambda: gizmo.draw_gizmo(place, region, view))
        length = 0
        for _, _, line in gizmo._shapes(place, region, view):
            flat = [location_3d_to_region_2d(region, view, point) for point in line]
            length += sum((b - a).length for a, b in zip(flat, flat[1:]))
        width = changed.sum() / length
        stage.check(0.6 < width / gizmo.LINE_WIDTH < 1.6, f"lines of {gizmo.LINE_WIDTH} are {width:.1f} pixels wide")
        stage.check(set(names) == {"POLYLINE_UNIFORM_COLOR"}, f"lines are drawn by {names}")
    finally:
        gpu.shader.from_builtin = builtin


def drawn(stage, before, name, draw):
    """The pixels that this draws, as (height, width) of bool."""
    handler = bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW")
    try:
        stage.area.tag_redraw()
        after = picture((yield from stage.screenshot(name)))
    finally:
        bpy.types.SpaceView3D.draw_handler_remove(handler, "WINDOW")
    return numpy.abs(after - before).max(axis=2) > 0.04
