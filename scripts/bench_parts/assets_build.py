"""Builds one asset on one core and on all, alternately, and prints the medians as JSON.

Run as: build/venv/core/bin/python assets_build.py MODEL.npz REPETITIONS
"""

import json
import sys
import time
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "native" / "python"))

import numpy as np  # noqa: E402
from partwheel import Hierarchy  # noqa: E402


def main():
    path, repetitions = sys.argv[1:]
    arrays = np.load(path)
    vertices, triangles = arrays["V"].astype(float), arrays["F"].astype(np.int32)
    seconds, walls = [], {1: [], 0: []}  # 0 threads: one for each core
    for _ in range(int(repetitions)):
        for threads, wall in walls.items():
            start, start_cpu = time.perf_counter(), time.process_time()
            hierarchy = Hierarchy.build(vertices, triangles, threads=threads)
            wall.append(time.perf_counter() - start)
            if threads == 1:
                seconds.append(time.process_time() - start_cpu)
    print(json.dumps({"triangles": len(triangles), "shells": hierarchy.summary.shells, "seconds": median(seconds),
                      "wall_one": median(walls[1]), "wall_all": median(walls[0])}))


if __name__ == "__main__":
    main()
