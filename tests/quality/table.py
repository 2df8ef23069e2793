# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the scores of hierarchies by category beside each other, as Markdown.

usage: table.py SCORE_PY MESH_DIR SEG_DIR NAME=OUT_DIR [NAME=OUT_DIR ...]

SCORE_PY: the benchmark's score.py, whose measures these are. OUT_DIR: what psb.py wrote; NAME heads its column, such as
default, paper, sdf. A model without a file counts 0 for a click and 1 for a cut. `spread` is the standard deviation
over the categories of their means.
"""

import argparse
import importlib.util
import os
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

MEASURES = {
    "best": "best IoU on the wheel's path", "start": "IoU at the click", "within2": "best IoU within two notches",
    "stops": "stops of the path", "notch": "notches to the best", "cut": "1-RI, K given", "auto": "1-RI, K automatic",
}


def benchmark(path):
    spec = importlib.util.spec_from_file_location("psb_score", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def row(score, model, meshes, segmentations, directory):
    """(7,) the model's means, in the order of MEASURES; None where nobody segmented it."""
    source = directory / f"{model}.npz"
    hierarchy = dict(np.load(source)) if source.exists() else None
    clicks, cut, auto = benchmark(score).score_model(model, meshes, segmentations, hierarchy)
    if not len(clicks):
        return None
    means = [0, 0, 0, np.nan, np.nan] if hierarchy is None else list(clicks.mean(axis=0))
    if len(means) != 5:
        raise SystemExit(f"{score} measures other things than this table knows.")
    return np.array([*means, cut.mean(), auto.mean()])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("score", "meshes", "segmentations"):
        parser.add_argument(name, type=Path)
    parser.add_argument("columns", nargs="+", metavar="NAME=OUT_DIR")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    args = parser.parse_args()
    columns = {name: Path(directory) for name, _, directory in (column.partition("=") for column in args.columns)}
    models = sorted(int(path.stem) for path in args.meshes.glob("*.off"))
    names = benchmark(args.score).CATEGORIES
    rows = {}
    with ProcessPoolExecutor(args.jobs) as pool:
        pending = {(column, model): pool.submit(row, args.score, model, args.meshes, args.segmentations, directory)
                   for column, directory in columns.items() for model in models}
        for key, result in pending.items():
            if result.result() is not None:
                rows[key] = result.result()

    heads = " | ".join(columns)
    for i, (measure, heading) in enumerate(MEASURES.items()):
        print(f"\n{measure}: {heading}\n\n| category | models | {heads} |\n|---|---|{'---|' * len(columns)}")
        of_category = {column: [] for column in columns}
        for c, name in enumerate(names):
            of = [model for model in models if (model - 1) // 20 == c and (next(iter(columns)), model) in rows]
            if not of:
                continue
            for column in columns:
                of_category[column].append(np.nanmean([rows[column, model][i] for model in of]))
            print(f"| {name} | {len(of)} |", " | ".join(f"{means[-1]:.3f}" for means in of_category.values()), "|")
        means = [np.nanmean([r[i] for (c, _), r in rows.items() if c == column]) for column in columns]
        print(f"| **all** | {len(rows) // len(columns)} |", " | ".join(f"**{mean:.4f}**" for mean in means), "|")
        print("| spread | |", " | ".join(f"{np.nanstd(means):.3f}" for means in of_category.values()), "|")


if __name__ == "__main__":
    main()
