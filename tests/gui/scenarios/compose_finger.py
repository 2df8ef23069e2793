"""A part completed, as the nose in the paper's Figure 8: a finger copied (C), another one removed (X), the copy placed
where that was, fitted to its border, and united; undone step by step."""
import bpy
from mathutils import Vector

from compose import caps, enter, place_over, unite, volume


def play(stage):
    yield from stage.open("hand")
    hand = stage.object
    whole = volume(hand)
    yield from finger(stage, 0.25, 0.78)
    yield from stage.screenshot("1-picked")
    count = len(stage.selection())
    stage.mouse.key("C", shift=True, ctrl=True)
    yield from stage.until("the copy is there, in Object Mode",
                           lambda: stage.object != hand and stage.object.mode == "OBJECT")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step takes the copy away, and is back in Edit Mode",
                           lambda: len(bpy.data.objects) == 1 and stage.object.mode == "EDIT")
    stage.check(len(stage.selection()) == count, "with the part selected")
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.until("and redo brings it again, in Object Mode",
                           lambda: stage.object.name == "hand part" and stage.object.mode == "OBJECT")
    hand, part = bpy.data.objects["hand"], stage.object
    border = abs((~caps(part)).sum() - count)
    stage.check(border < 0.25 * count, "the copy has the part's faces, but for its border, which goes to creases")
    stage.check(caps(part).any() and abs(volume(hand) - whole) < 1e-6 * whole, "it is capped; the hand is as it was")
    part.matrix_world.translation += stage.view_3d.view_rotation @ Vector((-0.8, 0.3, 0))
    yield from stage.screenshot("2-copied")

    yield from enter(stage, hand)
    yield from finger(stage, 0.97, 0.62)
    gone = len(stage.selection())
    stage.mouse.key("X", shift=True, ctrl=True)
    yield from stage.until("the other finger is gone", lambda: len(stage.coordinates()) < len(stage.wheels.vertices))
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step brings it back, selected", lambda: stage.object.mode == "EDIT" and
                           len(stage.coordinates()) == len(stage.wheels.vertices) and len(stage.selection()) == gone)
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.until("and redo takes it away",
                           lambda: len(stage.coordinates()) < len(stage.wheels.vertices))
    stage.mouse.key("TAB")
    yield from stage.until("Object Mode", lambda: stage.object.mode == "OBJECT")
    hand, part = bpy.data.objects["hand"], bpy.data.objects["hand part"]
    border = abs((~caps(hand)).sum() - (len(stage.wheels.triangles) - gone))
    stage.check(border < 0.25 * gone, "only its faces are gone, but for its border")
    rest = volume(hand)
    stage.check(rest < 0.99 * whole, "the hand has lost a finger")
    yield from stage.screenshot("3-removed")

    yield from place_over(stage, part, hand, fit=True)
    yield from stage.screenshot("4-placed")
    placed = part.matrix_world.copy()
    yield from stage.adjusted()
    hand, part = bpy.data.objects["hand"], bpy.data.objects["hand part"]
    off = max(abs(a - b) for one, other in zip(placed, part.matrix_world) for a, b in zip(one, other))
    stage.check(off < 1e-4, "placed again by the panel of the last operation it is at the same place")
    yield from unite(stage, hand, part)
    stage.check(rest < volume(hand) < rest + 0.2 * whole, "the hand has a finger more")
    yield from stage.screenshot("5-united")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("one undo step brings both back",
                           lambda: "hand part" in bpy.data.objects and abs(volume(bpy.data.objects["hand"]) - rest)
                           < 1e-6 * whole)


def finger(stage, x, y):
    _, stops, start = yield from stage.pick(x, y)
    finger = next(i for i, part in enumerate(stops) if len(part) >= 0.05 * len(stage.wheels.triangles))
    stage.mouse.wheel(finger - start)
    yield from stage.selected(stops[finger], "the finger")
