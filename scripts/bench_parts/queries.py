"""Queries on a finished hierarchy that a user waits for: a click, a notch, loading."""

import models
from programs import PROGRAMS, required, run

FACES = 400_000
QUICK = 100_000
CLICKS = 20_000


def measure(quick):
    faces = QUICK if quick else FACES
    path = models.write(f"natural-{faces}", models.subdivide(models.read(models.NATURAL), faces))
    report = required(f"the model of {faces} faces", run(PROGRAMS / "queries_bench", path, CLICKS))
    # Processor time, which does not include interruptions by other processes.
    longest = max(report[query]["longest"] for query in ("path", "wheel", "node_faces"))
    load_over_build = report["load"][1] / report["build"][1]
    print(f"   longest of {CLICKS} clicks {1000 * longest:.3f} ms, loading {100 * load_over_build:.1f} % of building")
    return {"clicks": CLICKS, "longest": longest, "load_over_build": load_over_build, **report}
