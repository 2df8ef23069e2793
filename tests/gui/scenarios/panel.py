"""The panel in the sidebar is drawn in both modes and in every state; its button starts the operator, a click picks. Without an
active mesh, as after importers that leave the armature active, it says what to do."""
import bmesh
import bpy

BUTTON = 45  # pixels from the sidebar's top to the middle of the button "Select Part by Wheel"


def play(stage):
    yield from stage.open("hand")
    draws = []
    panel = bpy.types.VIEW3D_PT_partwheel
    draw = panel.draw

    def recorded(self, context):
        draw(self, context)
        draws.append(context.mode)

    panel.draw = recorded
    sidebar = yield from stage.sidebar()
    yield from stage.until("the panel is drawn in Edit Mode", lambda: "EDIT_MESH" in draws)
    yield from stage.screenshot("edit")
    button = sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - BUTTON
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(*button)
    yield from stage.settle()
    stage.mouse.click()
    yield from stage.settle()
    stage.mouse.move(x, y)
    stage.mouse.click()
    yield from stage.selected(stops[start], "after the panel's button and a click")
    stage.mouse.wheel(1)
    yield from stage.selected(stops[start + 1], "after a notch up")
    stage.mouse.key("RET")
    yield from stage.ended()
    yield from stage.selected(stops[start + 1], "after Enter")

    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    yield from stage.until("the panel is drawn in Object Mode", lambda: "OBJECT" in draws)
    yield from stage.screenshot("object")

    other = bpy.data.objects.new("armature", bpy.data.armatures.new("armature"))
    stage.window.scene.collection.objects.link(other)
    model, stage.window.view_layer.objects.active = stage.object, other
    for without in (True, False):
        polls = [panel.poll(bpy.context) for panel in (bpy.types.VIEW3D_PT_partwheel_no_mesh, bpy.types.VIEW3D_PT_partwheel)]
        stage.check(polls == [without, not without], f"one of the two panels is there ({polls})")
        yield from stage.screenshot("without" if without else "with")
        stage.window.view_layer.objects.active = model

    def shown(state, name):
        yield from stage.until(f"the state is {state.name}",
                               lambda: stage.registry.get_state(stage.object.data)[0] == state)
        draws.clear()
        sidebar.tag_redraw()
        yield from stage.until("the panel is drawn", lambda: draws)
        yield from stage.screenshot(name)

    mesh = stage.object.data
    mesh.vertices[0].co.x += 0.001
    mesh.update()
    sidebar = next(region for region in stage.area.regions if region.type == "UI")
    yield from shown(stage.registry.State.MOVED, "moved")
    bm = bmesh.new()
    bm.from_mesh(mesh)
    bm.faces.ensure_lookup_table()
    bmesh.ops.delete(bm, geom=[bm.faces[0]], context="FACES_ONLY")
    bm.to_mesh(mesh)
    bm.free()
    yield from shown(stage.registry.State.CHANGED, "changed")
    with stage.override():
        bpy.ops.mesh.partwheel_build()
    stage.check(stage.registry.get_hierarchy(stage.snapshot(stage.object)).notes != "", "the repair left notes")
    yield from shown(stage.registry.State.FITS, "mended")
    with stage.override():
        bpy.ops.mesh.partwheel_clear()
    yield from shown(stage.registry.State.NONE, "cleared")
