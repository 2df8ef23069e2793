"""What the scenarios that model with parts share."""
import sys

import bpy
import numpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from view import View


def module(name):
    """A module of the installed add-on."""
    package = bpy.types.VIEW3D_PT_partwheel.__module__.rpartition(".ui.")[0]
    return sys.modules[f"{package}.{name}"]


def volume(obj):
    """In the world; in Edit Mode as before it was entered."""
    bpy.context.view_layer.update()  # Blender 5 forgets matrices at undo until it draws
    obj.data.calc_loop_triangles()
    matrix = numpy.array(obj.matrix_world)
    places = numpy.array([vertex.co for vertex in obj.data.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]
    corners = places[numpy.array([triangle.vertices for triangle in obj.data.loop_triangles])]
    return numpy.einsum("ij,ij->i", corners[:, 0], numpy.cross(corners[:, 1], corners[:, 2])).sum() / 6


def closed(obj):
    """Whether each directed edge of the mesh has exactly one face, and its opposite one."""
    directed = [pair for polygon in obj.data.polygons
                for pair in zip(polygon.vertices, [*polygon.vertices[1:], polygon.vertices[0]])]
    return len(directed) == len(set(directed)) and set(directed) == {(b, a) for a, b in directed}


def places(obj):
    """Of its mesh's vertices, as bytes."""
    return numpy.array([vertex.co for vertex in obj.data.vertices]).tobytes()


def caps(obj):
    """(F,) which faces are caps."""
    marks = numpy.empty(len(obj.data.polygons), bool)
    obj.data.attributes["partwheel_cap"].data.foreach_get("value", marks)
    return marks


def activate(stage, *objects):
    """Selects these, the first active."""
    for other in stage.window.view_layer.objects:
        other.select_set(other in objects)
    stage.window.view_layer.objects.active = objects[0]
    with stage.override():
        bpy.ops.ed.undo_push(message="Test selection")


def enter(stage, obj):
    """Edit Mode of an object, by Tab."""
    activate(stage, obj)
    stage.mouse.key("TAB")
    yield from stage.until("Edit Mode", lambda: obj.mode == "EDIT")


def seen(stage, obj):
    """The View of an object as its mesh now is."""
    obj.data.calc_loop_triangles()
    return View(stage.area, obj, numpy.array([vertex.co for vertex in obj.data.vertices]),
                numpy.array([triangle.vertices for triangle in obj.data.loop_triangles]))


def pixel(stage, place):
    """Where a point of the world is in the window."""
    region = next(region for region in stage.area.regions if region.type == "WINDOW")
    x, y = location_3d_to_region_2d(region, stage.view_3d, place)
    return int(x + region.x), int(y + region.y)


def choose(stage, menu, up):
    """Takes an entry of a menu, counted from its last, with the mouse beside the models."""
    stage.mouse.move(*stage.empty_spot())
    yield from stage.settle()
    with stage.override():
        bpy.ops.wm.call_menu(name=menu)
    yield from stage.settle()
    stage.mouse.key("END")
    for _ in range(up):
        stage.mouse.key("UP_ARROW")
    yield from stage.settle()
    stage.mouse.key("RET")
    yield from stage.settle()


def place_over(stage, part, target, fit=False, mirror=False):
    """Places the part over the target's border with the mouse."""
    loop = module("compose.placement").find_cap_loop(target)
    start = part.matrix_world.copy()
    before = places(target), target.matrix_world.copy()
    activate(stage, part)
    yield from choose(stage, "VIEW3D_MT_object", 1)
    x, y, _ = seen(stage, target).spot(*pixel(stage, loop.center))
    stage.mouse.move(x - 3, y)
    stage.mouse.move(x, y)
    yield from stage.until("the part follows the mouse", lambda: part.matrix_world != start)
    stage.mouse.wheel(2)
    stage.mouse.wheel(-1, shift=True)
    yield from stage.settle()
    stage.mouse.key("ESC")
    yield from stage.until("Esc puts it back", lambda: part.matrix_world == start)

    stage.mouse.move(x - 3, y)
    with stage.override():
        bpy.ops.object.partwheel_place("INVOKE_DEFAULT")
    stage.mouse.move(x, y)
    yield from stage.until("the part follows the mouse", lambda: part.matrix_world != start)
    if fit:
        stage.mouse.key("F")
        yield from stage.settle()
        fitted = module("compose.placement").find_cap_loop(part)
        stage.check(abs(fitted.radius / loop.radius - 1) < 0.01, "it has the border's size")
        stage.check(numpy.linalg.norm(fitted.center - loop.center) < 0.1 * loop.radius, "it is at the border")
    if mirror:
        stage.mouse.key("M")
    yield from stage.settle()
    stage.check((places(target), target.matrix_world) == before, "the target is as it was")
    stage.mouse.key("RET")
    yield from stage.settle()
    last = bpy.data.window_managers[0].operators[-1]
    stage.check(last.bl_idname == "OBJECT_OT_partwheel_place", "placing is the last operation")


def unite(stage, target, *parts):
    before = len(bpy.data.objects)
    activate(stage, target, *parts)
    yield from choose(stage, "VIEW3D_MT_object", 0)
    yield from stage.until("the parts are gone", lambda: len(bpy.data.objects) == before - len(parts))
    stage.check(closed(target), "the union is closed")
    yield from stage.until("its parts are found beside that",
                           lambda: stage.registry.get_state(target.data)[0] == stage.registry.State.FITS)
    last = bpy.data.window_managers[0].operators[-1]
    stage.check(last.bl_idname == "OBJECT_OT_partwheel_unite", "uniting is the last operation, with its panel")


def picked_up_to(stage, x, y, share):
    """Starts the tool by its key at a share of the active object's extent on the screen, whatever its mesh is now, and
    turns the wheel until the part has this share of the faces."""
    mesh, view = stage.object.data, seen(stage, stage.object)
    centers = view.centers()
    low, high = centers.min(axis=0), centers.max(axis=0)
    px, py, _ = view.spot(*(low + (high - low) * [x, y]))
    stage.mouse.move(px, py)
    stage.shortcut("mesh.partwheel_select")
    yield from stage.until("a part is picked", lambda: stage.selection())  # its parts may have to be found first
    while len(stage.selection()) < share * len(mesh.polygons):
        before = len(stage.selection())
        stage.mouse.wheel(1)
        yield from stage.until("a notch takes more", lambda before=before: len(stage.selection()) > before)
