"""The whole model in parts, with real events: the wheel changes how many, a click and the wheel split and join one, a
drag merges two; Esc leaves all as it was, Enter writes, as one undo step. In Object, Edit and Sculpt Mode."""
import bpy
import numpy


def play(stage):
    yield from stage.open("figure")
    model = stage.object
    cut = stage.package("cut").Cut
    hierarchy = stage.registry.find_hierarchy(model.data)
    automatic = cut.automatic(hierarchy)
    states, end_recording = stage.record_cuts()
    start = everything(model)
    yield from mode(stage, "OBJECT")
    arm, belly, head = (stage.spot(*place) for place in ((0.95, 0.6), (0.5, 0.5), (0.5, 0.95)))

    def begun(where):
        states.clear()
        stage.mouse.move(*where[:2])
        with stage.override():
            bpy.ops.mesh.partwheel_parts("INVOKE_DEFAULT")
        yield from stage.until("the parts are shown", lambda: len(states) == 1)
        yield from stage.wait_for_redraw()

    def now(what, predicate):
        yield from stage.until(what, lambda: predicate(states[-1]))
        yield from stage.wait_for_redraw()

    yield from begun(head)
    stage.check(states[-1].cut == automatic and states[-1].part is None, "it begins with the automatic cut")
    yield from stage.screenshot("1-automatic")
    stage.mouse.wheel(3)
    yield from now("the wheel makes more", lambda state: state.cut == automatic.resize(len(automatic) + 3))
    stage.mouse.wheel(-3)
    yield from now("and comes back", lambda state: state.cut == automatic)
    stage.mouse.key("SIX")
    yield from now("typed: six", lambda state: len(state.cut) == 6)
    yield from stage.screenshot("2-six")
    six = states[-1].cut
    stage.mouse.move(*arm[:2])
    stage.mouse.click()
    part = six.labels[arm[2]]
    yield from now("a click takes a part", lambda state: state.part == part and state.cut == six)
    yield from stage.screenshot("3-taken")
    stage.mouse.wheel(-1)
    yield from now("the wheel splits it", lambda state: state.cut == six.split(part))
    yield from stage.screenshot("4-split")
    stage.mouse.wheel(2)
    yield from now("and joins it", lambda state: state.cut == six.join(part) and len(state.cut) < 6)
    stage.mouse.wheel(-2)
    split = six.split(part)
    yield from now("and goes back", lambda state: state.cut == split)
    stage.mouse.move(*head[:2])  # from the head onto the belly
    yield from stage.drag("LEFTMOUSE", belly[0] - head[0], belly[1] - head[1])
    merged = split.merge(int(split.labels[belly[2]]), int(split.labels[head[2]]))
    yield from now("a drag merges", lambda state: state.cut == merged and state.part is None)
    stage.check(len(merged) == len(split) - 1, "one part less")
    yield from stage.screenshot("5-merged")
    stage.mouse.key("ESC")
    yield from ended(stage)
    stage.check(everything(model) == start, "Esc leaves all as it was")
    stage.check(len(bpy.data.objects) == 1, "and no object is new")

    # Objects, in Object Mode.
    yield from begun(head)
    stage.mouse.key("SIX")
    yield from now("typed again", lambda state: len(state.cut) == 6)
    stage.mouse.key("RET")
    yield from stage.until("there are objects", lambda: len(bpy.data.objects) == 7)
    yield from ended(stage)
    parts = [obj for obj in bpy.data.objects if obj.name != "figure"]
    stage.check(sum(obj.parent is None for obj in parts) == 1 and all("partwheel_cap" in obj.data.attributes
                                                                     for obj in parts), "closed, and hanging together")
    stage.check(bpy.data.objects["figure"].hide_get(), "the original is hidden")
    yield from stage.screenshot("6-objects")
    yield from stage.adjusted(count=7, explode=0.25)
    yield from stage.until("one more, apart", lambda: len(bpy.data.objects) == 8)
    yield from stage.settle()
    roots = [obj for obj in bpy.data.objects if obj.name != "figure" and not obj.parent]
    stage.check(len(roots) == 1 and abs(roots[0]["explode"] - 0.25) < 1e-6, "by a property that stays")
    stage.check(all(obj.delta_location.length > 0.01 for obj in bpy.data.objects if obj.parent), "all are moved")
    yield from stage.screenshot("6-apart")
    yield from undone(stage)
    yield from stage.until("one undo step takes all away", lambda: len(bpy.data.objects) == 1)
    stage.check(everything(stage.object) == start, "as it was")

    # Groups and colors, in Edit Mode; kept, and gone on with.
    yield from mode(stage, "EDIT")
    yield from begun(head)
    stage.mouse.key("FOUR")
    yield from now("four", lambda state: len(state.cut) == 4)
    stage.mouse.key("C")
    stage.mouse.key("RET")
    yield from stage.until("written, in Edit Mode", lambda: stage.object.mode == "EDIT"
                           and len(stage.object.vertex_groups) == 4)
    yield from ended(stage)
    stage.check(len(stage.object.data.materials) == 4, "colors, too")
    yield from stage.screenshot("7-groups")
    yield from begun(head)
    stage.check(len(states[-1].cut) == 4, "it goes on with those that are kept")
    stage.mouse.key("A")
    yield from now("A: the automatic ones", lambda state: state.cut == automatic)
    stage.mouse.key("ESC")
    yield from ended(stage)
    yield from undone(stage)
    yield from stage.until("undone in one step", lambda: not stage.object.vertex_groups and not stage.object.data.materials)

    # Face sets, in Sculpt Mode.
    yield from mode(stage, "SCULPT")
    yield from begun(head)
    stage.mouse.wheel(-2)
    fewer = automatic.resize(len(automatic) - 2)
    yield from now("two fewer", lambda state: state.cut == fewer)
    stage.mouse.key("RET")
    yield from stage.until("there are face sets", lambda: sets(stage.object) is not None)
    yield from ended(stage)
    stage.check((sets(stage.object) == fewer.labels + 1).all() and stage.object.mode == "SCULPT", "one a part")
    yield from stage.wait_for_redraw()
    yield from stage.screenshot("8-face-sets")
    yield from mode(stage, "EDIT")
    end_recording()


def mode(stage, name):
    with stage.override():
        bpy.ops.object.mode_set(mode=name)
        bpy.ops.ed.undo_push(message=name)
    yield from stage.wait_for_redraw()


def ended(stage):
    """Nothing is drawn or said any more, and the wheel is Blender's."""
    yield from stage.settle()
    bar = bpy.types.STATUSBAR_HT_header
    stage.check(bar.draw == getattr(bar, "_draw_orig", bar.draw), "the status bar is Blender's own again")
    distance = stage.view_3d.view_distance
    stage.mouse.wheel(1)
    yield from stage.until("the wheel zooms again", lambda: stage.view_3d.view_distance < distance)
    stage.mouse.wheel(-1)
    yield from stage.until("the wheel zooms back", lambda: abs(stage.view_3d.view_distance - distance) < 1e-3)
    yield from stage.wait_for_redraw()


def undone(stage):
    stage.mouse.key("Z", ctrl=True)
    yield from stage.settle()


def sets(obj):
    attribute = obj.data.attributes.get(".sculpt_face_set")
    if attribute is None:
        return None
    values = numpy.empty(len(obj.data.polygons), numpy.int32)
    attribute.data.foreach_get("value", values)
    return values


def everything(obj):
    """All that may have changed."""
    mesh = obj.data
    return ([tuple(vertex.co) for vertex in mesh.vertices], [tuple(polygon.vertices) for polygon in mesh.polygons],
            sorted(mesh.keys()), [group.name for group in obj.vertex_groups], len(mesh.materials),
            [name for name in mesh.attributes.keys() if name.startswith(("partwheel", ".sculpt"))],
            [obj.name for obj in bpy.data.objects], len(bpy.data.collections))
