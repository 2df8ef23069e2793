"""One natural model from 50,000 to 1,000,000 faces: time and memory against size.

Growth is against the smallest size, measured again after each other one, as the mean of before and after it: a machine's
speed may change within the minutes that the largest takes. What is short is repeated more often, as the median of five
short runs is a matter of chance.
"""

from math import log
from statistics import median

import models
from programs import Failure, stages

SIZES = (50_000, 100_000, 200_000, 400_000, 1_000_000)
QUICK = (50_000, 100_000, 200_000)
STAGES = ("solid", "cluster", "dendrogram", "hierarchy")


def repetitions(faces):
    return min(max(5, 2_000_000 // faces), 20)


def measure(quick):
    def measured(path, faces):
        report, why_not = stages(path, 1 if quick else repetitions(faces))
        if report is None:
            raise Failure(f"{path.name} could not be built: {why_not}")
        return {"tets": report["tets"], **sizes(report)}

    rows = []
    mesh = models.read(models.NATURAL)
    for faces in QUICK if quick else SIZES:
        mesh = models.subdivided(mesh, faces)
        path = models.write(f"natural-{faces}", mesh)
        row = {"faces": faces, **measured(path, faces)}
        if rows:
            after = measured(first, rows[0]["faces"])
        else:
            first, before, after = path, row, row
        smallest = (before["htc_seconds"] + after["htc_seconds"]) / 2 / before["tets"]
        row["growth"] = row["htc_seconds"] / row["tets"] / smallest
        row["log2_growth"] = (log(row["tets"]) / log(before["tets"])) ** 2
        row["over_tetgen"] = (row["peak"] - row["tetgen_peak"]) / row["tets"]
        rows.append(row)
        before = after
        print(f"   {faces} faces: {row['htc_seconds']:.2f} s HTC, a tetrahedron {row['growth']:.2f} x the smallest's, "
              f"{row['build_seconds']:.2f} s in all, {row['peak'] / 1e6:.0f} MB of which TetGen "
              f"{row['tetgen_peak'] / 1e6:.0f} MB")
    return {"model": models.NATURAL.stem, "sizes": rows}


def sizes(report):
    """Processor seconds (medians) and peak bytes of a model."""
    def seconds(*parts):
        return median(sum(r[part][1] for part in parts) for r in report["seconds"])

    peak = report["peak"]
    return {"htc_seconds": seconds("cluster", "dendrogram"), "tetgen_seconds": seconds("tetgen"),
            "build_seconds": seconds(*STAGES), "tetgen_peak": peak["tetgen"], "cluster_peak": peak["cluster"],
            "peak": max(peak[stage] for stage in ("tetgen", *STAGES, "cluster_two_threads"))}
