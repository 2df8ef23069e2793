"""Assets as artists have them: seconds per 100,000 triangles, and how many cores the models with several shells use."""

import os
import tarfile
from pathlib import Path
from statistics import median

import models
from programs import ROOT, WORK, Failure, build, required

ASSETS = Path(os.environ.get("PARTWHEEL_ASSETS", ROOT.parent / "shared" / "assets")) / "tune.tar.xz"
LARGE = 0.2  # processor seconds of a model whose cores are compared: the smaller ones end before threads matter


def measure(quick):
    """Each model in a process of its own."""
    if not ASSETS.exists():
        raise Failure(f"{ASSETS} is not there: set PARTWHEEL_ASSETS to the folder of the assets")
    with tarfile.open(ASSETS) as archive:
        archive.extractall(WORK)
    rows = []
    for path in models.evenly_spaced(sorted((WORK / "tune").glob("*.npz")), 12 if quick else 10**9):
        rows.append({"model": path.stem, **required(path.stem, build("asset", path, 1 if quick else 3))})
    for row in sorted(rows, key=lambda row: row["seconds"] / row["triangles"])[-5:]:
        print(f"   {row['model']}: {row['triangles']} triangles, {row['seconds']:.2f} s")
    several = [row["wall_one"] / row["wall_all"] for row in rows if row["shells"] > 1 and row["seconds"] > LARGE]
    triangles = sum(row["triangles"] for row in rows)
    return {"models": rows, "rate": 100_000 * sum(row["seconds"] for row in rows) / triangles,
            "rate_all_cores": 100_000 * sum(row["wall_all"] for row in rows) / triangles,
            "several": len(several), "speedup": median(several) if several else None}
