"""Worst cases for the clustering, relative to a natural model with the same number of faces."""

from statistics import median

import models
from programs import Failure, stages

CASES = (
    # name, shape or None for the natural model, faces, quality
    ("convex ball", models.ball, 50_000, 0),
    ("long thin strip", models.strip, 50_000, 0),
    ("coplanar box", models.box, 100_000, 0),
    ("comb", models.comb, 50_000, 0),
    ("porous cube", models.porous, 50_000, 0),
    ("interior points", None, 50_000, 1.4),
)


def measure(quick):
    ordinary = {}  # number of faces -> seconds per tetrahedron
    rows = []
    for name, shape, faces, quality in CASES:
        if quick:
            faces //= 5
        if faces not in ordinary:
            ordinary[faces] = seconds_per_tet(f"ordinary-{faces}", natural(faces), quick)
            if "error" in ordinary[faces]:
                raise Failure(f"the natural model of {faces} faces: {ordinary[faces]['error']}")
        mesh = shape(faces) if shape else natural(faces)
        row = {"case": name, **seconds_per_tet(name.replace(" ", "-") + f"-{faces}", mesh, quick, quality)}
        if "error" in row:
            print(f"   {name}: {row['error']}")
        else:
            row["ratio"] = row["per_tet"] / ordinary[faces]["per_tet"]
            print(f"   {name}: {row['faces']} faces, {row['tets']} tetrahedra, {1e6 * row['per_tet']:.1f} us each, "
                  f"{row['ratio']:.2f} x ordinary; TetGen {row['tetgen_seconds']:.1f} s")
        rows.append(row)
    return {"cases": rows, "ordinary": ordinary}


def natural(faces):
    """The natural model, subdivided to this number of faces; unchanged if it has more."""
    return models.subdivide(models.read(models.NATURAL), faces)


def seconds_per_tet(name, mesh, quick, quality=0):
    report, reason = stages(models.write(name, mesh), 1 if quick else 3, quality)
    if report is None:
        return {"error": reason}
    seconds = median(r["cluster"][1] + r["dendrogram"][1] for r in report["seconds"])
    return {"faces": report["faces"], "tets": report["tets"], "per_tet": seconds / report["tets"],
            "tetgen_seconds": median(r["tetgen"][1] for r in report["seconds"])}
