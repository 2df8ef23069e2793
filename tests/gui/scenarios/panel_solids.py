"""The panel's buttons for parts as solids, by real clicks, without opening or scrolling anything in a small window: copy, split
and explode, hulls of the part, unite with a blend, remove with a smooth fill; options changed afterwards, as the panel of the last
operation does it."""
import bpy
from mathutils import Vector

from compose import activate, caps, closed, volume

# Pixels from the sidebar's top to the middle of the panel's title, and from there to its buttons.
TITLE = 155
COPY, REMOVE, SPLIT, CONVEX, CONVEX_PART, UNITE = 31, 51, 72, 92, 113, 180


def play(stage):
    yield from stage.open("hand")
    sidebar = yield from stage.sidebar()
    top = sidebar.y + sidebar.height
    yield from stage.settle()
    _, stops, start = yield from stage.pick(0.5, 0.9)
    index = next(i for i, part in enumerate(stops) if len(part) >= 0.05 * len(stage.wheels.triangles))
    stage.mouse.wheel(index - start)
    yield from stage.selected(stops[index], "a finger")
    stage.mouse.key("RET")
    yield from stage.ended()
    stage.mouse.key("TAB")
    yield from stage.until("Object Mode", lambda: stage.object.mode == "OBJECT")
    yield from stage.wait_for_redraw()

    def click(below):
        stage.mouse.move(sidebar.x + sidebar.width // 2, top - TITLE - below)
        yield from stage.settle()
        stage.mouse.click()
        yield from stage.settle()

    def objects(name):
        return [obj for obj in bpy.data.objects if obj.name.startswith(name)]

    yield from stage.screenshot("1-panel")
    whole, finger = volume(stage.object), len(stops[index])
    total = len(stage.wheels.triangles)
    yield from click(COPY)
    yield from stage.until("the copy is there", lambda: stage.object.name == "hand part")
    copied = (~caps(stage.object)).sum()  # its border goes to the creases nearby
    stage.check(abs(copied - finger) < 0.3 * finger, "with the finger's faces")
    yield from stage.adjusted(material=True)
    stage.check([material and material.name for material in stage.object.data.materials][-1] == "Partwheel Cap",
                "its caps got a material afterwards")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("undone", lambda: not objects("hand part") and stage.object.mode == "OBJECT")

    activate(stage, bpy.data.objects["hand"])
    yield from stage.wait_for_redraw()
    yield from click(SPLIT)
    yield from stage.until("six parts", lambda: len(objects("hand part")) == 6)
    stage.check(all(closed(part) for part in objects("hand part")), "each of them closed")
    stage.check(abs(sum(map(volume, objects("hand part"))) - whole) < 1e-4 * whole, "together they are the hand")
    middles = [part.matrix_world.translation.copy() for part in objects("hand part")]
    yield from stage.adjusted(parts=5, explode=0.5)
    stage.check(len(objects("hand part")) == 5, "five parts, when that is changed")
    stage.check(any((part.matrix_world.translation - middles[0]).length > 0.01 for part in objects("hand part")),
                "moved apart")
    yield from stage.screenshot("2-exploded")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step takes them away",
                           lambda: not objects("hand part") and stage.object.mode == "OBJECT")

    activate(stage, bpy.data.objects["hand"])
    yield from stage.wait_for_redraw()
    yield from click(CONVEX_PART)
    yield from stage.until("hulls of the finger", lambda: 1 < len(bpy.data.objects["hand"].children) <= 16)
    yield from stage.adjusted(hulls=2)
    hulls = bpy.data.objects["hand"].children
    stage.check(len(hulls) == 2, "two, when that is changed")
    stage.check(sum(map(volume, hulls)) < 0.2 * whole, "of the finger only")
    counts = []
    for error in (5, 1):  # % of the size of the model
        yield from stage.adjusted(by="ERROR", error=error)
        counts.append(len(bpy.data.objects["hand"].children))
    stage.check(0 < counts[0] < counts[1], f"more hulls for a smaller error of the finger: {counts}")
    yield from stage.screenshot("3-hulls")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("undone", lambda: not bpy.data.objects["hand"].children)

    activate(stage, bpy.data.objects["hand"])
    yield from stage.wait_for_redraw()
    yield from click(COPY)
    yield from stage.until("the copy is there", lambda: stage.object.name == "hand part")
    part, hand = stage.object, bpy.data.objects["hand"]
    part.matrix_world.translation += stage.view_3d.view_rotation @ Vector((0, 0.25, 0.3))
    activate(stage, hand, part)
    yield from stage.wait_for_redraw()
    yield from click(UNITE)
    yield from stage.until("they are one", lambda: len(bpy.data.objects) == 1)
    stage.check(closed(stage.object) and volume(stage.object) > whole, "a closed one, and larger")
    creased = volume(stage.object)
    yield from stage.adjusted(blend=0.3)
    stage.check(len(bpy.data.objects) == 1 and closed(stage.object), "one closed mesh again")
    stage.check(abs(volume(stage.object) - creased) > 1e-5 * whole, "with another surface along the seam")
    yield from stage.until("its parts are found beside that", lambda: stage.registry.get_state(stage.object.data)[0] ==
                           stage.registry.State.FITS and not stage.has_builds())
    yield from stage.screenshot("4-blended")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("undone", lambda: len(bpy.data.objects) == 2)

    activate(stage, bpy.data.objects["hand"])
    yield from stage.wait_for_redraw()
    yield from click(REMOVE)
    yield from stage.until("the finger is gone", lambda: len(stage.object.data.polygons) != total)
    stage.check((~caps(stage.object)).sum() == total - copied and closed(stage.object), "the hole is closed")
    flat = volume(stage.object)
    yield from stage.adjusted(smooth=True)
    stage.check((~caps(stage.object)).sum() == total - copied and closed(stage.object), "with a smooth fill as well")
    stage.check(abs(volume(stage.object) - flat) > 1e-5 * whole, "which is another surface")
    yield from stage.screenshot("5-removed")
