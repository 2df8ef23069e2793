"""Creates images for the docs in docs/images from the demo's layers: named wheel stops, parts, cuts, and fill methods.

Run as: python docs.py FOLDER IMAGES
"""

import json
import math
import sys
from pathlib import Path

from paint import convex_cells, parts_cells, percent, sheet, fill_method_cells, wheel_cells

# Wheel stops of a click on a fingertip of the man: name, approximate fraction of the model's area.
STOPS = ("fingertip", 0.0012), ("finger", 0.005), ("hand", 0.02), ("arm", 0.079), ("body", 1.0)
SLACK = 1.5  # the largest ratio between the area of a stop and that of the named part


def load(folder, model):
    """(report, folder) of a model's layers."""
    layer_folder = folder / "layers" / model
    return json.loads((layer_folder / "report.json").read_text("utf-8")), layer_folder


def story(folder, model, click, names):
    """The cells of a click's wheel stops that have these names and about these fractions of the area."""
    report, layer_folder = load(folder, model)
    click = next(candidate for candidate in report["clicks"] if candidate["name"] == click)
    cells = wheel_cells(click, layer_folder)
    named_cells = []
    for name, share in names:
        off = [abs(math.log(stop["area"] / share)) for stop in click["stops"]]
        best = off.index(min(off))
        if off[best] > math.log(SLACK):
            sys.exit(f"{model}: no wheel stop has about {percent(share)} of the area, as the {name} has")
        named_cells.append((cells[best][0], name, percent(click["stops"][best]["area"])))
    return named_cells


def main():
    folder, images = map(Path, sys.argv[1:])
    images.mkdir(parents=True, exist_ok=True)
    pictures = {"man": [story(folder, "man-remeshed", "fingertip", STOPS)], "truck": [parts_cells(*load(folder, "truck"))],
                "parts": [convex_cells(*load(folder, model)) for model in ("figure", "truck")],
                "fill_methods": [fill_method_cells(*load(folder, "figure"))]}
    for name, rows in pictures.items():
        sheet([("", "", cells) for cells in rows]).save(images / f"{name}.jpg", quality=88, optimize=True)


if __name__ == "__main__":
    main()
