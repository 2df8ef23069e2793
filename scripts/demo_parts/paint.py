"""Draws the demo's images from what perform.py saved, arranges them in rows, labels them.

Run as: python paint.py FOLDER MODEL...   For each model it writes FOLDER/MODEL.png, a row for each click with its wheel
stops; and FOLDER/MODEL-parts.png, the model, its automatic segmentation, and the objects made of it.

Run as: python paint.py FOLDER --docs IMAGES   It writes images for the docs: named wheel stops, parts, cuts, and fill methods.
"""

import json
import math
import sys
from pathlib import Path

import numpy
from PIL import Image, ImageDraw, ImageFont, ImageOps

from models import MODELS

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests" / "quality"))

from pictures import View  # noqa: E402

from partwheel import meshes  # noqa: E402
from partwheel.cut import colors  # noqa: E402

BODY, PART, ADDED = map(numpy.array, ((0.76, 0.78, 0.81), (0.89, 0.38, 0.16), (0.96, 0.6, 0.33)))
INK, QUIET = "#23282f", "#7b838d"
SIZE = 300  # of an image, in pixels
GAP, LABEL, HEAD = 6, 50, 52  # pixels between pictures, below them, above the row
CLOSE_UP = 0.17  # a part whose size is a smaller fraction of the image's gets a close-up
# Wheel stops of a click on a fingertip of the man: name, approximate fraction of the model's area.
STOPS = ("fingertip", 0.0012), ("finger", 0.005), ("hand", 0.02), ("arm", 0.079), ("body", 1.0)
SLACK = 1.5  # the largest ratio between the area of a stop and that of the named part


class Performance:
    """What perform.py saved of a model."""

    def __init__(self, folder, name):
        self.name, self.direction = name, MODELS[name].view
        self.report = json.loads((folder / f"{name}.json").read_text("utf-8"))
        self.arrays = numpy.load(folder / f"{name}.npz")
        self.mesh = meshes.Mesh(*(self.arrays[key] for key in ("vertices", "triangles", "faces")), self.report["faces"], 0)
        self.whole = self.view(self.mesh)

    def view(self, mesh, focus=None):
        return View(mesh, self.direction, (0, 0, 1), SIZE, focus, soft=True)

    def view_bodies(self, name):
        """The View of surfaces from save_bodies(), of which each triangle is a face."""
        return self.view(meshes.triangle_mesh(self.arrays[f"{name}_vertices"], self.arrays[f"{name}_triangles"]))


def paint(view, colors):
    """An Image. colors : (faces, 3) or (3,)"""
    colors = numpy.broadcast_to(colors, (view.face.max() + 1, 3)) if numpy.ndim(colors) == 1 else colors
    return Image.fromarray((255 * view.painted(colors) ** 0.65).astype(numpy.uint8))


def font(size):
    return ImageFont.load_default(size)


def sheet(rows):
    """Arranges rows of images, without the white above and below. rows: [(title or "", heading, [(Image, label, remark)])]."""
    rows = [(title, heading, trim(cells)) for title, heading, cells in rows]
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


def trim(cells):
    """The cells with images of the height that the highest content has."""
    boxes = [ImageOps.invert(image).getbbox() for image, _, _ in cells]
    low, high = min(box[1] for box in boxes), max(box[3] for box in boxes)
    return [(image.crop((0, low, image.width, high)), *texts) for image, *texts in cells]


def percent(share):
    return f"{100 * share:.0f} %" if share >= 0.095 else f"{100 * share:.1f} %" if share >= 0.00095 else "< 0.1 %"


def wheel_cells(performance, click):
    """The cells of every wheel stop of a click, small parts in close-ups; faces that the last notch added are lighter."""
    entered, mesh, view = performance.arrays[click["name"]], performance.mesh, performance.whole
    cells = []
    for number, stop in reversed(list(enumerate(click["stops"]))):
        part = mesh.vertices[mesh.triangles[entered[mesh.faces] <= number]].reshape(-1, 3)
        size = numpy.ptp(part @ view.axes.T, axis=0)[:2].max()
        if size < CLOSE_UP * view.width:
            middle = part.mean(axis=0)
            view = performance.view(mesh, middle + 2.6 * (part - middle))
        shade = numpy.where(entered[:, None] <= number, PART, BODY)
        shade[entered == number] = ADDED if number else PART
        image = paint(view, shade)
        draw, (x, y) = ImageDraw.Draw(image), (SIZE * share for share in view.place(click["point"]))
        for color, radius in ((INK, 8), ("#ffffff", 7)):
            draw.ellipse((x - radius, y - radius, x + radius, y + radius), outline=color, width=2)
        if view is not performance.whole:
            draw.text((SIZE - 10, 10), f"{performance.whole.width / view.width:.1f} x", INK, font(13), "ra")
        label = f"{click['hidden'] + number + 1} / {click['hidden'] + len(click['stops'])}"
        faces = "1 face" if stop["faces"] == 1 else f"{stop['faces']:,} faces"
        cells.append((image, label + "  the click" * (number == click["start"]), f"{faces}, {percent(stop['area'])}"))
    return cells[::-1]


def parts_cells(performance):
    """The cells of the model, its automatic segmentation, and its parts as objects, moved apart."""
    report, arrays = performance.report, performance.arrays
    shells = f" in {report['shells']} shells" if report["shells"] > 1 else ""
    return [(paint(performance.whole, arrays["colors"]), "the model", f"{report['faces']:,} faces{shells}"),
            (paint(performance.whole, colors(arrays["labels"])), "Parts to...", f"{arrays['labels'].max() + 1} parts"),
            (paint(performance.view_bodies("apart"), arrays["apart_colors"]), "Enter", f"{report['parts']} closed objects")]


def follow_parts(cuts):
    """For each cut (coarse to fine), numbers of its parts for colors(). The largest piece of a coarser part keeps its number, so
    that the eye can follow it; the other pieces get new ones."""
    results, coarse, before, count = [], numpy.zeros(1), [], 0
    for bounds in (numpy.array(cut["bounds"]) for cut in cuts):
        owners = numpy.searchsorted(coarse, bounds[:-1], side="right") - 1
        numbers = numpy.full(len(owners), -1)
        for owner, number in enumerate(before):
            inside = numpy.flatnonzero(owners == owner)
            numbers[inside[numpy.diff(bounds)[inside].argmax()]] = number
        numbers[numbers < 0] = count + numpy.arange((numbers < 0).sum())
        results.append(numbers)
        coarse, before, count = bounds, numbers, numbers.max() + 1
    return results


def convex_cells(performance):
    """The cells of the model and its cuts into convex parts, from fine to coarse."""
    cells = []
    for cut, numbers in zip(performance.report["cuts"], follow_parts(performance.report["cuts"])):
        name = f"hulls{cut['parts']}"
        bodies = performance.arrays[f"{name}_bodies"]
        cells.append((paint(performance.view_bodies(name), colors(numbers[bodies])), f"{cut['parts']} convex parts",
                      f"{len(bodies):,} faces"))
    return [(paint(performance.whole, BODY), "the model", f"{performance.report['faces']:,} faces"), *cells[::-1]]


def fill_method_cells(performance):
    """The cells of the model's parts: filled exactly, filled from points, found on a coarser copy."""
    names = {"exact": "exactly", "points": "from points", "coarse": "on a coarser copy"}
    return [(paint(performance.whole, colors(performance.arrays[f"filled_{build['name']}"])), names[build["name"]],
             f"{build['parts']} parts, of {build['tetrahedra']:,} tetrahedra") for build in performance.report["fill_methods"]]


def named_cells(performance, names):
    """The cells of a click's wheel stops that have these names and about these fractions of the area."""
    click, result = performance.report["clicks"][0], []
    cells = wheel_cells(performance, click)
    for name, share in names:
        off = [abs(math.log(stop["area"] / share)) for stop in click["stops"]]
        best = off.index(min(off))
        if off[best] > math.log(SLACK):
            sys.exit(f"{performance.name}: no wheel stop has about {percent(share)} of the area, as the {name} has")
        result.append((cells[best][0], name, percent(click["stops"][best]["area"])))
    return result


def draw_docs(folder, images):
    man, figure, truck = (Performance(folder, name) for name in ("man-remeshed", "figure", "truck"))
    pictures = {"man": [named_cells(man, STOPS)], "truck": [parts_cells(truck)],
                "parts": [convex_cells(figure), convex_cells(truck)], "fill_methods": [fill_method_cells(figure)]}
    for name, rows in pictures.items():
        sheet([("", "", cells) for cells in rows]).save(images / f"{name}.jpg", quality=88, optimize=True)


def main():
    folder, *names = sys.argv[1:]
    folder = Path(folder)
    if names[0] == "--docs":
        draw_docs(folder, Path(names[1]))
        return
    for performance in (Performance(folder, name) for name in names):
        sheet([(performance.name, f"one click on the {click['name']}, then the wheel", wheel_cells(performance, click))
               for click in performance.report["clicks"]]).save(folder / f"{performance.name}.png", optimize=True)
        if "parts" in performance.report:
            parts = sheet([(performance.name, "its parts", parts_cells(performance))])
            parts.save(folder / f"{performance.name}-parts.png", optimize=True)


if __name__ == "__main__":
    main()
