"""One build at default settings, in a process of its own: prints what it was, or why there is none, as JSON. Seconds are
processor time, of all threads together, so that a busy machine changes little.

Run as: build/venv/core/bin/python any_build.py MODEL [MUTATION SEED]   the mutation being one of tests/reliability's
"""

import json
import re
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "reliability")]

import mutations  # noqa: E402
import numpy as np  # noqa: E402
from partwheel import Hierarchy, PartwheelError, meshes  # noqa: E402


def main():
    path, *mutation = sys.argv[1:]
    vertices, triangles, faces, face_count, _ = meshes.read(path)
    if mutation:
        kind, seed = mutation
        vertices, triangles = getattr(mutations, kind)(np.random.default_rng(int(seed)), vertices, triangles)
        faces, face_count = None, None
    report = {"faces": len(triangles)}
    began = time.process_time()
    try:
        summary = Hierarchy.build(vertices, triangles, faces, face_count).summary
        report.update(way=summary.rung, deviation=summary.deviation)
    except PartwheelError as error:
        report.update(way=error.name, why=str(error))
    report["seconds"] = time.process_time() - began
    with open("/proc/self/status") as file:
        report["peak"] = 1024 * int(re.search(r"VmHWM:\s+(\d+)", file.read()).group(1))
    print(json.dumps(report))


if __name__ == "__main__":
    main()
