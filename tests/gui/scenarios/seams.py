"""Parts as seams, in Edit Mode: marked, unwrapped, and seen in the UV editor; one undo step takes it back."""
import bmesh
import bpy


def play(stage):
    yield from stage.open("figure", mode="EDGE")
    x, y, _ = stage.spot(0.5, 0.5)
    with stage.override():
        bpy.ops.ed.undo_push(message="Begin")
    yield from stage.parts_to(x, y, "G", "U", "RET")  # no groups, seams
    yield from stage.until("it is unwrapped", lambda: stage.object.mode == "EDIT" and stage.object.data.uv_layers)
    yield from stage.settle()
    stage.check(not stage.object.vertex_groups, "nothing else is made")
    marked = sum(edge.seam for edge in bmesh.from_edit_mesh(stage.object.data).edges)
    stage.check(0 < marked < len(stage.object.data.edges) / 5, f"some edges are seams ({marked})")
    with stage.override():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    editor = [area for area in stage.window.screen.areas if area.type == "VIEW_3D"][1]
    editor.ui_type = "UV"
    bpy.context.preferences.themes[0].image_editor.vertex_size = 1
    stage.view_3d.view_distance *= 0.75
    yield from stage.wait_for_redraw()
    with bpy.context.temp_override(window=stage.window, area=editor, region=editor.regions[-1]):
        settings = editor.spaces.active.uv_editor
        settings.show_stretch, settings.display_stretch_type, settings.uv_opacity = True, "AREA", 0.15
        stage.window.scene.tool_settings.use_uv_select_sync = True  # all islands, though nothing is selected
        bpy.ops.image.view_all(fit_view=True)
    yield from stage.screenshot("unwrapped")
    yield from grid(stage)
    with bpy.context.temp_override(window=stage.window, area=editor):
        bpy.ops.screen.area_close()
    yield from stage.wait_for_redraw()
    while stage.object.data.uv_layers:
        stage.mouse.key("Z", ctrl=True)
        yield from stage.settle()
    stage.check(not any(edge.use_seam for edge in stage.object.data.edges), "undone with the seams")
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")


def grid(stage):
    """A picture of the model with Blender's test grid on its UV map."""
    image = bpy.data.images.new("grid", 1024, 1024)
    image.generated_type = "COLOR_GRID"
    material = bpy.data.materials.new("grid")
    material.use_nodes = True
    material.node_tree.nodes.active = node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    shading = stage.area.spaces.active.shading
    color_type, shading.color_type = shading.color_type, "TEXTURE"
    stage.object.active_material = material
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    yield from stage.screenshot("grid")
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")
    shading.color_type, stage.object.active_material = color_type, None
