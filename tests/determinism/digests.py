# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds cases with the library that PARTWHEEL_LIBRARY names; prints {case: what was saved, as a digest} as JSON.

Run as: python digests.py THREADS CASE...
"""

import hashlib
import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "native" / "python"))

from partwheel import Hierarchy, Mode, meshes  # noqa: E402  (found only now)

MESHES = ROOT / "build" / "deps" / "meshes"
CASES = {  # name: file, options of the build
    **{name: (f"{name}.off", {}) for name in (
        "helmet", "rotor", "pinion", "hand", "handle", "couplingdown", "knot", "elephant", "triceratops", "femur")},
    "rotor with points inside": ("rotor.off", {"quality": 1.4}),
    "hand with points inside": ("hand.off", {"quality": 1.4}),
    "hand in mode paper": ("hand.off", {"mode": Mode.PAPER}),
    "rotor in mode paper": ("rotor.off", {"mode": Mode.PAPER}),
    "head, repaired": ("head.off", {}),
    "pig, from points": ("pig.off", {}),
    "elephant with holes, from points": ("elephant-with-holes.off", {}),
}


def digest(file, options, threads):
    mesh = meshes.read(MESHES / file)
    hierarchy = Hierarchy.build(mesh.vertices, mesh.triangles, mesh.faces, mesh.face_count, threads=threads, **options)
    return hashlib.sha256(hierarchy.save()).hexdigest()


if __name__ == "__main__":
    print(json.dumps({name: digest(*CASES[name], int(sys.argv[1])) for name in sys.argv[2:]}))
