"""Creates images for the docs in docs/images from the demo's layers: named wheel stops, cuts, and fill methods.

Run as: python docs.py FOLDER IMAGES
"""

import json
import math
import sys
from pathlib import Path

from paint import parts_cells, percent, sheet, ways_cells, wheel_cells

# Image -> model, click, and (name, approximate fraction of the model's area) of wheel stops.
STORIES = {
    "man": ("man-remeshed", "finger tip", (
        ("finger tip", 0.0012), ("finger", 0.005), ("hand", 0.02), ("arm", 0.079), ("body", 1.0))),
    "armadillo": ("armadillo", "finger tip", (
        ("finger tip", 0.0014), ("finger", 0.003), ("hand", 0.027), ("arm", 0.1), ("body", 1.0))),
}
CUTS = {"parts": ("armadillo", "dino")}
WAYS = {"ways": "armadillo"}
SLACK = 1.5  # the largest ratio between the area of a stop and that of the named part


def load(folder, model):
    own = folder / "layers" / model
    return json.loads((own / "report.json").read_text("utf-8")), own


def story(folder, model, click, names):
    report, own = load(folder, model)
    click = next(each for each in report["clicks"] if each["name"] == click)
    cells = wheel_cells(click, own)
    chosen = []
    for name, share in names:
        off = [abs(math.log(stop["area"] / share)) for stop in click["stops"]]
        best = off.index(min(off))
        if off[best] > math.log(SLACK):
            sys.exit(f"{model}: no wheel stop has about {percent(share)} of the area, so none is the {name}")
        chosen.append((cells[best][0], name, percent(click["stops"][best]["area"])))
    return sheet([("", "", chosen)])


def main():
    folder, images = map(Path, sys.argv[1:])
    images.mkdir(parents=True, exist_ok=True)
    pictures = {name: story(folder, *what) for name, what in STORIES.items()}
    for name, models in CUTS.items():
        pictures[name] = sheet([("", "", parts_cells(*load(folder, model))) for model in models])
    pictures |= {name: sheet([("", "", ways_cells(*load(folder, model)))]) for name, model in WAYS.items()}
    for name, picture in pictures.items():
        picture.save(images / f"{name}.jpg", quality=88, optimize=True)


if __name__ == "__main__":
    main()
