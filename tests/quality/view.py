# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a click follows the view: chooses the constants of start_in_view() (native/src/tree/dendrogram.cpp) by fourfold
cross-validation over the categories of the Princeton Segmentation Benchmark.

usage: view.py MESH_DIR SEG_DIR [--every 2] [--clicks 100]

A click is a face, by area, that looks toward a random viewer, and the segment of a person that contains it. That segment
fills 10 to 50 % of the view, and the view is no wider than the model. Prints the mean overlap at the click and within two
notches, without the view, with the library's constants, and with those of the other folds. Then, with the library's constants,
how many clicks take a sliver (less than 0.1 % of the area, or fewer than 12 of 5,000 faces or more): in these views, where the
segment fills 50 to 200 %, and where 3 % of the model does.
"""

import argparse
import itertools
import os
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
from psb import build

SHARES = (0.3, 0.35, 0.4, 0.45, 0.5, 0.6, 0.7)
WEIGHTS = (0.1, 0.25, 0.4, 0.5, 0.6, 0.8, 1.0)
LIBRARY = (0.5, 0.6)
MIN_RELATIVE_SCORE = 0.3
FOLDS = 4


def clicks_of(path, segmentations, count):
    """[(overlaps, scores, extents, is_sliver, start, views)] of the stops of each click; extents and views are lengths."""
    mesh, hierarchy = build(path, 0)
    corners = mesh.vertices[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    people = [np.loadtxt(file, int) for file in sorted((segmentations / path.stem).glob("*.seg"))]
    random = np.random.default_rng(int(path.stem))

    def extent(faces):
        points = corners[faces].reshape(-1, 3)
        return np.linalg.norm(np.ptp(points, axis=0))

    def extent_of_stop(node, known={}):  # noqa: B006  (a cache of this model)
        if node not in known:
            known[node] = extent(hierarchy.faces(node))
        return known[node]

    whole, result = extent(slice(None)), []
    while len(result) < count and people:
        face = random.choice(len(areas), p=areas / areas.sum())
        if normals[face] @ random.normal(size=3) <= 0:
            continue
        segment = people[random.integers(len(people))]
        target = segment == segment[face]
        stops, start = hierarchy.wheel(face)
        overlaps = []
        for stop in stops:
            faces = hierarchy.faces(stop)
            common = areas[faces][target[faces]].sum()
            overlaps.append(common / (areas[faces].sum() + areas[target].sum() - common))
        size = extent(target)
        views = np.minimum([size / random.uniform(0.1, 0.5), size / 2 ** random.uniform(-1, 1), 0.03 * whole], whole)
        counts = np.array([len(hierarchy.faces(stop)) for stop in stops])
        is_sliver = (hierarchy.area[stops] < 0.001 * hierarchy.area[-1]) | (counts < 12) & (len(areas) >= 5000)
        result.append((np.array(overlaps), hierarchy.score[stops], np.array([extent_of_stop(s) for s in stops]), is_sliver,
                       start, views))
    return result


def overlaps_at(clicks, constants=None):
    """(n, 2): the overlap at each click, and the best within two notches."""
    rows = []
    for overlaps, scores, extents, _, start, views in clicks:
        if constants:
            start = start_in_view(scores, extents, views[0], *constants)
        rows.append((overlaps[start], overlaps[max(start - 2, 0):start + 3].max()))
    return np.array(rows)


def start_in_view(scores, extents, view, share, weight):
    """The stop that a click takes."""
    values = scores - weight * np.log(extents / view / share) ** 2
    return int(np.argmax(np.where(scores >= MIN_RELATIVE_SCORE * scores.max(), values, -np.inf)))


def sliver_shares(clicks):
    """The share of the clicks that take a sliver, in each of their views."""
    return np.mean([[is_sliver[start_in_view(scores, extents, view, *LIBRARY)] for view in views]
                    for _, scores, extents, is_sliver, _, views in clicks], axis=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path)
    parser.add_argument("segmentations", type=Path)
    parser.add_argument("--every", type=int, default=2, help="take every N-th model")
    parser.add_argument("--clicks", type=int, default=100, help="on each model")
    args = parser.parse_args()
    paths = sorted(args.meshes.glob("*.off"), key=lambda path: int(path.stem))[::args.every]
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        clicks = list(pool.map(partial(clicks_of, segmentations=args.segmentations, count=args.clicks), paths))
    fold = np.array([(int(path.stem) - 1) // 20 % FOLDS for path in paths])
    grid = {constants: np.array([overlaps_at(c, constants).mean(axis=0) for c in clicks])
            for constants in itertools.product(SHARES, WEIGHTS)}

    def show(name, means):
        print(f"{name:34} {means[0]:.3f} {means[1]:.3f}")

    print(f"{len(paths)} models, {sum(map(len, clicks))} clicks: overlap at the click, within two notches")
    show("without the view", np.mean([overlaps_at(c).mean(axis=0) for c in clicks], axis=0))
    show(f"share {LIBRARY[0]}, weight {LIBRARY[1]}: the library", grid[LIBRARY].mean(axis=0))
    held_out = np.empty((len(paths), 2))
    for k in range(FOLDS):
        best = max(grid, key=lambda constants: grid[constants][fold != k, 0].mean())
        held_out[fold == k] = grid[best][fold == k]
        print(f"  fold {k}: share {best[0]}, weight {best[1]}")
    show("constants of the other folds", held_out.mean(axis=0))
    for constants in sorted(grid, key=lambda constants: -grid[constants][:, 0].mean())[:12]:
        show(f"share {constants[0]}, weight {constants[1]}", grid[constants].mean(axis=0))
    shares = np.mean([sliver_shares(c) for c in clicks], axis=0)
    print("slivers in the usual, the closer and the closest views:", " ".join(f"{share:.2%}" for share in shares))


if __name__ == "__main__":
    main()
