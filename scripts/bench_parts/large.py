"""Large meshes: one natural model with 1, 4 and 10 million faces, built on a coarser copy. With 1 million also at full
resolution: how well the wheel stops agree."""

import models
import numpy as np
from programs import WORK, build, required

SIZES = (1_000_000, 4_000_000, 10_000_000)
QUICK = SIZES[:1]


def measure(quick):
    mesh, rows = models.read(models.NATURAL), []
    for faces in QUICK if quick else SIZES:
        mesh = models.subdivide(mesh, faces)
        WORK.mkdir(parents=True, exist_ok=True)
        path = WORK / "large.npz"
        np.savez(path, vertices=mesh[0].astype(np.float32), triangles=mesh[1].astype(np.int32))
        rows.append(required(f"{faces:,} faces", build("large", path, *["compare"] * (faces == SIZES[0]))))
        path.unlink()
        print(f"   {faces} faces: {rows[-1]['seconds']:.1f} s of processors, {rows[-1]['peak'] / 1e9:.2f} GB")
    return {"model": models.NATURAL.stem, "sizes": rows}
