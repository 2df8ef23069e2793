"""One natural model with 50,000 to 1,000,000 faces: time and memory against size.

Growth is relative to the smallest size. Runs of the smallest and of each other size alternate, and the median is taken,
because a machine's speed may change within seconds. Short runs are repeated more often, because their times vary more.
"""

from contextlib import ExitStack
from math import log
from statistics import median

import models
from programs import Stages

SIZES = (50_000, 100_000, 200_000, 400_000, 1_000_000)
QUICK = (50_000, 100_000, 200_000)
STAGES = ("solid", "cluster", "dendrogram", "hierarchy")


def repetitions(faces):
    """The number of runs with this many faces."""
    return min(max(5, 2_000_000 // faces), 20)


def measure(quick):
    rows = []
    mesh = models.read(models.NATURAL)
    with ExitStack() as programs:
        for faces in QUICK if quick else SIZES:
            mesh = models.subdivide(mesh, faces)
            path = models.write(f"natural-{faces}", mesh)
            count = 1 if quick else repetitions(faces)
            if not rows:
                smallest, max_count = programs.enter_context(Stages(path)), count
                runs = [smallest.rebuild() for _ in range(count)]
                row = {"faces": faces, "growth": 1, **sizes(smallest.report, runs)}
            else:
                with Stages(path) as program:
                    runs, growths = run_alternating(smallest, program, count, max_count // count)
                    row = {"faces": faces, "growth": median(growths), **sizes(program.report, runs)}
            rows.append(row)
            row["log2_growth"] = (log(row["tets"]) / log(rows[0]["tets"])) ** 2
            print(f"   {faces} faces: {row['htc_seconds']:.2f} s HTC, a tetrahedron {row['growth']:.2f} x the "
                  f"smallest's, {row['build_seconds']:.2f} s in all, {row['peak'] / 1e6:.0f} MB of which TetGen "
                  f"{row['tetgen_peak'] / 1e6:.0f} MB")
    return {"model": models.NATURAL.stem, "sizes": rows}


def run_alternating(small, large, n_large, n_small):
    """Runs the large model n_large times, and the small one n_small times before and after each of these.

    Returns the large model's runs, and for each the time per tetrahedron relative to the small model's median."""
    def run_small():
        return [htc(small.rebuild()) for _ in range(n_small)]

    runs, growths = [], []
    before = run_small()
    for _ in range(n_large):
        runs.append(large.rebuild())
        after = run_small()
        growths.append(htc(runs[-1]) / large.report["tets"] / (median(before + after) / small.report["tets"]))
        before = after
    return runs, growths


def htc(run):
    """Processor seconds of hierarchical tet clustering."""
    return run["cluster"][1] + run["dendrogram"][1]


def sizes(report, runs):
    """Tetrahedra, processor seconds (medians) and bytes of a model."""
    def seconds(*parts):
        return median(sum(r[part][1] for part in parts) for r in runs)

    peak = report["peak"]
    max_peak = max(peak[stage] for stage in ("tetgen", *STAGES))
    return {"tets": report["tets"], "htc_seconds": median(map(htc, runs)), "tetgen_seconds": seconds("tetgen"),
            "build_seconds": seconds(*STAGES), "tetgen_peak": peak["tetgen"], "cluster_peak": peak["cluster"],
            "peak": max_peak, "over_tetgen": (max_peak - peak["tetgen"]) / report["tets"]}
