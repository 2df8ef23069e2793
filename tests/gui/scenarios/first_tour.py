"""The two-minute tour as a new user takes it: the panel's button opens three models in a scene of their own, the panel says
what to do with the active one, and each step does it. The user's own scene stays as it is."""
import bpy
import numpy
from compose import pixel
from mathutils import Vector
from scenarios.modes import hover

TOUR_BUTTON = 133  # pixels from the sidebar's top to the middle of the button, below the panel without an active mesh
PLACES = {"Figure": Vector((0.42, -0.06, 1.16)), "Truck": Vector((2.62, -1.0, 0.35))}  # on an arm, on a wheel


def play(stage):
    yield from own_work(stage)
    own = stage.window.scene.name
    before, view = content(own), viewed(stage)
    yield from stage.sidebar()
    yield from stage.settle()
    sidebar = next(region for region in stage.area.regions if region.type == "UI")
    yield from stage.screenshot("0-panel")
    stage.mouse.move(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - TOUR_BUTTON)
    yield from stage.settle()
    stage.mouse.click()
    yield from stage.until("the tour is open", lambda: stage.window.scene.name != own)
    yield from stage.wait_for_redraw()
    names = {obj.name for obj in stage.window.scene.objects}
    stage.check(names == {"Figure", "Truck", "Chair"}, f"three models ({names})")
    stage.check(stage.object.name == "Figure", "the first is active")
    yield from parts_found(stage)
    yield from stage.screenshot("1-opened")
    yield from figure(stage)
    yield from truck(stage)
    yield from chair(stage)
    with stage.override():
        bpy.ops.wm.partwheel_tour_back()
    yield from stage.settle()
    stage.check(stage.window.scene.name == own, "back in the user's scene")
    stage.check(content(own) == before and viewed(stage) == view, "which is as it was, seen from where it was")
    with stage.override():
        bpy.ops.wm.partwheel_tour()
    yield from stage.settle()
    stage.check(len(bpy.data.scenes) == 2 and stage.window.scene.name != own, "the second time opens the same scene")


def viewed(stage):
    view = stage.view_3d
    return (stage.area.spaces.active.shading.color_type, view.view_perspective, view.view_distance, *view.view_rotation, *view.view_location)


def content(scene):
    return [(obj.name, obj.data.name, tuple(obj.location)) for obj in bpy.data.scenes[scene].objects]


def own_work(stage):
    """Something that is not saved, and nothing active."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    with stage.override():
        bpy.ops.object.light_add(location=(1, 2, 3))
        bpy.ops.ed.undo_push(message="Own work")
        stage.window.view_layer.objects.active = None
    yield from stage.wait_for_redraw()


def parts_found(stage):
    yield from stage.until("its parts are found", lambda: stage.registry.find_hierarchy(stage.object.data))


def chosen(stage, name):
    """The button of a model in the panel."""
    with stage.override():
        bpy.ops.wm.partwheel_tour("INVOKE_DEFAULT", model=name)
    yield from stage.settle()
    stage.check(stage.object.name == name and stage.object.select_get(), f"the {name} is active")


def picked(stage, name):
    """Hover and a click with the tool on a model: its part of the click."""
    display = stage.part("pick.display").pick_display
    hovering = stage.part("pick.hover").hover
    yield from hover(stage, *pixel(stage, PLACES[name]))
    yield from stage.until(f"hover shows a part of the {name}", lambda: hovering.target and hovering.target[0] == name)
    yield from stage.screenshot(f"2-{name.lower()}-hover")
    stage.mouse.click()
    yield from stage.until("a click picks it", lambda: display.is_shown and display._target[0] == name)


def figure(stage):
    yield from picked(stage, "Figure")
    first = stage.overlay_faces()
    stage.mouse.wheel(1)
    yield from stage.until("the wheel takes more", lambda: first < stage.overlay_faces())
    yield from stage.screenshot("3-figure-wheel")
    stage.mouse.key("ESC")
    yield from stage.settle()
    yield from objects(stage, "Figure")
    yield from stage.adjusted(explode=0.4)
    yield from stage.screenshot("4-figure-apart")
    parts = [obj for obj in stage.window.scene.objects if obj.name not in {"Figure", "Truck", "Chair"}]
    stage.check(len(parts) > 5 and all("partwheel_cap" in obj.data.attributes and obj.data.uv_layers for obj in parts),
                f"closed, textured objects ({[obj.name for obj in parts]})")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step", lambda: len(stage.window.scene.objects) == 3)


def objects(stage, name):
    """Parts to... and Enter."""
    states, end_recording = stage.record_cuts()
    with stage.override():
        bpy.ops.mesh.partwheel_parts("INVOKE_DEFAULT")
    yield from stage.until("its parts are shown", lambda: states)
    yield from stage.wait_for_redraw()
    yield from stage.screenshot(f"3-{name.lower()}-parts")
    stage.mouse.key("RET")
    count = len(states[-1].cut)
    yield from stage.until("there are objects", lambda: len(stage.window.scene.objects) == 3 + count)
    yield from stage.settle()
    end_recording()


def truck(stage):
    yield from chosen(stage, "Truck")
    yield from parts_found(stage)
    yield from picked(stage, "Truck")
    shell = stage.overlay_faces()
    mesh = bpy.data.objects["Truck"].data
    sides = [side for face in shell for side in mesh.polygons[face].edge_keys]
    stage.check(len(shell) > 5 and len(sides) == 2 * len({*sides}), "all of a shell")
    yield from stage.screenshot("5-truck")
    stage.mouse.wheel(1)
    yield from stage.until("the wheel adds others", lambda: shell < stage.overlay_faces())
    stage.mouse.key("ESC")
    yield from stage.settle()


def chair(stage):
    yield from chosen(stage, "Chair")
    with stage.override():
        bpy.ops.mesh.partwheel_convex()
    yield from stage.settle()
    hulls = bpy.data.objects["Chair"].children
    stage.check(len(hulls) > 5, f"hulls ({len(hulls)})")
    places = numpy.array([hull.matrix_world @ vertex.co for hull in hulls for vertex in hull.data.vertices])
    stage.check(numpy.ptp(places[:, 2]) > 1.79, "around all of it")
    yield from stage.screenshot("6-chair")
