"""Builds one model at default settings in a separate process and prints the result or the error as JSON. Times are
processor seconds of all threads, which depend little on the machine's load.

Run as: build/venv/core/bin/python any_build.py [--points] MODEL [MUTATION SEED]   MUTATION: a function of
tests/reliability/mutations.py; --points: filled from points in any case
"""

import json
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "reliability")]

import mutations  # noqa: E402
import numpy as np  # noqa: E402
from partwheel import FillMethod, Hierarchy, PartwheelError, meshes  # noqa: E402
from partwheel.worker import read_memory  # noqa: E402


def main():
    words = sys.argv[1:]
    options = {"fill_methods": FillMethod.POINTS} if "--points" in words else {}
    path, *mutation = (word for word in words if word != "--points")
    vertices, triangles, faces, face_count = meshes.read(path)[:4]
    if mutation:
        kind, seed = mutation
        vertices, triangles = getattr(mutations, kind)(np.random.default_rng(int(seed)), vertices, triangles)
        faces, face_count = None, None
    report = {"faces": len(triangles)}
    start = time.process_time()
    try:
        summary = Hierarchy.build(vertices, triangles, faces, face_count, **options).summary
        report.update(fill_method="proxy" if summary.proxy_triangles else summary.fill_method, deviation=summary.deviation)
    except PartwheelError as error:
        report.update(fill_method=error.name, reason=str(error))
    report["seconds"] = time.process_time() - start
    report["peak"] = read_memory("VmHWM")
    print(json.dumps(report))


if __name__ == "__main__":
    main()
