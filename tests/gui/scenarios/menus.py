"""Where hands expect it: the right-click menu, F3 by the field's words, the pie menu after it was given a key, and the
list of remembered parts with its search."""
import bpy

NAMES, ROW, SEARCH = 365, 21, 421  # pixels from the sidebar's top to the first name, to the next, and to what opens the search


def play(stage):
    yield from stage.open("homer")
    stage.use_tool()
    yield from stage.take(stage.spot(0.05, 0.5, above=1), "to be used", notches=0)
    arm = stage.selection()
    stage.mouse.key("RET")
    yield from stage.ended()

    stage.mouse.click("RIGHTMOUSE")
    yield from stage.settle()
    yield from stage.screenshot("right-click")
    stage.mouse.key("ESC")
    stage.mouse.key("F3")
    yield from stage.settle()
    stage.mouse.write("segment")
    yield from stage.settle()
    yield from stage.screenshot("search")
    stage.mouse.key("ESC")
    stage.mouse.key("ESC")
    yield from stage.settle()
    yield from stage.selected(arm, "after all that")

    key = stage.part("preferences").find_pie_key()
    stage.check(key.type == "NONE", "no key is taken for the pie")
    key.type = "F6"
    stage.mouse.key("F6")
    yield from stage.settle()
    yield from stage.screenshot("pie")
    stage.mouse.move(stage.mouse.x + 150, stage.mouse.y)
    yield from stage.settle()
    stage.mouse.click()
    yield from stage.until("the pie's right selects what is alike", lambda: len(stage.selection()) > len(arm))
    stage.mouse.key("RET")
    yield from stage.ended()

    with stage.override():
        bpy.ops.mesh.partwheel_remember("EXEC_DEFAULT", True, part="Left arm")
        bpy.ops.mesh.partwheel_mirrored("EXEC_DEFAULT", True, extend=False)
        bpy.ops.mesh.partwheel_remember("EXEC_DEFAULT", True, part="Right arm")
    other = stage.selection()
    sidebar = yield from stage.sidebar()
    yield from stage.settle()
    yield from stage.screenshot("remembered")
    names = stage.part("related.named_parts").part_names

    def click(down):
        stage.mouse.move(sidebar.x + 40, sidebar.y + sidebar.height - down)
        yield from stage.settle()
        stage.mouse.click()

    yield from click(NAMES)
    yield from stage.selected(arm, "after a click on its name")
    yield from click(NAMES + ROW)
    yield from stage.selected(other, "after a click on the other's name")
    for expected in (arm, other):
        stage.mouse.move(stage.area.x + 300, stage.area.y + 300)
        stage.mouse.key("Z", ctrl=True)
        yield from stage.selected(expected, "after Ctrl Z")
    stage.check(names(stage.object.data) == ["Left arm", "Right arm"], "the names outlive undoing what came after them")
    yield from click(SEARCH)
    yield from stage.settle()
    yield from stage.screenshot("search-of-the-list")
    stage.mouse.move(stage.area.x + 300, stage.area.y + 300)
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("undo takes the name back", lambda: names(stage.object.data) == ["Left arm"])
