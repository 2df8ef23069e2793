"""Any mesh: every real model there is, as it is, and broken ones made from them; each built at default settings."""

from collections import Counter
from pathlib import Path
from statistics import median

import models
from programs import BUILD, ROOT, run

PYTHON = ROOT / "build" / "venv" / "core" / "bin" / "python"
PROGRAM = Path(__file__).with_name("any_build.py")
HANGS = ROOT.parent / "shared" / "meshes" / "ring.off"  # clean, and without end for TetGen's improvement
MUTATIONS = {"delete": "holes", "flip": "turned faces", "duplicate": "doubled faces", "intersect": "a crossing copy",
             "tremble": "noise", "slivers": "slivers", "dust": "dust"}
MUTANTS = 300
LEAST, MOST = 1_000, 60_000  # faces of what is mutated
TIME_LIMIT = 200
ALIKE = 2  # a clean model with at most so many times as many or as few faces is one of as many faces
SHEETS = {"not solid"}
LARGE = 1_000_000  # faces of one more, subdivided
NO_MESH = {"b9.ply"}  # a cloud of points


def measure(quick):
    """One after the other, so that none takes time from another."""
    files = [path for path in sorted(models.DEMO.iterdir()) if path.name not in NO_MESH]
    benchmark, source = models.real(0, 10**9)
    if benchmark[0].parent != models.DEMO:
        files += benchmark
    sizes = sorted((models.face_count(path), path) for path in files if path.suffix == ".off")
    whole = models.spread([path for faces, path in sizes if LEAST <= faces <= MOST], MUTANTS // len(MUTATIONS) + 1)
    mutants = [(path, kind, str(seed)) for seed, path in enumerate(whole) for kind in MUTATIONS][:MUTANTS]
    large = [] if quick else [models.write(f"natural-{LARGE}", models.subdivided(models.read(models.NATURAL), LARGE))]
    files += large
    builds = [(path,) for path in [*files, *[HANGS] * HANGS.exists()]] + mutants
    rows = []
    for build in builds[::20] if quick else builds:
        report, why_not = run(PYTHON, PROGRAM, *build, time_limit=TIME_LIMIT)
        if report is None:
            report = {"faces": 0, "way": "lost", "why": why_not}
        name = build[0].name + "".join(f" + {MUTATIONS[kind]}" for kind in build[1:2])
        rows.append({"model": name, **report})
    lines = table(rows)
    (BUILD / "any.txt").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    return {"source": source, "models": rows, **figures(rows)}


def figures(rows):
    """What the goals are about."""
    built = [row for row in rows if "deviation" in row]
    clean = [row for row in built if row["way"] == "exact"]
    ratios = []
    for row in built:
        alike = [other["seconds"] for other in clean if 1 / ALIKE <= other["faces"] / row["faces"] <= ALIKE]
        if row["way"] != "exact" and alike:
            ratios.append(row["seconds"] / median(alike))
    return {"ways": Counter(row["way"] for row in rows).most_common(),
            "longest": max(row["seconds"] / max(10, row["faces"] / 20_000) for row in built),
            "broken": len(ratios), "broken_over_clean": median(ratios),
            "refused": sum(row["way"] not in SHEETS for row in rows if "deviation" not in row)}


def table(rows):
    """A line each, those that took longest first."""
    lines = [f"{'model':48}{'faces':>9}  {'way':10}{'seconds':>8}{'MB':>7}{'away':>8}"]
    for row in sorted(rows, key=lambda row: -row.get("seconds", TIME_LIMIT)):
        seconds, peak = (f"{row['seconds']:.2f}", f"{row['peak'] / 1e6:.0f}") if "seconds" in row else ("", "")
        away = f"{row['deviation']:.2%}" if "deviation" in row else ""
        lines.append(f"{row['model']:48}{row['faces']:9}  {row['way']:10}{seconds:>8}{peak:>7}{away:>8}  "
                     f"{row.get('why', '')}".rstrip())
    return lines
