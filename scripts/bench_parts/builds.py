"""Builds a model in a process of its own and prints the result as JSON. Times are processor seconds of all threads, which depend
little on the machine's load, if nothing else is said.

Run as: build/venv/core/bin/python builds.py any MODEL [MUTATION SEED]
                                             points MODEL
                                             asset MODEL.npz REPETITIONS
                                             large MODEL.npz [compare]
any: at default settings; MUTATION: a function of tests/reliability/mutations.py. points: filled from points in any case.
asset: on one core and on all, alternately; the medians.
large: on a coarser copy. compare: also builds the mesh at full resolution, and measures how well the wheel stops of the two
hierarchies overlap; and, as a bound on that, those of two builds at full resolution, one with vertices moved by a millionth of
the model's size.
"""

import json
import sys
import time
from pathlib import Path
from statistics import median

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "native" / "python"), str(ROOT / "tests" / "reliability")]

import mutations  # noqa: E402
import numpy as np  # noqa: E402
from partwheel import FillMethod, Hierarchy, PartwheelError, meshes  # noqa: E402
from partwheel.triangles import triangle_areas  # noqa: E402
from partwheel.worker import read_memory  # noqa: E402

CLICKS = 200
JITTER = 1e-6  # of the model's size


def build_any(path, *mutation, **options):
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
    return {**report, "seconds": time.process_time() - start, "peak": read_memory("VmHWM")}


def build_asset(path, repetitions):
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
    return {"triangles": len(triangles), "shells": hierarchy.summary.shells, "seconds": median(seconds),
            "wall_one": median(walls[1]), "wall_all": median(walls[0])}


# ---- Large meshes


def build_large(path, compare=""):
    with np.load(path) as file:
        vertices, triangles = file["vertices"].astype(float), file["triangles"]
    hierarchy, report = build(vertices, triangles, False)
    if compare:
        exact, report["full_resolution"] = build(vertices, triangles, True)
        report["overlap"] = statistics(overlaps(vertices, triangles, hierarchy, exact))
        size = np.linalg.norm(np.ptp(vertices, axis=0))
        moved = vertices + JITTER * size * np.random.default_rng(1).normal(size=vertices.shape)
        report["jittered"] = statistics(overlaps(vertices, triangles, build(moved, triangles, True)[0], exact))
    return report


def build(vertices, triangles, full_resolution):
    """(Hierarchy, report)"""
    start = time.process_time()
    hierarchy = Hierarchy.build(vertices, triangles, full_resolution=full_resolution)
    return hierarchy, {"faces": len(triangles), "seconds": time.process_time() - start, "peak": read_memory("VmHWM"),
                       "fill_method": "proxy" if hierarchy.summary.proxy_triangles else hierarchy.summary.fill_method}


def click(vertices, triangles):
    """((F,) areas, (CLICKS,) random faces)"""
    areas = triangle_areas(vertices[triangles])
    return areas, np.random.default_rng(1).choice(len(areas), CLICKS, p=areas / areas.sum())


def overlaps(vertices, triangles, coarse, exact):
    """For each wheel stop of CLICKS random faces, its largest overlap (intersection over union of area) with an exact
    stop."""
    areas, clicked = click(vertices, triangles)
    result = []
    for face in clicked:
        # The stops of a path are nested, so the first stop that contains each face determines all intersections.
        (coarse_stop, n_coarse), (exact_stop, n_exact) = (first_stops(hierarchy, face) for hierarchy in (coarse, exact))
        shared = np.bincount(coarse_stop * n_exact + exact_stop, areas, n_coarse * n_exact).reshape(n_coarse, n_exact)
        shared = shared.cumsum(axis=0).cumsum(axis=1)
        union = shared[:, -1:] + shared[-1:] - shared
        result += (shared / union).max(axis=1).tolist()
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


BUILDS = {"any": build_any, "points": lambda path: build_any(path, fill_methods=FillMethod.POINTS), "asset": build_asset,
          "large": build_large}

if __name__ == "__main__":
    print(json.dumps(BUILDS[sys.argv[1]](*sys.argv[2:])))
