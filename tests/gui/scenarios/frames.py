"""An animated hand in Object Mode: after playback, and after each new frame, hover and a click take the part that is seen
there; what is held is drawn where it is seen, also in another frame."""
import bpy
import numpy
from scenarios.modes import hover
from scenarios.visible_surface import shown

LAST = 40


def play(stage):
    yield from stage.open("hand")
    with stage.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    positions, across, scene = stage.wheels.vertices, float(numpy.ptp(stage.wheels.vertices, axis=0).max()), stage.window.scene
    modifier = stage.object.modifiers.new("away", "DISPLACE")
    modifier.direction, modifier.mid_level = "X", 0
    modifier.driver_add("strength").driver.expression = f"frame / {LAST} * {0.4 * across}"
    scene.frame_start, scene.frame_end = 1, LAST
    scene.frame_set(1)
    stage.use_tool()
    highlight, prepared = stage.part("pick.hover").highlight, stage.part("pick.view_cache")

    def seen_now():
        stage.wheels.vertices = shown(stage.object)

    def picked(when):
        """Hover and a click at the same share of the model, wherever it is seen now."""
        seen_now()
        yield from stage.wait_for_redraw()
        x, y, face = stage.spot(0.5, 0.9, above=1)
        stops, start = stage.wheels.stops(face)
        stage.mouse.move(x - 3, y)
        yield from hover(stage, x, y)
        yield from stage.until(f"hover shows the part that is seen ({when})", lambda: stage.hovered() == stops[start])
        stage.mouse.click()
        yield from stage.until(f"it is held ({when})", lambda: stage.overlay_faces() == stops[start])
        yield from stage.screenshot(f"held-{when}")
        stage.mouse.key("RET")
        yield from stage.until(f"it is highlighted ({when})", lambda: highlight.target is not None
                               and set(highlight.target[2].tolist()) == set(stops[start]))

    yield from picked("first")
    for frame in (2, 3):
        stage.mouse.key("RIGHT_ARROW")
        yield from stage.until("the next frame is shown", lambda: scene.frame_current == frame)
    yield from picked("third")

    stage.mouse.key("SPACE")
    yield from stage.until("it plays", lambda: stage.window.screen.is_animation_playing and scene.frame_current > LAST // 2)
    stage.check(not prepared.is_at_rest(), "the add-on knows that it plays, and makes nothing for hovering")
    stage.mouse.key("SPACE")
    yield from stage.until("it stands", lambda: not stage.window.screen.is_animation_playing)
    yield from picked("played")

    # A part is held while the frame changes.
    seen_now()
    x, y, face = stage.spot(0.5, 0.9, above=1)
    stops, start = stage.wheels.stops(face)
    stage.mouse.move(x, y)
    with stage.override():
        bpy.ops.object.partwheel_select("INVOKE_DEFAULT")
    yield from stage.until("a part is held", lambda: stage.overlay_faces() == stops[start])
    frame = scene.frame_current = LAST if scene.frame_current < LAST // 2 else 1
    yield from stage.wait_for_redraw()
    stage.mouse.move(x + 1, y)
    seen_now()
    yield from stage.until(f"it is drawn where it is seen in frame {frame}", lambda: numpy.allclose(
        stage.part("pick.display").pick_display._target[1].positions, stage.wheels.vertices, atol=1e-5))
    yield from stage.screenshot("held-elsewhere")
    stage.mouse.key("ESC")
    stage.wheels.vertices = positions
    stage.check(stage.object.mode == "OBJECT", "Esc leaves all as it was")
    yield from stage.settle()
