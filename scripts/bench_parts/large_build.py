"""Builds a large mesh in a separate process and prints time and memory as JSON. Times are processor seconds of all
threads.

Run as: build/venv/core/bin/python large_build.py MODEL.npz [compare]
compare: also builds the mesh at full resolution, and measures how well the wheel stops of the two hierarchies overlap.
Two bounds on that: the overlap of two builds at full resolution, one with vertices moved by a millionth of the model's
size; and how well sets of the copy's tetrahedra can represent the stops, independent of the tree.
"""

import json
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "native" / "python"))

import numpy as np  # noqa: E402
from partwheel import Hierarchy  # noqa: E402
from partwheel.worker import read_memory  # noqa: E402

CLICKS = 200
JITTER = 1e-6  # of the model's size


def build(vertices, triangles, full_resolution):
    """(Hierarchy, report)"""
    start = time.process_time()
    hierarchy = Hierarchy.build(vertices, triangles, full_resolution=full_resolution)
    return hierarchy, {"faces": len(triangles), "seconds": time.process_time() - start, "peak": read_memory("VmHWM"),
                       "fill_method": "proxy" if hierarchy.summary.proxy_triangles else hierarchy.summary.fill_method}


def overlaps(vertices, triangles, coarse, exact):
    """For each wheel stop of CLICKS random faces, its largest overlap (intersection over union of area) with an exact
    stop."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    areas, result = np.linalg.norm(np.cross(b - a, c - a), axis=1), []
    for face in np.random.default_rng(1).choice(len(areas), CLICKS, p=areas / areas.sum()):
        # The stops of a path are nested, so the first stop that contains each face determines all intersections.
        (coarse_stop, n_coarse), (exact_stop, n_exact) = (first_stops(hierarchy, face) for hierarchy in (coarse, exact))
        shared = np.bincount(coarse_stop * n_exact + exact_stop, areas, n_coarse * n_exact).reshape(n_coarse, n_exact)
        shared = shared.cumsum(axis=0).cumsum(axis=1)
        union = shared[:, -1:] + shared[-1:] - shared
        result += (shared / union).max(axis=1).tolist()
    return result


def best_overlaps(vertices, triangles, coarse, exact):
    """For each exact wheel stop of CLICKS random faces, its largest overlap with any set of tetrahedra of the coarse
    tree."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    areas, result = np.linalg.norm(np.cross(b - a, c - a), axis=1), []
    count = len(coarse.tetrahedra)
    tetrahedron = np.empty(len(areas), np.int64)
    tetrahedron[coarse.order] = np.repeat(np.arange(count), (coarse.last - coarse.first)[:count])
    whole = np.bincount(tetrahedron, areas, count)
    for face in np.random.default_rng(1).choice(len(areas), CLICKS, p=areas / areas.sum()):
        for node in exact.wheel(face)[0]:
            faces = exact.faces(node)
            inside = np.bincount(tetrahedron[faces], areas[faces], count)
            touched = np.flatnonzero(inside)
            order = touched[np.argsort(-inside[touched] / whole[touched], kind="stable")]  # the best set is a prefix
            union = inside.sum() + np.cumsum(whole[order] - inside[order])
            result.append(float((np.cumsum(inside[order]) / union).max()))
    return result


def first_stops(hierarchy, face):
    """((F,) index of the first of the face's stops that contains each face, number of stops)"""
    stops = hierarchy.wheel(face)[0].tolist()
    first = np.full(len(hierarchy.order), len(stops) - 1)
    for number, node in reversed(list(enumerate(stops))):
        first[hierarchy.faces(node)] = number
    return first, len(stops)


def statistics(values):
    return {"median": float(np.median(values)), "mean": float(np.mean(values)), "stops": len(values)}


def main():
    path, *options = sys.argv[1:]
    with np.load(path) as file:
        vertices, triangles = file["vertices"].astype(float), file["triangles"]
    hierarchy, report = build(vertices, triangles, False)
    if options:
        exact, report["full_resolution"] = build(vertices, triangles, True)
        report["overlap"] = statistics(overlaps(vertices, triangles, hierarchy, exact))
        report["best_overlap"] = statistics(best_overlaps(vertices, triangles, hierarchy, exact))
        size = np.linalg.norm(np.ptp(vertices, axis=0))
        moved = vertices + JITTER * size * np.random.default_rng(1).normal(size=vertices.shape)
        report["jittered"] = statistics(overlaps(vertices, triangles, build(moved, triangles, True)[0], exact))
    print(json.dumps(report))


if __name__ == "__main__":
    main()
