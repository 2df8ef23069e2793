"""Features composed, as the arms in the paper's Figure 8: Homer's arms removed (X), an arm of the bear copied (C),
placed with its mirror image, united, and a part of the result picked."""
import bpy

from compose import activate, caps, closed, enter, picked_up_to, place_over, unite, volume


def play(stage):
    yield from stage.open("bear")
    yield from picked_up_to(stage, 0.02, 0.6, 0.03)
    yield from stage.screenshot("1-picked")
    bear = stage.object
    stage.mouse.key("C", shift=True, ctrl=True)
    yield from stage.until("the copy is there", lambda: stage.object != bear and stage.object.mode == "OBJECT")
    stage.check(closed(stage.object), "the copy is closed")
    yield from stage.screenshot("2-copied")
    arm = stage.object.data
    arm.use_fake_user = True

    yield from stage.open("homer")
    homer = stage.object
    whole, width = volume(homer), homer.dimensions.x
    # The arms, then the fingers that are no part of them: they are joined with the whole later than the arm is.
    for side, share in ((0.02, 0.08), (0.98, 0.08), (0.02, 0.001), (0.98, 0.001), (0.02, 0.001), (0.98, 0.001)):
        if homer.dimensions.x < 0.6 * width:
            break
        yield from picked_up_to(stage, side, 0.62, share)
        before = len(homer.data.polygons)
        stage.mouse.key("X", shift=True, ctrl=True)
        yield from stage.until("it is gone", lambda before=before: len(homer.data.polygons) != before)
        stage.select(())
        homer.update_from_editmode()
    stage.mouse.key("TAB")
    yield from stage.until("Object Mode", lambda: homer.mode == "OBJECT")
    stage.check(closed(homer) and volume(homer) < whole, "what is left is closed and smaller")
    stage.check(homer.dimensions.x < 0.6 * width, f"nothing of either arm is left ({homer.dimensions.x} of {width})")
    rest = volume(homer)
    yield from stage.screenshot("3-removed")

    part = bpy.data.objects.new("arm", arm)
    stage.window.scene.collection.objects.link(part)
    activate(stage, part)
    yield from place_over(stage, part, homer, fit=True, mirror=True)
    mirrored = next(obj for obj in bpy.data.objects if obj not in (homer, part))
    yield from stage.screenshot("4-placed")
    yield from unite(stage, homer, part, mirrored)
    stage.check(volume(homer) > rest and not caps(homer).all(), "Homer has arms again")
    yield from enter(stage, homer)
    stage.select(())
    yield from picked_up_to(stage, 0.02, 0.62, 0.01)
    stage.mouse.key("RET")
    yield from stage.screenshot("5-united-and-picked")
