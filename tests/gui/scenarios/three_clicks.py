"""A fused, textured figure taken apart in three clicks: on the figure, on the panel's button, beside the figure. Before
them nothing is known of its parts; after them there are named, closed, textured objects. The log has the time."""
import time

import bpy
import numpy

BUTTON = 45  # pixels from the sidebar's top to the middle of the button "Parts to..."


def play(stage):
    yield from stage.open("figure", build=False)
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    figure = stage.object
    example = stage.part("ui.tour").create_object(stage.package("examples").figure(), "figure")
    figure.data = example.data
    bpy.data.objects.remove(example)
    material, = figure.data.materials
    image = next(node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE")
    uvs = known(figure)
    shading = stage.area.spaces.active.shading
    shading.color_type = "TEXTURE"
    yield from opened_panel(stage)
    x, y, _ = stage.spot(0.5, 0.5)
    empty = stage.empty_spot()
    sidebar = next(region for region in stage.area.regions if region.type == "UI")
    with stage.override():
        bpy.ops.object.select_all(action="DESELECT")
    stage.check(stage.registry.find_hierarchy(figure.data) is None, "no parts are known")
    shown, end_recording = stage.record_cuts()
    yield from stage.screenshot("1-fused")

    def click(x, y):
        stage.mouse.move(x, y)
        yield from stage.settle()
        stage.mouse.click()

    start_time = time.monotonic()
    yield from click(x, y)
    yield from stage.until("the figure is selected", lambda: figure.select_get())
    yield from click(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - BUTTON)
    yield from stage.until("its parts are shown", lambda: shown)
    seen_time = time.monotonic()
    yield from stage.screenshot("2-parts")
    pictured = time.monotonic() - seen_time
    yield from click(*empty)
    yield from stage.until("there are objects", lambda: len(bpy.data.objects) == 1 + len(shown[-1].cut))
    print(f"three clicks: {time.monotonic() - start_time - pictured:.1f} s, of which {seen_time - start_time:.1f} s until the parts are "
          f"shown; {len(shown[-1].cut)} objects", flush=True)
    yield from stage.settle()

    parts = [obj for obj in bpy.data.objects if obj != figure]
    stage.check(figure.hide_get() and all(obj.select_get() for obj in parts), "in the figure's place")
    stage.check(all(obj.name.startswith("Part ") for obj in parts), "named")
    for obj in parts:
        mesh = obj.data
        sides = [side for polygon in mesh.polygons
                 for side in zip(polygon.vertices, [*polygon.vertices[1:], polygon.vertices[0]])]
        stage.check(len(sides) == len({*sides}) and {*sides} == {side[::-1] for side in sides}, f"{obj.name} is closed")
        caps = numpy.empty(len(mesh.polygons), bool)
        mesh.attributes["partwheel_cap"].data.foreach_get("value", caps)
        stage.check(caps.any() and [slot.material for slot in obj.material_slots] == [material],
                    f"{obj.name} has caps and the material")
        outer_corners = [place for polygon, cap in zip(mesh.polygons, caps) if not cap for place in corners(mesh, polygon)]
        stage.check(numpy.mean([place in uvs for place in outer_corners]) > 0.9, f"{obj.name} has the figure's UVs")
    stage.check(image.has_data, "and its texture")
    yield from stage.screenshot("3-objects")
    last = bpy.data.window_managers[0].operators[-1]
    last.properties.explode = 0.2
    with stage.override():
        bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)
    yield from stage.until("they are moved apart", lambda: any(obj.delta_location.length > 0.01
                                                               for obj in bpy.data.objects))
    yield from stage.screenshot("4-apart")
    end_recording()


def opened_panel(stage):
    """The sidebar with our tab."""
    pictures = []
    panel = bpy.types.VIEW3D_PT_partwheel
    draw = panel.draw

    def recorded(self, context):
        draw(self, context)
        pictures.append(True)

    panel.draw = recorded
    yield from stage.sidebar()
    yield from stage.until("the panel is drawn", lambda: pictures)
    panel.draw = draw
    yield from stage.wait_for_redraw()


def corners(mesh, polygon):
    """(place, UV) of each of its corners, rounded."""
    layer = mesh.uv_layers.active.data
    return [tuple(round(value, 4) for value in layer[loop].uv) for loop in polygon.loop_indices]


def known(obj):
    return {place for polygon in obj.data.polygons for place in corners(obj.data, polygon)}

