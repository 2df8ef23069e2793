"""Runs a competing tool on one model; prints its number of parts, seconds [wall, cpu] and peak memory in bytes as JSON.

Run as: build/venv/peers/bin/python peer.py coacd|vhacd MODEL.off   With the tool's default options.
"""

import json
import os
import re
import sys
import time

import numpy as np


def coacd(vertices, triangles):
    import coacd as peer

    peer.set_log_level("error")
    mesh = peer.Mesh(vertices, triangles)
    return lambda: peer.run_coacd(mesh)


def vhacd(vertices, triangles):
    import vhacdx as peer

    return lambda: peer.compute_vhacd(vertices, triangles.astype(np.uint32))


def read(path):
    with open(path) as file:
        words = file.read().split()
    v, f = int(words[1]), int(words[2])
    vertices = np.array(words[4:4 + 3 * v], float).reshape(v, 3)
    return vertices, np.array(words[4 + 3 * v:4 + 3 * v + 4 * f], np.int32).reshape(f, 4)[:, 1:].copy()


def main():
    name, path = sys.argv[1:]
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what the tool prints must not mix with the answer
    decompose = {"coacd": coacd, "vhacd": vhacd}[name](*read(path))
    wall, cpu = time.monotonic(), time.process_time()
    parts = decompose()
    seconds = [time.monotonic() - wall, time.process_time() - cpu]
    with open("/proc/self/status") as file:
        peak = 1024 * int(re.search(r"VmHWM:\s+(\d+)", file.read()).group(1))
    print(json.dumps({"parts": len(parts), "seconds": seconds, "peak": peak}), file=answer)


if __name__ == "__main__":
    main()
