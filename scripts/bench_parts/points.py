"""Broken models filled from points: seconds, without the attempts to use or to repair them first."""

from statistics import median

import models
from programs import Failure, build

# Name, model of libcgal-demo, faces after holes and a crossing copy were added (None: the model as it is), goal in seconds.
CASES = ("bear with holes, crossed by another", "bear.off", 124_008, 3), ("man", "man.off", None, 1.5), (
    "elephant with holes, crossed by another", "elephant.off", 14_400, 1)


def measure(quick):
    rows = []
    for name, file, faces, goal in CASES[1:] if quick else CASES:
        path = models.DEMO / file
        if faces:
            path = models.write(f"crossed-{faces}", models.crossed(path, faces))
        reports = [build("points", path) for _ in range(1 if quick else 3)]
        for report, reason in reports:
            if report is None or report["fill_method"] != "points":
                raise Failure(f"{name} is not filled from points: {reason or report['fill_method']}")
        rows.append({"model": name, "faces": report["faces"], "goal": goal,
                     "seconds": median(report["seconds"] for report, _ in reports)})
        print(f"   {name}: {rows[-1]['faces']} triangles, {rows[-1]['seconds']:.2f} s")
    return {"models": rows}
