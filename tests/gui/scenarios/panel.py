"""The panel in the sidebar is drawn in Edit Mode and in Object Mode."""
import bpy


def play(stage):
    yield from stage.open("hand")
    drawn = []
    panel = bpy.types.VIEW3D_PT_partwheel
    draw = panel.draw

    def recorded(self, context):
        draw(self, context)
        drawn.append(context.mode)

    panel.draw = recorded
    stage.area.spaces.active.show_region_ui = True
    yield from stage.drawn()
    sidebar = next(region for region in stage.area.regions if region.type == "UI")
    stage.mouse.move(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height // 2)
    for _ in range(6):  # Ctrl and the wheel go from tab to tab, ours is the last
        stage.mouse.wheel(-1, ctrl=True)
    yield from stage.until("the panel is drawn in Edit Mode", lambda: "EDIT_MESH" in drawn)
    yield from stage.screenshot("edit")
    stage.mouse.move(*stage.empty_spot())
    stage.mouse.key("TAB")
    yield from stage.until("the panel is drawn in Object Mode", lambda: "OBJECT" in drawn)
    yield from stage.screenshot("object")
