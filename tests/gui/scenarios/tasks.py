"""What an artist's tasks take with the tool, with the tool before it was in every mode, and with Blender's own tools: the
table of docs/tasks.md, line by line in the log. Each is played, and its result checked.

An event is one that a hand makes: going to a place, a click, a notch, a key, a modifier. Seconds are by the
keystroke-level model (Card, Moran, Newell 1980) for a practised hand: going to a place 1.1, a key 0.28, a click 0.2, and by our
own guess a notch 0.2; thinking is left out of all three. Blender's own way is a lasso of eight corners around the part,
through the model (X-ray); the table has their overlap.
"""
import bpy
import numpy

from scenarios.gather import drag, place, use
from scenarios.menus import NAMES, ROW
from scenarios.modes import enter, masked, painted_on
from scenarios.wheel_at_click import STEP

PLACE, KEY, CLICK, NOTCH = 1.1, 0.28, 0.2, 0.2
LEVEL = -1  # notches from what the click takes, the arm, to the hand
SPILT = 20  # faces beside a part whose corners it has, so that its vertex group selects them, too
REACH = 20  # pixels
FINGER = 120  # faces that a finger of Homer's has at most
BOX = 0.2, 0.97, 0.8, 0.82  # left, top, right, bottom over the fingers of the fist, as shares of its extent


class Hand:
    """The mouse and keys of the stage, counted."""

    def __init__(self, stage):
        self.stage, self.events, self.seconds = stage, 0, 0.0

    def count(self, number, seconds):
        self.events, self.seconds = self.events + number, self.seconds + number * seconds

    def point(self, x, y):
        self.stage.mouse.move(x - 3, y)
        self.stage.mouse.move(x, y)
        self.count(1, PLACE)
        yield from self.stage.settle()

    def click(self, **session_module):
        self.stage.mouse.click(**session_module)
        self.count(1, CLICK)
        self.count(len(session_module), KEY)
        yield from self.stage.settle()

    def wheel(self, notches):
        self.stage.mouse.wheel(notches)
        self.count(abs(notches), NOTCH)
        yield from self.stage.settle()

    def key(self, key, **session_module):
        self.stage.mouse.key(key, **session_module)
        self.count(1 + len(session_module), KEY)
        yield from self.stage.settle()

    def write(self, text):
        self.stage.mouse.write(text)
        self.count(len(text), KEY)
        yield from self.stage.settle()

    def menu(self, operator, *arguments, **options):
        """A menu and an entry of it: two places and two clicks; what it starts is started."""
        self.count(2, PLACE)
        self.count(2, CLICK)
        with self.stage.override():
            operator(*arguments, **options)
        yield from self.stage.settle()

    def box(self, left, top, right, bottom):
        self.count(2, PLACE)
        self.count(1, CLICK)
        yield from drag(self.stage, [(left, top), (right, bottom)])

    def lasso(self, faces):
        """Around them, in Edit Mode: what is selected then."""
        view, region = self.stage.view, self.stage.view.region
        corners = view._pixels[sorted({v for face in faces for v in self.stage.wheels.triangles[face]})]
        directions = [(numpy.cos(angle), numpy.sin(angle)) for angle in numpy.arange(8) * numpy.pi / 4]
        path = [corners[(corners @ direction).argmax()] + 2 * numpy.array(direction) - [region.x, region.y] for direction in directions]
        self.count(len(path) + 1, PLACE)
        self.count(1, CLICK)
        with self.stage.override():
            self.stage.area.spaces.active.shading.show_xray = True
            bpy.ops.view3d.select_lasso(path=[{"name": "", "loc": place.tolist(), "time": 0} for place in path], mode="SET")
            self.stage.area.spaces.active.shading.show_xray = False
            selected = self.stage.selection()
            bpy.ops.mesh.select_all(action="DESELECT")
        return selected


def tell(task, before, own, likeness, new, extra=0, note=""):
    """extra: events of Blender's own way beside the lassos, each a place and a click."""
    cells = [f"{hand.events}, {hand.seconds:.1f} s" for hand in (before, new)]
    mine = f"{own.events + 2 * extra}, {own.seconds + extra * (PLACE + CLICK):.1f} s, {likeness:.0%} alike{note}"
    print(f"task | {task} | {cells[0]} | {mine} | {cells[1]} |", flush=True)


def alike(own, parts):
    """How much lassos around these parts and the parts have in common: the hand that made them is own."""
    got, expected = frozenset().union(*map(own.lasso, parts)), frozenset().union(*parts)
    return len(got & expected) / len(got | expected)


def play(stage):
    yield from one_part(stage)
    yield from two_parts(stage)
    yield from fingers(stage)
    yield from four_names(stage)
    yield from box(stage)


def one_part(stage):
    yield from stage.open("homer")
    preferences = stage.part("preferences").preferences()
    x, y, face = stage.spot(0.95, 0.6)
    stops, start = stage.wheels.stops(face)
    part = stops[start + LEVEL]
    empty = stage.empty_spot()
    own = Hand(stage)
    likeness = alike(own, [part])

    def pick(hand, end):
        yield from hand.point(x, y)
        yield from hand.click()
        yield from hand.wheel(LEVEL)
        if end:
            yield from hand.key("RET")

    # Select, then look nearer.
    stage.use_tool()
    hands = {}
    for tool, wheel in (("before", "HELD"), ("new", "NEAR")):
        preferences.wheel, hand = wheel, Hand(stage)
        hands[tool] = hand
        stage.select(())
        yield from pick(hand, tool == "before")
        distance = stage.view_3d.view_distance
        if tool == "new":
            yield from hand.point(*empty)
        yield from hand.wheel(1)
        yield from stage.until("it is nearer", lambda: stage.view_3d.view_distance < distance)
        yield from stage.selected(part, f"to select ({tool})")
        stage.mouse.wheel(-1)
        yield from stage.until("and far again", lambda: abs(stage.view_3d.view_distance - distance) < 1e-3)
        stage.mouse.key("RET")
        yield from stage.wait_for_redraw()
    tell("Select a hand, then zoom in", hands["before"], own, likeness, hands["new"], note=", 1 for the zoom left out")

    # Without a wheel.
    preferences.show_steps = True
    stage.select(())
    pen, pulled = Hand(stage), Hand(stage)
    yield from pen.point(x, y)
    yield from pen.click()
    yield from pen.point(x + STEP[0], y + LEVEL * STEP[1])
    for _ in range(abs(LEVEL)):
        yield from pen.click()
    yield from stage.selected(part, "with a pen")
    stage.mouse.key("RET")
    preferences.show_steps = False
    stage.select(())
    yield from pulled.point(x, y)
    stage.mouse.press("LEFTMOUSE")
    yield from stage.settle()
    stage.mouse.move(x, y + 24 * LEVEL)
    pulled.count(1, CLICK)
    pulled.count(1, PLACE)
    yield from stage.settle()
    stage.mouse.release("LEFTMOUSE")
    yield from stage.selected(part, "with a drag")
    stage.mouse.key("RET")
    tell("The same with a pen, by buttons; before by a drag", pulled, own, likeness, pen)

    # In the other modes: by a menu before.
    def in_mode(task, mode, read, kind, write):
        hands = {}
        expected = stage.elements(part, kind)
        for tool in ("before", "new"):
            yield from enter(stage, mode)
            hand = hands[tool] = Hand(stage)
            if tool == "before":
                with stage.override():
                    bpy.ops.wm.tool_set_by_index(index=0)
                stage.mouse.move(*empty)
                yield from hand.menu(bpy.ops.mesh.partwheel_paint, "INVOKE_DEFAULT", write=write)
            yield from pick(hand, True)
            yield from stage.until(lambda: f"{task}, {tool} ({len(read(stage))} of {len(expected)})",
                                   lambda: read(stage) == expected)
            stage.mouse.key("Z", ctrl=True)
            yield from stage.until(f"undone ({tool})", lambda: read(stage) != expected)
        tell(task, hands["before"], own, likeness, hands["new"])

    yield from in_mode("Mask a hand while sculpting", "SCULPT", masked, "verts", "MASK")
    yield from in_mode("Weight a hand", "WEIGHT_PAINT", weighted, "verts", "VERTEX_GROUP")
    yield from in_mode("Paint on a hand alone", "VERTEX_PAINT", painted_on, "faces", "PAINT_MASK")

    # A solid of it, from Object Mode.
    hands = {}
    for tool in ("before", "new"):
        with stage.override():
            bpy.ops.object.mode_set(mode="OBJECT")
            bpy.ops.ed.undo_push(message="Object Mode")
        hand = hands[tool] = Hand(stage)
        objects_before = set(bpy.data.objects)
        stage.mouse.move(*empty)
        if tool == "before":
            yield from hand.key("TAB")
        stage.use_tool()
        yield from pick(hand, False)
        if tool == "before":
            yield from hand.key("C", shift=True, ctrl=True)
        else:
            yield from hand.key("RET")
            yield from hand.menu(bpy.ops.mesh.partwheel_copy, "EXEC_DEFAULT", True)
        yield from stage.until(f"there is a solid ({tool})", lambda: len(set(bpy.data.objects) - objects_before) == 1)
        with stage.override():
            bpy.data.objects.remove((set(bpy.data.objects) - objects_before).pop())
            model = bpy.data.objects["homer"]
            model.select_set(True)
            bpy.context.view_layer.objects.active = model
    tell("Copy a hand as a solid, in Object Mode", hands["before"], own, likeness, hands["new"], extra=3, note=", and open")


def two_parts(stage):
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")
    stage.select(())
    stage.use_tool()
    hand, own = Hand(stage), Hand(stage)
    parts = yield from clicked(hand, [stage.spot(*share) for share in ((0.03, 0.55), (0.97, 0.62))], LEVEL)
    tell("Select both hands", hand, own, alike(own, parts), hand)


def clicked(hand, spots, level=0):
    """Each part by a click of its own, from the second on with Shift; the parts, which are others each time."""
    stage, parts = hand.stage, []
    for number, (x, y, face) in enumerate(spots):
        yield from hand.point(x, y)
        yield from hand.click(**({"shift": True} if number else {}))
        if level:
            yield from hand.wheel(level)
        stops, start = stage.wheels.stops(face)
        parts.append(stops[start + level])
    stage.mouse.key("RET")
    yield from stage.selected(frozenset().union(*parts), "each by a click")
    stage.check(len(set(parts)) == len(spots), "which are as many parts")
    return parts


def fingers(stage):
    """All six of Homer's, beside his thumbs; one is clicked, the others are found."""
    stage.select(())
    centers = stage.view.centers()
    low, high = centers.min(axis=0), centers.max(axis=0)
    union, spots = set(), []
    for x in (0.02, 0.12, 0.17, 0.85, 0.89, 0.98):
        spots.append(finger(stage, (low + (high - low) * [x, 0.6]).astype(int), union))
        union |= taken(stage, spots[-1][2])
    before, new, own = Hand(stage), Hand(stage), Hand(stage)
    parts = yield from clicked(before, spots)
    stage.select(())
    yield from new.point(*spots[0][:2])
    yield from new.click()
    yield from new.key("L", shift=True, ctrl=True)
    yield from new.wheel(2)  # the outermost is the least like the others: with another one there is nothing to be added
    stage.mouse.key("RET")
    yield from stage.selected(frozenset().union(*parts), "all that are alike")
    yield from stage.screenshot("fingers")
    stage.select(())
    tell("Select all six fingers", before, own, alike(own, parts), new)


def finger(stage, near, union):
    """(x, y, face) of the nearest pixel where a click takes a finger that is not found yet, and so does one beside it."""
    view = stage.view
    for x, y in sorted(numpy.ndindex(2 * REACH, 2 * REACH), key=lambda at: (at[0] - REACH) ** 2 + (at[1] - REACH) ** 2):
        x, y = int(near[0]) + x - REACH, int(near[1]) + y - REACH
        face = view.face_at(x, y)
        if face is None or face in union or len(taken(stage, face)) > FINGER:
            continue
        faces = [view.face_at(x + dx, y + dy) for dx in (-1, 1) for dy in (-1, 1)]
        if taken(stage, face).issuperset(faces):
            return x, y, face
    raise AssertionError(f"There is no finger near {near}.")


def taken(stage, face):
    """The part that a click on a face takes."""
    stops, start = stage.wheels.stops(face)
    return stops[start]


def four_names(stage):
    """Named; then something is deleted, which undo brings back; then each is selected again. Without names of parts by
    vertex groups: Ctrl G, Assign to New Group, its name; and to come back deselect all, choose it, Select."""
    spots = dict(zip(("head", "belly", "left", "right"), (stage.spot(*share) for share in (
        (0.5, 0.9), (0.5, 0.45), (0.35, 0.1), (0.65, 0.1)))))
    parts = {name: taken(stage, spot[2]) for name, spot in spots.items()}
    stage.check(len(set(parts.values())) == 4, "the four are four")
    hands = {}
    for tool in ("before", "new"):
        hand = hands[tool] = Hand(stage)
        stage.select(())
        sidebar = yield from stage.sidebar()
        for name, (x, y, _) in spots.items():
            yield from hand.point(x, y)
            yield from hand.click()
            stage.mouse.key("RET")
            yield from stage.selected(parts[name], f"to be named {name} ({tool})")
            if tool == "new":
                yield from hand.menu(bpy.ops.mesh.partwheel_remember, "INVOKE_DEFAULT", True)
                yield from hand.write(name)
                yield from hand.key("RET")
                yield from hand.key("RET")
                yield from stage.until(f"{name} is remembered", lambda name=name: name in names(stage))
            else:
                grouping(hand, name)
        yield from hand.menu(bpy.ops.mesh.delete, "EXEC_DEFAULT", True, type="FACE")
        yield from hand.key("Z", ctrl=True)
        stage.mouse.release("LEFT_CTRL")  # or Blender takes the next click on a button for one with Ctrl
        yield from stage.until(f"it is there again ({tool})",
                               lambda: stage.object.data.total_face_sel == len(parts["right"]))
        for number, name in enumerate(spots):
            if tool == "new":
                yield from hand.point(sidebar.x + 40, sidebar.y + sidebar.height - NAMES - ROW * number)
                yield from hand.click()
            else:
                yield from group_selected(hand, name)
            missing = lambda name=name: parts[name] - stage.selection()
            yield from stage.until(f"{name} again ({tool})", lambda: not missing() and len(stage.selection()) <= (
                len(parts[name]) + (SPILT if tool == "before" else 0)))
    yield from stage.screenshot("names")
    own = Hand(stage)
    likeness = alike(own, parts.values())
    own.count(hands["before"].events - 2 * len(parts), 0)  # as before, but each part by a lasso, not by a place and a click
    own.seconds += hands["before"].seconds - len(parts) * (PLACE + CLICK)
    tell("Name four parts, come back to each after undo", hands["before"], own, likeness, hands["new"])


def names(stage):
    return stage.part("related.named_parts").part_names(stage.object.data)


def grouping(hand, name):
    """What is selected as a new vertex group: Ctrl G, an entry, a double click on its name, the name, Enter."""
    hand.count(4 + len(name), KEY)
    hand.count(2, PLACE)
    hand.count(3, CLICK)
    with hand.stage.override():
        bpy.ops.object.vertex_group_assign_new()
        hand.stage.object.vertex_groups.active.name = name
        bpy.ops.ed.undo_push(message="Named")


def group_selected(hand, name):
    """Alt A; then the group in the list, and the button Select."""
    yield from hand.key("A", alt=True)
    hand.count(2, PLACE)
    hand.count(2, CLICK)
    with hand.stage.override():
        bpy.ops.object.vertex_group_set_active(group=name)
        bpy.ops.object.vertex_group_select()
    yield from hand.stage.settle()


def box(stage):
    """Three fingers and the thumb of a fist, by their ends."""
    yield from stage.open("hand")
    stage.use_tool()
    before, new, own = Hand(stage), Hand(stage), Hand(stage)
    parts = yield from clicked(before, [stage.spot(*share) for share in (
        (0.24, 0.83), (0.42, 0.92), (0.64, 0.94), (0.73, 0.8))])
    stage.select(())
    yield from use(stage, "box")
    yield from new.box(*place(stage, *BOX))
    yield from stage.selected(frozenset().union(*parts), "by a box")
    yield from stage.screenshot("box")
    tell("Select three fingers and a thumb", before, own, alike(own, parts), new)


def weighted(stage):
    return frozenset(vertex.index for vertex in stage.object.data.vertices for group in vertex.groups if group.weight == 1)
