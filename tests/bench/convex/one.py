# SPDX-License-Identifier: GPL-3.0-or-later
"""One model in convex parts by one tool, in a process of its own, whose time and memory these are.

Run as: python one.py TOOL HULLS IN.npz OUT.npz    HULLS: at most so many, 0: as the tool likes. IN: vertices, triangles.
OUT: points of all hulls, one after the other, counts of points, processor seconds and wall-clock seconds from arrays to hulls on all
cores, bytes by which the process grew at most meanwhile, and its peak in bytes."""

import os
import re
import sys
import time
from pathlib import Path

import numpy as np

FAST = {"mcts_iterations": 60, "mcts_max_depth": 2, "mcts_nodes": 10, "resolution": 1000}
FINE = 0.02  # CoACD's threshold, whose default is 0.05, where 16 hulls or more are asked for: else it makes fewer
MANY = 16


def partwheel(vertices, triangles, hulls):
    sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "native" / "python"))
    from partwheel import Hierarchy, Mode

    def work():
        hierarchy = Hierarchy.build(vertices, triangles, mode=Mode.PAPER)
        return [part.vertices for part in hierarchy.convex_parts(hulls)]
    return work


def coacd(vertices, triangles, hulls, **options):
    import coacd as peer

    peer.set_log_level("error")
    mesh = peer.Mesh(vertices, triangles)
    if hulls >= MANY and options:
        options["threshold"] = FINE
    return lambda: [part[0] for part in peer.run_coacd(mesh, max_convex_hull=hulls or -1, **options)]


def vhacd(vertices, triangles, hulls):
    import vhacdx as peer

    options = {"maxConvexHulls": hulls} if hulls else {}
    return lambda: [part[0] for part in peer.compute_vhacd(vertices, triangles.astype(np.uint32), **options)]


TOOLS = {"ours": partwheel, "CoACD": coacd, "CoACD, fast": lambda *model: coacd(*model, **FAST), "V-HACD": vhacd}


def memory(name):
    with open("/proc/self/status") as file:
        return 1024 * int(re.search(rf"{name}:\s+(\d+)", file.read()).group(1))


def main():
    tool, hulls, source, target = sys.argv[1:]
    with np.load(source) as model:
        work = TOOLS[tool](model["vertices"], model["triangles"], int(hulls))
    os.dup2(2, 1)  # what the peers print is none of the table
    before, start, wall_start = memory("VmRSS"), time.process_time(), time.perf_counter()
    parts = [np.asarray(part, float) for part in work()]
    seconds, wall = time.process_time() - start, time.perf_counter() - wall_start
    np.savez(target, points=np.concatenate(parts), counts=[len(part) for part in parts], seconds=seconds,
             wall=wall, memory=memory("VmHWM") - before, peak=memory("VmHWM"))


if __name__ == "__main__":
    main()
