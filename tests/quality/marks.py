#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How well shells, patches of one material and limbs can be selected if borders of materials are passed as marks.

usage: tests/quality/marks.py SCORE ASSETS [--fused] [--strength S | --colors face|vertex [--seed K]] [--every N] [--mirror]
(partwheel importable; numpy, scipy)

SCORE: the folder of score.py, whose targets and measures are used: overlap of the wheel's best stop, at the click, within two
notches. ASSETS: models as score.py takes them. --strength: of the marks; 0: no marks. --colors: materials are passed as noisy
colors instead, of faces, as a texture has them, or of vertices, which are blurred where vertices are shared. --seed: of the noise.
--every: takes only each Nth model. --mirror: also prints, of symmetric models, the share of clicks and of nodes that have their mirror image on the
other side (mirror.py).
"""

import argparse
import colorsys
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import mirror
import numpy as np
from partwheel import Hierarchy, Marks, PartwheelError
from partwheel.appearance import to_linear
from partwheel.marks import find_face_pairs, marks_of_colors, mean_over_faces

COLOR_NOISE = 0.04  # standard deviation of each sRGB value


def material_borders(vertices, triangles, materials):
    """(n, 2) the edges between triangles of different materials; vertices at the same place count as one."""
    place = np.unique(vertices, axis=0, return_inverse=True)[1].ravel()
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    ends = np.sort(place[edges], axis=1)
    order = np.lexsort(ends.T)
    ends, edges, sides = ends[order], edges[order], np.repeat(materials, 3)[order]
    return edges[1:][(ends[1:] == ends[:-1]).all(axis=1) & (sides[1:] != sides[:-1])]


def color_marks(vertices, triangles, areas, materials, of_vertices, seed):
    """The Marks of noisy colors, a hue for each material. of_vertices: a vertex has the mean of its triangles' colors."""
    hues = np.array([colorsys.hsv_to_rgb(0.618 * number % 1, 0.6, 0.5 + 0.4 * (number % 2)) for number in range(materials.max() + 2)])
    colors = hues[materials]
    if of_vertices:
        corners = triangles.ravel()
        count = np.maximum(np.bincount(corners, minlength=len(vertices)), 1)
        colors = np.column_stack([np.bincount(corners, channel.repeat(3), len(vertices)) for channel in colors.T]) / count[:, None]
    colors = to_linear((colors + np.random.default_rng(seed).normal(0, COLOR_NOISE, colors.shape)).clip(0, 1))
    if of_vertices:
        colors = colors[triangles].mean(axis=1)
    return marks_of_colors(find_face_pairs(vertices, triangles), *mean_over_faces(colors, areas, np.arange(len(triangles))))


def fused_targets(score, model, areas):
    """Of a fused model: what is hidden inside, by more than half, is not looked for."""
    source = {name: model["source_" + name] for name in ("V", "F", "object", "material", "bone")}
    whole = score.areas(source["V"].astype(float), source["F"].astype(np.int64))
    result = []
    for kind, name, mask in score.targets({**source, "parents": model["parents"], "bones": model["bones"]}):
        visible = mask[model["source"]]
        share, (low, high) = areas[visible].sum() / areas.sum(), score.KINDS[kind]
        if low < share < high and share > 0.5 * whole[mask].sum() / whole.sum():
            result.append((kind, name, visible))
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("score", type=Path)
    parser.add_argument("assets", type=Path)
    parser.add_argument("--fused", action="store_true")
    parser.add_argument("--strength", type=float, default=0.9)
    parser.add_argument("--colors", choices=("face", "vertex"))
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--mirror", action="store_true")
    args = parser.parse_args()
    sys.path.insert(0, str(args.score))
    import score

    rows, images, seconds = [], [], 0.0
    for path in sorted(args.assets.glob("*.npz"))[::args.every]:
        model = np.load(path, allow_pickle=False)
        vertices, triangles = model["V"].astype(float), model["F"].astype(np.int64)
        areas = score.areas(vertices, triangles)
        targets = fused_targets(score, model, areas) if args.fused else score.targets(model)
        materials = model["source_material"][model["source"]] if args.fused else model["material"]
        if args.colors:
            marks = color_marks(vertices, triangles, areas, materials, args.colors == "vertex", args.seed)
        else:
            edges = material_borders(vertices, triangles, materials)
            marks = Marks("materials", edges, np.full(len(edges), args.strength))
        started = time.process_time()
        try:
            hierarchy = Hierarchy.build(vertices, triangles, threads=1, marks=[marks])
        except PartwheelError as error:
            print(f"{path.stem} is refused: {error}")
            rows += [(kind, 0.0, 0.0, 0.0) for kind, _, _ in targets]
            continue
        seconds += time.process_time() - started
        if args.mirror:
            mesh = SimpleNamespace(vertices=vertices, triangles=triangles, faces=np.arange(len(triangles)), face_count=len(triangles))
            image = mirror.mirror_faces(mesh)
            images += [] if image is None else [mirror.images(hierarchy, mesh, image)]
        random = np.random.default_rng(0)
        rows += [(kind, *score.scored(hierarchy, areas, mask, random)[:3]) for kind, _, mask in targets]
    print(f"{seconds:.1f} s of one core")
    if images:
        print(len(images), "symmetric models: clicks with an image {:.3f}, nodes {:.3f}".format(*np.nanmean(images, axis=0)))
    for kind in score.KINDS:
        if found := [row[1:] for row in rows if row[0] == kind]:
            print(kind, len(found), "best {:.3f}, click {:.3f}, within two notches {:.3f}".format(*np.mean(found, axis=0)))


if __name__ == "__main__":
    main()
