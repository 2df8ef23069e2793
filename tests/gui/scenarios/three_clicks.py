"""A fused, textured figure taken apart in three clicks: on the figure, on the panel's button, beside the figure. Before
them nothing is known of its parts; after them there are named, closed, textured objects. The log has the time."""
import time

import bpy
import numpy

BUTTON = 45  # pixels from the sidebar's top to the middle of the button "Parts to..."
SIZE = 1024  # pixels of the texture


def play(stage):
    yield from stage.open("homer", build=False)
    with stage.override():
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.uv.smart_project(island_margin=0.004)
        bpy.ops.object.mode_set(mode="OBJECT")
    homer = stage.object
    material, image = textured(homer)
    uvs = known(homer)
    shading = stage.area.spaces.active.shading
    shading.color_type = "TEXTURE"
    yield from opened_panel(stage)
    x, y, _ = stage.spot(0.5, 0.5)
    empty = stage.empty_spot()
    sidebar = next(region for region in stage.area.regions if region.type == "UI")
    with stage.override():
        bpy.ops.object.select_all(action="DESELECT")
    stage.check(stage.registry.find_hierarchy(homer.data) is None, "no parts are known")
    shown_times = []
    operator = stage.part("cut.parts_to").MESH_OT_partwheel_parts
    show = operator._set_state

    def noted(self, context, state):
        shown_times.append(len(state.cut))
        return show(self, context, state)

    operator._set_state = noted
    yield from stage.screenshot("1-fused")

    def click(x, y):
        stage.mouse.move(x, y)
        yield from stage.settle()
        stage.mouse.click()

    start_time = time.monotonic()
    yield from click(x, y)
    yield from stage.until("the figure is selected", lambda: homer.select_get())
    yield from click(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - BUTTON)
    yield from stage.until("its parts are shown", lambda: shown_times)
    seen_time = time.monotonic()
    yield from stage.screenshot("2-parts")
    pictured = time.monotonic() - seen_time
    yield from click(*empty)
    yield from stage.until("there are objects", lambda: len(bpy.data.objects) == 1 + shown_times[-1])
    print(f"three clicks: {time.monotonic() - start_time - pictured:.1f} s, of which {seen_time - start_time:.1f} s until the parts are "
          f"shown; {shown_times[-1]} objects", flush=True)
    yield from stage.settle()

    parts = [obj for obj in bpy.data.objects if obj != homer]
    stage.check(homer.hide_get() and all(obj.select_get() for obj in parts), "in the figure's place")
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
    operator._set_state = show


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


def textured(obj):
    """(material, image): painted by places, as he is known."""
    mesh = obj.data
    uv = numpy.empty(2 * len(mesh.loops), numpy.float32)
    mesh.uv_layers.active.data.foreach_get("uv", uv)
    uv = uv.reshape(-1, 3, 2) * SIZE
    places = numpy.array([vertex.co for vertex in mesh.vertices])
    places = (places - places.min(axis=0)) / numpy.ptp(places, axis=0)
    triangles = numpy.array([polygon.vertices for polygon in mesh.polygons])
    pixels = numpy.ones((SIZE, SIZE, 4), numpy.float32)
    for corners, triangle in zip(uv, places[triangles]):
        low = numpy.floor(corners.min(axis=0)).astype(int) - 1
        high = numpy.ceil(corners.max(axis=0)).astype(int) + 2
        grid = numpy.stack(numpy.meshgrid(*(numpy.arange(a, b) for a, b in zip(low, high))), axis=-1).reshape(-1, 2)
        sides = numpy.column_stack([corners[1] - corners[0], corners[2] - corners[0]])
        if abs(numpy.linalg.det(sides)) < 1e-6:
            continue
        shares = (grid + 0.5 - corners[0]) @ numpy.linalg.inv(sides).T
        near = (shares > -0.3).all(axis=1) & (shares.sum(axis=1) < 1.3)
        grid, shares = numpy.clip(grid[near], 0, SIZE - 1), shares[near]
        pixels[grid[:, 1], grid[:, 0], :3] = color(triangle[0] + shares @ (triangle[1:] - triangle[0]))
    image = bpy.data.images.new("figure", SIZE, SIZE)
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    material = bpy.data.materials.new("figure")
    material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    tree.links.new(node.outputs["Color"], next(shader_node for shader_node in tree.nodes if shader_node.type == "BSDF_PRINCIPLED").inputs[0])
    tree.nodes.active = node
    mesh.materials.append(material)
    return material, image


def color(place):
    """(n,3) of places 0..1 in the figure's box: trousers, a shirt with stripes, skin."""
    across, up = abs(place[:, 0] - 0.5), place[:, 1]
    skin, shirt, trousers, shoe = [(1, 0.82, 0.25)], [(0.95, 0.95, 0.97)], [(0.25, 0.4, 0.75)], [(0.35, 0.25, 0.2)]
    paint = numpy.repeat(skin, len(place), axis=0)
    body = (up < 0.66) & (across < 0.36)
    paint[body] = numpy.where((up[body] * 24 % 1 < 0.5)[:, None], shirt, [(0.75, 0.85, 0.95)])
    legs = up < 0.36
    paint[legs] = numpy.where((place[legs, 0] * 16 % 1 < 0.12)[:, None], [(0.2, 0.32, 0.62)], trousers)
    paint[up < 0.07] = shoe
    return paint
