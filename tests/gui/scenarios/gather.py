"""Box and lasso select whole parts: those that a click and as many notches as last would take of what they touch. Shift adds, Ctrl takes away,
each is one undo step, Esc leaves everything; a click in these tools picks as ever."""
import bpy
import numpy


def play(stage):
    yield from stage.open("hand")
    yield from use(stage, "box")
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x - 3, y)
    stage.mouse.move(x, y)
    yield from stage.until("hover shows the part of a click", lambda: stage.hovered() == stops[start])
    stage.mouse.click()
    yield from stage.selected(stops[start], "after a click with the tool")
    stage.mouse.key("RET")
    yield from stage.ended()

    left, top, right, bottom = place(stage, 0.0, 0.95, 0.3, 0.8)
    expected = boxed(stage, left, top, right, bottom)
    stage.check(0 < len(expected) < len(stage.wheels.triangles) / 2, f"the box is over some parts ({len(expected)})")
    yield from drag(stage, [(left, top), (right, bottom)])
    yield from stage.selected(expected, "after a box")
    yield from stage.screenshot("0-box")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected(stops[start], "after one Ctrl Z")
    yield from drag(stage, [(left, top), (right, bottom)], shift=True)
    yield from stage.selected(stops[start] | expected, "after a box with Shift")
    yield from drag(stage, [(left, top), (right, bottom)], ctrl=True)
    yield from stage.selected(stops[start] - expected, "after a box with Ctrl")

    stage.mouse.move(left, top)
    stage.mouse.press("LEFTMOUSE")
    yield from stage.settle()
    for step in range(1, 5):
        stage.mouse.move(left + (right - left) * step // 4, top + (bottom - top) * step // 4)
    yield from stage.settle()
    stage.mouse.key("ESC")
    stage.mouse.release("LEFTMOUSE")
    yield from stage.settle()
    yield from stage.selected(stops[start] - expected, "after Esc")

    yield from use(stage, "lasso")
    ring = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top - 1)]
    yield from drag(stage, ring)
    yield from stage.selected(expected, "after a lasso of the same shape")
    yield from stage.screenshot("1-lasso")
    with stage.override():
        bpy.ops.mesh.select_all(action="DESELECT")
        bpy.ops.mesh.select_mode(type="VERT")
    yield from use(stage, "box")
    yield from drag(stage, [(left, top), (right, bottom)])
    yield from stage.until("vertices too", lambda: stage.selection("verts") >= stage.elements(expected, "verts"))


def use(stage, tool):
    with stage.override():
        bpy.ops.wm.tool_set_by_id(name=f"partwheel.{tool}")
    yield from stage.wait_for_redraw()


def boxed(stage, left, top, right, bottom):
    """All of the parts that a click takes from the faces that Blender's own box selects, but those that it only grazes;
    of a face in one that more of these faces take, only that one."""
    region = stage.view.region
    with stage.override():
        bpy.ops.view3d.select_box(xmin=left - region.x, xmax=right - region.x, ymin=bottom - region.y,
                                  ymax=top - region.y, wait_for_input=False)
        selected = stage.selection()
        bpy.ops.ed.undo_push(message="Box")
        bpy.ops.ed.undo()
    takes = {}
    for face in selected:
        stops, start = stage.wheels.stops(face)
        takes.setdefault(stops[start], []).append(face)
    union = frozenset()
    for part in sorted(takes, key=lambda part: -len(takes[part])):
        left = set(takes[part]) - union
        if left and len(left) >= 0.1 * min(len(selected), len(part)):
            union |= part
    return union


def place(stage, *shares):
    """left, top, right, bottom in pixels, from shares of the model's extent."""
    centers = stage.view.centers()
    low, high = centers.min(axis=0), centers.max(axis=0)
    at = lambda x, y: (low + (high - low) * [x, y]).round().astype(int).tolist()
    return *at(shares[0], shares[1]), *at(shares[2], shares[3])


def drag(stage, way, **session_module):
    """Through these places with the left button down. A drag has the modifiers of the last key."""
    key = {"shift": "LEFT_SHIFT", "ctrl": "LEFT_CTRL"}[next(iter(session_module), "shift")]
    stage.mouse.press(key, **session_module)
    stage.mouse.move(*way[0], **session_module)
    yield from stage.settle()
    stage.mouse.press("LEFTMOUSE", **session_module)
    yield from stage.settle()
    for begin, end in zip(way, way[1:]):
        for share in numpy.linspace(0, 1, 6)[1:]:
            stage.mouse.move(*(int(a + (b - a) * share) for a, b in zip(begin, end)), **session_module)
            yield from stage.settle()
    stage.mouse.release("LEFTMOUSE", **session_module)
    stage.mouse.release(key)
    yield from stage.settle()
