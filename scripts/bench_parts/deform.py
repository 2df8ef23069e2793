"""What a mouse move costs while a part of 20,000 and one of 100,000 vertices is deformed."""

import models
import numpy as np
from programs import BUILD, Failure, run

PARTS = {20_000: 33, 100_000: 100}  # vertices of the part, the goal in ms
MOVES, ITERATIONS = 60, 2  # the iterations of a mouse move in the add-on
AXIS = 1


def measure(quick):
    """As the add-on does it: the part and the faces around it, nothing else."""
    sizes = []
    for count, goal in PARTS.items():
        vertices, triangles = models.subdivided(models.read(models.NATURAL), round(count * 2.5))
        inside = np.zeros(len(vertices), bool)
        inside[np.argsort(-vertices[:, AXIS], kind="stable")[:count]] = True
        near = triangles[inside[triangles].any(axis=1)]
        used, near = np.unique(near, return_inverse=True)
        path = models.write(f"part-{count}", (vertices[used], near.reshape(-1, 3)))
        report, why_not = run(BUILD / "deform_bench", path, AXIS, count, MOVES // 3 if quick else MOVES, ITERATIONS)
        if report is None:
            raise Failure(f"the part of {count} vertices: {why_not}")
        print(f"   {count} vertices: {1000 * report['move']['median']:.1f} ms a move (processor: "
              f"{1000 * report['move']['median_cpu']:.1f} ms), {report['create'][0]:.2f} s to begin")
        sizes.append({"count": count, "goal": goal, **report})
    return {"iterations": ITERATIONS, "sizes": sizes}
