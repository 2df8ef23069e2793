"""One natural model from 50,000 to 1,000,000 faces: time and memory against size."""

from math import log
from statistics import median

import models
from programs import Failure, stages

SIZES = (50_000, 100_000, 200_000, 400_000, 1_000_000)
QUICK = (50_000, 100_000, 200_000)
STAGES = ("solid", "cluster", "dendrogram", "hierarchy")


def measure(quick):
    rows = []
    mesh = models.read(models.NATURAL)
    for faces in QUICK if quick else SIZES:
        mesh = models.subdivided(mesh, faces)
        report, why_not = stages(models.write(f"natural-{faces}", mesh), 1 if quick or faces > 200_000 else 3)
        if report is None:
            raise Failure(f"the model of {faces} faces could not be built: {why_not}")
        rows.append({"faces": faces, "tets": report["tets"], **sizes(report)})
        print(f"   {faces} faces: {rows[-1]['htc_seconds']:.2f} s HTC, {rows[-1]['build_seconds']:.2f} s in all, "
              f"{rows[-1]['peak'] / 1e6:.0f} MB of which TetGen {rows[-1]['tetgen_peak'] / 1e6:.0f} MB")
    first = rows[0]
    for row in rows:
        row["growth"] = (row["htc_seconds"] / row["tets"]) / (first["htc_seconds"] / first["tets"])
        row["log2_growth"] = (log(row["tets"]) / log(first["tets"])) ** 2
        row["over_tetgen"] = (row["peak"] - row["tetgen_peak"]) / row["tets"]
    return {"model": models.NATURAL.stem, "sizes": rows}


def sizes(report):
    """Processor seconds (medians) and peak bytes of a model."""
    def seconds(*parts):
        return median(sum(r[part][1] for part in parts) for r in report["seconds"])

    peak = report["peak"]
    return {"htc_seconds": seconds("cluster", "dendrogram"), "tetgen_seconds": seconds("tetgen"),
            "build_seconds": seconds(*STAGES), "tetgen_peak": peak["tetgen"], "cluster_peak": peak["cluster"],
            "peak": max(peak[stage] for stage in ("tetgen", *STAGES, "cluster_two_threads"))}
