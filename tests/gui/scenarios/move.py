"""Shift Ctrl G: Blender moves the part with proportional editing, which reaches by its size; Esc leaves the mesh as it
was."""
import numpy


def play(stage):
    yield from stage.open("hand")
    stage.select([3])
    settings = stage.window.scene.tool_settings
    settings.proportional_size = 1.37

    def proportional():
        return [getattr(settings, name) for name in dir(settings) if "proportional" in name]

    users = proportional()
    x, y, face = stage.spot(0.25, 0.84)
    stops, start = stage.wheels.stops(face)
    part = stops[start]
    before = stage.coordinates()

    for ending in ("ESC", "LEFTMOUSE"):
        stage.mouse.move(x, y)
        stage.shortcut("mesh.partwheel_select")
        yield from stage.selected(part, "after the start")
        stage.mouse.key("G", shift=True, ctrl=True)
        for modifier in ("LEFT_SHIFT", "LEFT_CTRL"):  # which Blender's tool takes for precise and for snapping meanwhile
            stage.mouse.release(modifier)
        yield from stage.settle()
        stage.mouse.move(x - 20, y + 10)
        stage.mouse.move(x - 80, y + 30)
        yield from stage.until("the part moves with the mouse", lambda: (stage.coordinates() != before).any())
        if ending == "ESC":
            yield from stage.screenshot("moving")
            stage.mouse.key("ESC")
            yield from stage.until("Esc puts the mesh back", lambda: (stage.coordinates() == before).all())
            yield from stage.ended()
            yield from stage.selected(part, "after Esc of the move")
            stage.check((stage.coordinates() == before).all(), "the mesh stays as it was")
            stage.mouse.key("Z", ctrl=True)
            yield from stage.selected({3}, "after one Ctrl Z")
        else:
            stage.mouse.click()
            yield from stage.ended()

    shift = stage.coordinates() - before
    moved = numpy.linalg.norm(shift, axis=1) / numpy.linalg.norm(shift, axis=1).max()
    inside = numpy.array(sorted(stage.elements(part, "verts")))
    outside = numpy.setdiff1d(numpy.arange(len(before)), inside)
    stage.check(numpy.ptp(shift[inside], axis=0).max() < 1e-5, "all of the part has moved alike")
    stage.check((moved[inside] > 0.999).all(), "and most of all")
    stage.check(((moved[outside] > 0.05) & (moved[outside] < 0.95)).sum() > 20, "its surroundings have followed")
    # As far as half the square root of the part's area, not as far as the user's own setting. (Blender's ways along the
    # surface are some percent too short.)
    scale = stage.object.matrix_world.median_scale
    corners = before[stage.wheels.triangles[list(part)]] * scale
    sides = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    reach = 0.5 * numpy.sqrt(numpy.linalg.norm(sides, axis=1).sum() / 2)
    follows = outside[moved[outside] > 1e-4]
    gaps = numpy.linalg.norm(before[follows][:, None] - before[inside], axis=2).min(axis=1) * scale
    stage.check(0.5 * reach < gaps.max() < 1.15 * reach, f"they follow up to {reach} ({gaps.max()})")
    settings = stage.window.scene.tool_settings
    yield from stage.until("the user's own settings of proportional editing are as they were",
                           lambda: proportional() == users)

    after = stage.coordinates()
    stage.mouse.key("Z", ctrl=True)
    yield from stage.until("Ctrl Z takes the move back", lambda: (stage.coordinates() == before).all())
    yield from stage.selected(part, "after that Ctrl Z")
    stage.mouse.key("Z", ctrl=True)
    yield from stage.selected({3}, "after a second Ctrl Z")
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.selected(part, "after Shift Ctrl Z")
    stage.mouse.key("Z", ctrl=True, shift=True)
    yield from stage.until("Shift Ctrl Z moves again", lambda: (stage.coordinates() == after).all())
