"""Any mesh: all real models, unchanged and with defects added; each built at default settings."""

from collections import Counter
from statistics import median

import models
from programs import BUILD, ROOT, build

HANGS = ROOT.parent / "shared" / "meshes" / "ring.off"  # clean, but TetGen's mesh improvement does not terminate on it
MUTATIONS = {"delete": "holes", "flip": "turned faces", "duplicate": "doubled faces", "intersect": "a crossing copy",
             "tremble": "noise", "slivers": "slivers", "dust": "dust"}
MUTANTS = 300
MIN_FACES, MAX_FACES = 1_000, 60_000  # of a model that is mutated
TIME_LIMIT = 200
SIZE_RATIO = 2  # models whose face counts differ by at most this factor are compared
SHEETS = {"not solid"}
LARGE = 1_000_000  # faces of one more model, which is subdivided
NO_MESH = {"b9.ply"}  # a point cloud


def measure(quick):
    """Builds the models one after another, so that they don't compete for cores."""
    files = [path for path in sorted(models.DEMO.iterdir()) if path.name not in NO_MESH]
    benchmark, source = models.real_models(0, 10**9)
    if benchmark[0].parent != models.DEMO:
        files += benchmark
    sizes = sorted((models.face_count(path), path) for path in files if path.suffix == ".off")
    originals = models.evenly_spaced([path for faces, path in sizes if MIN_FACES <= faces <= MAX_FACES],
                                     MUTANTS // len(MUTATIONS) + 1)
    mutants = [(path, kind, str(seed)) for seed, path in enumerate(originals) for kind in MUTATIONS][:MUTANTS]
    large = [] if quick else [models.write(f"natural-{LARGE}", models.subdivide(models.read(models.NATURAL), LARGE))]
    files += large
    builds = [(path,) for path in [*files, *[HANGS] * HANGS.exists()]] + mutants
    rows = []
    for path, *mutation in builds[::20] if quick else builds:
        report, reason = build("any", path, *mutation, time_limit=TIME_LIMIT)
        if report is None:
            report = {"faces": 0, "fill_method": "lost", "reason": reason}
        name = path.name + "".join(f" + {MUTATIONS[kind]}" for kind in mutation[:1])
        rows.append({"model": name, **report})
    lines = table(rows)
    (BUILD / "any.txt").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    return {"source": source, "models": rows, **figures(rows)}


def figures(rows):
    """The figures that have goals."""
    built = [row for row in rows if "deviation" in row]
    clean = [row for row in built if row["fill_method"] == "exact"]
    ratios = []
    for row in built:
        comparable = [model["seconds"] for model in clean if 1 / SIZE_RATIO <= model["faces"] / row["faces"] <= SIZE_RATIO]
        if row["fill_method"] != "exact" and comparable:
            ratios.append(row["seconds"] / median(comparable))
    return {"fill_methods": Counter(row["fill_method"] for row in rows).most_common(),
            "longest": max(row["seconds"] / max(10, row["faces"] / 20_000) for row in built),
            "broken": len(ratios), "broken_over_clean": median(ratios),
            "refused": sum(row["fill_method"] not in SHEETS for row in rows if "deviation" not in row)}


def table(rows):
    """Lines of text, one per model, the slowest first."""
    lines = [f"{'model':48}{'faces':>9}  {'method':10}{'seconds':>8}{'MB':>7}{'distance':>9}"]
    for row in sorted(rows, key=lambda row: -row.get("seconds", TIME_LIMIT)):
        seconds, peak = (f"{row['seconds']:.2f}", f"{row['peak'] / 1e6:.0f}") if "seconds" in row else ("", "")
        distance = f"{row['deviation']:.2%}" if "deviation" in row else ""
        lines.append(f"{row['model']:48}{row['faces']:9}  {row['fill_method']:10}{seconds:>8}{peak:>7}{distance:>9}  "
                     f"{row.get('reason', '')}".rstrip())
    return lines
