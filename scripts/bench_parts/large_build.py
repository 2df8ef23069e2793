"""One build of a large mesh, in a process of its own: prints what it took as JSON. Seconds are processor time, of all
threads together.

Run as: build/venv/core/bin/python large_build.py MODEL.npz [beside]
beside: exactly, too, and how well the wheel's stops of the one are stops of the other. Then two bounds of that: the same
of two exact ones, of which the first has its vertices moved by a millionth of the model's size; and how well the
tetrahedra of the copy can tell the exact stops, whatever tree is made of them.
"""

import json
import re
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "native" / "python"))

import numpy as np  # noqa: E402
from partwheel import Hierarchy  # noqa: E402

CLICKS = 200
SHAKE = 1e-6


def peak():
    with open("/proc/self/status") as file:
        return 1024 * int(re.search(r"VmHWM:\s+(\d+)", file.read()).group(1))


def built(vertices, triangles, exactly):
    """(Hierarchy, report)"""
    began = time.process_time()
    hierarchy = Hierarchy.build(vertices, triangles, exactly=exactly)
    return hierarchy, {"faces": len(triangles), "seconds": time.process_time() - began, "peak": peak(),
                       "way": hierarchy.summary.rung}


def overlaps(vertices, triangles, coarse, exact):
    """Of each wheel stop of some clicks the largest overlap, by area, with a stop of the exact tree at that face."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    areas, found = np.linalg.norm(np.cross(b - a, c - a), axis=1), []
    for face in np.random.default_rng(1).choice(len(areas), CLICKS, p=areas / areas.sum()):
        # The stops of a path lie in each other: the first that holds each face tells all that two paths share.
        (mine, counts), (theirs, others) = (first_stops(hierarchy, face) for hierarchy in (coarse, exact))
        shared = np.bincount(mine * others + theirs, areas, counts * others).reshape(counts, others)
        shared = shared.cumsum(axis=0).cumsum(axis=1)
        union = shared[:, -1:] + shared[-1:] - shared
        found += (shared / union).max(axis=1).tolist()
    return found


def told(vertices, triangles, coarse, exact):
    """Of each exact wheel stop of some clicks its largest overlap, by area, with tetrahedra of the coarse tree."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    areas, found = np.linalg.norm(np.cross(b - a, c - a), axis=1), []
    count = len(coarse.tetrahedra)
    tetrahedron = np.empty(len(areas), np.int64)
    tetrahedron[coarse.order] = np.repeat(np.arange(count), (coarse.last - coarse.first)[:count])
    whole = np.bincount(tetrahedron, areas, count)
    for face in np.random.default_rng(1).choice(len(areas), CLICKS, p=areas / areas.sum()):
        for node in exact.wheel(face)[0]:
            faces = exact.faces(node)
            inside = np.bincount(tetrahedron[faces], areas[faces], count)
            some = np.flatnonzero(inside)
            most = some[np.argsort(-inside[some] / whole[some], kind="stable")]  # the best set is a beginning of this
            union = inside.sum() + np.cumsum(whole[most] - inside[most])
            found.append(float((np.cumsum(inside[most]) / union).max()))
    return found


def first_stops(hierarchy, face):
    """(the number of the first of the face's stops that holds each face, how many stops there are)"""
    stops = hierarchy.wheel(face)[0].tolist()
    first = np.full(len(hierarchy.order), len(stops) - 1)
    for number, node in reversed(list(enumerate(stops))):
        first[hierarchy.faces(node)] = number
    return first, len(stops)


def spread(found):
    return {"median": float(np.median(found)), "mean": float(np.mean(found)), "stops": len(found)}


def main():
    path, *how = sys.argv[1:]
    with np.load(path) as file:
        vertices, triangles = file["vertices"].astype(float), file["triangles"]
    hierarchy, report = built(vertices, triangles, False)
    if how:
        exact, report["exactly"] = built(vertices, triangles, True)
        report["overlap"] = spread(overlaps(vertices, triangles, hierarchy, exact))
        report["told"] = spread(told(vertices, triangles, hierarchy, exact))
        size = np.linalg.norm(np.ptp(vertices, axis=0))
        moved = vertices + SHAKE * size * np.random.default_rng(1).normal(size=vertices.shape)
        report["shaken"] = spread(overlaps(vertices, triangles, built(moved, triangles, True)[0], exact))
    print(json.dumps(report))


if __name__ == "__main__":
    main()
