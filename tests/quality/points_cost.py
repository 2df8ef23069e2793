# SPDX-License-Identifier: GPL-3.0-or-later
"""What filling from points costs: the clean models of the Princeton Segmentation Benchmark, as they are, and from points
all the same.

usage: points_cost.py SCORE_PY MESH_DIR SEG_DIR OUT_DIR [--jobs N]

A model is clean if the first fill method works for it. Both hierarchies are made by psb.py with default settings, into
OUT_DIR/exact and OUT_DIR/points (what is there already is not made again), and scored by the benchmark's score.py. A
clean model that could not be filled counts 0. Prints the models that lose most and the means. Exit code 1 if that
costs more than 0.01 of "best".
"""

import argparse
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
from table import MEASURES, row

FILL_METHODS = {"exact": 1, "points": 4}
MOST = 0.01
WORST = 10  # models to name


def build(meshes, out, jobs):
    """Both hierarchies of each clean model."""
    def psb(directory, name):
        subprocess.run([sys.executable, str(Path(__file__).with_name("psb.py")), str(directory), str(out / name),
                        "--fill-methods", str(FILL_METHODS[name]), "--jobs", str(jobs)], check=True)

    psb(meshes, "exact")
    with tempfile.TemporaryDirectory() as clean:
        for model in (out / "exact").glob("*.npz"):
            Path(clean, f"{model.stem}.off").symlink_to((meshes / f"{model.stem}.off").resolve())
        psb(clean, "points")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("score", "meshes", "segmentations", "out"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    args = parser.parse_args()
    build(args.meshes, args.out, args.jobs)
    models = sorted(int(path.stem) for path in (args.out / "exact").glob("*.npz"))
    with ProcessPoolExecutor(args.jobs) as pool:
        pending = {(name, model): pool.submit(row, args.score, model, args.meshes, args.segmentations, args.out / name)
                   for name in FILL_METHODS for model in models}
        rows = {key: result.result() for key, result in pending.items()}
    models = [model for model in models if rows["exact", model] is not None]
    exact, filled = (np.array([rows[name, model] for model in models]) for name in FILL_METHODS)
    cost = exact[:, 0] - filled[:, 0]
    for i in np.argsort(-cost)[:WORST]:
        print(f"{models[i]}: best {exact[i, 0]:.3f} exact, {filled[i, 0]:.3f} from points")
    for i, heading in enumerate(MEASURES.values()):
        print(f"{heading}: {np.nanmean(exact[:, i]):.4f} exact, {np.nanmean(filled[:, i]):.4f} from points")
    print(f"{len(models)} clean models: points cost {cost.mean():.4f} of best (at most {MOST})")
    sys.exit(not cost.mean() <= MOST)


if __name__ == "__main__":
    main()
