"""What is drawn over the model: the part, the next notch, the hull, all parts; and nothing once it is over."""
import bpy
import numpy
from view import picture

ENOUGH = 10  # faces to look at


def play(stage):
    yield from stage.open("homer")
    settings = stage.part("preferences").preferences()
    for line_width in ("THICK", "AUTO"):  # the first change moves the borders of areas by a few pixels for good
        bpy.context.preferences.view.ui_line_width = line_width
        yield from stage.settle()
    plain = picture((yield from stage.screenshot("0-plain")))
    _, stops, start = yield from stage.pick(0.95, 0.6, above=2)
    level = next(level for level in range(start + 1, len(stops) - 1)
                 if min(len(seen(stage, faces)) for faces in (stops[level], stops[level + 1] - stops[level])) > ENOUGH)
    stage.mouse.wheel(level - start)
    part, larger = stops[level], stops[level + 1]
    yield from stage.selected(part, f"after {level - start} notches")
    settings.show_part = False
    yield from tinted(stage, plain, larger - part, "1-next", lambda change: change[2] - change[0] > 0.05)
    settings.show_next = False
    bare = picture((yield from stage.screenshot("2-none")))
    settings.show_part = True
    yield from tinted(stage, bare, part, "3-part", lambda change: change[0] - change[2] > 0.02)
    settings.show_part, settings.show_hull = False, True
    hull = picture((yield from stage.screenshot("4-hull")))
    stage.check(changed(hull, bare) > 500, "the hull is drawn")
    settings.show_hull, settings.show_cut = False, True
    cut = picture((yield from stage.screenshot("5-cut")))
    stage.check(changed(cut, bare) > 10000, "all parts are drawn")
    settings.show_cut, settings.show_part, settings.show_next = False, True, False

    yield from outlined(stage)
    shading = stage.area.spaces.active.shading
    for name, kind, more in (("xray", "SOLID", {"show_xray": True}), ("wireframe", "WIREFRAME", {}),
                             ("matcap", "SOLID", {"light": "MATCAP"}), ("material", "MATERIAL", {})):
        shading.type = kind
        before = {name_of_setting: getattr(shading, name_of_setting) for name_of_setting in more}
        for name_of_setting, value in more.items():
            setattr(shading, name_of_setting, value)
        yield from outlined(stage, f"9-{name}")
        for name_of_setting, value in before.items():
            setattr(shading, name_of_setting, value)
    shading.type = "SOLID"
    settings.show_next = True

    stage.area.spaces.active.overlay.show_overlays = False
    stage.check(stage.drawn_things() == 1, "the overlay is on")
    hidden = picture((yield from stage.screenshot("6-overlays-off")))
    colors = inside(stage, hidden, larger - part)
    stage.check(numpy.abs(colors[:, 0] - colors[:, 2]).mean() < 0.02, "with Blender's overlays off nothing is tinted")
    stage.area.spaces.active.overlay.show_overlays = True
    stage.mouse.key("RET")
    yield from stage.ended()
    stage.check(stage.drawn_things() == 0, "nothing is drawn after Enter")
    after = picture((yield from stage.screenshot("7-after")))
    rest = inside(stage, after, larger - part) - inside(stage, plain, larger - part)
    stage.check(numpy.abs(rest).mean() < 0.02, "the model looks as before")


def outlined(stage, name="8-outline"):
    """The part has an outline, which is as wide as the screen wants it."""
    overlay, view = stage.part("view.overlay"), bpy.context.preferences.view
    make_layers, widths = overlay._make_line_layers, []
    for line_width in ("THIN", "THICK") if name == "8-outline" else ("AUTO",):
        view.ui_line_width = line_width
        yield from stage.settle()
        outline = picture((yield from stage.screenshot(f"{name}-{line_width}")))
        overlay._make_line_layers = lambda *_: []
        overlay.redraw_views()
        plain = picture((yield from stage.screenshot(f"{name}-{line_width}-without")))
        overlay._make_line_layers = make_layers
        overlay.redraw_views()
        differs = numpy.abs(outline - plain).max(axis=2) > 0.1
        runs = numpy.diff(numpy.flatnonzero(numpy.diff(numpy.pad(differs, ((0, 0), (1, 1))).ravel().astype(int))))[::2]
        widths.append(float(numpy.median(runs)) if len(runs) else 0)
        stage.check(differs.sum() > 200, f"{name}: outlined, by {differs.sum()} pixels, {widths[-1]} wide")
    view.ui_line_width = "AUTO"
    stage.check(len(widths) < 2 or 0 < widths[0] < widths[1] < 20, f"{name}: wider where lines are, {widths}")


def seen(stage, faces):
    """(n,2) the pixels of the centers of the faces that can be seen, or of some of them."""
    faces = sorted(faces)
    return stage.view.visible_centers(faces[::len(faces) // 150 + 1]).round().astype(int)


def inside(stage, pixels, faces):
    """(n,3) colors at the centers of the faces that can be seen."""
    centers = seen(stage, faces)
    return pixels[centers[:, 1], centers[:, 0], :3]


def tinted(stage, before, faces, name, holds):
    pixels = picture((yield from stage.screenshot(name)))
    change = (inside(stage, pixels, faces) - inside(stage, before, faces)).mean(axis=0)
    stage.check(holds(change), f"{name}: tinted, by {change}")


def changed(a, b):
    """How many pixels differ."""
    return int((numpy.abs(a - b).max(axis=2) > 0.04).sum())
