"""Combines perform.py's layers into the demo's images: colors them, arranges them in rows, labels them.

Run as: python paint.py FOLDER MODEL...   For each model it writes FOLDER/MODEL.png, a row for each click with its wheel
stops; and FOLDER/MODEL-parts.png, the model, its automatic segmentation, and the objects made of it.
"""

import json
import sys
from pathlib import Path

import numpy
from PIL import Image, ImageDraw, ImageFont

import layers
from layers import OVERSAMPLING

BACKDROP, BODY, PART, ADDED, EDGE = "#eceff3", "#c3c8cf", "#e4602a", "#f59a55", "#6b2408"
PALETTE = ("#ef7f5f", "#63b3e4", "#f3bd4f", "#74c794", "#b795dd", "#f29bb8", "#56bcb6", "#cfca62", "#8fa3f2", "#dd9a5c",
           "#86c5d8", "#a9da7f", "#d987c4")
INK, QUIET = "#23282f", "#7b838d"
EXPOSURE = 1.15
GAP, LABEL, HEAD = 6, 50, 52  # pixels between pictures, below them, above the row


def linear(color):
    """(3,) linear light of an sRGB color, "#rrggbb"."""
    value = numpy.array([int(color[i:i + 2], 16) for i in (1, 3, 5)]) / 255.0
    return numpy.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4).astype(numpy.float32)


def develop(light):
    """Linear light -> 8-bit sRGB. Highlights are compressed instead of clipped."""
    knee = 0.75
    light = numpy.where(light < knee, light, 1.0 - (1.0 - knee) * numpy.exp((knee - light) / (1.0 - knee)))
    value = numpy.where(light <= 0.0031308, 12.92 * light, 1.055 * numpy.maximum(light, 0.0031308) ** (1 / 2.4) - 0.055)
    return (value * 255.0 + 0.5).astype(numpy.uint8)


def paint(picture, colors):
    """Combines layers into an Image. colors: (h, w, 3) linear; ignored at pixels of the backdrop."""
    colors = numpy.where(picture.shown[..., None] < 0, linear(BACKDROP), colors)
    light = picture.light * colors * EXPOSURE + picture.gloss
    height, width = (side // OVERSAMPLING for side in picture.shown.shape)
    return Image.fromarray(develop(light.reshape(height, OVERSAMPLING, width, OVERSAMPLING, 3).mean((1, 3))))


def edges(ids, is_model):
    """(h, w) bool: pixels of the model next to pixels of the model with another id."""
    is_edge = numpy.zeros(ids.shape, bool)
    for axis in (0, 1):
        after = [slice(None), slice(None)]
        before = [slice(None), slice(None)]
        after[axis], before[axis] = slice(1, None), slice(None, -1)
        after, before = tuple(after), tuple(before)
        differ = (ids[after] != ids[before]) & is_model[after] & is_model[before]
        is_edge[after] |= differ
        is_edge[before] |= differ
    return is_edge


def paint_stop(picture, entered, stop):
    """entered: (faces,) the first stop that contains each face. Faces added by the last notch are lighter."""
    first_stop = entered[picture.shown]
    colors = numpy.where((first_stop <= stop)[..., None], linear(PART), linear(BODY))
    if stop:
        colors = numpy.where((first_stop == stop)[..., None], linear(ADDED), colors)
    colors = numpy.where(edges(first_stop <= stop, picture.shown >= 0)[..., None], linear(EDGE), colors)
    return paint(picture, colors)


def paint_parts(picture, parts, palette):
    """parts: (h, w) the part that each pixel shows; ignored at the backdrop."""
    colors = palette[parts]
    return paint(picture, numpy.where(edges(parts, picture.shown >= 0)[..., None], colors * 0.45, colors))


def palettes(cuts):
    """For each cut (coarse to fine), the linear colors of its parts. The largest piece of a coarser part keeps its
    color, so that the eye can follow it; the other pieces get new colors."""
    colors, count = [], 0
    for number, cut in enumerate(cuts):
        bounds = numpy.array(cut["bounds"])
        sizes = numpy.diff(bounds)
        part_colors = [None] * len(sizes)
        if number:
            coarse = numpy.array(cuts[number - 1]["bounds"])
            coarse_part = numpy.searchsorted(coarse, bounds[:-1], side="right") - 1
            for owner in range(len(coarse) - 1):
                inside = numpy.flatnonzero(coarse_part == owner)
                if len(inside):
                    part_colors[inside[numpy.argmax(sizes[inside])]] = colors[-1][owner]
        for part in range(len(sizes)):
            if part_colors[part] is None:
                part_colors[part] = linear(PALETTE[count % len(PALETTE)])
                count += 1
        colors.append(part_colors)
    return [numpy.array(part_colors, numpy.float32) for part_colors in colors]


def font(size):
    return ImageFont.load_default(size)


def ring(image, at):
    """Draws a ring at the clicked point (x, y), 0..1."""
    size, scale = 16, 4
    left, top = round(at[0] * image.width - size / 2), round(at[1] * image.height - size / 2)
    for color, margin, line in ((INK, 1.0, 4.0), ("#ffffff", 2.0, 2.0)):
        mark = Image.new("L", (size * scale, size * scale))
        box = margin * scale, margin * scale, (size - margin) * scale, (size - margin) * scale
        ImageDraw.Draw(mark).ellipse(box, outline=255, width=round(line * scale))
        image.paste(color, (left, top), mark.resize((size, size), Image.LANCZOS))


def sheet(rows):
    """Arranges rows of images. rows: [(title or "", heading, [(Image, label, remark)])]."""
    width = max(sum(image.width + GAP for image, _, _ in cells) for _, _, cells in rows) + GAP
    height = GAP + sum((HEAD if title else 0) + cells[0][0].height + LABEL for title, _, cells in rows)
    page = Image.new("RGB", (width, height), "#ffffff")
    draw = ImageDraw.Draw(page)
    top = GAP
    for title, heading, cells in rows:
        left = GAP + 6
        if title:
            draw.text((left, top + 7), title, INK, font(24))
            draw.text((left + draw.textlength(title, font(24)) + 16, top + 13), heading, QUIET, font(17))
            top += HEAD
        left = GAP
        for image, label, remark in cells:
            page.paste(image, (left, top))
            middle = left + image.width / 2
            draw.text((middle, top + image.height + 15), label, INK, font(16), anchor="mm")
            draw.text((middle, top + image.height + 35), remark, QUIET, font(13), anchor="mm")
            left += image.width + GAP
        top += cells[0][0].height + LABEL
    return page


def percent(share):
    return f"{100 * share:.0f} %" if share >= 0.095 else f"{100 * share:.1f} %" if share >= 0.00095 else "< 0.1 %"


def wheel_cells(click, folder):
    """The cells of every wheel stop of a click."""
    views = [layers.load(folder / "whole.npz")]
    views += [layers.load(folder / f"{click['name']}-{number}.npz") for number in range(1, len(click["views"]))]
    entered = numpy.load(folder / f"{click['name']}.npy")
    cells = []
    for number, stop in enumerate(click["stops"]):
        view = click["views"][stop["view"]]
        image = paint_stop(views[stop["view"]], entered, number)
        ring(image, view["clicked"])
        if stop["view"]:
            ImageDraw.Draw(image).text((image.width - 10, 10), f"{view['closer']:.1f} x", INK, font(13), "ra")
        label = f"{click['hidden'] + number + 1} / {click['hidden'] + len(click['stops'])}" + ("  the click" if number == click["start"] else "")
        faces = "1 face" if stop["faces"] == 1 else f"{stop['faces']:,} faces"
        cells.append((image, label, f"{faces}, {percent(stop['area'])}"))
    return cells


def parts_cells(report, folder):
    """The cells of the model, its automatic segmentation, and its parts as objects, moved apart."""
    whole, apart = layers.load(folder / "whole.npz"), layers.load(folder / "apart.npz")
    colors, labels = numpy.load(folder / "colors.npy"), numpy.load(folder / "labels.npy")
    palette = numpy.array([linear(color) for color in PALETTE])
    shells = f" in {report['shells']} shells" if report["shells"] > 1 else ""
    return [(paint(whole, colors[whole.shown]), "the model", f"{report['faces']:,} faces{shells}"),
            (paint_parts(whole, labels[whole.shown], palette[numpy.arange(labels.max() + 1) % len(palette)]),
             "Parts to...", f"{labels.max() + 1} parts"),
            (paint(apart, numpy.load(folder / "apart-colors.npy")[apart.shown]), "Enter", f"{report['parts']} closed objects")]


def convex_cells(report, folder):
    """The cells of the model and its cuts into convex parts, from fine to coarse."""
    cells = []
    for cut, palette in zip(report["cuts"], palettes(report["cuts"])):
        picture = layers.load(folder / f"hulls-{cut['parts']}.npz")
        cells.append((paint_parts(picture, picture.shown, palette), f"{cut['parts']} convex parts", f"{cut['polygons']:,} faces"))
    body = layers.load(folder / "whole.npz")
    cells.append((paint(body, linear(BODY)), "the model", f"{report['faces']:,} faces"))
    return cells[::-1]


def fill_method_cells(report, folder):
    """The cells of the model's parts: filled exactly, filled from points, found on a coarser copy."""
    body = layers.load(folder / "whole.npz")
    names = {"exact": "exactly", "points": "from points", "coarse": "on a coarser copy"}
    palette, cells = numpy.array([linear(color) for color in PALETTE]), []
    for build in report["fill_methods"]:
        parts = numpy.load(folder / f"filled-{build['name']}.npy") % len(PALETTE)
        cells.append((paint_parts(body, parts[body.shown], palette), names[build["name"]],
                      f"{build['parts']} parts, of {build['tetrahedra']:,} tetrahedra"))
    return cells


def main():
    folder = Path(sys.argv[1])
    for name in sys.argv[2:]:
        layer_folder = folder / "layers" / name
        report = json.loads((layer_folder / "report.json").read_text("utf-8"))
        wheel = [(name, f"one click on the {click['name']}, then the wheel", wheel_cells(click, layer_folder))
                 for click in report["clicks"]]
        sheet(wheel).save(folder / f"{name}.png", optimize=True)
        if "parts" in report:
            sheet([(name, "its parts", parts_cells(report, layer_folder))]).save(folder / f"{name}-parts.png", optimize=True)


if __name__ == "__main__":
    main()
