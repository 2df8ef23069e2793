"""Competing tools on the same models in the same run: CoACD, V-HACD, CGAL's SDF segmentation."""

from statistics import median

import models
import numpy as np
from programs import PROGRAMS, ROOT, Failure, run, stages

PYTHON = ROOT / "build" / "venv" / "peers" / "bin" / "python"
PEERS = "CoACD", "V-HACD", "CGAL SDF"
STAGES = ("solid", "cluster", "dendrogram", "hierarchy")
TIME_LIMIT = 600


def measure(quick):
    """Runs each tool with its default options, each model in a separate process, the tools alternating. Partwheel
    builds the whole hierarchy, from arrays to saved bytes, in one thread; CoACD and V-HACD use all cores. Seconds are
    wall time."""
    files, source = models.real_models(10_000, 30_000)
    rows = []
    for first in [0] if quick else models.evenly_spaced(range(len(files)), 6)[:-1]:
        # The first closed model from there on.
        attempts = ((file, run_partwheel(file)) for file in files[first:])
        file, partwheel = next((attempt for attempt in attempts if "error" not in attempt[1]), (None, None))
        if file is None:
            raise Failure("no model could be built")
        row = {"model": file.stem, "faces": models.face_count(file), "Partwheel": partwheel}
        row.update((name, run_peer(name, file)) for name in PEERS)
        rows.append(row)
        print(f"   {file.stem}, {row['faces']} faces: " + ", ".join(
            f"{name} {row[name]['error']}" if "error" in row[name] else
            f"{name} {row[name]['seconds'][0]:.1f} s {row[name]['peak'] / 1e6:.0f} MB"
            for name in ("Partwheel", *PEERS)))
    return {"source": source, "models": rows, "medians": {name: medians(rows, name) for name in ("Partwheel", *PEERS)}}


def run_peer(name, file):
    """The tool's report, or {"error": why not}."""
    if name == "CGAL SDF":
        report, reason = run(PROGRAMS / "sdf_bench", file, time_limit=TIME_LIMIT)
        return report or {"error": reason}
    source, target = (models.WORK / f"peer-{which}.npz" for which in ("in", "out"))
    models.WORK.mkdir(parents=True, exist_ok=True)
    vertices, triangles = models.read(file)
    np.savez(source, vertices=vertices, triangles=triangles)
    _, reason = run(PYTHON, ROOT / "tests/bench/convex/one.py", name, 0, source, target, time_limit=TIME_LIMIT)
    if reason:
        return {"error": reason}
    with np.load(target) as saved:
        return {"parts": len(saved["counts"]), "seconds": [float(saved["wall"]), float(saved["seconds"])], "peak": int(saved["peak"])}


def run_partwheel(file):
    """The report of building the model, or {"error": why not}."""
    report, reason = stages(file, 1)
    if report is None:
        return {"error": reason}
    seconds = report["seconds"][0]
    return {"seconds": [sum(seconds[stage][i] for stage in STAGES) for i in (0, 1)],
            "peak": max(report["peak"][stage] for stage in ("tetgen", *STAGES))}


def medians(rows, name):
    runs = [row[name] for row in rows if "error" not in row[name]]
    if not runs:
        return {"done": 0}
    return {"done": len(runs), "wall": median(r["seconds"][0] for r in runs),
            "cpu": median(r["seconds"][1] for r in runs), "peak": median(r["peak"] for r in runs),
             "parts": median(r.get("parts", 0) for r in runs)}
