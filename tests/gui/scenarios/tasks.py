"""What an artist's tasks take with the tool, with the tool before it was in every mode, and with Blender's own tools: the
table of docs/tasks.md, line by line in the log. Each is played, and its result checked.

An event is one that a hand makes: going to a place, a click, a notch, a key, a modifier. Seconds are by the
keystroke-level model (Card, Moran, Newell 1980) for a practised hand: going to a place 1.1, a key 0.28, a click 0.2, and by our
own guess a notch 0.2; thinking is left out of all three. Blender's own way is a lasso of eight corners around the part,
through the model (X-ray); told is how much of it and the part is common to both.
"""
import bpy
import numpy

from scenarios.modes import enter, masked, painted_on

PLACE, KEY, CLICK, NOTCH = 1.1, 0.28, 0.2, 0.2
LEVEL = 1  # notches up from what the click takes


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

    def click(self, **held):
        self.stage.mouse.click(**held)
        self.count(1, CLICK)
        self.count(len(held), KEY)
        yield from self.stage.settle()

    def wheel(self, notches):
        self.stage.mouse.wheel(notches)
        self.count(abs(notches), NOTCH)
        yield from self.stage.settle()

    def key(self, key, **held):
        self.stage.mouse.key(key, **held)
        self.count(1 + len(held), KEY)
        yield from self.stage.settle()

    def menu(self, operator, *arguments, **options):
        """A menu and an entry of it: two places and two clicks; what it starts is started."""
        self.count(2, PLACE)
        self.count(2, CLICK)
        with self.stage.override():
            operator(*arguments, **options)
        yield from self.stage.settle()

    def lasso(self, faces):
        """Around them, in Edit Mode: what is selected then."""
        view, region = self.stage.view, self.stage.view.region
        corners = view._pixels[sorted({v for face in faces for v in self.stage.wheels.triangles[face]})]
        ways = [(numpy.cos(angle), numpy.sin(angle)) for angle in numpy.arange(8) * numpy.pi / 4]
        path = [corners[(corners @ way).argmax()] + 2 * numpy.array(way) - [region.x, region.y] for way in ways]
        self.count(len(path) + 1, PLACE)
        self.count(1, CLICK)
        with self.stage.override():
            self.stage.area.spaces.active.shading.show_xray = True
            bpy.ops.view3d.select_lasso(path=[{"name": "", "loc": place.tolist(), "time": 0} for place in path], mode="SET")
            self.stage.area.spaces.active.shading.show_xray = False
            selected = self.stage.selection()
            bpy.ops.mesh.select_all(action="DESELECT")
        return selected


def play(stage):
    yield from stage.open("homer")
    wanted = stage.part("preferences").preferences()
    x, y, face = stage.spot(0.95, 0.6, above=LEVEL)
    stops, start = stage.wheels.stops(face)
    part = stops[start + LEVEL]
    away = stage.empty_spot()
    own = Hand(stage)
    got = own.lasso(part)
    likeness = len(got & part) / len(got | part)

    def tell(task, new, before, extra=0, note=""):
        """extra: events of Blender's own way beside the lasso, each a place and a click."""
        cells = [f"{hand.events}, {hand.seconds:.1f} s" for hand in (before, new)]
        mine = f"{own.events + 2 * extra}, {own.seconds + extra * (PLACE + CLICK):.1f} s, {likeness:.0%} alike{note}"
        print(f"task | {task} | {cells[0]} | {mine} | {cells[1]} |", flush=True)

    def pick(hand, end):
        yield from hand.point(x, y)
        yield from hand.click()
        yield from hand.wheel(LEVEL)
        if end:
            yield from hand.key("RET")

    # Select, then look nearer.
    stage.use_tool()
    hands = {}
    for way, wheel in (("before", "HELD"), ("new", "NEAR")):
        wanted.wheel, hand = wheel, Hand(stage)
        hands[way] = hand
        stage.select(())
        yield from pick(hand, way == "before")
        distance = stage.view_3d.view_distance
        if way == "new":
            yield from hand.point(*away)
        yield from hand.wheel(1)
        yield from stage.until("it is nearer", lambda: stage.view_3d.view_distance < distance)
        yield from stage.selected(part, f"to select ({way})")
        stage.mouse.wheel(-1)
        yield from stage.until("and far again", lambda: abs(stage.view_3d.view_distance - distance) < 1e-3)
        stage.mouse.key("RET")
        yield from stage.drawn()
    tell("Select a hand, then zoom in", hands["new"], hands["before"], note=", 1 for the zoom left out")

    # Without a wheel.
    wanted.show_steps = True
    stage.select(())
    pen, drag = Hand(stage), Hand(stage)
    yield from pen.point(x, y)
    yield from pen.click()
    yield from pen.point(x + 44, y + 18)
    for _ in range(LEVEL):
        yield from pen.click()
    yield from stage.selected(part, "with a pen")
    stage.mouse.key("RET")
    wanted.show_steps = False
    stage.select(())
    yield from drag.point(x, y)
    stage.mouse.press("LEFTMOUSE")
    yield from stage.settle()
    stage.mouse.move(x, y + 24 * LEVEL)
    drag.count(1, CLICK)
    drag.count(1, PLACE)
    yield from stage.settle()
    stage.mouse.release("LEFTMOUSE")
    yield from stage.selected(part, "with a drag")
    stage.mouse.key("RET")
    tell("The same with a pen, by buttons; before by a drag", pen, drag)

    # In the other modes: by a menu before.
    def in_mode(task, mode, read, kind, write):
        hands = {}
        expected = stage.elements(part, kind)
        for way in ("before", "new"):
            yield from enter(stage, mode)
            hand = hands[way] = Hand(stage)
            if way == "before":
                with stage.override():
                    bpy.ops.wm.tool_set_by_index(index=0)
                stage.mouse.move(*away)
                yield from hand.menu(bpy.ops.mesh.partwheel_paint, "INVOKE_DEFAULT", write=write)
            yield from pick(hand, True)
            yield from stage.until(lambda: f"{task}, {way} ({len(read(stage))} of {len(expected)})",
                                   lambda: read(stage) == expected)
            stage.mouse.key("Z", ctrl=True)
            yield from stage.until(f"undone ({way})", lambda: read(stage) != expected)
        tell(task, hands["new"], hands["before"])

    yield from in_mode("Mask a hand while sculpting", "SCULPT", masked, "verts", "MASK")
    yield from in_mode("Weight a hand", "WEIGHT_PAINT", weighted, "verts", "VERTEX_GROUP")
    yield from in_mode("Paint on a hand alone", "VERTEX_PAINT", painted_on, "faces", "PAINT_MASK")

    # A solid of it, from Object Mode.
    hands = {}
    for way in ("before", "new"):
        with stage.override():
            bpy.ops.object.mode_set(mode="OBJECT")
            bpy.ops.ed.undo_push(message="Object Mode")
        hand = hands[way] = Hand(stage)
        there = set(bpy.data.objects)
        stage.mouse.move(*away)
        if way == "before":
            yield from hand.key("TAB")
        stage.use_tool()
        yield from pick(hand, False)
        if way == "before":
            yield from hand.key("C", shift=True, ctrl=True)
        else:
            yield from hand.key("RET")
            yield from hand.menu(bpy.ops.mesh.partwheel_copy, "EXEC_DEFAULT", True)
        yield from stage.until(f"there is a solid ({way})", lambda: len(set(bpy.data.objects) - there) == 1)
        with stage.override():
            bpy.data.objects.remove((set(bpy.data.objects) - there).pop())
            model = bpy.data.objects["homer"]
            model.select_set(True)
            bpy.context.view_layer.objects.active = model
    tell("Copy a hand as a solid, in Object Mode", hands["new"], hands["before"], extra=3, note=", and open")

    # All that is in a place.
    with stage.override():
        bpy.ops.object.mode_set(mode="EDIT")
    stage.select(())
    stage.use_tool()
    spots = {}
    for share in ((0.03, 0.55), (0.97, 0.62)):
        spot = stage.spot(*share, above=LEVEL)
        spots[spot[2]] = spot
    hand = Hand(stage)
    for number, (px, py, _) in enumerate(spots.values()):
        yield from hand.point(px, py)
        yield from hand.click(**({"shift": True} if number else {}))
        yield from hand.wheel(LEVEL)
    stage.mouse.key("RET")
    both = frozenset().union(*(stage.wheels.stops(f)[0][stage.wheels.stops(f)[1] + LEVEL] for f in spots))
    yield from stage.selected(both, "both hands")
    lassos = Hand(stage)
    lassos.lasso(part)
    lassos.lasso(part)
    print(f"task | Select both hands | {hand.events}, {hand.seconds:.1f} s | {lassos.events}, {lassos.seconds:.1f} s, "
          f"{likeness:.0%} alike | {hand.events}, {hand.seconds:.1f} s |", flush=True)


def weighted(stage):
    return frozenset(vertex.index for vertex in stage.object.data.vertices for each in vertex.groups if each.weight == 1)
